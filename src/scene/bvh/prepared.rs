//! One ray against four boxes and four triangles: the inner loop of every traversal. And the same for one box and one
//! triangle, as a definition: `tests.rs` holds both against each other, bit for bit.
//!
//! ```text
//! box:       t = (plane − o)/d per axis; entered at the largest of the near ones, left at the smallest of the far ones
//! triangle:  (x, y, z)′ = shear(p − o) makes the ray the z axis;   eᵢ = x′ⱼy′ₖ − y′ⱼx′ₖ are its three edge functions
//! ```

use super::quads::{Leaf, Quad};
use crate::math::Vec3;
use glam::Vec4;

/// A direction's components are taken to be at least this large: what it bends a ray by is far below the padding.
const TINY: f32 = 1e-20;
/// 1 + 2γ₃: what rounding may have taken from the far distance.
const WIDEN: f32 = 1.000_000_4;

/// A ray prepared for both tests: its largest axis as z, the shear that makes it the z axis, and its reciprocals.
pub(super) struct PreparedRay {
    /// Start, per axis.
    origin: [Vec4; 3],
    /// Reciprocal of the direction, finite, per axis.
    reciprocal: [Vec4; 3],
    /// Per axis: does the ray meet a box's upper corner before the lower one?
    upper_first: [bool; 3],
    /// The axes to use as x, y, z: z the direction's largest, x and y such that the winding is kept.
    axes: [usize; 3],
    /// The start along these axes.
    start: [Vec4; 3],
    /// The shear of x and y by z, and the scale of z.
    shear: [Vec4; 3],
}

/// Where a ray meets the triangles of a leaf.
pub(super) struct Hits {
    /// A bit per triangle that it meets.
    pub lanes: u32,
    /// Distance in units of the direction's length.
    pub distance: Vec4,
    /// Barycentric coordinate of p1.
    pub b1: Vec4,
    /// Barycentric coordinate of p2.
    pub b2: Vec4,
}

impl PreparedRay {
    #[inline(always)]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        let z = direction.abs().max_position();
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        // Swapping x and y where z points backwards keeps the winding.
        let axes = if direction[z] < 0.0 { [y, x, z] } else { [x, y, z] };
        let divisor = |d: f32| if d.abs() < TINY { TINY.copysign(d) } else { d };
        let [dx, dy, dz] = direction.to_array();
        let reciprocal: [f32; 4] = (1.0 / Vec4::new(divisor(dx), divisor(dy), divisor(dz), 1.0)).into();
        let scale = reciprocal[z & 3];
        let reciprocal = [reciprocal[0], reciprocal[1], reciprocal[2]];
        Self {
            origin: origin.to_array().map(Vec4::splat),
            reciprocal: reciprocal.map(Vec4::splat),
            upper_first: reciprocal.map(|r| r < 0.0),
            axes,
            start: axes.map(|a| Vec4::splat(origin[a])),
            shear: [direction[axes[0]] * scale, direction[axes[1]] * scale, scale].map(Vec4::splat),
        }
    }

    /// A bit per box that the ray meets within 0…`t_max`, and where it enters each.
    #[inline(always)]
    pub fn enter(&self, quad: &Quad, t_max: f32) -> (u32, Vec4) {
        let plane = |corner: usize, axis: usize| (quad.bounds[corner][axis] - self.origin[axis]) * self.reciprocal[axis];
        let [x, y, z] = self.upper_first.map(usize::from);
        let near = plane(x, 0).max(plane(y, 1)).max(plane(z, 2)).max(Vec4::ZERO);
        let far = plane(1 - x, 0).min(plane(1 - y, 1)).min(plane(1 - z, 2)) * WIDEN;
        (near.cmple(far.min(Vec4::splat(t_max))).bitmask(), near)
    }

    /// The watertight triangle test, both faces, for 0 < distance < `t_max`; `None` if all are missed.
    #[inline(always)]
    pub fn hits(&self, leaf: &Leaf, t_max: f32) -> Option<Hits> {
        let axes = self.axes.map(|axis| axis.min(2));
        let sheared = |corner: usize| {
            let [x, y, z] = [0, 1, 2].map(|i| leaf.corners[corner][axes[i]] - self.start[i]);
            [x - z * self.shear[0], y - z * self.shear[1], z]
        };
        let [[x0, y0, z0], [x1, y1, z1], [x2, y2, z2]] = [sheared(0), sheared(1), sheared(2)];
        let (mut e0, mut e1, mut e2) = (x2 * y1 - y2 * x1, x0 * y2 - y0 * x2, x1 * y0 - y1 * x0);
        let zero = e0.cmpeq(Vec4::ZERO) | e1.cmpeq(Vec4::ZERO) | e2.cmpeq(Vec4::ZERO);
        if zero.any() {
            let exact = exact_edges([x0, x1, x2], [y0, y1, y2]);
            [e0, e1, e2] = [(exact[0], e0), (exact[1], e1), (exact[2], e2)].map(|(exact, e)| Vec4::select(zero, exact, e));
        }
        let negative = e0.cmplt(Vec4::ZERO) | e1.cmplt(Vec4::ZERO) | e2.cmplt(Vec4::ZERO);
        let positive = e0.cmpgt(Vec4::ZERO) | e1.cmpgt(Vec4::ZERO) | e2.cmpgt(Vec4::ZERO);
        let det = e0 + e1 + e2;
        let inside = !(negative & positive) & det.cmpne(Vec4::ZERO);
        if inside.bitmask() & leaf.lanes == 0 {
            return None;
        }
        let inverse = 1.0 / det;
        let distance = self.shear[2] * (e0 * z0 + e1 * z1 + e2 * z2) * inverse;
        let reached = inside & distance.cmpgt(Vec4::ZERO) & distance.cmplt(Vec4::splat(t_max));
        let lanes = reached.bitmask() & leaf.lanes;
        (lanes != 0).then_some(Hits { lanes, distance, b1: e1 * inverse, b2: e2 * inverse })
    }
}

/// The edge functions again, for the triangles where one came out as 0: in f64 their signs are exact.
#[cold]
#[inline(never)]
fn exact_edges([x0, x1, x2]: [Vec4; 3], [y0, y1, y2]: [Vec4; 3]) -> [Vec4; 3] {
    let ([x0, x1, x2], [y0, y1, y2]) = ([x0, x1, x2].map(|v| v.as_dvec4()), [y0, y1, y2].map(|v| v.as_dvec4()));
    [x2 * y1 - y2 * x1, x0 * y2 - y0 * x2, x1 * y0 - y1 * x0].map(|e| e.as_vec4())
}
