//! One declaration: every struct and constant of shaders/types.wgsl is Rust's, and the bindings are as few as promised.

use bdpt_explorer::bdpt::strategy::MAX_VERTICES;
use bdpt_explorer::bdpt::{HeuristicKind, Vertex, vertex};
use bdpt_explorer::gpu::shader::{FILES, Source};
use bdpt_explorer::gpu::{Batch, Control, Params, SplatRecord, heuristic_code};
use bdpt_explorer::layout::Field;
use bdpt_explorer::rng;
use bdpt_explorer::scene::alias::AliasCell;
use bdpt_explorer::scene::attributes::{Attributes, Colors, Normals, Tangents, Uvs};
use bdpt_explorer::scene::bvh::Node;
use bdpt_explorer::scene::environment::Texel;
use bdpt_explorer::scene::light::{self, Light};
use bdpt_explorer::scene::material::{self, Material};
use bdpt_explorer::scene::texture::{self, Texture};
use bdpt_explorer::scene::{Look, NONE, Triangle};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, Expression, Literal, Module, TypeInner};

type Layout = (&'static str, usize, Vec<Field>);

fn structs() -> [Layout; 18] {
    [
        Triangle::layout(),
        Node::layout(),
        Material::layout(),
        Look::layout(),
        Attributes::layout(),
        Normals::layout(),
        Tangents::layout(),
        Uvs::layout(),
        Colors::layout(),
        Texture::layout(),
        Light::layout(),
        AliasCell::layout(),
        Texel::layout(),
        Vertex::layout(),
        Params::layout(),
        Batch::layout(),
        Control::layout(),
        SplatRecord::layout(),
    ]
}

/// Names and values, as bits.
fn constants() -> Vec<(&'static str, u32)> {
    let heuristic = |name, kind| (name, heuristic_code(kind));
    vec![
        ("NONE", NONE),
        ("LAMBERT", material::LAMBERT),
        ("MIRROR", material::MIRROR),
        ("DIELECTRIC", material::DIELECTRIC),
        ("THIN_DIELECTRIC", material::THIN_DIELECTRIC),
        ("CONDUCTOR", material::CONDUCTOR),
        ("COAT", material::COAT),
        ("VARIES", material::VARIES),
        ("TRANSPARENT", material::TRANSPARENT),
        ("UNLIT", material::UNLIT),
        ("MIN_ALPHA", material::MIN_ALPHA.to_bits()),
        ("WRAP_U", texture::WRAP_U),
        ("WRAP_V", texture::WRAP_V),
        ("SRGB", texture::SRGB),
        ("NEAREST", texture::NEAREST),
        ("SET_1", texture::SET_1),
        ("AREA", light::AREA),
        ("POINT", light::POINT),
        ("SPOT", light::SPOT),
        ("DIRECTIONAL", light::DIRECTIONAL),
        ("ENVIRONMENT", light::ENVIRONMENT),
        ("BLOCK_EYE_START", rng::BLOCK_EYE_START),
        ("BLOCK_LIGHT_START", rng::BLOCK_LIGHT_START),
        ("BLOCK_LIGHT_DIRECTION", rng::BLOCK_LIGHT_DIRECTION),
        ("BLOCK_LIGHT_PLACE", rng::BLOCK_LIGHT_PLACE),
        ("BLOCK_LIGHT_VERTEX", rng::BLOCK_LIGHT_VERTEX),
        ("BLOCK_EYE_VERTEX", rng::BLOCK_EYE_VERTEX),
        ("BLOCK_FRESH_LIGHT", rng::BLOCK_FRESH_LIGHT),
        ("BLOCK_FRESH_LENS", rng::BLOCK_FRESH_LENS),
        ("BLOCK_SPLAT", rng::BLOCK_SPLAT),
        ("BLOCK_FRESH_PLACE", rng::BLOCK_FRESH_PLACE),
        ("BLOCK_ALPHA", rng::BLOCK_ALPHA),
        ("SAMPLER_HASH", rng::Sampler::Hash as u32),
        ("SAMPLER_SOBOL", rng::Sampler::Sobol as u32),
        ("MOST_GEOMETRY", vertex::MOST_GEOMETRY.to_bits()),
        ("ON_LENS", vertex::ON_LENS),
        ("ON_LIGHT", vertex::ON_LIGHT),
        ("ON_SURFACE", vertex::ON_SURFACE),
        ("DELTA", vertex::DELTA),
        ("DISCRETE", vertex::DISCRETE),
        ("AT_INFINITY", vertex::AT_INFINITY),
        ("AT_POINT", vertex::AT_POINT),
        ("MAX_VERTICES", MAX_VERTICES as u32),
        heuristic("HEURISTIC_POWER", HeuristicKind::Power),
        heuristic("HEURISTIC_BALANCE", HeuristicKind::Balance),
        heuristic("HEURISTIC_MAX", HeuristicKind::Max),
        heuristic("HEURISTIC_CUTOFF", HeuristicKind::Cutoff),
        heuristic("HEURISTIC_UNIFORM", HeuristicKind::Uniform),
    ]
}

/// What is different in a WGSL text, a line each.
fn struct_differences(module: &Module) -> Vec<String> {
    let differs = |(name, size, fields): Layout| {
        let Some((_, found)) = module.types.iter().find(|(_, t)| t.name.as_deref() == Some(name)) else {
            return Some(format!("{name} is missing"));
        };
        let TypeInner::Struct { members, span } = &found.inner else { return Some(format!("{name} is no struct")) };
        let there: Vec<_> = members.iter().map(|m| (m.name.as_deref().unwrap_or_default(), m.offset as usize)).collect();
        (there != fields || *span as usize != size)
            .then(|| format!("{name}: {span} bytes {there:?} in WGSL, {size} bytes {fields:?} in Rust"))
    };
    structs().into_iter().filter_map(differs).collect()
}

/// The same of the constants, none missing on either side.
fn constant_differences(module: &Module) -> Vec<String> {
    let value = |constant: &naga::Constant| match module.global_expressions[constant.init] {
        Expression::Literal(Literal::U32(x)) => Some(x),
        Expression::Literal(Literal::F32(x)) => Some(x.to_bits()),
        _ => None,
    };
    let mut there: Vec<_> = module.constants.iter().map(|(_, c)| (c.name.clone().unwrap_or_default(), value(c))).collect();
    let mut differences = Vec::new();
    for (name, expected) in constants() {
        let found = there.iter().position(|(n, _)| n == name).map(|i| there.remove(i).1);
        if found != Some(Some(expected)) {
            differences.push(format!("{name}: {found:?} in WGSL, {expected} in Rust"));
        }
    }
    differences.extend(there.into_iter().map(|(name, _)| format!("{name} is not in this test's table")));
    differences
}

fn types() -> &'static str {
    FILES.iter().find(|(name, _)| *name == "types.wgsl").unwrap().1
}

fn parse(text: &str) -> Module {
    naga::front::wgsl::parse_str(text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)))
}

#[test]
fn structs_and_constants_are_rusts() {
    assert_eq!(struct_differences(&parse(&Source::kernels(1).text)), Vec::<String>::new());
    assert_eq!(constant_differences(&parse(types())), Vec::<String>::new());
    println!("{} structs, {} constants", structs().len(), constants().len());
}

/// Negative controls.
#[test]
fn another_declaration_is_noticed() {
    let changed = |from: &str, to: &str| {
        assert!(types().contains(from), "types.wgsl no longer says {from}");
        let module = parse(&types().replacen(from, to, 1));
        [struct_differences(&module).len(), constant_differences(&module).len()]
    };
    assert_eq!(changed("geometry_prev: f32", "geometry_before: f32"), [1, 0], "a renamed field");
    let both = ["pdf_fwd_area: f32,\n    pdf_rev_area: f32,", "pdf_rev_area: f32,\n    pdf_fwd_area: f32,"];
    assert_eq!(changed(both[0], both[1]), [1, 0], "two fields in another order");
    assert_eq!(changed("radiance: vec3<f32>,\n    pdf_sa: f32,", "radiance: vec3<f32>,"), [1, 0], "no number after a vec3");
    assert_eq!(changed("    barycentric: vec2<f32>,\n", "    barycentric: vec3<f32>,\n"), [2, 0], "a wider field, here and in Vertex");
    assert_eq!(changed("DELTA: u32 = 8u", "DELTA: u32 = 9u"), [0, 1], "a constant of another value");
    assert_eq!(changed("MIN_ALPHA: f32 = 1e-3", "MIN_ALPHA: f32 = 1.0001e-3"), [0, 1], "a number of another value");
    assert_eq!(changed("// rng.rs\n", "const NEW: u32 = 3u;\n"), [0, 1], "a constant that Rust does not have");
    assert_eq!(changed("const SRGB: u32 = 16u;\n", ""), [0, 1], "a constant that WGSL does not have");
}

#[test]
fn kernels_use_the_storage_bindings_that_are_promised() {
    let module = parse(&Source::kernels(1).text);
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
    let names: Vec<_> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
    for name in ["trace_light", "trace_eye", "resolve"] {
        assert!(names.contains(&name), "{names:?}");
    }
    for (i, name) in names.iter().enumerate() {
        let used = module.global_variables.iter().filter(|(handle, variable)| {
            matches!(variable.space, AddressSpace::Storage { .. }) && !info.get_entry_point(i)[*handle].is_empty()
        });
        let used: Vec<_> = used.map(|(_, variable)| variable.name.as_deref().unwrap_or_default()).collect();
        println!("{name}: {used:?}");
        assert!(used.len() <= 8, "{name} uses {used:?}");
    }
}

#[test]
fn no_file_is_forgotten() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut there: Vec<_> = walkdir::WalkDir::new(&root)
        .into_iter()
        .map(Result::unwrap)
        .filter(|entry| entry.path().extension().is_some_and(|extension| extension == "wgsl"))
        .map(|entry| entry.path().strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/"))
        .collect();
    // The kernels' files, and the one of the 3-D view's raster.
    let raster = "raster/surface.wgsl";
    assert_eq!(std::fs::read_to_string(root.join(raster)).unwrap(), bdpt_explorer::gpu::raster::SHADER);
    let mut listed: Vec<_> = FILES.iter().map(|(name, _)| *name).chain([raster]).map(str::to_owned).collect();
    there.sort();
    listed.sort();
    assert_eq!(there, listed);
}
