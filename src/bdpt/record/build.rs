//! Making a record: the sample is run again by the renderer's own code, and written down.

use super::{
    EdgeRecord, LookRecord, Measure, PathRecord, PathVertexRecord, RECORD_VERSION, SplitReason, SplitRecord, StrategyRecord, SubpathRecord,
    VertexRecord,
};
use crate::bdpt::connect::{Contribution, Sample};
use crate::bdpt::context::Context;
use crate::bdpt::mis::{log_densities, log_expected, mis_weights_by_definition};
use crate::bdpt::path::FullPath;
use crate::bdpt::reason::Reason;
use crate::bdpt::strategy::Strategy;
use crate::bdpt::vertex::{AT_INFINITY, AT_POINT, DISCRETE, ON_LENS, ON_LIGHT, Subpath, Vertex};
use crate::bdpt::visibility::segment;
use crate::math::Vec3;
use crate::scene::light::{AREA, ENVIRONMENT};
use crate::scene::material::{COAT, CONDUCTOR, DIELECTRIC, THIN_DIELECTRIC};
use crate::scene::{Material, NONE, Scene};
use std::f64::consts::LN_10;

/// Re-runs sample `sample` of `pixel` and writes down everything about it. The caller sees to it that the pixel exists.
pub fn record(context: &Context, pixel: [u32; 2], sample: u32) -> PathRecord {
    let (scene, settings) = (context.scene, context.settings);
    let id = settings.sample(pixel, sample);
    let mut traced = Sample::default();
    let k = settings.max_edges as usize;
    let lens = context.view.has_lens();
    traced.trace(context, id, k + usize::from(lens), k + 1);
    let strategies = Strategy::all(settings.max_edges, lens).map(|strategy| strategy_record(context, &mut traced, strategy)).collect();
    PathRecord {
        version: RECORD_VERSION,
        scene: scene.name.clone(),
        camera: context.view.name.clone(),
        // A view does not know whether it was moved: who made it fills this in.
        pose: None,
        edits: Some(&scene.edits).filter(|edits| !edits.is_empty()).cloned(),
        pixel,
        sample,
        seed: settings.seed,
        sampler: settings.sampler,
        size: context.view.size,
        lens_radius: context.view.lens.radius,
        focus_distance: Some(context.view.lens.focus_distance).filter(|d| lens && d.is_finite()),
        max_edges: settings.max_edges,
        heuristic: settings.heuristic,
        roulette: settings.roulette,
        light_subpaths: settings.light_subpaths,
        fresh_ends: settings.fresh_ends,
        raster: traced.raster.to_array(),
        light: subpath_record(context, &traced.light),
        light_end: traced.light.end,
        eye: subpath_record(context, &traced.eye),
        eye_end: traced.eye.end,
        strategies,
    }
}

fn subpath_record(context: &Context, subpath: &Subpath) -> SubpathRecord {
    let before = |i: usize| i.checked_sub(1).map(|i| &subpath.vertices[i]);
    let vertices = subpath.vertices.iter().enumerate();
    SubpathRecord { vertices: vertices.map(|(i, v)| vertex_record(context, v, before(i))).collect(), end: subpath.end }
}

/// The edge from `a` to its neighbour `b`; G as the estimator computes it, from the light side.
fn edge_record(a: &Vertex, b: &Vertex) -> EdgeRecord {
    let (w, g) = if b.has(AT_INFINITY) || b.has(AT_POINT) { b.edge_to(a) } else { a.edge_to(b) };
    let turned = b.has(AT_INFINITY) || b.has(AT_POINT);
    let infinite = a.has(AT_INFINITY) || b.has(AT_INFINITY);
    EdgeRecord {
        length: (!infinite).then(|| (b.position - a.position).length()),
        direction: (if turned { -w } else { w }).to_array(),
        geometry_term: g.is_finite().then_some(g),
    }
}

/// What the light a vertex lies on emits there.
fn emission(context: &Context, v: &Vertex) -> Option<Vec3> {
    let lights = &context.scene.lights;
    let light = lights.list.get(v.light as usize)?;
    Some(match light.kind {
        AREA => light.radiance * context.emission_factor(v),
        ENVIRONMENT => lights.l_e(light, v.n_g, v.n_g),
        _ => light.radiance,
    })
}

fn look_record(scene: &Scene, v: &Vertex) -> Option<LookRecord> {
    let material = scene.materials.get(v.material as usize)?;
    Some(LookRecord {
        color: v.look.color.to_array(),
        roughness: v.look.roughness,
        ggx_alpha: matches!(material.kind, CONDUCTOR | COAT).then(|| Material::alpha(v.look.roughness)),
        metallic: v.look.metallic,
        ior: matches!(material.kind, DIELECTRIC | THIN_DIELECTRIC).then_some(material.ior),
        coat_f0: (material.kind == COAT).then(|| material.f0.to_array()),
        opacity: v.look.opacity,
    })
}

/// A vertex, and the edge to it from the one `before` it in its list.
fn vertex_record(context: &Context, v: &Vertex, before: Option<&Vertex>) -> VertexRecord {
    let scene = context.scene;
    let on_surface = v.material != NONE;
    VertexRecord {
        position: scene.in_file(v.position),
        n_g: v.n_g.to_array(),
        n_s: v.n_s.to_array(),
        kind: match () {
            () if v.has(AT_INFINITY) => "infinity",
            () if v.has(ON_LENS) => "lens",
            () if v.has(ON_LIGHT) => "light",
            () => "surface",
        },
        light: v.emits().then(|| scene.lights.list[v.light as usize].kind_name()),
        light_name: scene.lights.name(v.light).map(str::to_owned),
        material: on_surface.then(|| scene.material_names[v.material as usize].clone()),
        material_index: on_surface.then_some(v.material),
        light_index: v.emits().then_some(v.light),
        model: on_surface.then(|| scene.materials[v.material as usize].kind_name()),
        look: look_record(scene, v),
        emitter: v.emits(),
        emission: emission(context, v).map(|l| l.to_array()),
        edge: before.map(|before| edge_record(before, v)),
        alpha: v.alpha.to_array(),
        pdf_fwd: v.pdf_fwd_area,
        // Nothing can hit a pinhole or a light without extent: there is no density to speak of.
        pdf_rev: (v.pdf_rev_area > 0.0 && !v.has(DISCRETE)).then_some(v.pdf_rev_area),
        measure: match () {
            () if v.has(DISCRETE) => Measure::Discrete,
            () if v.has(AT_INFINITY) => Measure::SolidAngle,
            () => Measure::Area,
        },
        delta: v.is_delta(),
        survival: v.survival,
    }
}

fn strategy_record(context: &Context, sample: &mut Sample, strategy: Strategy) -> StrategyRecord {
    let outcome = match context.settings.strategies.contains(strategy) {
        true => sample.evaluate(context, strategy),
        false => Err(Reason::Removed),
    };
    let mut record = StrategyRecord {
        s: strategy.s,
        t: strategy.t,
        feasible: false,
        reason: None,
        reason_text: None,
        raster: None,
        vertices: Vec::new(),
        blocker: None,
        visibility: None,
        p: None,
        connection_term: [0.0; 3],
        contribution_unweighted: [0.0; 3],
        mis_weight: 0.0,
        contribution: [0.0; 3],
        splits: Vec::new(),
    };
    let joined = matches!(outcome, Ok(_) | Err(Reason::Blocked));
    if let Err(Reason::Blocked) = outcome {
        sample.join_blocked(context, strategy);
    }
    match outcome {
        Ok(contribution) => record.carry(&contribution),
        Err(reason) => {
            record.reason = Some(reason);
            record.reason_text = Some(reason.text());
        }
    }
    let no_path = matches!(
        record.reason,
        Some(
            Reason::LightSubpathTooShort
                | Reason::EyeSubpathTooShort
                | Reason::NotMet
                | Reason::EyeVertexAtInfinity
                | Reason::LightMissesTheLens
                | Reason::NoLight
                | Reason::Removed
        )
    );
    if strategy.s >= 1 && strategy.t >= 1 {
        record.visibility = match record.reason {
            None => Some(sample.edge_visibility()),
            Some(Reason::Blocked) => Some(0.0),
            Some(_) => None,
        };
    }
    if !no_path {
        record.write_path(context, sample, joined);
    }
    record
}

impl StrategyRecord {
    fn carry(&mut self, contribution: &Contribution) {
        self.feasible = true;
        self.raster = Some(contribution.raster.to_array());
        self.connection_term = contribution.connection_term.to_array();
        self.contribution_unweighted = contribution.contribution_unweighted.to_array();
        self.mis_weight = contribution.mis_weight;
        self.contribution = (contribution.contribution_unweighted * contribution.mis_weight).to_array();
    }

    /// The path's vertices x₀…x_k, their densities where they could be joined, and the other splits where it carries light.
    fn write_path(&mut self, context: &Context, sample: &Sample, joined: bool) {
        let (y, z) = (sample.light_vertices(self.strategy()), sample.eye_vertices(self.strategy()));
        let (path, k) = (&sample.path, y.len() + z.len() - 1);
        let x: Vec<&Vertex> = y.iter().chain(z.iter().rev()).collect();
        let record = |(i, v): (usize, &&Vertex)| PathVertexRecord {
            vertex: VertexRecord {
                // A fresh direction has no place of its own: it is drawn where the line to x₁ comes from.
                position: context.scene.in_file(if v.has(AT_INFINITY) { before(context, x[1], v.n_g) } else { v.position }),
                ..vertex_record(context, v, i.checked_sub(1).map(|i| x[i]))
            },
            fresh: (i == 0 && sample.fresh_light.is_some()) || (i == k && sample.fresh_lens.is_some()),
            p_light: (joined && (i == 0 || !v.has(DISCRETE))).then(|| path.p_light[i]),
            p_eye: (joined && (i == k || !v.has(DISCRETE))).then(|| path.p_eye[i]),
        };
        self.vertices = x.iter().enumerate().map(record).collect();
        let ln_p: f64 = x.iter().map(|v| f64::from(v.pdf_fwd_area).ln()).sum();
        self.p = ln_p.is_finite().then_some(ln_p / LN_10);
        if let (Some(Reason::Blocked), Some(a), Some(b)) = (self.reason, y.last(), z.last()) {
            let (w, _) = a.edge_to(b);
            let start = if a.has(AT_INFINITY) { Vertex { position: before(context, b, a.n_g), ..*a } } else { *a };
            self.blocker = context.scene.blocker(&segment(context, &start, b, w)).map(|point| context.scene.in_file(point.position));
        }
        if self.feasible {
            self.splits = splits(context, sample, self.s as usize, self.contribution_unweighted);
        }
    }
}

/// A point from which light that travels along `direction` comes to `v`, beyond the scene.
fn before(context: &Context, v: &Vertex, direction: Vec3) -> Vec3 {
    v.position - direction * context.view.sphere.beyond(v.position)
}

/// The path joined last under every strategy that has its number of edges: C* of one is f/(n p).
fn splits(context: &Context, sample: &Sample, made_by: usize, unweighted: [f32; 3]) -> Vec<SplitRecord> {
    let path = &sample.path;
    let ln_p = log_densities(path);
    let ln_np = log_expected(ln_p.clone(), path.light_subpaths);
    let weights = mis_weights_by_definition(path, &path.active, &context.settings.heuristic);
    (0..=path.k + 1)
        .map(|s| {
            let reason = split_reason(context, path, s, ln_p[s]);
            let c = unweighted.map(|c| f64::from(c) * (ln_np[made_by] - ln_np[s]).exp());
            let c = Some(c).filter(|c| reason.is_none() && c.iter().all(|c| c.is_finite()));
            SplitRecord {
                s: s as u32,
                t: (path.k + 1 - s) as u32,
                p: (path.samplable[s] && ln_p[s].is_finite()).then_some(ln_p[s] / LN_10),
                samplable: reason.is_none(),
                reason,
                reason_text: reason.map(SplitReason::text),
                weight: weights[s],
                contribution_unweighted: c,
                contribution: c.unwrap_or_default().map(|c| c * weights[s]),
            }
        })
        .collect()
}

fn split_reason(context: &Context, path: &FullPath, s: usize, ln_p: f64) -> Option<SplitReason> {
    if path.samplable[s] {
        return match () {
            () if ln_p == f64::NEG_INFINITY => Some(SplitReason::ZeroDensity),
            () if !path.active[s] => Some(SplitReason::Removed),
            () => None,
        };
    }
    // s = 0 and s = k + 1 have no connection that a Dirac could spoil.
    Some(match s {
        0 => SplitReason::LightCannotBeHit,
        s if s == path.k + 1 && !context.view.has_lens() => SplitReason::PinholeCannotBeHit,
        _ => SplitReason::DiracEnd,
    })
}
