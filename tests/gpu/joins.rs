//! Joining: every strategy of the CPU's subpaths, evaluated on the device from the CPU's own vertices: the pixel, what it
//! contributes unweighted, its weight. Whether it contributes at all is the same, or the CPU was near to another decision.

use crate::compare::Worst;
use crate::harness::{Work, gpu};
use crate::table::{Table, bits, load};
use crate::twins_rays::{MARGIN, Reach, ray_is_marginal};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::bdpt::connect::{Contribution, Sample};
use bdpt_explorer::bdpt::context::Context;
use bdpt_explorer::bdpt::vertex::AT_INFINITY;
use bdpt_explorer::bdpt::visibility::segment;
use bdpt_explorer::bdpt::{Reason, Settings, Strategy, Vertex};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::SampleId;
use bdpt_explorer::scene::{CONDUCTOR, Material, NONE, Ray, Scene};
use std::sync::Arc;

const VERTEX: usize = size_of::<Vertex>() / 4;
/// Vertices of a side that a row has room for.
const ROOM: usize = 8;
const INPUTS: usize = 2 * VERTEX + 8 + 6 * ROOM;
const EDGES: u32 = 6;

fn body() -> String {
    let (a, b, at) = (load("Vertex", "a", 0), load("Vertex", "b", VERTEX), 2 * VERTEX);
    format!(
        "fn run_row(row: u32) {{
            var a: Vertex;
            {a}
            var b: Vertex;
            {b}
            let s = in_u(row, {at}u);
            let t = in_u(row, {at}u + 1u);
            let id = SampleId(in_u(row, {at}u + 2u), in_u(row, {at}u + 3u), in_u(row, {at}u + 4u), in_u(row, {at}u + 5u), SAMPLER_HASH);
            let opacity_a = in_f(row, {at}u + 6u);
            let opacity_b = in_f(row, {at}u + 7u);
            for (var i = 0u; i < {ROOM}u; i++) {{
                let k = {at}u + 8u + 6u * i;
                light_fwd[i] = in_f(row, k);
                light_rev[i] = in_f(row, k + 1u);
                light_flags[i] = in_u(row, k + 2u);
                eye_fwd[i] = in_f(row, k + 3u);
                eye_rev[i] = in_f(row, k + 4u);
                eye_flags[i] = in_u(row, k + 5u);
            }}
            var c = no_contribution();
            if t == 0u {{
                c = light_hits_lens(s, b, opacity_a);
            }} else {{
                c = evaluate(id, s, t, a, b, opacity_a, opacity_b);
            }}
            out_u(row, 0u, u32(c.some));
            out_u(row, 1u, c.pixel.x);
            out_u(row, 2u, c.pixel.y);
            out_v(row, 3u, c.contribution_unweighted);
            out_f(row, 6u, c.mis_weight);
        }}"
    )
}

/// A strategy of a sample as the CPU has it.
struct Join {
    id: SampleId,
    strategy: Strategy,
    a: Vertex,
    b: Vertex,
    /// a of the vertices before the ends.
    opacity: [f32; 2],
    sides: Vec<f32>,
    result: Result<Contribution, Reason>,
}

impl Join {
    fn new(context: &Context, sample: &mut Sample, strategy: Strategy) -> Option<Self> {
        let result = sample.evaluate(context, strategy);
        let too_short = [
            Reason::LightSubpathTooShort,
            Reason::EyeSubpathTooShort,
            Reason::NotMet,
            Reason::EyeVertexAtInfinity,
            Reason::LightMissesTheLens,
            Reason::NoLight,
        ];
        if result.as_ref().is_err_and(|reason| too_short.contains(reason)) {
            return None;
        }
        let (y, z) = (sample.light_vertices(strategy), sample.eye_vertices(strategy));
        let before = |side: &[Vertex], n: u32| if n >= 2 { side.get(n as usize - 2).map_or(1.0, |v| v.look.opacity) } else { 1.0 };
        let (light, eye) = (&sample.light.vertices, &sample.eye.vertices);
        let none = <Vertex as bytemuck::Zeroable>::zeroed();
        let number = |side: &[Vertex], i: usize| side.get(i).map_or([0.0; 3], |v| [v.pdf_fwd_area, v.pdf_rev_area, bits(v.flags)]);
        Some(Self {
            id: sample.id,
            strategy,
            a: y.last().copied().unwrap_or(none),
            b: *z.last()?,
            opacity: [before(y, strategy.s), before(z, strategy.t)],
            sides: (0..ROOM).flat_map(|i| [number(light, i), number(eye, i)].concat()).collect(),
            result,
        })
    }

    fn row(&self) -> Vec<f32> {
        let mut row: Vec<f32> = bytemuck::cast_slice(&[self.a, self.b]).to_vec();
        let SampleId { x, y, sample, seed, .. } = self.id;
        row.extend([self.strategy.s, self.strategy.t, x, y, sample, seed].map(bits));
        row.extend(self.opacity);
        row.extend(&self.sides);
        row
    }

    fn joins(&self) -> bool {
        self.strategy.s > 0 && self.strategy.t > 0
    }

    /// Was the CPU near to another decision?
    fn is_marginal(&self, context: &Context) -> bool {
        let Self { a, b, .. } = self;
        if !self.joins() {
            return self.cosines(b.w_prev).iter().any(|cos| *cos < MARGIN);
        }
        let (w, _) = a.edge_to(b);
        let near_rim = self.strategy.t == 1
            && context.view.project(-w, b.position).is_some_and(|raster| {
                // Between two pixels, or at the film's rim.
                [raster.x, raster.y].iter().any(|x| (x - x.round()).abs() < 1e-3)
            });
        let side = |ends: [Vec3; 2]| ends.iter().any(|n| n.dot(w).abs() < MARGIN);
        if near_rim || side([a.n_g, b.n_g]) || side([a.n_s, b.n_s]) {
            return true;
        }
        let path = segment(context, a, b, w);
        let (ray, end) = if a.has(AT_INFINITY) {
            (Ray { origin: path.to, direction: -w }, f32::MAX)
        } else {
            (Ray { origin: path.from, direction: (path.to - path.from).normalize() }, (path.to - path.from).length())
        };
        ray_is_marginal(context.scene, &ray, Reach::End(end), false)
    }

    fn cosines(&self, w: Vec3) -> Vec<f32> {
        [self.a.n_g, self.a.n_s, self.b.n_g, self.b.n_s].iter().map(|n| n.dot(w).abs()).filter(|cos| *cos > 0.0).collect()
    }

    /// By how much rounding grows: over short edges, at grazing angles, with sharp microfacets.
    fn growth(&self, scene: &Scene) -> f32 {
        let (w, _) = if self.joins() { self.a.edge_to(&self.b) } else { (self.b.w_prev, 0.0) };
        let mut growth = 1.0 + self.cosines(w).iter().map(|cos| 1.0 / cos).sum::<f32>();
        if self.joins() && !self.a.has(AT_INFINITY) {
            growth += scene.sphere.radius / (self.a.position - self.b.position).length();
        }
        for v in [&self.a, &self.b] {
            growth += [v.n_g, v.n_s].iter().map(|n| n.dot(v.w_prev).abs()).filter(|cos| *cos > 0.0).map(|cos| 1.0 / cos).sum::<f32>();
            if v.material != NONE && scene.materials[v.material as usize].kind >= CONDUCTOR {
                growth += 1.0 / Material::alpha(v.look.roughness);
            }
        }
        growth
    }
}

/// Strategies evaluated, contributing, decided otherwise, these without need.
fn joins(gpu: &Gpu, scene: Arc<Scene>, change: Option<(&str, &str)>) -> ([usize; 4], [Worst; 2]) {
    const SIDE: u32 = 16;
    let settings = Settings { max_edges: EDGES, seed: 5, ..Settings::default() };
    let work = Work::new(Job { size: [SIDE; 2], settings, ..Job::new(scene) });
    let context = Context::new(&work.job.scene, &work.view, &work.job.settings);
    let (mut list, mut sample) = (Vec::new(), Sample::default());
    for i in 0..2 * SIDE * SIDE {
        let id = context.settings.sample([i % SIDE, i / SIDE % SIDE], i / (SIDE * SIDE));
        sample.trace(&context, id, EDGES as usize, EDGES as usize + 1);
        let strategies = Strategy::all(EDGES, context.view.has_lens());
        list.extend(strategies.filter_map(|strategy| Join::new(&context, &mut sample, strategy)));
    }
    let table: Vec<f32> = list.iter().flat_map(Join::row).collect();
    let out = Table { gpu, work: &work, change }.run(&body(), INPUTS, 7, &table);
    // In ε over the growth.
    let mut all = [Worst::new("contribution_unweighted", 256.0), Worst::new("mis_weight", 1024.0)];
    let mut seen = [list.len(), 0, 0, 0];
    for (row, join) in out.iter().zip(&list) {
        let found = (row[0].to_bits() == 1).then(|| [row[1].to_bits(), row[2].to_bits()]);
        let own = join.result.as_ref().ok();
        seen[1] += usize::from(own.is_some());
        if found != own.map(|c| c.pixel) {
            seen[2] += 1;
            if !join.is_marginal(&context) {
                seen[3] += 1;
                if change.is_none() {
                    println!("{}: {row:?} on the device, {:?} here", join.strategy, join.result);
                }
            }
        } else if let Some(own) = own {
            let growth = join.growth(context.scene);
            let raw = own.contribution_unweighted;
            all[0].within(&row[3..6], &raw.to_array(), raw.max_element().max(1e-30) * growth);
            all[1].within(&row[6..], &[own.mis_weight], own.mis_weight.max(1e-20) * growth);
        }
    }
    (seen, all)
}

#[test]
fn every_strategy_joins_alike() {
    let Some(gpu) = gpu("every_strategy_joins_alike") else { return };
    let list = [
        scenes::builtin("cornell"),
        scenes::specular(),
        scenes::tilted(),
        surface_scenes::glossy_tilted(),
        surface_scenes::glossy_room(),
        surface_scenes::textured(),
        surface_scenes::holes(),
        surface_scenes::veils(true),
        surface_scenes::veils_under_the_sky(),
        emitters_scenes::wide_lens(),
        emitters_scenes::dirac_room(),
        emitters_scenes::under_the_sky(),
        emitters_scenes::everything(),
    ];
    for scene in list {
        let (name, (seen, all)) = (scene.name.clone(), joins(gpu, scene, None));
        println!("{name}: {} strategies, {} contribute, {} decided otherwise, {} of them without need", seen[0], seen[1], seen[2], seen[3]);
        all.iter().for_each(Worst::finish);
        assert_eq!(seen[3], 0, "{name}");
        assert!(seen[1] > 500 && seen[2] * 500 < seen[0], "{name}: {seen:?}");
    }
}

/// Negative control: one factor of one density.
#[test]
fn another_density_is_noticed() {
    let Some(gpu) = gpu("another_density_is_noticed") else { return };
    let change = ("b.survival * at_b.reverse * b.geometry_prev", "1.001 * b.survival * at_b.reverse * b.geometry_prev");
    let (seen, [contribution, weight]) = joins(gpu, scenes::builtin("cornell"), Some(change));
    assert!(seen[3] == 0 && contribution.holds() && !weight.holds(), "{contribution:?} {weight:?}");
}
