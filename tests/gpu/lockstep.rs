//! Lockstep: every step of the device starts from the CPU's vertex. Each decision (what is hit, does the walk end and why, is
//! the component a Dirac) is the CPU's, or the CPU was itself this near to another one:
//!
//! ```text
//! a hit        1e-5, barycentric, from an edge of something along the ray; 1e-5 of the scene between two hits
//! alpha        |u − a| < 1e-5                roulette     |u − q| < 1e-5
//! scattering   another number, 1e-5 away, gives another component, or none
//! an arrival   the cosine at either end < 1e-5
//! ```

use crate::compare::Worst;
use crate::harness::{Work, gpu};
use crate::twins_rays::{MARGIN, Reach, ray_is_marginal};
use crate::walks::{Answer, Ask, Row, ask};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::vertex::DELTA;
use bdpt_explorer::bdpt::walk::Step;
use bdpt_explorer::bdpt::{End, Settings, Subpath, Vertex};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::math::{Vec2, Vec3, offset_ray_origin};
use bdpt_explorer::rng::{BLOCK_ALPHA, BLOCK_EYE_VERTEX, BLOCK_LIGHT_DIRECTION, BLOCK_LIGHT_VERTEX, SampleId, pair, pcg4d, unit_f32};
use bdpt_explorer::scene::TransportMode::{Importance, Radiance};
use bdpt_explorer::scene::{BsdfSample, Material, NONE, Ray, Scene, TransportMode};
use std::sync::Arc;

/// A step of the CPU's, and what it led to.
struct Stepped {
    row: Row,
    from: Vertex,
    step: Step,
    last: u32,
    /// The new vertex, if there is one, without what later steps add to it.
    to: Option<Vertex>,
    end: Option<End>,
    /// The step after it.
    next: Option<Step>,
    pdf_rev_area: f32,
}

fn first_block(mode: TransportMode) -> u32 {
    if mode == Importance { BLOCK_LIGHT_VERTEX } else { BLOCK_EYE_VERTEX }
}

/// The step that a vertex made, number `i` ≥ 1 of its subpath; `u` are its numbers.
fn step_from(context: &Context, v: &Vertex, mode: TransportMode, u: [f32; 4]) -> Option<(BsdfSample, Step)> {
    if v.material == NONE || u[3] >= v.survival {
        return None;
    }
    let sample = v.bsdf::<bdpt_explorer::scene::General>(context.scene).sample(v.w_prev, mode, u[0], pair(u, 1))?;
    let pdf_fwd_psa = sample.pdf_fwd_psa * v.survival;
    Some((sample, Step { direction: sample.w, pdf_fwd_psa, alpha: v.alpha * sample.f / pdf_fwd_psa }))
}

/// The first step of a subpath whose first vertex is known (`light_subpath` and `eye_subpath` do not tell it).
fn start(context: &Context, v: &Vertex, mode: TransportMode, id: SampleId, raster: Vec2) -> Step {
    if mode == Radiance {
        let direction = context.view.direction(raster, v.position);
        return Step { direction, pdf_fwd_psa: context.view.pdf_direction_psa_on_film(direction), alpha: v.alpha * context.view.pixels() };
    }
    let (light, u) = (&context.scene.lights.list[v.light as usize], id.numbers(BLOCK_LIGHT_DIRECTION));
    let direction = if light.is_infinite() { v.n_g } else { light.sample_direction(v.n_g, pair(u, 0), u[2]) };
    let pdf_fwd_psa = light.pdf_direction_psa(v.n_g, direction, context.view.pdf_disk_area);
    let alpha = if pdf_fwd_psa > 0.0 { v.alpha * (light.l_e_1(v.n_g, direction) / pdf_fwd_psa) } else { Vec3::ZERO };
    Step { direction, pdf_fwd_psa, alpha }
}

/// The steps of a subpath: a row to ask for each, the start of it first.
fn steps(context: &Context, mode: TransportMode, id: SampleId, max_vertices: u32, out: &mut Vec<Stepped>) {
    let mut sub = Subpath::new();
    let raster = if mode == Importance {
        context.light_subpath(id, max_vertices as usize, &mut sub, &mut 0);
        Vec2::ZERO
    } else {
        context.eye_subpath(id, max_vertices as usize, &mut sub, &mut 0)
    };
    let count = sub.vertices.len();
    let mut step = start(context, &sub.vertices[0], mode, id, raster);
    let row = |ask| Row { ask, mode, id, max_vertices };
    let fresh = |i: usize| Vertex { pdf_rev_area: 0.0, ..sub.vertices[i] };
    out.push(Stepped {
        row: row(Ask::Start),
        from: fresh(0),
        step,
        last: 0,
        to: Some(fresh(0)),
        end: None,
        next: Some(step),
        pdf_rev_area: 0.0,
    });
    if count == 1 && sub.end == End::Absorbed && !(step.pdf_fwd_psa > 0.0 && sub.vertices[0].alpha != Vec3::ZERO) {
        return;
    }
    for i in 0..count {
        let (from, last) = (fresh(i), i as u32);
        let reached = (i + 1 < count).then(|| fresh(i + 1));
        if reached.is_none() && sub.end != End::Escaped && sub.end != End::Absorbed {
            return;
        }
        // The walk went on, or was about to, from the new vertex.
        let at_end = i as u32 + 2 == max_vertices;
        let made = reached.filter(|_| !at_end).and_then(|v| step_from(context, &v, mode, id.numbers(first_block(mode) + last + 1)));
        let next = made.map(|(_, step)| step);
        let goes_on = next.is_some_and(|step| step.alpha.max_element() > 0.0 && step.alpha.is_finite());
        let end = if goes_on { None } else { Some(sub.end) };
        let pdf_rev_area = if made.is_some() { sub.vertices[i].pdf_rev_area } else { 0.0 };
        out.push(Stepped { row: row(Ask::Step { from, step, last }), from, step, last, to: reached, end, next, pdf_rev_area });
        match next {
            Some(next) if goes_on => step = next,
            _ => return,
        }
    }
}

impl Stepped {
    /// Is every decision the same?
    fn same(&self, answer: &Answer) -> bool {
        if matches!(self.row.ask, Ask::Start) {
            return self
                .to
                .is_some_and(|v| [v.triangle, v.flags, v.light] == [answer.vertex.triangle, answer.vertex.flags, answer.vertex.light]);
        }
        let seen = |v: &Vertex| [v.triangle, v.flags, v.light, v.material];
        answer.end == self.end && answer.pushed == self.to.is_some() && self.to.is_none_or(|v| seen(&v) == seen(&answer.vertex))
    }

    /// Was the CPU near to another decision?
    fn is_marginal(&self, context: &Context) -> bool {
        let Self { from, step, last, .. } = self;
        let (id, mode, scene) = (self.row.id, self.row.mode, context.scene);
        let origin = offset_ray_origin(from.position, from.error, from.n_g, step.direction);
        let ray = Ray { origin, direction: step.direction };
        let reach = self.to.filter(|v| v.triangle != NONE).map_or(f32::MAX, |v| (v.position - origin).length());
        if ray_is_marginal(scene, &ray, Reach::Hit(reach), false)
            || alpha_is_marginal(scene, &ray, id.words(first_block(mode) + BLOCK_ALPHA + last))
        {
            return true;
        }
        // No arrival at all: the cosine at one end is 0, or the ends coincide.
        let Some(v) = self.to else { return self.end == Some(End::Absorbed) };
        let u = id.numbers(first_block(mode) + last + 1);
        if (u[3] - v.survival).abs() < MARGIN || v.n_g.dot(v.w_prev).abs() < MARGIN || from.n_g.dot(v.w_prev).abs() < MARGIN {
            return true;
        }
        let decision = |k: usize, by: f32| {
            let mut u = u;
            u[k] = (u[k] + by).clamp(0.0, 1.0f32.next_down());
            step_from(context, &v, mode, u).map(|(sample, _)| sample.delta)
        };
        let bent = |k: usize, by: f32| {
            let mut u = u;
            u[k] = (u[k] + by).clamp(0.0, 1.0f32.next_down());
            step_from(context, &v, mode, u).map_or(Vec3::ZERO, |(_, step)| step.direction)
        };
        (0..3)
            .any(|k| [-MARGIN, MARGIN].iter().any(|&by| decision(k, by) != decision(k, 0.0) || (bent(k, by) - bent(k, 0.0)).length() > 0.1))
    }

    /// By how much rounding grows: over short edges, at grazing angles, with sharp microfacets.
    fn growth(&self, context: &Context) -> f32 {
        let Some(v) = self.to else { return 1.0 };
        let cos = |n: Vec3, w: Vec3| if n == Vec3::ZERO { 1.0 } else { n.dot(w).abs() };
        if matches!(self.row.ask, Ask::Start) {
            return self.next.map_or(1.0, |next| 1.0 + 1.0 / cos(v.n_g, next.direction));
        }
        let mut growth = 1.0 / cos(v.n_g, v.w_prev) + 1.0 / cos(v.n_s, v.w_prev) + 1.0 / cos(self.from.n_g, v.w_prev);
        growth += context.scene.sphere.radius / (v.position - self.from.position).length();
        if let Some(next) = self.next {
            growth += 1.0 / cos(v.n_g, next.direction) + 1.0 / cos(v.n_s, next.direction);
        }
        if v.material != NONE && context.scene.materials[v.material as usize].kind >= bdpt_explorer::scene::CONDUCTOR {
            growth += 1.0 / Material::alpha(v.look.roughness);
        }
        growth
    }
}

/// Is the draw for something along a ray within the margin of its alpha?
fn alpha_is_marginal(scene: &Scene, ray: &Ray, [a, b, c, d]: [u32; 4]) -> bool {
    let near = std::cell::Cell::new(false);
    scene.bvh.closest_hit_where(ray, |hit| {
        let alpha = scene.opacity(hit);
        let drawn = unit_f32(pcg4d([a, b, c, d ^ hit.triangle])[0]);
        near.set(near.get() || (alpha < 1.0 && (drawn - alpha).abs() < MARGIN));
        false
    });
    near.get()
}

fn bounds() -> [Worst; 7] {
    // In ε over the growth of each step.
    [
        Worst::new("position", 64.0),
        Worst::new("normals, where it came from", 256.0),
        Worst::new("look, survival", 2048.0),
        Worst::new("alpha", 256.0),
        Worst::new("geometry, pdf_fwd_area", 256.0),
        Worst::new("next direction", 1024.0),
        Worst::new("next densities, alpha, pdf_rev_area", 1024.0),
    ]
}

fn compare(stepped: &Stepped, answer: &Answer, growth: f32, radius: f32, all: &mut [Worst; 7]) {
    let [position, normals, look, alpha, densities, direction, next] = all;
    if let Some(v) = stepped.to {
        let g = &answer.vertex;
        position.within(&g.position.to_array(), &v.position.to_array(), radius * growth);
        for (found, own) in [(g.n_g, v.n_g), (g.n_s, v.n_s), (g.w_prev, v.w_prev)] {
            normals.within(&found.to_array(), &own.to_array(), growth);
        }
        let of = |v: &Vertex| {
            [&v.look.color.to_array()[..], &[v.look.roughness, v.look.metallic, v.look.opacity, v.survival], &v.look.barycentric.to_array()]
                .concat()
        };
        look.within(&of(g), &of(&v), growth);
        alpha.within(&g.alpha.to_array(), &v.alpha.to_array(), v.alpha.max_element().max(1e-30) * growth);
        for (found, own) in [(g.geometry_prev, v.geometry_prev), (g.pdf_fwd_area, v.pdf_fwd_area)] {
            densities.within(&[found], &[own], own.max(1e-30) * growth);
        }
    }
    if let Some(own) = stepped.next {
        direction.within(&answer.step.direction.to_array(), &own.direction.to_array(), growth);
        next.within(&[answer.step.pdf_fwd_psa], &[own.pdf_fwd_psa], own.pdf_fwd_psa * growth);
        next.within(&answer.step.alpha.to_array(), &own.alpha.to_array(), own.alpha.max_element().max(1e-30) * growth);
        next.within(&[answer.pdf_rev_area], &[stepped.pdf_rev_area], stepped.pdf_rev_area.max(1e-30) * growth);
    }
}

const SIDE: u32 = 32;

fn work(scene: Arc<Scene>) -> Work {
    let settings = Settings { max_edges: 8, seed: 11, ..Settings::default() };
    Work::new(Job { size: [SIDE; 2], settings, ..Job::new(scene) })
}

fn all_steps(context: &Context) -> Vec<Stepped> {
    let mut list = Vec::new();
    for i in 0..SIDE * SIDE {
        let id = context.settings.sample([i % SIDE, i / SIDE], 2);
        steps(context, Importance, id, 8, &mut list);
        steps(context, Radiance, id, 9, &mut list);
    }
    list
}

/// Steps, decisions that differ, those of them without a margin, and the numbers' differences.
fn lockstep(gpu: &Gpu, scene: Arc<Scene>, change: Option<(&str, &str)>) -> ([usize; 4], [Worst; 7]) {
    let work = work(scene);
    let context = Context::new(&work.job.scene, &work.view, &work.job.settings);
    let list = all_steps(&context);
    let rows: Vec<Row> = list.iter().map(|stepped| stepped.row).collect();
    let answers = ask(gpu, &work, &rows, change);
    let (mut seen, mut all) = ([list.len(), 0, 0, 0], bounds());
    for (stepped, answer) in list.iter().zip(&answers) {
        if stepped.same(answer) {
            seen[3] += usize::from(stepped.to.is_some_and(|v| v.has(DELTA)));
            compare(stepped, answer, stepped.growth(&context), work.view.sphere.radius, &mut all);
            continue;
        }
        seen[1] += 1;
        if !stepped.is_marginal(&context) {
            seen[2] += 1;
            if change.is_none() {
                println!("{:?} {:?} {:?}\n   here {:?}\n   there {answer:?}", stepped.from, stepped.step, stepped.end, stepped.to);
            }
        }
    }
    (seen, all)
}

#[test]
fn every_step_is_the_cpus() {
    let Some(gpu) = gpu("every_step_is_the_cpus") else { return };
    let list = [
        scenes::builtin("cornell"),
        scenes::specular(),
        scenes::tilted(),
        surface_scenes::glossy(),
        surface_scenes::glossy_room(),
        surface_scenes::glossy_tilted(),
        surface_scenes::textured(),
        surface_scenes::holes(),
        surface_scenes::veils(true),
        surface_scenes::veils_under_the_sky(),
        emitters_scenes::dirac_lights(),
        emitters_scenes::under_the_sky(),
        emitters_scenes::everything(),
    ];
    for scene in list {
        let name = scene.name.clone();
        let ([count, differ, unexplained, delta], all) = lockstep(gpu, scene, None);
        println!("{name}: {count} steps, {delta} at Diracs, {differ} decided otherwise, {unexplained} of them without need");
        all.iter().for_each(Worst::finish);
        assert_eq!(unexplained, 0, "{name}");
        assert!(differ * 1000 < count, "{name}: {differ} of {count}");
    }
}

/// The margins excuse little: few of the CPU's steps are near to another decision.
#[test]
fn few_steps_are_near_to_another_decision() {
    for scene in [scenes::builtin("cornell"), scenes::tilted(), surface_scenes::glossy_tilted(), surface_scenes::veils(true)] {
        let work = work(scene);
        let context = Context::new(&work.job.scene, &work.view, &work.job.settings);
        let list = all_steps(&context);
        let near = list.iter().filter(|stepped| !matches!(stepped.row.ask, Ask::Start) && stepped.is_marginal(&context)).count();
        println!("{}: {near} of {} steps", work.job.scene.name, list.len());
        assert!(near * 100 < list.len());
        // But one that is near is seen.
        let mut stepped = list.into_iter().find(|stepped| stepped.last == 1 && stepped.next.is_some()).unwrap();
        let u = stepped.row.id.numbers(first_block(stepped.row.mode) + 2);
        stepped.to = stepped.to.map(|v| Vertex { survival: u[3] + 0.5 * MARGIN, ..v });
        assert!(stepped.is_marginal(&context));
    }
}

/// Negative controls: one that decides otherwise, and one that only computes otherwise.
#[test]
fn another_step_is_noticed() {
    let Some(gpu) = gpu("another_step_is_noticed") else { return };
    let ([_, differ, unexplained, _], _) =
        lockstep(gpu, scenes::builtin("cornell"), Some(("BLOCK_LIGHT_VERTEX: u32 = 16u", "BLOCK_LIGHT_VERTEX: u32 = 17u")));
    assert!(differ > 100 && unexplained > 100, "{differ} {unexplained}");
    let ([_, differ, ..], all) =
        lockstep(gpu, scenes::tilted(), Some(("v.survival * sample.pdf_rev_psa", "1.001 * v.survival * sample.pdf_rev_psa")));
    assert!(differ == 0 && all.iter().any(|worst| !worst.holds()));
}
