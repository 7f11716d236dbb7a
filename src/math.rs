//! Vectors, frames, sampling warps and the error bounds that keep rays off the surfaces they leave.
//!
//! ```text
//! G(x↔x′)  = |cosθ cosθ′| / ‖x − x′‖²                    (Veach 8.2; visibility is a separate factor)
//! P_A(x′)  = P_σ⊥(x→x′) · G(x↔x′)                        (Veach 8.8)
//! ```
//! Everything here is a pure function of its arguments; sampling uses + − × ÷ √ and our own polynomials only, so that
//! another machine or a GPU computes the same numbers.

pub use glam::{DMat3, DMat4, DVec3, Vec2, Vec3};

/// π as f32.
pub const PI: f32 = std::f32::consts::PI;
/// 1/π, sr⁻¹: the density of a cosine-distributed direction per *projected* solid angle.
pub const INV_PI: f32 = std::f32::consts::FRAC_1_PI;

/// An orthonormal frame whose third axis is a given unit vector (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// First tangent.
    pub x: Vec3,
    /// Second tangent.
    pub y: Vec3,
    /// The given axis.
    pub z: Vec3,
}

impl Frame {
    /// The frame around the unit vector `z`.
    #[inline]
    pub fn around(z: Vec3) -> Self {
        let sign = 1.0f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        Self { x: Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x), y: Vec3::new(b, sign + z.y * z.y * a, -z.y), z }
    }

    /// From local coordinates to the coordinates of the frame's axes.
    #[inline]
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

/// `(sin, cos)` of `2π·turn` for `turn ∈ [0, 1)`, by our own polynomials; |error| < 4·10⁻⁷.
#[inline]
pub fn sin_cos_turn(turn: f32) -> (f32, f32) {
    // Reduce to the nearest quarter turn: r ∈ [−1/8, 1/8] turn, as an angle a ∈ [−π/4, π/4].
    let quarter = (turn * 4.0 + 0.5).floor();
    let a = (turn - quarter * 0.25) * (2.0 * PI);
    let a2 = a * a;
    let s = a * (1.0 + a2 * (-1.666_666_5e-1 + a2 * (8.333_216e-3 + a2 * -1.951_529_6e-4)));
    let c = 1.0 + a2 * (-0.5 + a2 * (4.166_664_6e-2 + a2 * (-1.388_731_6e-3 + a2 * 2.443_315_7e-5)));
    match quarter as i32 & 3 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// A point of the unit disk, uniform in area (concentric map, Shirley & Chiu 1997); density 1/π per area.
#[inline]
pub fn sample_disk(u: Vec2) -> Vec2 {
    let a = u * 2.0 - 1.0;
    if a.x == 0.0 && a.y == 0.0 {
        return Vec2::ZERO;
    }
    // The angle is (π/4)·(small/large), measured from the axis of the larger coordinate.
    let (radius, turn) = if a.x.abs() > a.y.abs() { (a.x, (a.y / a.x) * 0.125) } else { (a.y, 0.25 - (a.x / a.y) * 0.125) };
    let (sin, cos) = sin_cos_turn(turn - turn.floor());
    Vec2::new(cos, sin) * radius
}

/// A direction around +z with density cosθ/π per solid angle, i.e. 1/π per projected solid angle.
#[inline]
pub fn sample_cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = sample_disk(u);
    Vec3::new(d.x, d.y, (1.0 - d.length_squared()).max(0.0).sqrt())
}

/// A direction uniform on the sphere; density 1/(4π) per solid angle.
#[inline]
pub fn sample_sphere(u: Vec2) -> Vec3 {
    direction_at(u.y, 2.0 * u.x)
}

/// The direction `turn` around +z whose cosine with +z is 1 − `versine`, `versine` ∈ [0, 2]: near the axis 1 − cosθ keeps
/// the digits that cosθ has lost.
#[inline]
pub fn direction_at(turn: f32, versine: f32) -> Vec3 {
    let (sin, cos) = sin_cos_turn(turn);
    let r = (versine * (2.0 - versine)).max(0.0).sqrt();
    Vec3::new(cos * r, sin * r, 1.0 - versine)
}

/// 1 − cosθ of the angle between two unit vectors.
#[inline]
pub fn versine(a: Vec3, b: Vec3) -> f32 {
    0.5 * (a - b).length_squared()
}

/// The angle of the point (x, y) as a part of a full turn, in [0, 1); |error| < 10⁻⁷ turns. 0 at the origin.
#[inline]
pub fn turn_of(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    let (small, large) = if ax < ay { (ax, ay) } else { (ay, ax) };
    if large == 0.0 {
        return 0.0;
    }
    // atan on [0, tan π/8], the rest by atan a = π/4 + atan((a − 1)/(a + 1)).
    const TAN_EIGHTH: f32 = 0.414_213_57;
    let shifted = small > TAN_EIGHTH * large;
    let a = if shifted { (small - large) / (small + large) } else { small / large };
    let a2 = a * a;
    let poly = a + a * a2 * (-3.333_295e-1 + a2 * (1.997_771_1e-1 + a2 * (-1.387_768_6e-1 + a2 * 8.053_744_5e-2)));
    let octant = poly * (0.5 * INV_PI) + if shifted { 0.125 } else { 0.0 };
    let quarter = if ax < ay { 0.25 - octant } else { octant };
    let half = if x < 0.0 { 0.5 - quarter } else { quarter };
    let turn = if y < 0.0 { 1.0 - half } else { half };
    if turn >= 1.0 { 0.0 } else { turn }
}

/// ∛x for x ∈ [0, 1], relative error < 10⁻⁶: a first guess from the exponent, then Newton's steps.
#[inline]
pub fn cube_root(x: f32) -> f32 {
    if x <= f32::MIN_POSITIVE {
        return 0.0;
    }
    let mut y = f32::from_bits(x.to_bits() / 3 + 0x2a51_37a0);
    for _ in 0..3 {
        y -= (y - x / (y * y)) * (1.0 / 3.0);
    }
    y
}

/// Barycentric coordinates `(b1, b2)` of a point uniform on a triangle (Turk 1990 square-root warp).
#[inline]
pub fn sample_triangle(u: Vec2) -> Vec2 {
    let r = u.x.sqrt();
    Vec2::new(r * (1.0 - u.y), r * u.y)
}

/// Reflection of `w` about `n`; both point away from the surface.
#[inline]
pub fn reflect(w: Vec3, n: Vec3) -> Vec3 {
    n * (2.0 * w.dot(n)) - w
}

/// Refraction of `w` (pointing away from the surface) through the interface with normal `n`;
/// `eta` = index on the side of `n` over index on the other side's, seen from `w`: η_w / η_other.
/// `None` at total internal reflection.
#[inline]
pub fn refract(w: Vec3, n: Vec3, eta: f32) -> Option<Vec3> {
    let cos_i = w.dot(n);
    let n = if cos_i < 0.0 { -n } else { n };
    let cos_i = cos_i.abs();
    let cos2_t = 1.0 - eta * eta * (1.0 - cos_i * cos_i).max(0.0);
    if cos2_t <= 0.0 {
        return None;
    }
    Some((n * (eta * cos_i - cos2_t.sqrt()) - w * eta).normalize())
}

/// The unit direction from `a` to `b` and the squared distance between them, m². One rounding for everyone: from `b` to `a`
/// it is the exact opposite.
#[inline]
pub fn direction_between(a: Vec3, b: Vec3) -> (Vec3, f32) {
    let offset = b - a;
    let distance_squared = offset.length_squared();
    (offset * (1.0 / distance_squared.sqrt()), distance_squared)
}

/// The geometry term without visibility, m⁻²; `w` is the unit direction between the points.
#[inline]
pub fn geometry_term(n: Vec3, n_other: Vec3, w: Vec3, distance_squared: f32) -> f32 {
    (n.dot(w) * n_other.dot(w)).abs() / distance_squared
}

/// Moves `p` off the surface with normal `n`, to the side `w` leaves on, by the bound `error` (metres, per axis) on where
/// the exact point may lie (Pharr, Jakob, Humphreys: *PBRT*, 6.8.6). The bound has room for the rounding of this very sum.
#[inline]
pub fn offset_ray_origin(p: Vec3, error: f32, n: Vec3, w: Vec3) -> Vec3 {
    p + n * ((n.x.abs() + n.y.abs() + n.z.abs()) * error).copysign(n.dot(w))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sin_cos_turn_is_accurate_all_round() {
        for i in 0..100_000 {
            let turn = i as f32 / 100_000.0;
            let (s, c) = sin_cos_turn(turn);
            let exact = f64::from(turn) * std::f64::consts::TAU;
            assert!((f64::from(s) - exact.sin()).abs() < 4e-7, "sin at {turn}");
            assert!((f64::from(c) - exact.cos()).abs() < 4e-7, "cos at {turn}");
        }
    }

    #[test]
    fn turn_of_is_accurate_all_round() {
        for i in 0..100_000 {
            let angle = (f64::from(i) + 0.5) / 100_000.0 * std::f64::consts::TAU;
            for r in [1e-6, 1.0, 1e6] {
                let (x, y) = ((r * angle.cos()) as f32, (r * angle.sin()) as f32);
                let exact = f64::from(y).atan2(f64::from(x)).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
                assert!((f64::from(turn_of(y, x)) - exact).abs() < 1e-7, "{x} {y}: {} {exact}", turn_of(y, x));
            }
        }
        assert_eq!([(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 0.0)].map(|(y, x)| turn_of(y, x)), [0.0, 0.25, 0.5, 0.75, 0.0]);
    }

    #[test]
    fn cube_roots_are_cube_roots() {
        for i in 0..100_000 {
            let x = (i as f32 + 1.0) / 100_000.0;
            for x in [x, x * 1e-10] {
                assert!((cube_root(x).powi(3) / x - 1.0).abs() < 3e-6, "{x}: {}", cube_root(x));
            }
        }
        assert_eq!((cube_root(0.0), cube_root(1.0)), (0.0, 1.0));
    }

    #[test]
    fn frames_are_orthonormal_everywhere() {
        for z in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_Z, Vec3::new(1e-4, 0.0, -1.0).normalize(), Vec3::new(1.0, -2.0, 0.5).normalize()] {
            let f = Frame::around(z);
            for (a, b) in [(f.x, f.y), (f.y, f.z), (f.x, f.z)] {
                assert!(a.dot(b).abs() < 1e-6);
            }
            assert!((f.x.cross(f.y) - f.z).length() < 1e-6);
        }
    }

    #[test]
    fn refraction_is_reversible() {
        let n = Vec3::Z;
        let w = Vec3::new(0.6, 0.1, 0.7).normalize();
        let t = refract(w, n, 1.0 / 1.5).unwrap();
        let back = refract(t, n, 1.5).unwrap();
        assert!((back - w).length() < 1e-6, "{back} {w}");
        assert!(refract(Vec3::new(0.9, 0.0, -0.2).normalize(), n, 1.5).is_none());
    }
}
