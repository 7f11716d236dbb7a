//! V: whether anything lies on an edge.

use super::vertex::{AT_INFINITY, ON_LENS, Vertex};
use super::walk::Context;
use crate::math::{Vec3, offset_ray_origin};
use crate::scene::{Ray, Segment};

/// V of the edge, along `w`, from a light vertex to a surface or lens vertex.
#[inline(always)]
pub fn visible(context: &Context, a: &Vertex, b: &Vertex, w: Vec3) -> bool {
    if a.has(AT_INFINITY) { visible_from_infinity(context, b, w) } else { context.scene.visible(&segment(context, a, b, w)) }
}

/// Kept apart, so that the traversal above stays in the registers of its caller.
#[inline(never)]
fn visible_from_infinity(context: &Context, b: &Vertex, w: Vec3) -> bool {
    let origin = end(context, b, w);
    context.scene.visible_to_infinity(&Ray { origin, direction: -w })
}

/// An edge as a segment that starts and ends just off its surfaces.
pub fn segment(context: &Context, a: &Vertex, b: &Vertex, w: Vec3) -> Segment {
    Segment { from: offset_ray_origin(a.position, a.error, a.n_g, w), to: end(context, b, w) }
}

/// Where an edge along `w` ends: just off the surface, or just before the lens.
#[inline]
fn end(context: &Context, b: &Vertex, w: Vec3) -> Vec3 {
    let error = if b.has(ON_LENS) { context.view.clearance } else { b.error };
    offset_ray_origin(b.position, error, b.n_g, -w)
}
