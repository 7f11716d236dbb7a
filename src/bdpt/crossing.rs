//! t = 0: where a light subpath crosses the lens. The lens is a disk that blocks nothing: the crossing ends one path, and the
//! walk goes on.
//!
//! ```text
//! x_k = the crossing        P_A(x_k) = q(y_{k−1}) P_σ⊥(y_{k−1}→x_k) G V        C*_{k+1,0} = α^L_{k+1} W_e⁽⁰⁾ W_e⁽¹⁾(x_{k−1}→x_k) / n
//! ```

use super::context::Context;
use super::vertex::{Subpath, Vertex};
use super::walk::Step;
use crate::math::Vec3;
use crate::scene::Shape;

/// A light subpath's way through the lens.
#[derive(Clone, Copy, Debug)]
pub struct Crossing {
    /// s of its strategy (s, 0): the vertices before it, and itself.
    pub s: u32,
    /// The vertex on the lens, as the light subpath reaches it.
    pub lens: Vertex,
}

/// Finds the crossings of y₀…y_{n−1} and of the step `last` that left the scene. Each edge has at most one.
pub fn find<F: Shape>(context: &Context<F>, light: &Subpath, last: Option<Step>, out: &mut Vec<Crossing>) {
    out.clear();
    if !context.view.has_lens() {
        return;
    }
    for (i, pair) in light.vertices.windows(2).enumerate() {
        let (from, to) = (&pair[0], &pair[1]);
        // What the walk drew is still in the vertex it led to.
        let pdf_fwd_psa = to.pdf_fwd_area / (to.geometry_prev * context.opacity(to));
        let step = Step { direction: -to.w_prev, pdf_fwd_psa, alpha: to.alpha };
        out.extend(crossing(context, from, Some(to), &step).map(|lens| Crossing { s: i as u32 + 2, lens }));
    }
    if let (Some(step), Some(from)) = (last, light.vertices.last()) {
        let s = light.vertices.len() as u32 + 1;
        out.extend(crossing(context, from, None, &step).map(|lens| Crossing { s, lens }));
    }
}

/// The vertex at which a step from `from` crosses the lens, if the walk came so far: `to`, where it ended, lies beyond. Where it
/// passed surfaces that are partly there, its own draws have decided; V in the density has only their odds.
fn crossing<F: Shape>(context: &Context<F>, from: &Vertex, to: Option<&Vertex>, step: &Step) -> Option<Vertex> {
    let point = context.view.cross_lens(from.position, step.direction)?;
    let lens = arrive_at_lens(context, from, step, point)?;
    let room = context.view.clearance / lens.w_prev.dot(lens.n_g).abs();
    let along = |p: Vec3| (p - from.position).dot(step.direction);
    to.is_none_or(|to| along(to.position) > along(point) - room).then_some(lens)
}

/// The lens vertex at `point` as a step from `from` reaches it; `None` if the edge has no G or nothing of it is free.
pub fn arrive_at_lens<F: Shape>(context: &Context<F>, from: &Vertex, step: &Step, point: Vec3) -> Option<Vertex> {
    let lens = context.lens_vertex(point);
    let (w, geometry) = from.edge_to(&lens);
    let geometry = geometry * context.seen_through(from, &lens, w);
    let pdf = step.pdf_fwd_psa * geometry;
    (pdf > 0.0 && pdf.is_finite()).then_some(Vertex {
        alpha: step.alpha,
        w_prev: -w,
        pdf_fwd_area: pdf,
        pdf_rev_area: context.view.pdf_lens_area(),
        geometry_prev: geometry,
        ..lens
    })
}
