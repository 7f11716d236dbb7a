//! Reading structs out of the tables: every field of every element of several scenes comes back as Rust has it.

use crate::harness::{Work, gpu};
use crate::scenes::Room;
use crate::table::{Table, store};
use crate::{emitters_scenes, scenes, surface_scenes};
use bdpt_explorer::engine::Job;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::parts::PartAttributes;
use bdpt_explorer::scene::texture::linear_values;
use bdpt_explorer::scene::{Material, Scene};
use bytemuck::Pod;
use glam::Vec4;
use std::sync::Arc;

/// An array of the tables: its struct, how WGSL reads element `row`, and Rust's words.
struct Array {
    of: &'static str,
    read: &'static str,
    words: Vec<u32>,
    /// Words of an element.
    size: usize,
}

fn arrays(scene: &Scene) -> Vec<Array> {
    fn array<T: Pod>(of: &'static str, read: &'static str, list: &[T]) -> Array {
        Array { of, read, words: bytemuck::cast_slice(list).to_vec(), size: size_of::<T>() / 4 }
    }
    let environment = scene.lights.environment.as_ref();
    vec![
        array("Material", "load_material(row)", &scene.materials),
        array("Light", "load_light(row)", &scene.lights.list),
        array("Texture", "load_texture(row)", &scene.textures.list),
        array("AliasCell", "load_alias_cell(control.params.light_choice, row)", &scene.lights.choice.cells),
        array("Texel", "load_texel(row)", environment.map_or(&[], |map| &map.texels)),
        array("AliasCell", "load_alias_cell(control.params.environment_choice, row)", environment.map_or(&[], |map| &map.choice.cells)),
        array("Attributes", "load_attributes(row)", &scene.attributes.list),
        array("Normals", "load_normals(row)", &scene.attributes.normals),
        array("Tangents", "load_tangents(row)", &scene.attributes.tangents),
        array("Uvs", "load_uvs(row)", &scene.attributes.uvs),
        array("Colors", "load_colors(row)", &scene.attributes.colors),
        array("", "load_linear(row)", linear_values()),
    ]
}

/// How many elements of each array came back, and how many of all were not Rust's.
fn read_back(gpu: &Gpu, scene: Arc<Scene>, change: Option<(&str, &str)>) -> (Vec<usize>, usize) {
    let work = Work::new(Job::new(scene));
    let arrays = arrays(&work.job.scene);
    let (mut body, mut at) = (String::from("fn run_row(row: u32) {\n"), 0);
    for (i, Array { of, read, size, words }) in arrays.iter().enumerate() {
        let stored = if of.is_empty() { format!("out_f(row, {at}u, x{i});") } else { store(of, &format!("x{i}"), at) };
        body += &format!("if row < in_u(row, {i}u) {{ let x{i} = {read};\n{stored} }}\n");
        at += size;
        assert_eq!(words.len() % size, 0);
    }
    body += "}";
    let counts: Vec<usize> = arrays.iter().map(|array| array.words.len() / array.size).collect();
    let rows = counts.iter().max().unwrap();
    let input: Vec<f32> = (0..*rows).flat_map(|_| counts.iter().map(|&n| f32::from_bits(n as u32))).collect();
    let out = Table { gpu, work: &work, change }.run(&body, counts.len(), at, &input);
    let (mut wrong, mut first) = (0, 0);
    for array in &arrays {
        for (expected, row) in array.words.chunks(array.size).zip(&out) {
            let found: Vec<u32> = row[first..first + array.size].iter().map(|x| x.to_bits()).collect();
            wrong += usize::from(found != expected);
            if found != expected && change.is_none() {
                println!("{}: {found:x?} instead of {expected:x?}", array.read);
            }
        }
        first += array.size;
    }
    (counts, wrong)
}

#[test]
fn every_element_comes_back() {
    let Some(gpu) = gpu("every_element_comes_back") else { return };
    let scenes = [
        surface_scenes::textured(),
        surface_scenes::veils_under_the_sky(),
        surface_scenes::holes(),
        emitters_scenes::everything(),
        emitters_scenes::under_the_sky(),
        scenes::tilted(),
        scenes::builtin("normal-map"),
        with_tangents(),
    ];
    let mut seen = Vec::new();
    for scene in scenes {
        let name = scene.name.clone();
        let (counts, wrong) = read_back(gpu, scene, None);
        println!("{name}: {counts:?} elements");
        assert_eq!(wrong, 0, "{name}");
        seen.resize(counts.len(), 0);
        seen.iter_mut().zip(counts).for_each(|(seen, n)| *seen = (*seen).max(n));
    }
    assert!(seen.iter().all(|&n| n > 1), "some array had no elements to read: {seen:?}");
}

/// Quads with two sets of texture coordinates, most of them with tangents, all different; textures that are turned and moved.
pub fn with_tangents() -> Arc<Scene> {
    let mut room = Room::new("tangents");
    let byte = |x: u32, y: u32, k: u32| (60 + (x * 37 + y * 91 + k * 53) % 190) as u8;
    let color = room.texture(6, true, |x, y| [byte(x, y, 1), byte(x, y, 2), byte(x, y, 3), byte(x, y, 4)]);
    let bumps = room.texture(4, false, |x, y| [byte(x, y, 5), byte(x, y, 6), 240, 255]);
    let parts = room.parts();
    parts.textures[bumps as usize].set = 1;
    parts.textures[bumps as usize].rows = [Vec3::new(0.8, -0.6, 0.1), Vec3::new(0.6, 0.8, -0.3)];
    parts.textures[color as usize].rows = [Vec3::new(0.0, 1.2, 0.0), Vec3::new(-0.7, 0.0, 0.4)];
    let rough = Material::coat(Vec3::splat(0.8), 0.6, 0.5, 1.5);
    let white = Material { base_color_texture: color, normal_texture: bumps, metallic_roughness_texture: color, ..rough };
    let white = room.material(white.finished());
    for i in 0..6u8 {
        let x = f64::from(i);
        room.quad([x, 0.0, 0.0], [0.9, 0.0, 0.1], [0.0, 1.0, 0.2 * x], white);
    }
    room.camera([0.0, 0.0, 4.0], [1.0, 0.0, 0.0], 50.0);
    let parts = room.parts();
    for (i, triangle) in parts.triangles.iter_mut().enumerate() {
        let at = |k: usize| ((i * 7 + k * 5) as f32 * 0.37).sin();
        let uvs = [0, 3].map(|first| Some([0, 1, 2].map(|k| Vec2::new(at(first + k), at(first + k + 9)))));
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        // The last ones take the axes of the texture coordinates instead.
        let tangents = (i < 8).then(|| [1, 2, 3].map(|k| Vec4::new(1.0, at(k), -at(k), sign)));
        triangle.attributes = parts.attributes.len() as u32;
        let colors = Some([4, 5, 6].map(|k| Vec4::splat(at(k).abs())));
        parts.attributes.push(PartAttributes { uvs, tangents, colors });
        triangle.normals = Some([0.0, 0.1, 0.2].map(|tilt| Vec3::new(tilt, 0.1, 1.0).normalize()));
    }
    room.build()
}

/// Negative control.
#[test]
fn a_wrong_stride_is_noticed() {
    let Some(gpu) = gpu("a_wrong_stride_is_noticed") else { return };
    for change in [("index * 6u", "index * 5u"), ("(index >> 1u) * 3u", "(index >> 1u) * 2u"), ("(index & 1u) == 1u", "(index & 2u) == 2u")]
    {
        let (_, wrong) = read_back(gpu, surface_scenes::textured(), Some(change));
        assert!(wrong > 0, "{change:?}");
    }
}
