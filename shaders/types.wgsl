// The structs and constants that Rust and WGSL share; a test holds every name, offset, size and value against Rust's.
// What a field means stands beside its Rust twin.

// scene/mod.rs
const NONE: u32 = 0xffffffffu;

struct Triangle {
    p0: vec3<f32>,
    material: u32,
    p1: vec3<f32>,
    light: u32,
    p2: vec3<f32>,
    attributes: u32,
}

// scene/bvh.rs
struct Node {
    min: vec3<f32>,
    first: u32,
    max: vec3<f32>,
    count: u32,
}

// scene/material.rs
struct Material {
    color: vec3<f32>,
    kind: u32,
    emission: vec3<f32>,
    ior: f32,
    f0: vec3<f32>,
    f90: f32,
    roughness: f32,
    metallic: f32,
    opacity: f32,
    cutoff: f32,
    survival: f32,
    two_sided: u32,
    flags: u32,
    normal_scale: f32,
    base_color_texture: u32,
    metallic_roughness_texture: u32,
    emissive_texture: u32,
    normal_texture: u32,
}

const LAMBERT: u32 = 0u;
const MIRROR: u32 = 1u;
const DIELECTRIC: u32 = 2u;
const THIN_DIELECTRIC: u32 = 3u;
const CONDUCTOR: u32 = 4u;
const COAT: u32 = 5u;
const VARIES: u32 = 1u;
const TRANSPARENT: u32 = 2u;
const UNLIT: u32 = 4u;
const MIN_ALPHA: f32 = 1e-3;

// scene/surface.rs
struct Look {
    color: vec3<f32>,
    roughness: f32,
    metallic: f32,
    opacity: f32,
    barycentric: vec2<f32>,
}

// scene/attributes.rs
struct Attributes {
    normals: u32,
    tangents: u32,
    uvs_0: u32,
    uvs_1: u32,
    colors: u32,
    _pad0: u32,
    _pad1: u32,
    _pad2: u32,
}

struct Normals {
    n0: vec3<f32>,
    _pad0: u32,
    n1: vec3<f32>,
    _pad1: u32,
    n2: vec3<f32>,
    _pad2: u32,
}

struct Tangents {
    t0: vec3<f32>,
    sign: f32,
    t1: vec3<f32>,
    _pad0: u32,
    t2: vec3<f32>,
    _pad1: u32,
}

struct Uvs {
    uv0: vec2<f32>,
    uv1: vec2<f32>,
    uv2: vec2<f32>,
}

struct Colors {
    c0: vec4<f32>,
    c1: vec4<f32>,
    c2: vec4<f32>,
}

// scene/texture.rs
struct Texture {
    first: u32,
    width: u32,
    height: u32,
    flags: u32,
    row_u: vec3<f32>,
    _pad0: u32,
    row_v: vec3<f32>,
    _pad1: u32,
}

const WRAP_U: u32 = 0u;
const WRAP_V: u32 = 2u;
const SRGB: u32 = 16u;
const NEAREST: u32 = 32u;
const SET_1: u32 = 64u;

// scene/light.rs
struct Light {
    radiance: vec3<f32>,
    kind: u32,
    position: vec3<f32>,
    triangle: u32,
    axis: vec3<f32>,
    pmf: f32,
    area: f32,
    sides: f32,
    versine_inner: f32,
    versine_outer: f32,
}

const AREA: u32 = 0u;
const POINT: u32 = 1u;
const SPOT: u32 = 2u;
const DIRECTIONAL: u32 = 3u;
const ENVIRONMENT: u32 = 4u;

// scene/alias.rs
struct AliasCell {
    threshold: f32,
    other: u32,
}

// scene/environment.rs
struct Texel {
    radiance: vec3<f32>,
    pdf_sa: f32,
}

// rng.rs
const BLOCK_EYE_START: u32 = 0u;
const BLOCK_LIGHT_START: u32 = 1u;
const BLOCK_LIGHT_DIRECTION: u32 = 2u;
const BLOCK_LIGHT_PLACE: u32 = 3u;
const BLOCK_LIGHT_VERTEX: u32 = 16u;
const BLOCK_EYE_VERTEX: u32 = 96u;
const BLOCK_FRESH_LIGHT: u32 = 176u;
const BLOCK_FRESH_LENS: u32 = 256u;
const BLOCK_SPLAT: u32 = 336u;
const BLOCK_FRESH_PLACE: u32 = 416u;
const BLOCK_ALPHA: u32 = 512u;
const SAMPLER_HASH: u32 = 0u;
const SAMPLER_SOBOL: u32 = 1u;

// bdpt/vertex.rs
struct Vertex {
    position: vec3<f32>,
    flags: u32,
    n_g: vec3<f32>,
    material: u32,
    n_s: vec3<f32>,
    light: u32,
    alpha: vec3<f32>,
    triangle: u32,
    w_prev: vec3<f32>,
    error: f32,
    pdf_fwd_area: f32,
    pdf_rev_area: f32,
    survival: f32,
    geometry_prev: f32,
    look: Look,
}

const MOST_GEOMETRY: f32 = 1e30;
const ON_LENS: u32 = 1u;
const ON_LIGHT: u32 = 2u;
const ON_SURFACE: u32 = 4u;
const DELTA: u32 = 8u;
const DISCRETE: u32 = 16u;
const AT_INFINITY: u32 = 32u;
const AT_POINT: u32 = 64u;

// bdpt/strategy.rs
const MAX_VERTICES: u32 = 65u;

// gpu/params.rs
struct Params {
    camera_position: vec3<f32>,
    lens_radius: f32,
    camera_right: vec3<f32>,
    inverse_focus: f32,
    camera_up: vec3<f32>,
    per_pass: f32,
    camera_axis: vec3<f32>,
    clearance: f32,
    sphere_centre: vec3<f32>,
    sphere_radius: f32,
    half_extent: vec2<f32>,
    inverse_half_extent: vec2<f32>,
    size: vec2<u32>,
    pixels: f32,
    film_area: f32,
    pdf_lens_area: f32,
    pdf_disk_area: f32,
    quantum: f32,
    seed: u32,
    max_edges: u32,
    heuristic: u32,
    beta: f32,
    cutoff: f32,
    roulette: u32,
    fresh_ends: u32,
    alpha_blend: u32,
    light_vertices: u32,
    eye_vertices: u32,
    crop_x: u32,
    crop_y: u32,
    crop_width: u32,
    crop_height: u32,
    lights_count: u32,
    triangles_count: u32,
    materials: u32,
    lights: u32,
    textures: u32,
    light_choice: u32,
    light_cells: u32,
    linear: u32,
    slots: u32,
    environment_light: u32,
    environment_texels: u32,
    environment_choice: u32,
    environment_cells: u32,
    environment_width: u32,
    environment_height: u32,
    environment_rotation: f32,
    attributes: u32,
    normals: u32,
    tangents: u32,
    uvs: u32,
    colors: u32,
    canary: u32,
    sampler: u32,
    light_subpaths: f32,
    per_splat: f32,
    _pad0: u32,
    _pad1: u32,
    strategies: array<vec4<u32>, 18>,
}

const HEURISTIC_POWER: u32 = 0u;
const HEURISTIC_BALANCE: u32 = 1u;
const HEURISTIC_MAX: u32 = 2u;
const HEURISTIC_CUTOFF: u32 = 3u;
const HEURISTIC_UNIFORM: u32 = 4u;

struct Batch {
    pass_number: u32,
    first_row: u32,
    row_step: u32,
    pairs: u32,
    tile_row: u32,
    tile_pixels: u32,
    sample: u32,
    _pad0: u32,
}

struct Control {
    batch: Batch,
    params: Params,
}

struct SplatRecord {
    value: vec3<f32>,
    mis_weight: f32,
    pixel: u32,
    source: u32,
    strategy: u32,
    s: u32,
}
