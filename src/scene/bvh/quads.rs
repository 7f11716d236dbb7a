//! The hierarchy as the CPU walks it: four boxes of a node at once, four triangles of a leaf at once.
//!
//! It is the binary tree with levels left out, so it holds the same boxes and the same triangles. Nodes and triangles lie lane
//! by lane in vectors of four; [`super::prepared`] has the tests, and the definition of each for one box and one triangle.

use super::super::Triangle;
use super::prepared::PreparedRay;
use super::{Hit, LEAF_SIZE, Node, STACK_SIZE, Visit};
use glam::{Vec3Swizzles, Vec4};

/// Marks a child that is a leaf; the rest of the number is its place among the leaves.
const LEAF: u32 = 1 << 31;
/// Trees whose walk keeps no more than this waiting are walked with a small stack, which costs less to clear.
const SMALL_STACK: usize = 15;
/// The same for trees of a million triangles.
const MEDIUM_STACK: usize = 39;
/// Three of a node's four children wait while one is walked, on every level of the deepest tree.
const LARGE_STACK: usize = 3 * STACK_SIZE;

/// Up to four boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quad {
    /// Lower and upper corners: [lower or upper][axis], a lane per child. An empty lane's box is inside out: nothing meets it.
    pub bounds: [[Vec4; 3]; 2],
    /// Index of a node, or [`LEAF`] and that of a leaf.
    children: [u32; 4],
}

/// One to four triangles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leaf {
    /// [corner][axis], a lane per triangle; empty lanes repeat the first.
    pub corners: [[Vec4; 3]; 3],
    /// Which triangle is in which lane.
    triangles: [u32; 4],
    /// A bit per lane that is not empty.
    pub lanes: u32,
}

/// The tree; node 0 is the root.
#[derive(Clone, Debug, Default)]
pub(super) struct Quads {
    nodes: Vec<Quad>,
    leaves: Vec<Leaf>,
    /// The most that ever waits on the stack of a walk.
    waiting: usize,
}

impl Quads {
    /// The tree with the boxes of a binary one.
    pub fn new(binary: &[Node], triangles: &[Triangle]) -> Self {
        let mut tree = Self::default();
        if binary.is_empty() {
            return tree;
        }
        let below = triangles_below(binary);
        // (place, the binary node that it stands for, what waits above it)
        tree.nodes.push(Quad::EMPTY);
        let mut open = vec![(0, 0, 0)];
        while let Some((place, node, waiting)) = open.pop() {
            let children = descendants(binary, &below, node);
            let waiting = waiting + children.len() - 1;
            tree.waiting = tree.waiting.max(waiting);
            for (lane, &child) in children.iter().enumerate() {
                let code = if below[child] as usize <= LEAF_SIZE {
                    tree.leaves.push(Leaf::new(binary, child, triangles));
                    LEAF | (tree.leaves.len() as u32 - 1)
                } else {
                    tree.nodes.push(Quad::EMPTY);
                    open.push((tree.nodes.len() - 1, child, waiting));
                    tree.nodes.len() as u32 - 1
                };
                tree.nodes[place].put(lane, &binary[child], code);
            }
        }
        tree
    }

    /// Bytes of its arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.leaves.as_slice())
    }

    /// Visits hits at distances below `t_max` until told to stop (then true) or there is none left; nearer boxes first, unless
    /// any hit (`ANY`) is as good as another.
    #[inline(always)]
    pub fn traverse<const ANY: bool>(&self, ray: &PreparedRay, t_max: f32, visit: impl FnMut(&Hit) -> Visit) -> bool {
        if self.waiting <= SMALL_STACK {
            self.traverse_with::<{ SMALL_STACK + 1 }, ANY>(ray, t_max, visit)
        } else if self.waiting <= MEDIUM_STACK {
            self.traverse_with::<{ MEDIUM_STACK + 1 }, ANY>(ray, t_max, visit)
        } else {
            self.traverse_with::<{ LARGE_STACK + 1 }, ANY>(ray, t_max, visit)
        }
    }

    #[inline(always)]
    fn traverse_with<const N: usize, const ANY: bool>(
        &self,
        ray: &PreparedRay,
        mut t_max: f32,
        mut visit: impl FnMut(&Hit) -> Visit,
    ) -> bool {
        // Entry distances above, children below: a non-negative f32 and its bits are ordered alike.
        let key = |near: f32, child: u32| u64::from(near.to_bits()) << 32 | u64::from(child);
        let (mut stack, mut top, mut at) = ([0u64; N], 0, 0u32);
        if self.nodes.is_empty() {
            return false;
        }
        loop {
            if at & LEAF == 0 {
                let quad = &self.nodes[at as usize];
                let (mut lanes, near) = ray.enter(quad, t_max);
                if lanes.is_power_of_two() {
                    at = quad.children[lanes.trailing_zeros() as usize];
                    continue;
                }
                if ANY && lanes != 0 {
                    while !lanes.is_power_of_two() {
                        stack[top] = u64::from(quad.children[lanes.trailing_zeros() as usize]);
                        top += 1;
                        lanes &= lanes - 1;
                    }
                    at = quad.children[lanes.trailing_zeros() as usize];
                    continue;
                }
                if lanes != 0 {
                    let near = near.to_array();
                    let waiting = |lane: usize| if lanes >> lane & 1 == 1 { key(near[lane], quad.children[lane]) } else { u64::MAX };
                    let [first, rest @ ..] = sorted([waiting(0), waiting(1), waiting(2), waiting(3)]);
                    for key in rest.into_iter().rev().filter(|&key| key != u64::MAX) {
                        stack[top] = key;
                        top += 1;
                    }
                    at = first as u32;
                    continue;
                }
            } else {
                let leaf = &self.leaves[(at & !LEAF) as usize];
                if let Some(hits) = ray.hits(leaf, t_max) {
                    let mut lanes = hits.lanes;
                    while lanes != 0 {
                        let lane = lanes.trailing_zeros() as usize & 3;
                        lanes &= lanes - 1;
                        let distance = hits.distance[lane];
                        if distance < t_max {
                            let hit = Hit { triangle: leaf.triangles[lane], distance, b1: hits.b1[lane], b2: hits.b2[lane] };
                            match visit(&hit) {
                                Visit::Ignore => {}
                                Visit::Nearer => t_max = distance,
                                Visit::Stop => return true,
                            }
                        }
                    }
                }
            }
            loop {
                if top == 0 {
                    return false;
                }
                top -= 1;
                if ANY || f32::from_bits((stack[top] >> 32) as u32) <= t_max {
                    at = stack[top] as u32;
                    break;
                }
            }
        }
    }
}

impl Quad {
    /// Four empty lanes.
    pub const EMPTY: Self = Self { bounds: [[Vec4::MAX; 3], [Vec4::MIN; 3]], children: [LEAF; 4] };

    fn put(&mut self, lane: usize, node: &Node, child: u32) {
        for axis in 0..3 {
            self.bounds[0][axis][lane] = node.min[axis];
            self.bounds[1][axis][lane] = node.max[axis];
        }
        self.children[lane] = child;
    }
}

impl Leaf {
    /// The one to four triangles below a binary node.
    fn new(binary: &[Node], node: usize, triangles: &[Triangle]) -> Self {
        let (mut own, mut stack) = (Vec::with_capacity(LEAF_SIZE), vec![node]);
        while let Some(index) = stack.pop() {
            let Node { first, count, .. } = binary[index];
            own.extend(first..first + count);
            if count == 0 {
                stack.extend([first as usize + 1, first as usize]);
            }
        }
        let lane = |i: usize| own.get(i).copied().unwrap_or(own[0]);
        let of = [0, 1, 2, 3].map(lane);
        let corner = |get: fn(&Triangle) -> glam::Vec3| {
            let [a, b, c, d] = of.map(|i| get(&triangles[i as usize]));
            [0, 1, 2].map(|axis| Vec4::new(a[axis], b[axis], c[axis], d[axis]))
        };
        Self { corners: [corner(|t| t.p0), corner(|t| t.p1), corner(|t| t.p2)], triangles: of, lanes: (1 << own.len()) - 1 }
    }
}

/// How many triangles lie below each binary node.
fn triangles_below(binary: &[Node]) -> Vec<u32> {
    let mut below = vec![0; binary.len()];
    for index in super::parents_first(binary).into_iter().rev() {
        let Node { first, count, .. } = binary[index];
        below[index] = if count > 0 { count } else { below[first as usize] + below[first as usize + 1] };
    }
    below
}

/// Up to four descendants that hold all of a node's triangles: the largest that is no leaf's worth makes room for its children
/// until there are four.
fn descendants(binary: &[Node], below: &[u32], node: usize) -> Vec<usize> {
    let area = |&index: &usize| {
        let size = binary[index].max - binary[index].min;
        size.dot(size.zxy())
    };
    let mut chosen = vec![node];
    while chosen.len() < 4 {
        let open = (0..chosen.len()).filter(|&i| below[chosen[i]] as usize > LEAF_SIZE);
        let Some(largest) = open.max_by(|&a, &b| area(&chosen[a]).total_cmp(&area(&chosen[b]))) else { break };
        let first = binary[chosen[largest]].first as usize;
        chosen[largest] = first;
        chosen.push(first + 1);
    }
    chosen
}

/// Four numbers in ascending order.
#[inline(always)]
fn sorted([a, b, c, d]: [u64; 4]) -> [u64; 4] {
    let order = |a: u64, b: u64| (a.min(b), a.max(b));
    let ((a, b), (c, d)) = (order(a, b), order(c, d));
    let ((a, c), (b, d)) = (order(a, c), order(b, d));
    let (b, c) = order(b, c);
    [a, b, c, d]
}
