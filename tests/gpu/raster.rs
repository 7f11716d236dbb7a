//! The surfaces of the 3-D view: what is in front hides what is behind, what faces away is left out, and WebGL2 can do it all.

use crate::harness::gpu;
use crate::scenes::Room;
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::gpu::raster::{Raster, SHADER, Shot};
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::{Material, Scene};
use naga::back::glsl;
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::sync::Arc;
use std::time::Duration;

const SIZE: [u32; 2] = [64, 64];
const GROUND: [f32; 3] = [0.0, 0.0, 1.0];

/// A red wall before a green one, both facing +z; `swapped`, the other way round.
fn walls(swapped: bool) -> Arc<Scene> {
    let mut room = Room::new("walls");
    let red = room.material(Material::lambert(Vec3::X));
    let green = room.material(Material::lambert(Vec3::Y));
    let (front, back) = if swapped { (green, red) } else { (red, green) };
    // The far one last and first in turn: the order of drawing must not matter.
    room.quad([-1.0, -1.0, 0.5], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], front);
    room.quad([-1.0, -1.0, -0.5], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], back);
    room.point([0.0, 0.0, 3.0], Vec3::ONE);
    room.camera([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], 40.0);
    room.build()
}

/// The pixel in the middle, seen from `z` towards the origin.
fn middle(gpu: &Gpu, scene: &Arc<Scene>, z: f32, cull: bool) -> [u8; 4] {
    let mut raster = Raster::new(&gpu.device, &gpu.queue);
    while !raster.load(scene, Duration::ZERO) {}
    let shot = Shot {
        position: Vec3::new(0.0, 0.0, z),
        axes: [Vec3::X * z.signum(), Vec3::Y, -Vec3::Z * z.signum()],
        half_extent: Vec2::splat(0.3),
        near: 1e-3,
        cull,
        size: SIZE,
        ground: GROUND,
    };
    assert!(raster.draw(&shot) && !raster.draw(&shot), "an unchanged view is not drawn again");
    let pixels = read_back(gpu, raster.texture().unwrap());
    pixels[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize]
}

fn read_back(gpu: &Gpu, texture: &wgpu::Texture) -> Vec<[u8; 4]> {
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(SIZE[0] * SIZE[1] * 4),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(SIZE[0] * 4), rows_per_image: None };
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
    );
    gpu.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.unwrap());
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = buffer.slice(..).get_mapped_range().unwrap();
    bytemuck::cast_slice(&bytes).to_vec()
}

fn is(color: [u8; 4], channel: usize) -> bool {
    (0..3).all(|other| other == channel || u16::from(color[other]) + 40 < u16::from(color[channel])) && color[3] == 255
}

#[test]
fn a_wall_in_front_hides_the_wall_behind() {
    let Some(gpu) = gpu("a_wall_in_front_hides_the_wall_behind") else { return };
    for (swapped, front, back) in [(false, 0, 1), (true, 1, 0)] {
        let scene = walls(swapped);
        let seen = middle(gpu, &scene, 3.0, true);
        assert!(is(seen, front), "{seen:?}");
        // The control: from the other side the other one is in front.
        let seen = middle(gpu, &scene, -3.0, false);
        assert!(is(seen, back), "{seen:?}");
    }
}

#[test]
fn what_faces_away_is_left_out() {
    let Some(gpu) = gpu("what_faces_away_is_left_out") else { return };
    assert!(is(middle(gpu, &walls(false), -3.0, true), 2), "the ground");
    // Into a closed box, through its near wall.
    let mut room = Room::new("box");
    let red = room.material(Material::lambert(Vec3::X));
    let green = room.material(Material::lambert(Vec3::Y));
    room.cuboid([-1.0; 3], [1.0; 3], true, [red, red, red, red, green, red]);
    room.point([0.0, 0.0, 0.0], Vec3::ONE);
    room.camera([0.0, 0.0, 0.5], [0.0, 0.0, 0.0], 40.0);
    let scene = room.build();
    assert!(is(middle(gpu, &scene, 4.0, true), 1), "the far wall");
    assert!(is(middle(gpu, &scene, 4.0, false), 0), "with nothing left out, the near one");
}

#[test]
fn another_scene_takes_the_place_of_the_old_one() {
    let Some(gpu) = gpu("another_scene_takes_the_place_of_the_old_one") else { return };
    let mut raster = Raster::new(&gpu.device, &gpu.queue);
    let (old, new) = (walls(false), walls(true));
    assert!(raster.load(&old, Duration::from_secs(1)) && raster.load(&new, Duration::from_secs(1)) && raster.load(&new, Duration::ZERO));
    assert!(!raster.refuses(&old) && !raster.refuses(&new));
    gpu.check().unwrap();
}

/// The shader compiles to the language of WebGL2, and needs nothing that WebGL2 lacks.
#[test]
fn webgl2_can_draw_the_surfaces() {
    let module = naga::front::wgsl::parse_str(SHADER).unwrap_or_else(|error| panic!("{}", error.emit_to_string(SHADER)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
    let storage = |space: naga::AddressSpace| matches!(space, naga::AddressSpace::Storage { .. });
    assert!(module.global_variables.iter().all(|(_, variable)| !storage(variable.space)));
    let options = glsl::Options { version: glsl::Version::Embedded { version: 300, is_webgl: true }, ..glsl::Options::default() };
    for (shader_stage, name) in [(naga::ShaderStage::Vertex, "corner"), (naga::ShaderStage::Fragment, "shade")] {
        let pipeline = glsl::PipelineOptions { shader_stage, entry_point: name.into(), multiview: None };
        let mut text = String::new();
        let mut writer = glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, BoundsCheckPolicies::default()).unwrap();
        writer.write().unwrap();
        assert!(text.starts_with("#version 300 es"), "{text}");
    }
    // The control: a storage buffer has no place there.
    let wrong = SHADER.replace("var<uniform>", "var<storage, read>");
    let module = naga::front::wgsl::parse_str(&wrong).unwrap();
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
    let pipeline = glsl::PipelineOptions { shader_stage: naga::ShaderStage::Vertex, entry_point: "corner".into(), multiview: None };
    let mut text = String::new();
    let written =
        glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, BoundsCheckPolicies::default()).and_then(|mut x| x.write());
    assert!(written.is_err());
}

/// A device with no more than WebGL2's limits makes and draws it.
#[test]
fn a_device_with_webgl2_s_limits_draws_it() {
    let Some(gpu) = gpu("a_device_with_webgl2_s_limits_draws_it") else { return };
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::PRIMARY;
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).unwrap();
    let required_limits = wgpu::Limits::downlevel_webgl2_defaults();
    let asked = wgpu::DeviceDescriptor { required_limits, ..wgpu::DeviceDescriptor::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&asked)).unwrap();
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let mut raster = Raster::new(&device, &queue);
    let scene = walls(false);
    while !raster.load(&scene, Duration::ZERO) {}
    let axes = [Vec3::X, Vec3::Y, -Vec3::Z];
    let position = Vec3::new(0.0, 0.0, 3.0);
    raster.draw(&Shot { position, axes, half_extent: Vec2::ONE, near: 1e-3, cull: true, size: SIZE, ground: GROUND });
    assert!(pollster::block_on(scope.pop()).is_none());
    gpu.check().unwrap();
}

/// A measurement: a scene of a million triangles on its way to the device, and a picture of it.
/// `cargo test --test gpu -- --ignored --nocapture a_million_triangles`
#[test]
#[ignore = "a measurement"]
fn a_million_triangles() {
    let Some(gpu) = gpu("a_million_triangles") else { return };
    let mut room = Room::new("many");
    let white = room.material(Material::lambert(Vec3::splat(0.8)));
    for i in 0..4 {
        room.sphere([f64::from(i % 2) - 0.5, f64::from(i / 2) - 0.5, 0.0], 0.45, 256, true, white);
    }
    room.point([0.0, 0.0, 3.0], Vec3::ONE);
    room.camera([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], 40.0);
    let scene = room.build();
    let mut raster = Raster::new(&gpu.device, &gpu.queue);
    let (mut passes, mut longest, began) = (0, Duration::ZERO, std::time::Instant::now());
    loop {
        let pass = std::time::Instant::now();
        let done = raster.load(&scene, Duration::from_millis(4));
        (passes, longest) = (passes + 1, longest.max(pass.elapsed()));
        if done {
            break;
        }
    }
    println!("{} triangles: {passes} passes, the longest {longest:?}, {:?} in all", scene.triangles.len(), began.elapsed());
    let axes = [Vec3::X, Vec3::Y, -Vec3::Z];
    for x in [0.0, 0.01, 0.02] {
        let (position, began) = (Vec3::new(x, 0.0, 3.0), std::time::Instant::now());
        raster.draw(&Shot { position, axes, half_extent: Vec2::splat(0.4), near: 1e-3, cull: true, size: [640, 480], ground: GROUND });
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        println!("a picture: {:?}", began.elapsed());
    }
    gpu.check().unwrap();
}
