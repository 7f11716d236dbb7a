//! One ray against one box and one triangle: the inner loop of every traversal.
//!
//! ```text
//! box:       t = (plane − o)/d per axis; entered at the largest of the near ones, left at the smallest of the far ones
//! triangle:  (x, y, z)′ = shear(p − o) makes the ray the z axis;   eᵢ = x′ⱼy′ₖ − y′ⱼx′ₖ are its three edge functions
//! ```

use super::super::Triangle;
use super::{Hit, Node};
use crate::math::Vec3;
use glam::{Vec3A, Vec3Swizzles, Vec4};

/// A direction's components are taken to be at least this large: what it bends a ray by is far below the padding.
const TINY: f32 = 1e-20;

/// A ray prepared for both tests: its largest axis as z, the shear that makes it the z axis, and its reciprocals.
pub struct PreparedRay {
    /// Start.
    origin: Vec3A,
    /// Reciprocal of the direction, finite.
    reciprocal: Vec3A,
    /// The axes to use as x, y, z: z the direction's largest, x and y such that the winding is kept.
    axes: [usize; 3],
    /// The start along these axes.
    start: Vec3,
    /// The shear of x and y by z, and the scale of z.
    shear: Vec3,
}

impl PreparedRay {
    #[inline(always)]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        let z = direction.abs().max_position();
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        // Swapping x and y where z points backwards keeps the winding.
        let axes = if direction[z] < 0.0 { [y, x, z] } else { [x, y, z] };
        let scale = 1.0 / direction[z];
        let finite = |d: f32| 1.0 / if d.abs() < TINY { TINY.copysign(d) } else { d };
        Self {
            origin: origin.into(),
            reciprocal: Vec3A::new(finite(direction.x), finite(direction.y), finite(direction.z)),
            axes,
            start: Vec3::from_array(axes.map(|a| origin[a])),
            shear: Vec3::new(direction[axes[0]] * scale, direction[axes[1]] * scale, scale),
        }
    }

    /// The distances at which the ray enters and leaves the box, within 0…`t_max`; it misses if the first is the larger.
    #[inline(always)]
    pub fn span(&self, node: &Node, t_max: f32) -> (f32, f32) {
        // 1 + 2γ₃: what rounding may have taken from the far distance.
        const WIDEN: f32 = 1.000_000_4;
        // Whole nodes are loaded: the fourth lane holds the indices and is never looked at.
        let [min, max]: [[f32; 4]; 2] = bytemuck::cast(*node);
        let t0 = (Vec3A::from_vec4(Vec4::from_array(min)) - self.origin) * self.reciprocal;
        let t1 = (Vec3A::from_vec4(Vec4::from_array(max)) - self.origin) * self.reciprocal;
        let (near, far) = (t0.min(t1).max_element(), t0.max(t1).min_element() * WIDEN);
        (if near > 0.0 { near } else { 0.0 }, if far < t_max { far } else { t_max })
    }

    /// The watertight triangle test, both faces, for 0 < distance < `t_max`.
    #[inline(always)]
    pub fn hit(&self, triangle: &Triangle, index: u32, t_max: f32) -> Option<Hit> {
        // Loads at the axes' places in the flat struct: no vector is indexed.
        let numbers: &[f32; 12] = bytemuck::cast_ref(triangle);
        let column = |a: usize| Vec3A::new(numbers[self.axes[a] & 3], numbers[4 + (self.axes[a] & 3)], numbers[8 + (self.axes[a] & 3)]);
        let z = column(2) - self.start.z;
        let x = column(0) - self.start.x - z * self.shear.x;
        let y = column(1) - self.start.y - z * self.shear.y;
        // (cx·by − cy·bx, ax·cy − ay·cx, bx·ay − by·ax)
        let mut e = x.zxy() * y.yzx() - y.zxy() * x.yzx();
        if e.cmpeq(Vec3A::ZERO).any() {
            e = exact_edges(x, y);
        }
        if e.cmplt(Vec3A::ZERO).any() && e.cmpgt(Vec3A::ZERO).any() {
            return None;
        }
        let det = e.x + e.y + e.z;
        if det == 0.0 {
            return None;
        }
        let inv = 1.0 / det;
        let distance = self.shear.z * e.dot(z) * inv;
        (distance > 0.0 && distance < t_max).then_some(Hit { triangle: index, distance, b1: e.y * inv, b2: e.z * inv })
    }
}

/// The edge functions again where one came out as 0: in f64 their signs are exact.
#[cold]
fn exact_edges(x: Vec3A, y: Vec3A) -> Vec3A {
    let (x, y) = (x.as_dvec3(), y.as_dvec3());
    (x.zxy() * y.yzx() - y.zxy() * x.yzx()).as_vec3a()
}
