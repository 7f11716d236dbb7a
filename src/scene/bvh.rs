//! A bounding-volume hierarchy: built by `obvhs` as a binary tree, which the GPU walks; the CPU walks the same boxes four at a
//! time (`quads`). Watertight.
//!
//! The triangle test is Woop, Benthin, Wald 2013 ("Watertight Ray/Triangle Intersection"): two triangles that share an edge
//! evaluate the same edge function, so no ray slips between them. No box hides a triangle that the exact ray would hit:
//! boxes are padded when they are built, and the box test is widened by its own rounding error (Ize 2013, "Robust BVH Ray
//! Traversal"). All numbers of the traversal are finite: a direction component of 0 gets a large finite reciprocal.

mod prepared;
mod quads;
#[cfg(test)]
mod tests;

use super::Triangle;
use crate::math::Vec3;
use crate::shared_struct;
use obvhs::BvhBuildParams;
use obvhs::bvh2::leaf_collapser::collapse;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::PlocBuilder;
use prepared::PreparedRay;
use quads::Quads;
use std::sync::Arc;

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

/// What a traversal does after a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Visit {
    /// As if there had been none.
    Ignore,
    /// Only nearer ones count from now on.
    Nearer,
    /// It ends.
    Stop,
}

/// The hierarchy; node 0 is the root. Empty for a scene without triangles.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    /// The nodes, as the GPU walks them. Boxes reach [`PADDING`] beyond what they hold.
    pub nodes: Arc<[Node]>,
    /// Depth of the tree, root = 1: the GPU's traversal stack never holds more than this. At most [`STACK_SIZE`].
    pub depth: u32,
    /// The same tree as the CPU walks it.
    quads: Arc<Quads>,
}

/// Trees up to this depth are walked with a small stack.
pub const SMALL_STACK: u32 = 16;

/// Deepest tree the traversal can walk.
pub const STACK_SIZE: usize = 64;

/// How far boxes reach beyond what they hold, as a part of the largest coordinate: four times its rounding error. A ray in
/// the plane of a box's face is inside the box.
pub const PADDING: f32 = 2.0 * f32::EPSILON;

/// Most triangles in a leaf.
const LEAF_SIZE: usize = 4;

impl Bvh {
    /// Builds the hierarchy and reorders `triangles` so that every leaf's are contiguous. Coordinates must be finite.
    pub fn build(triangles: &mut Vec<Triangle>) -> Self {
        if triangles.is_empty() {
            return Self::default();
        }
        let (mut nodes, mut order) = by_surface_area(triangles);
        if depth_of(&nodes) as usize > STACK_SIZE {
            // Degenerate input can make a list of a tree; halving cannot.
            (nodes, order) = by_halves(triangles);
        }
        *triangles = order.iter().map(|&i| triangles[i as usize]).collect();
        pad(&mut nodes);
        Self { depth: depth_of(&nodes), quads: Quads::new(&nodes, triangles).into(), nodes: nodes.into() }
    }

    /// The same tree around triangles that have moved: as right as a new one, if not as good.
    #[must_use]
    pub fn refitted(&self, triangles: &[Triangle]) -> Self {
        let mut nodes = self.nodes.to_vec();
        // Backwards, every node finds its children done.
        for index in parents_first(&nodes).into_iter().rev() {
            let Node { first, count, .. } = nodes[index];
            let first = first as usize;
            let (min, max) = match count {
                0 => (nodes[first].min.min(nodes[first + 1].min), nodes[first].max.max(nodes[first + 1].max)),
                _ => box_around(triangles[first..first + count as usize].iter()),
            };
            (nodes[index].min, nodes[index].max) = (min, max);
        }
        pad(&mut nodes);
        Self { depth: self.depth, quads: Quads::new(&nodes, triangles).into(), nodes: nodes.into() }
    }

    /// Bytes of both trees.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes) + self.quads.bytes()
    }

    /// The nearest hit with distance > 0.
    #[inline(always)]
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        self.nearest(&PreparedRay::new(ray.origin, ray.direction), f32::MAX, |_| true)
    }

    /// The nearest hit with distance > 0 that is accepted.
    #[inline(always)]
    pub fn closest_hit_where(&self, ray: &Ray, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        self.nearest(&PreparedRay::new(ray.origin, ray.direction), f32::MAX, accept)
    }

    /// Does anything lie strictly between the ends?
    #[inline(always)]
    pub fn any_hit(&self, segment: &Segment) -> bool {
        self.each_hit(segment, |_| Visit::Stop)
    }

    /// Visits everything strictly between the ends, in no order, until told to stop; was it?
    #[inline(always)]
    pub fn each_hit(&self, segment: &Segment, visit: impl FnMut(&Hit) -> Visit) -> bool {
        self.quads.traverse::<true>(&PreparedRay::new(segment.from, segment.to - segment.from), 1.0, visit)
    }

    /// Visits everything along a ray, in no order, until told to stop; was it?
    #[inline]
    pub fn any_hit_to_infinity(&self, ray: &Ray, visit: impl FnMut(&Hit) -> Visit) -> bool {
        self.quads.traverse::<true>(&PreparedRay::new(ray.origin, ray.direction), f32::MAX, visit)
    }

    /// The accepted hit nearest to the segment's start, `distance` as a fraction of the segment.
    pub fn closest_hit_on_segment(&self, segment: &Segment, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        self.nearest(&PreparedRay::new(segment.from, segment.to - segment.from), 1.0, accept)
    }

    #[inline(always)]
    fn nearest(&self, ray: &PreparedRay, t_max: f32, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let mut best = None;
        self.quads.traverse::<false>(ray, t_max, |hit| {
            if !accept(hit) {
                return Visit::Ignore;
            }
            best = Some(*hit);
            Visit::Nearer
        });
        best
    }
}

/// The nodes in an order in which parents come before their children.
fn parents_first(nodes: &[Node]) -> Vec<usize> {
    let (mut order, mut stack) = (Vec::with_capacity(nodes.len()), if nodes.is_empty() { Vec::new() } else { vec![0] });
    while let Some(index) = stack.pop() {
        order.push(index);
        let node = &nodes[index];
        if node.count == 0 {
            stack.extend([node.first as usize, node.first as usize + 1]);
        }
    }
    order
}

/// Makes every box reach [`PADDING`] beyond what it holds.
fn pad(nodes: &mut [Node]) {
    let largest = nodes.first().map_or(0.0, |root| root.min.abs().max(root.max.abs()).max_element());
    let padding = Vec3::splat(largest * PADDING);
    for node in nodes {
        (node.min, node.max) = (node.min - padding, node.max + padding);
    }
}

/// The box around triangles.
fn box_around<'a>(triangles: impl Iterator<Item = &'a Triangle>) -> (Vec3, Vec3) {
    let corners = triangles.flat_map(|t| [t.p0, t.p1, t.p2]);
    corners.fold((Vec3::MAX, Vec3::MIN), |(min, max), p| (min.min(p), max.max(p)))
}

/// A good tree: the surface-area heuristic as `obvhs` optimises it. The order lists the triangles leaf by leaf.
fn by_surface_area(triangles: &[Triangle]) -> (Vec<Node>, Vec<u32>) {
    let corners: Vec<_> =
        triangles.iter().map(|t| obvhs::triangle::Triangle { v0: t.p0.into(), v1: t.p1.into(), v2: t.p2.into() }).collect();
    // Large scenes build with the faster preset: the build must not dwarf the first picture.
    let preset = if triangles.len() <= 200_000 { BvhBuildParams::slow_build() } else { BvhBuildParams::medium_build() };
    // The steps of `build_bvh2_from_tris`, which itself reads a clock that browsers do not have.
    let (indices, depth) = ((0..triangles.len() as u32).collect(), preset.search_depth_threshold);
    let mut tree =
        PlocBuilder::with_capacity(corners.len()).build(preset.ploc_search_distance, &corners, indices, preset.sort_precision, depth);
    let mut optimizer = ReinsertionOptimizer::default();
    optimizer.run(&mut tree, preset.reinsertion_batch_ratio, None);
    collapse(&mut tree, LEAF_SIZE as u32, preset.collapse_traversal_cost);
    optimizer.run(&mut tree, preset.reinsertion_batch_ratio * preset.post_collapse_reinsertion_batch_ratio_multiplier, None);
    let node = |n: &Bvh2Node| Node { min: n.aabb.min.into(), first: n.first_index, max: n.aabb.max.into(), count: n.prim_count };
    (tree.nodes.iter().map(node).collect(), tree.primitive_indices)
}

/// A balanced tree, of depth ≤ 2 + log₂ n: every node's triangles are halved along the longest side of their centroids.
fn by_halves(triangles: &[Triangle]) -> (Vec<Node>, Vec<u32>) {
    let centroid = |i: &u32| {
        let t = &triangles[*i as usize];
        t.p0 + t.p1 + t.p2
    };
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    let mut nodes = vec![Node { min: Vec3::ZERO, first: 0, max: Vec3::ZERO, count: 0 }];
    let mut open = vec![(0, 0..order.len())];
    while let Some((index, range)) = open.pop() {
        let own = &mut order[range.clone()];
        let (min, max) = box_around(own.iter().map(|&i| &triangles[i as usize]));
        if own.len() <= LEAF_SIZE {
            nodes[index] = Node { min, first: range.start as u32, max, count: own.len() as u32 };
            continue;
        }
        let (low, high) = own.iter().map(centroid).fold((Vec3::MAX, Vec3::MIN), |(low, high), c| (low.min(c), high.max(c)));
        let (axis, half) = ((high - low).max_position(), own.len() / 2);
        own.select_nth_unstable_by(half, |a, b| centroid(a)[axis].total_cmp(&centroid(b)[axis]));
        let first = nodes.len();
        nodes[index] = Node { min, first: first as u32, max, count: 0 };
        nodes.extend([nodes[index]; 2]);
        open.extend([(first, range.start..range.start + half), (first + 1, range.start + half..range.end)]);
    }
    (nodes, order)
}

/// Depth of the tree, root = 1.
fn depth_of(nodes: &[Node]) -> u32 {
    let mut stack = vec![(0usize, 1u32)];
    let mut depth = 0;
    while let Some((index, level)) = stack.pop() {
        depth = depth.max(level);
        let Some(node) = nodes.get(index) else { continue };
        if node.count == 0 {
            stack.extend([(node.first as usize, level + 1), (node.first as usize + 1, level + 1)]);
        }
    }
    depth
}
