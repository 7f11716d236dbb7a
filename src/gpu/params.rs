//! What a kernel is told beside the scene: the view, the settings, and where in its buffers things are.
//!
//! Twin: `Control`, `Params`, `Batch` and `SplatRecord` in shaders/types.wgsl.

use super::scene::Places;
use crate::bdpt::render::Plan;
use crate::bdpt::{HeuristicKind, Settings};
use crate::film::Rect;
use crate::math::{Vec2, Vec3};
use crate::scene::{NONE, Scene, View};
use crate::shared_struct;

/// Rounds of the loop by which a kernel finds out that its loops still run.
pub const CANARY: u32 = 3;

shared_struct! {
    /// The same for all batches of a rendering. Offsets count vec4s.
    pub struct Params {
        /// `View::position`.
        pub camera_position: Vec3,
        /// `View::lens`, m; 0 is a pinhole.
        pub lens_radius: f32,
        /// To the right of the picture.
        pub camera_right: Vec3,
        /// 1/focus distance, m⁻¹.
        pub inverse_focus: f32,
        /// To the top of the picture.
        pub camera_up: Vec3,
        /// 1/n.
        pub per_pass: f32,
        /// Viewing direction.
        pub camera_axis: Vec3,
        /// `View::clearance`, m.
        pub clearance: f32,
        /// Of the sphere around scene and lens, m.
        pub sphere_centre: Vec3,
        /// Of the same sphere, m.
        pub sphere_radius: f32,
        /// Half the film on the plane at distance 1.
        pub half_extent: Vec2,
        /// Its reciprocal.
        pub inverse_half_extent: Vec2,
        /// Film size, pixels.
        pub size: [u32; 2],
        /// Number of pixels.
        pub pixels: f32,
        /// A_film.
        pub film_area: f32,
        /// P_A(z₀), m⁻²; of a pinhole 1.
        pub pdf_lens_area: f32,
        /// 1/(πR²), m⁻².
        pub pdf_disk_area: f32,
        /// Of the splats, radiance.
        pub quantum: f32,
        /// Of the random numbers.
        pub seed: u32,
        /// K.
        pub max_edges: u32,
        /// One of `HEURISTIC_…`.
        pub heuristic: u32,
        /// β; 1 for the balance heuristic.
        pub beta: f32,
        /// Threshold of the cutoff heuristic.
        pub cutoff: f32,
        /// 1: Russian roulette.
        pub roulette: u32,
        /// 1: s = 1 and t = 1 draw a fresh end.
        pub fresh_ends: u32,
        /// 1: there are surfaces that are there with a probability.
        pub alpha_blend: u32,
        /// Most vertices of a light subpath.
        pub light_vertices: u32,
        /// Most vertices of an eye subpath.
        pub eye_vertices: u32,
        /// Crop window: first column.
        pub crop_x: u32,
        /// First row.
        pub crop_y: u32,
        /// Columns.
        pub crop_width: u32,
        /// Rows.
        pub crop_height: u32,
        /// Number of lights.
        pub lights_count: u32,
        /// Number of triangles.
        pub triangles_count: u32,
        /// Where the materials begin in the tables.
        pub materials: u32,
        /// Lights.
        pub lights: u32,
        /// Texture uses.
        pub textures: u32,
        /// Alias table of the lights.
        pub light_choice: u32,
        /// Its cells.
        pub light_cells: u32,
        /// Linear values of the 256 sRGB codes.
        pub linear: u32,
        /// A vec4 per strategy, by its index: does it run, its weighted and its raw layer, nothing.
        pub slots: u32,
        /// Number of the environment among the lights, or [`NONE`].
        pub environment_light: u32,
        /// The environment's texels.
        pub environment_texels: u32,
        /// Its alias table.
        pub environment_choice: u32,
        /// The table's cells.
        pub environment_cells: u32,
        /// Texels around.
        pub environment_width: u32,
        /// Texels from top to bottom.
        pub environment_height: u32,
        /// Turns.
        pub environment_rotation: f32,
        /// What triangles have beyond their corners: the list.
        pub attributes: u32,
        /// Normals.
        pub normals: u32,
        /// Tangents.
        pub tangents: u32,
        /// Texture coordinates.
        pub uvs: u32,
        /// Colours.
        pub colors: u32,
        /// [`CANARY`].
        pub canary: u32,
        /// One of `SAMPLER_…`.
        pub sampler: u32,
        /// n_i of the strategies with t ≤ 1.
        pub light_subpaths: f32,
        /// 1/n of these.
        pub per_splat: f32,
        /// Padding.
        pub _pad0: u32,
        /// Padding.
        pub _pad1: u32,
        /// The strategies that take part: a bit per index.
        pub strategies: [[u32; 4]; 18],
    }
}

shared_struct! {
    /// A part of a pass: every `row_step`-th row of a tile, from `first_row` on.
    pub struct Batch {
        /// Number of the pass: the eye subpath's sample in each pixel.
        pub pass_number: u32,
        /// First row.
        pub first_row: u32,
        /// From one row to the next.
        pub row_step: u32,
        /// Pairs of subpaths: rows times the film's width.
        pub pairs: u32,
        /// The tile's first row (when splats are added: of the tile they are added to).
        pub tile_row: u32,
        /// Its pixels.
        pub tile_pixels: u32,
        /// The light subpath's sample in each pixel.
        pub sample: u32,
        /// Padding.
        pub _pad0: u32,
    }
}

shared_struct! {
    /// All that a dispatch is told.
    pub struct Control {
        /// Which part of which pass.
        pub batch: Batch,
        /// Of the whole rendering.
        pub params: Params,
    }
}

shared_struct! {
    /// A splat on its way to the film.
    pub struct SplatRecord {
        /// C*, radiance.
        pub value: Vec3,
        /// w.
        pub mis_weight: f32,
        /// Where it lands: row · width + column.
        pub pixel: u32,
        /// The pixel of its sample: column | row << 16.
        pub source: u32,
        /// Index of the strategy.
        pub strategy: u32,
        /// Its s.
        pub s: u32,
    }
}

/// `HEURISTIC_…` of a kind.
pub fn heuristic_code(kind: HeuristicKind) -> u32 {
    match kind {
        HeuristicKind::Power => 0,
        HeuristicKind::Balance => 1,
        HeuristicKind::Max => 2,
        HeuristicKind::Cutoff => 3,
        HeuristicKind::Uniform => 4,
    }
}

/// What is rendered, as the kernels see it.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The camera with its film.
    pub view: &'a View,
    /// The estimator's settings.
    pub settings: &'a Settings,
    /// Which strategies run and where their layers are.
    pub plan: &'a Plan,
    /// The part of the film that is wanted.
    pub crop: Rect,
}

impl Params {
    /// The parameters of a task whose scene lies at these places.
    pub fn new(task: &Task, places: &Places, quantum: f32) -> Self {
        let Task { scene, view, settings, plan, crop } = *task;
        let environment = scene.lights.environment.as_ref();
        let axes = view.axes();
        let beta = if settings.heuristic.kind == HeuristicKind::Balance { 1.0 } else { settings.heuristic.beta };
        Self {
            camera_position: view.position,
            lens_radius: view.lens.radius,
            camera_right: axes.right,
            inverse_focus: axes.inverse_focus,
            camera_up: axes.up,
            per_pass: view.per_pass(),
            camera_axis: view.axis,
            clearance: view.clearance,
            sphere_centre: view.sphere.centre,
            sphere_radius: view.sphere.radius,
            half_extent: axes.half_extent,
            inverse_half_extent: axes.inverse_half_extent,
            size: view.size,
            pixels: view.pixels(),
            film_area: view.film_area(),
            pdf_lens_area: view.pdf_lens_area(),
            pdf_disk_area: view.pdf_disk_area,
            quantum,
            seed: settings.seed,
            max_edges: settings.max_edges,
            heuristic: heuristic_code(settings.heuristic.kind),
            beta,
            cutoff: settings.heuristic.cutoff,
            roulette: u32::from(settings.roulette),
            fresh_ends: u32::from(settings.fresh_ends),
            alpha_blend: u32::from(scene.features.alpha_blend),
            light_vertices: plan.light_vertices() as u32,
            eye_vertices: plan.eye_vertices() as u32,
            crop_x: crop.x,
            crop_y: crop.y,
            crop_width: crop.width,
            crop_height: crop.height,
            lights_count: scene.lights.list.len() as u32,
            triangles_count: scene.triangles.len() as u32,
            materials: places.materials,
            lights: places.lights,
            textures: places.textures,
            light_choice: places.light_choice,
            light_cells: scene.lights.choice.cells.len() as u32,
            linear: places.linear,
            slots: places.slots,
            environment_light: scene.lights.environment_index().unwrap_or(NONE),
            environment_texels: places.environment_texels,
            environment_choice: places.environment_choice,
            environment_cells: environment.map_or(0, |map| map.choice.cells.len() as u32),
            environment_width: environment.map_or(0, |map| map.width),
            environment_height: environment.map_or(0, |map| map.height),
            environment_rotation: environment.map_or(0.0, |map| map.rotation()),
            attributes: places.attributes,
            normals: places.normals,
            tangents: places.tangents,
            uvs: places.uvs,
            colors: places.colors,
            canary: CANARY,
            sampler: settings.sampler as u32,
            light_subpaths: settings.light_subpaths as f32,
            per_splat: view.per_pass() / settings.light_subpaths as f32,
            _pad0: 0,
            _pad1: 0,
            strategies: settings.strategies.words(),
        }
    }
}
