//! Small scenes of glossy, textured and half-transparent surfaces; each is there for one thing.

use crate::scenes::Room;
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::material::{TRANSPARENT, UNLIT};
use bdpt_explorer::scene::parts::PartAttributes;
use bdpt_explorer::scene::texture::{Image, TextureUse, Wrap};
use bdpt_explorer::scene::{Material, NONE, Scene};
use glam::Vec4;
use std::sync::Arc;

/// A material that is there with probability `opacity`.
pub fn veil(material: Material, opacity: f32) -> Material {
    Material { opacity, flags: TRANSPARENT, ..material }
}

impl Room {
    /// An image of `size` × `size` texels as a texture.
    pub fn texture(&mut self, size: u32, srgb: bool, texel: impl Fn(u32, u32) -> [u8; 4]) -> u32 {
        let parts = self.parts();
        let texels = (0..size * size).map(|i| u32::from_le_bytes(texel(i % size, i / size))).collect();
        parts.images.push(Image { size: [size; 2], texels });
        let image = parts.images.len() as u32 - 1;
        parts.textures.push(TextureUse { wrap: [Wrap::Repeat, Wrap::Mirror], ..TextureUse::of(image, srgb) });
        parts.textures.len() as u32 - 1
    }

    /// Gives every triangle so far that has none texture coordinates, as if it were half of a quad, `repeat` images wide.
    pub fn unwrap_uvs(&mut self, repeat: f32) {
        let parts = self.parts();
        for (i, triangle) in parts.triangles.iter_mut().enumerate().filter(|(_, triangle)| triangle.attributes == NONE) {
            let uv = if i % 2 == 0 { [Vec2::ZERO, Vec2::X, Vec2::ONE] } else { [Vec2::ZERO, Vec2::ONE, Vec2::Y] };
            let uv = uv.map(|uv| uv * repeat);
            triangle.attributes = parts.attributes.len() as u32;
            parts.attributes.push(PartAttributes { uvs: [Some(uv), None], ..PartAttributes::default() });
        }
    }

    /// A quad whose texture coordinates run from 0 to `repeat`, with colours at its corners.
    pub fn textured_quad(&mut self, p: [f64; 3], u: [f64; 3], v: [f64; 3], material: u32, (repeat, colors): (f32, [Vec4; 4])) {
        self.quad(p, u, v, material);
        let uv = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].map(|uv| uv * repeat);
        let parts = self.parts();
        let count = parts.triangles.len();
        for (triangle, corners) in parts.triangles[count - 2..].iter_mut().zip([[0, 1, 2], [0, 2, 3]]) {
            triangle.attributes = parts.attributes.len() as u32;
            let attributes =
                PartAttributes { uvs: [Some(corners.map(|i| uv[i])), None], tangents: None, colors: Some(corners.map(|i| colors[i])) };
            parts.attributes.push(attributes);
        }
    }
}

/// Patches that do not touch, of rough metal, of coats and of mixtures, under a lamp: every strategy has a finite variance.
pub fn glossy() -> Arc<Scene> {
    glossy_with("glossy", 0.0, false)
}

/// The same with normals that lean by 20°, seen through a wide lens: an adjoint slip cannot hide.
pub fn glossy_tilted() -> Arc<Scene> {
    glossy_with("glossy, tilted", 20.0, true)
}

fn glossy_with(name: &str, tilt: f64, lens: bool) -> Arc<Scene> {
    let mut room = Room::new(name);
    let gold = room.material(Material::conductor(Vec3::new(0.95, 0.7, 0.35), 0.5));
    let paint = room.material(Material::coat(Vec3::new(0.3, 0.5, 0.8), 0.4, 0.0, 1.5));
    let alloy = room.material(Material::coat(Vec3::new(0.8, 0.6, 0.5), 0.7, 0.5, 1.8));
    let lamp = room.material(Material { emission: Vec3::splat(4.0), two_sided: 1, ..Material::coat(Vec3::splat(0.4), 0.6, 0.2, 1.5) });
    room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], paint);
    room.quad([-1.3, -0.8, -1.0], [0.0, 1.6, 0.0], [0.0, 0.0, 2.0], gold);
    room.quad([-0.8, -0.7, -1.4], [1.6, 0.0, 0.0], [0.0, 1.6, 0.0], alloy);
    room.quad([-0.5, 1.2, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
    if tilt > 0.0 {
        for material in [gold, paint, alloy] {
            room.tilt_normals(material, tilt);
        }
    }
    room.camera([0.6, 0.1, 2.6], [-0.1, -0.1, 0.0], 55.0);
    if lens {
        room.lens(0.6, 1.7);
    }
    room.build()
}

/// A closed room of coats with a rough-metal ball of smooth normals and a glass ball, so that η ≠ 1 and n_s ≠ n_g meet GGX.
pub fn glossy_room() -> Arc<Scene> {
    let mut room = Room::new("glossy room");
    let wall = room.material(Material::coat(Vec3::new(0.6, 0.6, 0.5), 0.5, 0.0, 1.5));
    let metal = room.material(Material::conductor(Vec3::new(0.9, 0.8, 0.7), 0.35));
    let glass = room.material(Material::dielectric(Vec3::new(0.9, 1.0, 0.9), 1.5, false));
    let lamp = room.emitter(6.0, 0.5, false);
    room.cuboid([-1.0; 3], [1.0; 3], true, [wall; 6]);
    room.quad([-0.4, 0.95, -0.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8], lamp);
    room.sphere([-0.4, -0.5, -0.2], 0.4, 16, true, metal);
    room.sphere([0.45, -0.6, 0.1], 0.35, 16, true, glass);
    room.camera([0.0, 0.1, 0.95], [0.0, -0.2, -1.0], 75.0);
    room.build()
}

/// Everything a texture can vary, on patches that do not touch: colour, roughness and metallic share, normal, emission, alpha,
/// and colours at the corners.
pub fn textured() -> Arc<Scene> {
    let mut room = Room::new("textured");
    let noise = |x: u32, y: u32, k: u32| (x.wrapping_mul(374_761_393) ^ y.wrapping_mul(668_265_263) ^ k.wrapping_mul(2_246_822_519)) >> 7;
    let byte = move |x, y, k, low: u32| (low + noise(x, y, k) % (256 - low)) as u8;
    let color = room.texture(8, true, |x, y| [byte(x, y, 1, 90), byte(x, y, 2, 90), byte(x, y, 3, 90), byte(x, y, 4, 60)]);
    let rough = room.texture(4, false, |x, y| [0, byte(x, y, 5, 140), byte(x, y, 6, 0), 255]);
    let bumps = room.texture(8, false, |x, y| [96 + (noise(x, y, 7) % 64) as u8, 96 + (noise(x, y, 8) % 64) as u8, 230, 255]);
    let glow = room.texture(4, true, |x, y| if (x + y) % 2 == 0 { [0, 0, 0, 255] } else { [byte(x, y, 9, 120), 200, 160, 255] });
    let base = Material::coat(Vec3::new(0.9, 0.8, 0.7), 0.8, 0.6, 1.5);
    let all = Material { base_color_texture: color, metallic_roughness_texture: rough, normal_texture: bumps, ..base }.finished();
    let all = room.material(all);
    let bumpy = Material { base_color_texture: color, normal_texture: bumps, normal_scale: 0.7, ..Material::lambert(Vec3::splat(0.9)) };
    let bumpy = room.material(bumpy.finished());
    let leaf = Material { base_color_texture: color, opacity: 0.9, flags: TRANSPARENT, ..Material::lambert(Vec3::splat(0.8)) };
    let leaf = room.material(leaf.finished());
    let lamp = Material { emission: Vec3::new(6.0, 5.0, 4.0), emissive_texture: glow, two_sided: 1, ..Material::lambert(Vec3::splat(0.3)) };
    let lamp = room.material(lamp.finished());
    let tint = |i: u32| Vec4::new(1.0, 0.5 + 0.1 * i as f32, 0.9 - 0.1 * i as f32, 1.0 - 0.1 * i as f32);
    let corners = (2.0, [0, 1, 2, 3].map(tint));
    room.textured_quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], all, corners);
    room.textured_quad([-1.3, -0.8, -1.0], [0.0, 1.6, 0.0], [0.0, 0.0, 2.0], bumpy, corners);
    room.textured_quad([-0.8, -0.7, -1.4], [1.6, 0.0, 0.0], [0.0, 1.6, 0.0], all, corners);
    room.textured_quad([-0.9, 0.2, -0.9], [0.0, 0.2, 1.6], [1.7, 0.0, 0.0], leaf, corners);
    room.textured_quad([-0.5, 1.2, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp, (1.5, [Vec4::ONE; 4]));
    room.camera([0.6, 0.1, 2.6], [-0.1, -0.1, 0.0], 55.0);
    room.build()
}

/// Half-transparent sheets everywhere: before the camera, before the lamp, around a patch, and the lamp itself; a sheet of glass,
/// a mirror and a lens among them if wanted.
pub fn veils(lens: bool) -> Arc<Scene> {
    let mut room = Room::new(if lens { "veils, lens" } else { "veils" });
    let white = room.material(veil(Material::lambert(Vec3::new(0.8, 0.6, 0.4)), 0.85));
    let sheet = room.material(veil(Material::lambert(Vec3::splat(0.7)), 0.5));
    let film = room.material(veil(Material::coat(Vec3::splat(0.5), 0.6, 0.3, 1.5), 0.3));
    let lamp = room.material(Material { emission: Vec3::splat(5.0), two_sided: 1, ..veil(Material::lambert(Vec3::splat(0.3)), 0.6) });
    room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    room.quad([-1.3, -0.8, -1.0], [0.0, 1.6, 0.0], [0.0, 0.0, 2.0], white);
    room.quad([-0.8, -0.7, -1.4], [1.6, 0.0, 0.0], [0.0, 1.6, 0.0], white);
    room.quad([-0.9, 0.0, -0.8], [0.0, 0.1, 1.6], [1.8, 0.0, 0.0], sheet);
    room.quad([-0.9, 0.4, -0.8], [0.0, 0.1, 1.6], [1.8, 0.0, 0.0], film);
    room.quad([-1.2, -0.9, 1.0], [1.9, 0.0, 0.0], [0.0, 1.5, 0.2], sheet);
    room.quad([-0.5, 1.2, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
    room.camera([0.6, 0.1, 2.6], [-0.1, -0.1, 0.0], 55.0);
    if lens {
        room.lens(0.9, 1.7);
    }
    room.build()
}

/// Veils under a sky and a sun, one of them a mirror and one of glass: V towards infinity, and Diracs that are only partly there.
pub fn veils_under_the_sky() -> Arc<Scene> {
    let mut room = Room::new("veils under the sky");
    let white = room.material(Material::lambert(Vec3::splat(0.7)));
    let sheet = room.material(veil(Material::lambert(Vec3::splat(0.6)), 0.5));
    let mirror = room.material(veil(Material::mirror(Vec3::splat(0.9)), 0.6));
    let pane = room.material(veil(Material::dielectric(Vec3::splat(0.95), 1.5, true), 0.7));
    room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    room.quad([-1.3, -0.8, -1.0], [0.0, 1.6, 0.0], [0.0, 0.0, 2.0], sheet);
    room.quad([-0.8, -0.7, -1.4], [1.6, 0.0, 0.0], [0.0, 1.6, 0.0], mirror);
    room.quad([-0.9, 0.4, -0.8], [0.0, 0.1, 1.6], [1.8, 0.0, 0.0], sheet);
    room.quad([-0.2, -0.6, 0.2], [0.9, 0.0, 0.3], [0.0, 0.9, 0.1], pane);
    room.environment(crate::emitters_scenes::sky_map(0.0));
    room.directional([0.2, -1.0, -0.4], Vec3::splat(0.8));
    room.point([0.6, 0.8, 0.6], Vec3::splat(0.5));
    room.camera([0.6, 0.1, 2.6], [-0.1, -0.1, 0.0], 55.0);
    room.lens(0.4, 2.0);
    room.build()
}

/// The closed furnace with glowing half-transparent sheets in it: whatever a ray meets glows and reflects alike, so paths of k
/// edges still carry exactly L_e ρ^(k−1).
pub fn furnace_with_veils(radiance: f32, albedo: f32, lens: bool) -> Arc<Scene> {
    let mut room = Room::new("furnace with veils");
    let wall = room.emitter(radiance, albedo, false);
    let glow = Material { emission: Vec3::splat(radiance), two_sided: 1, ..Material::lambert(Vec3::splat(albedo)) };
    let sheets = [0.2, 0.5, 0.8].map(|a| room.material(veil(glow, a)));
    room.cuboid([-1.0; 3], [1.0, 1.2, 1.4], true, [wall; 6]);
    room.quad([-0.8, -0.7, -0.5], [1.6, 0.0, 0.1], [0.0, 1.5, 0.2], sheets[0]);
    room.quad([-0.7, -0.6, -0.8], [0.0, 0.1, 1.9], [1.5, 0.0, 0.0], sheets[1]);
    room.quad([0.5, -0.8, -0.7], [0.0, 1.6, 0.0], [0.1, 0.0, 1.8], sheets[2]);
    room.camera([0.1, 0.2, 0.3], [1.0, 0.3, -0.4], 70.0);
    if lens {
        room.lens(0.5, 0.8);
    }
    room.build()
}

/// A floor under a spot or a lamp, and `count` black sheets of alpha `opacity` between them and before the camera.
pub fn stack(count: u32, opacity: f32, lamp: bool) -> Arc<Scene> {
    let mut room = Room::new("stack");
    let floor = room.material(Material::lambert(Vec3::splat(0.5)));
    let sheet = room.material(veil(Material::lambert(Vec3::ZERO), opacity));
    room.quad([-1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], floor);
    for i in 0..count {
        let y = 0.5 + 0.05 * f64::from(i);
        room.quad([-4.0, y, -4.0], [0.0, 0.0, 8.0], [8.0, 0.0, 0.0], sheet);
    }
    if lamp {
        let lamp = room.emitter(3.0, 0.0, false);
        room.quad([-0.3, 1.0, -0.3], [0.6, 0.0, 0.0], [0.0, 0.0, 0.6], lamp);
    } else {
        room.spot([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], Vec3::splat(3.0), [35.0, 40.0]);
    }
    room.camera([0.0, 0.45, 0.6], [0.0, 0.0, 0.0], 60.0);
    room.build()
}

/// A lamp looked at through `count` black sheets of alpha `opacity`.
pub fn lamp_behind(count: u32, opacity: f32) -> Arc<Scene> {
    let mut room = Room::new("lamp behind sheets");
    let sheet = room.material(veil(Material::lambert(Vec3::ZERO), opacity));
    let lamp = room.emitter(3.0, 0.0, false);
    for i in 0..count {
        room.quad([-2.0, -2.0, 0.1 * f64::from(i)], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], sheet);
    }
    room.quad([-2.0, -2.0, -0.3], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], lamp);
    room.camera([0.0, 0.0, 0.9], [0.0, 0.0, 0.0], 60.0);
    room.lens(0.8, 1.5);
    room.build()
}

/// A lamp with holes and a dark texture on it, a sign that shows its colours unlit, a fence, under a wide lens: alpha that is 0 or
/// 1, texels without interpolation, emission that is nothing in places.
pub fn holes() -> Arc<Scene> {
    let mut room = Room::new("holes");
    let holes = room.texture(4, true, |x, y| [200, 160, 120, if (x + y) % 2 == 0 { 255 } else { 20 }]);
    let glow = room.texture(2, true, |x, y| if x == y { [255, 200, 120, 255] } else { [0, 0, 0, 255] });
    room.parts().textures.iter_mut().for_each(|texture| texture.nearest = true);
    let masked = |material: Material| Material { base_color_texture: holes, cutoff: 0.5, flags: TRANSPARENT, ..material }.finished();
    let white = room.material(Material::lambert(Vec3::new(0.8, 0.6, 0.4)));
    let fence = room.material(masked(Material::coat(Vec3::splat(0.7), 0.5, 0.2, 1.5)));
    let lamp = Material { emission: Vec3::splat(6.0), emissive_texture: glow, ..Material::lambert(Vec3::splat(0.3)) };
    let lamp = room.material(masked(lamp));
    let sign =
        Material { emission: Vec3::splat(0.8), emissive_texture: holes, two_sided: 1, flags: UNLIT, ..Material::lambert(Vec3::ZERO) };
    let sign = room.material(sign);
    room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    room.quad([-1.3, -0.8, -1.0], [0.0, 1.6, 0.0], [0.0, 0.0, 2.0], white);
    let tint = |i: u32| Vec4::new(1.0, 1.0 - 0.1 * i as f32, 0.8, 1.0);
    let corners = (1.5, [0, 1, 2, 3].map(tint));
    room.textured_quad([-0.9, 0.1, -0.9], [0.0, 0.2, 1.6], [1.7, 0.0, 0.0], fence, corners);
    room.textured_quad([-0.8, -0.7, -1.4], [1.6, 0.0, 0.0], [0.0, 1.2, 0.0], sign, corners);
    room.textured_quad([-0.5, 1.2, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp, corners);
    room.camera([0.6, 0.1, 2.6], [-0.1, -0.1, 0.0], 55.0);
    room.lens(0.8, 1.7);
    room.build()
}

/// All of them.
pub fn all() -> Vec<Arc<Scene>> {
    vec![
        glossy(),
        glossy_tilted(),
        glossy_room(),
        textured(),
        veils(false),
        veils(true),
        veils_under_the_sky(),
        holes(),
        furnace_with_veils(1.0, 0.6, true),
    ]
}
