// What the kernels read and write. Binding numbers are those of src/gpu/mod.rs, where the list stands with its reasons.

// What the kernels are compiled for (scene::features::Shape): a narrower kernel renders the scenes that do not need the rest.
override HAS_ALPHA: bool = true;
override HAS_TEXTURES: bool = true;
override HAS_GLOSSY: bool = true;

@group(0) @binding(0) var<storage, read> control: Control;
@group(0) @binding(1) var<storage, read> nodes: array<Node>;
@group(0) @binding(2) var<storage, read> triangles: array<Triangle>;
@group(0) @binding(3) var<storage, read> tables: array<vec4<u32>>;
@group(0) @binding(4) var<storage, read> texels: array<u32>;
@group(0) @binding(5) var<storage, read_write> light_vertices: array<Vertex>;
@group(0) @binding(6) var<storage, read_write> film: array<f32>;
@group(0) @binding(7) var<storage, read_write> output: Output;

struct Output {
    records_count: atomic<u32>,
    rays_closest_low: atomic<u32>,
    rays_closest_high: atomic<u32>,
    rays_shadow_low: atomic<u32>,
    rays_shadow_high: atomic<u32>,
    non_finite: atomic<u32>,
    saturated: atomic<u32>,
    stack_overflows: atomic<u32>,
    cut_short: atomic<u32>,
    _pad0: u32,
    _pad1: u32,
    _pad2: u32,
    records: array<SplatRecord>,
}

// This invocation's counts.
var<private> rays_closest: u32;
var<private> rays_shadow: u32;
var<private> non_finite: u32;
var<private> stack_overflows: u32;
