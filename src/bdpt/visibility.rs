//! V: what of an edge is free.

use super::context::Context;
use super::vertex::{AT_INFINITY, ON_LENS, Vertex};
use crate::math::{Vec3, offset_ray_origin};
use crate::scene::{Ray, Segment, Shape};

/// V of the edge, along `w`, from a light vertex to a surface or lens vertex, in [0, 1].
#[inline(always)]
pub fn visibility<F: Shape>(context: &Context<F>, a: &Vertex, b: &Vertex, w: Vec3) -> f32 {
    if a.has(AT_INFINITY) { visibility_from_infinity(context, b, w) } else { context.scene.visibility::<F>(&segment(context, a, b, w)) }
}

/// Kept apart, so that the traversal above stays in the registers of its caller.
#[inline(never)]
fn visibility_from_infinity<F: Shape>(context: &Context<F>, b: &Vertex, w: Vec3) -> f32 {
    let origin = end(context, b, w);
    context.scene.visibility_to_infinity::<F>(&Ray { origin, direction: -w })
}

/// An edge as a segment that starts and ends just off its surfaces.
pub fn segment<F: Shape>(context: &Context<F>, a: &Vertex, b: &Vertex, w: Vec3) -> Segment {
    Segment { from: offset_ray_origin(a.position, a.error, a.n_g, w), to: end(context, b, w) }
}

/// Where an edge along `w` ends: just off the surface, or just before the lens.
#[inline]
fn end<F: Shape>(context: &Context<F>, b: &Vertex, w: Vec3) -> Vec3 {
    let error = if b.has(ON_LENS) { context.view.clearance } else { b.error };
    offset_ray_origin(b.position, error, b.n_g, -w)
}
