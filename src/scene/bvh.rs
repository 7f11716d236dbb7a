//! A binary bounding-volume hierarchy: built by `obvhs`, traversed here, watertight.
//!
//! The triangle test is Woop, Benthin, Wald 2013 ("Watertight Ray/Triangle Intersection"): two triangles that share an edge
//! evaluate the same edge function, so no ray slips between them. The box test is widened by its own rounding error (Ize 2013,
//! "Robust BVH Ray Traversal"), so no box hides a triangle that the exact ray would hit.

use super::Triangle;
use crate::math::Vec3;
use crate::shared_struct;
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;

shared_struct! {
    /// A box with either its two children (`count` = 0, at `first` and `first` + 1) or `count` triangles from `first` on.
    pub struct Node {
        /// Lower corner, m.
        pub min: Vec3,
        /// Index of the first child or of the first triangle.
        pub first: u32,
        /// Upper corner, m.
        pub max: Vec3,
        /// Number of triangles; 0 for an inner node.
        pub count: u32,
    }
}

/// A ray from a point along a unit direction.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Start, already moved off the surface it leaves.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
}

/// An open segment between two points, both already moved off their surfaces towards each other.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// One end.
    pub from: Vec3,
    /// The other.
    pub to: Vec3,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The triangle.
    pub triangle: u32,
    /// Distance in units of the direction's length.
    pub distance: f32,
    /// Barycentric coordinate of p1.
    pub b1: f32,
    /// Barycentric coordinate of p2.
    pub b2: f32,
}

/// The hierarchy; node 0 is the root. Empty for a scene without triangles.
#[derive(Debug, Default)]
pub struct Bvh {
    /// The nodes.
    pub nodes: Vec<Node>,
    /// Depth of the tree: the traversal stack never holds more than this.
    pub depth: u32,
}

/// Deepest tree the traversal can walk.
pub const STACK_SIZE: usize = 96;

impl Bvh {
    /// Builds the hierarchy and reorders `triangles` so that every leaf's are contiguous.
    pub fn build(triangles: &mut Vec<Triangle>) -> Self {
        if triangles.is_empty() {
            return Self::default();
        }
        let corners: Vec<_> = triangles
            .iter()
            .map(|t| obvhs::triangle::Triangle { v0: t.p0.into(), v1: t.p1.into(), v2: t.p2.into() })
            .collect();
        // Large scenes build with the faster preset: the build must not dwarf the first picture.
        let mut params = if triangles.len() <= 200_000 { BvhBuildParams::slow_build() } else { BvhBuildParams::medium_build() };
        params.pre_split = false;
        params.max_prims_per_leaf = 4;
        let built = build_bvh2_from_tris(&corners, params, &mut std::time::Duration::default());
        let nodes: Vec<Node> = built
            .nodes
            .iter()
            .map(|n| Node { min: n.aabb.min.into(), first: n.first_index, max: n.aabb.max.into(), count: n.prim_count })
            .collect();
        *triangles = built.primitive_indices.iter().map(|&i| triangles[i as usize]).collect();
        let depth = depth_of(&nodes);
        Self { nodes, depth }
    }

    /// The nearest hit with distance > 0.
    #[inline]
    pub fn closest_hit(&self, triangles: &[Triangle], ray: &Ray) -> Option<Hit> {
        let mut best = None;
        self.traverse(triangles, &Woop::new(ray.origin, ray.direction), f32::MAX, |hit| {
            best = Some(hit);
            false
        });
        best
    }

    /// Does anything lie strictly between the ends?
    #[inline]
    pub fn any_hit(&self, triangles: &[Triangle], segment: &Segment) -> bool {
        self.traverse(triangles, &Woop::new(segment.from, segment.to - segment.from), 1.0, |_| true)
    }

    /// The hit nearest to the segment's start, `distance` as a fraction of the segment.
    pub fn closest_hit_on_segment(&self, triangles: &[Triangle], segment: &Segment) -> Option<Hit> {
        let mut best = None;
        self.traverse(triangles, &Woop::new(segment.from, segment.to - segment.from), 1.0, |hit| {
            best = Some(hit);
            false
        });
        best
    }

    /// Visits hits nearer and nearer, from `t_max` down, until `stop` says so (then true) or there is none left.
    #[inline(always)]
    fn traverse(&self, triangles: &[Triangle], ray: &Woop, mut t_max: f32, mut stop: impl FnMut(Hit) -> bool) -> bool {
        let Some(root) = self.nodes.first() else { return false };
        let mut stack = [(0u32, 0.0f32); STACK_SIZE];
        let mut top = 0;
        if ray.enters(root, t_max).is_none() {
            return false;
        }
        let mut node = root;
        loop {
            if node.count > 0 {
                for index in node.first..node.first + node.count {
                    if let Some(hit) = ray.hit(&triangles[index as usize], index, t_max) {
                        if stop(hit) {
                            return true;
                        }
                        t_max = hit.distance;
                    }
                }
            } else {
                // Nearer child first, the other waits on the stack with its entry distance.
                let (a, b) = (&self.nodes[node.first as usize], &self.nodes[node.first as usize + 1]);
                match (ray.enters(a, t_max), ray.enters(b, t_max)) {
                    (Some(t_a), Some(t_b)) => {
                        let (near, far) = if t_a <= t_b { (a, (node.first + 1, t_b)) } else { (b, (node.first, t_a)) };
                        stack[top] = far;
                        top += 1;
                        node = near;
                        continue;
                    }
                    (Some(_), None) => {
                        node = a;
                        continue;
                    }
                    (None, Some(_)) => {
                        node = b;
                        continue;
                    }
                    (None, None) => {}
                }
            }
            loop {
                if top == 0 {
                    return false;
                }
                top -= 1;
                let (index, entry) = stack[top];
                if entry < t_max {
                    node = &self.nodes[index as usize];
                    break;
                }
            }
        }
    }
}

/// Depth of the tree, root = 1.
fn depth_of(nodes: &[Node]) -> u32 {
    let mut stack = vec![(0usize, 1u32)];
    let mut depth = 0;
    while let Some((index, level)) = stack.pop() {
        depth = depth.max(level);
        let node = &nodes[index];
        if node.count == 0 {
            stack.push((node.first as usize, level + 1));
            stack.push((node.first as usize + 1, level + 1));
        }
    }
    depth
}

/// A ray prepared for both tests: its largest axis as z, the shear that makes it the z axis, and its reciprocals.
struct Woop {
    origin: Vec3,
    inv_direction: Vec3,
    k: [usize; 3],
    shear: Vec3,
}

impl Woop {
    #[inline(always)]
    fn new(origin: Vec3, direction: Vec3) -> Self {
        let kz = direction.abs().max_position();
        let (kx, ky) = ((kz + 1) % 3, (kz + 2) % 3);
        // Swapping x and y where z points backwards keeps the winding.
        let k = if direction[kz] < 0.0 { [ky, kx, kz] } else { [kx, ky, kz] };
        let inv_z = 1.0 / direction[kz];
        let shear = Vec3::new(direction[k[0]] * inv_z, direction[k[1]] * inv_z, inv_z);
        Self { origin, inv_direction: direction.recip(), k, shear }
    }

    /// Distance at which the ray enters the box, if it does before `t_max`.
    #[inline(always)]
    fn enters(&self, node: &Node, t_max: f32) -> Option<f32> {
        // 1 + 2γ₃, so that rounding never loses a box. NaN (0 · ∞, a ray inside a face's plane) leaves its axis out.
        const WIDEN: f32 = 1.000_000_4;
        let t0 = (node.min - self.origin) * self.inv_direction;
        let t1 = (node.max - self.origin) * self.inv_direction;
        let near = |a: f32, b: f32, t: f32| t.max(a.min(b));
        let far = |a: f32, b: f32, t: f32| t.min(a.max(b) * WIDEN);
        let t_near = near(t0.x, t1.x, near(t0.y, t1.y, near(t0.z, t1.z, 0.0)));
        let t_far = far(t0.x, t1.x, far(t0.y, t1.y, far(t0.z, t1.z, t_max)));
        (t_near <= t_far).then_some(t_near)
    }

    /// The watertight triangle test, both faces, for 0 < distance < `t_max`.
    #[inline(always)]
    fn hit(&self, triangle: &Triangle, index: u32, t_max: f32) -> Option<Hit> {
        let [kx, ky, kz] = self.k;
        let (a, b, c) = (triangle.p0 - self.origin, triangle.p1 - self.origin, triangle.p2 - self.origin);
        let shear = |p: Vec3| (p[kx] - self.shear.x * p[kz], p[ky] - self.shear.y * p[kz]);
        let ((ax, ay), (bx, by), (cx, cy)) = (shear(a), shear(b), shear(c));
        let (mut u, mut v, mut w) = (cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax);
        if u == 0.0 || v == 0.0 || w == 0.0 {
            let det = |p: f32, q: f32, r: f32, s: f32| (f64::from(p) * f64::from(q) - f64::from(r) * f64::from(s)) as f32;
            (u, v, w) = (det(cx, by, cy, bx), det(ax, cy, ay, cx), det(bx, ay, by, ax));
        }
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let det = u + v + w;
        if det == 0.0 {
            return None;
        }
        let inv = 1.0 / det;
        let distance = self.shear.z * (u * a[kz] + v * b[kz] + w * c[kz]) * inv;
        (distance > 0.0 && distance < t_max).then(|| Hit { triangle: index, distance, b1: v * inv, b2: w * inv })
    }
}
