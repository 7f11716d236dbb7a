//! Small scenes for the ladder, built from triangles; each is there for one thing.

use bdpt_explorer::math::{DVec3, Vec3};
use bdpt_explorer::scene::parts::{PartCamera, PartLight, PartTriangle, Parts};
use bdpt_explorer::scene::{Environment, Material, NONE, Scene};
use std::sync::Arc;

/// A scene under construction.
pub struct Room(Parts);

impl Room {
    pub fn new(name: &str) -> Self {
        Self(Parts { name: name.into(), ..Parts::default() })
    }

    /// What it is made of, so far.
    pub fn parts(&mut self) -> &mut Parts {
        &mut self.0
    }

    pub fn material(&mut self, material: Material) -> u32 {
        self.0.materials.push((format!("m{}", self.0.materials.len()), material));
        self.0.materials.len() as u32 - 1
    }

    pub fn emitter(&mut self, radiance: f32, albedo: f32, two_sided: bool) -> u32 {
        let material = Material::lambert(Vec3::splat(albedo));
        self.material(Material { emission: Vec3::splat(radiance), two_sided: u32::from(two_sided), ..material })
    }

    /// A parallelogram from `p` along `u` and `v`; it faces u × v.
    pub fn quad(&mut self, p: [f64; 3], u: [f64; 3], v: [f64; 3], material: u32) {
        let (p, u, v) = (DVec3::from(p), DVec3::from(u), DVec3::from(v));
        for corners in [[p, p + u, p + u + v], [p, p + u + v, p + v]] {
            self.0.triangles.push(PartTriangle { corners, normals: None, material, attributes: NONE });
        }
    }

    /// The six faces of a box, facing inwards or outwards.
    pub fn cuboid(&mut self, min: [f64; 3], max: [f64; 3], inwards: bool, materials: [u32; 6]) {
        let (a, b) = (DVec3::from(min), DVec3::from(max));
        let d = b - a;
        let (x, y, z) = ([d.x, 0.0, 0.0], [0.0, d.y, 0.0], [0.0, 0.0, d.z]);
        let corner = |i: [bool; 3]| std::array::from_fn(|c| if i[c] { b[c] } else { a[c] });
        let (low, high) = (corner([false; 3]), |axis: usize| corner(std::array::from_fn(|c| c == axis)));
        // (start, u, v) with u × v pointing outwards.
        let faces = [(low, z, y), (high(0), y, z), (low, x, z), (high(1), z, x), (low, y, x), (high(2), x, y)];
        for ((p, u, v), material) in faces.into_iter().zip(materials) {
            if inwards { self.quad(p, v, u, material) } else { self.quad(p, u, v, material) }
        }
    }

    /// A tessellated sphere; `smooth` gives it the exact sphere's normals.
    pub fn sphere(&mut self, centre: [f64; 3], radius: f64, rings: u32, smooth: bool, material: u32) {
        let centre = DVec3::from(centre);
        let at = |i: u32, j: u32| {
            let (theta, phi) = (
                f64::from(i) / f64::from(rings) * std::f64::consts::PI,
                f64::from(j % (2 * rings)) / f64::from(rings) * std::f64::consts::PI,
            );
            DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
        };
        for i in 0..rings {
            for j in 0..2 * rings {
                let (a, b, c, d) = (at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
                for normals in [[a, b, c], [a, c, d]] {
                    let corners = normals.map(|n| centre + n * radius);
                    let normals = smooth.then(|| normals.map(DVec3::as_vec3));
                    self.0.triangles.push(PartTriangle { corners, normals, material, attributes: NONE });
                }
            }
        }
    }

    pub fn camera(&mut self, position: [f64; 3], target: [f64; 3], yfov_degrees: f64) {
        let position = DVec3::from(position);
        let camera = PartCamera {
            name: "camera".into(),
            position,
            axis: DVec3::from(target) - position,
            up: DVec3::Y,
            yfov: yfov_degrees.to_radians(),
            ..PartCamera::default()
        };
        self.0.cameras.push(camera);
    }

    /// Gives the last camera a lens, focused at a distance (m).
    pub fn lens(&mut self, radius: f64, focus_distance: f64) {
        let camera = self.0.cameras.last_mut().expect("a camera first");
        (camera.lens_radius, camera.focus_distance) = (radius, Some(focus_distance));
    }

    pub fn point(&mut self, position: [f64; 3], intensity: Vec3) {
        self.0.lights.push(("point".into(), PartLight::Point { position: position.into(), intensity }));
    }

    /// A spot; the angles from its axis in degrees.
    pub fn spot(&mut self, position: [f64; 3], axis: [f64; 3], intensity: Vec3, angles: [f64; 2]) {
        let angles = angles.map(f64::to_radians);
        self.0.lights.push(("spot".into(), PartLight::Spot { position: position.into(), axis: axis.into(), intensity, angles }));
    }

    pub fn directional(&mut self, axis: [f64; 3], irradiance: Vec3) {
        self.0.lights.push(("sun".into(), PartLight::Directional { axis: axis.into(), irradiance }));
    }

    pub fn environment(&mut self, environment: Environment) {
        self.0.environment = Some(environment);
    }

    pub fn build(self) -> Arc<Scene> {
        let mut parts = self.0;
        // Degenerate polar triangles of spheres are not wanted and not noted.
        parts.triangles.retain(|t| (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).length() > 1e-12);
        Arc::new(Scene::assemble(parts).expect("a test scene assembles"))
    }

    /// Tilts the corner normals of every triangle of a material, the same way everywhere: n_s ≠ n_g by `degrees`.
    pub fn tilt_normals(&mut self, material: u32, degrees: f64) {
        for t in self.0.triangles.iter_mut().filter(|t| t.material == material) {
            let n = (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).normalize();
            let tangent = n.any_orthonormal_vector();
            let tilted = (n * degrees.to_radians().cos() + tangent * degrees.to_radians().sin()).as_vec3();
            t.normals = Some([tilted; 3]);
        }
    }
}

/// A built-in scene.
pub fn builtin(name: &str) -> Arc<Scene> {
    Arc::new(bdpt_explorer::scene::builtin::open(name).expect("a built-in scene opens"))
}

/// A closed room of one albedo whose faces all emit inwards: paths of k edges carry exactly L_e ρ^(k−1).
pub fn furnace(radiance: f32, albedo: f32) -> Arc<Scene> {
    furnace_at(radiance, albedo, 1.0, 0.0)
}

/// The furnace scaled, and then moved along all axes (m).
pub fn furnace_at(radiance: f32, albedo: f32, scale: f64, offset: f64) -> Arc<Scene> {
    let at = |p: [f64; 3]| p.map(|c| c * scale + offset);
    let mut room = Room::new("furnace");
    let m = room.emitter(radiance, albedo, false);
    room.cuboid(at([-1.0; 3]), at([1.0, 1.2, 1.4]), true, [m; 6]);
    room.camera(at([0.1, 0.2, 0.3]), at([1.0, 0.3, -0.4]), 60.0);
    room.build()
}

/// A small lamp inside a glass sphere in a white room: every path from it is refracted first.
pub fn lamp_in_glass() -> Arc<Scene> {
    let mut room = Room::new("lamp in glass");
    let white = room.material(Material::lambert(Vec3::splat(0.6)));
    let glass = room.material(Material::dielectric(Vec3::new(0.7, 1.0, 0.9), 1.5, false));
    let lamp = room.emitter(10.0, 0.2, true);
    room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
    room.sphere([0.0, 0.2, 0.0], 0.45, 24, true, glass);
    room.quad([-0.15, 0.2, -0.15], [0.3, 0.0, 0.0], [0.0, 0.0, 0.3], lamp);
    room.camera([0.0, 0.0, 0.95], [0.0, -0.1, -1.0], 70.0);
    room.build()
}

/// Camera and lamp that a mirror alone connects: only the eye path that happens to hit the lamp can make these paths.
pub fn only_a_mirror() -> Arc<Scene> {
    let mut room = Room::new("only a mirror");
    let mirror = room.material(Material::mirror(Vec3::splat(0.9)));
    let lamp = room.emitter(3.0, 0.0, false);
    room.quad([-1.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], mirror);
    room.quad([-1.0, -1.0, 2.0], [0.0, 2.0, 0.0], [2.0, 0.0, 0.0], lamp);
    room.camera([0.0, 0.0, 1.0], [0.0, 0.0, -1.0], 40.0);
    room.build()
}

/// A room without any light.
pub fn dark() -> Arc<Scene> {
    let mut room = Room::new("dark");
    let white = room.material(Material::lambert(Vec3::splat(0.8)));
    room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
    room.camera([0.0; 3], [0.0, 0.0, -1.0], 70.0);
    room.build()
}

/// Needle-thin triangles and a lamp much smaller, and one much larger, than anything else.
pub fn extremes() -> Arc<Scene> {
    let mut room = Room::new("extremes");
    let white = room.material(Material::lambert(Vec3::splat(0.7)));
    let (tiny, huge) = (room.emitter(1e8, 0.0, false), room.emitter(1e-3, 0.5, true));
    room.quad([-1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    for i in 0..50 {
        let x = f64::from(i) * 0.03 - 0.75;
        room.quad([x, 0.2, -1.0], [1e-5, 0.0, 0.0], [0.0, 0.3, 2.0], white);
    }
    room.quad([0.2, 0.9, 0.0], [1e-4, 0.0, 0.0], [0.0, 0.0, 1e-4], tiny);
    room.quad([-500.0, 50.0, -500.0], [1000.0, 0.0, 0.0], [0.0, 0.0, 1000.0], huge);
    room.camera([0.0, 0.6, 1.8], [0.0, 0.1, 0.0], 50.0);
    room.build()
}

/// Patches that do not touch each other in black space: every strategy has a finite variance, so raw means can be compared.
pub fn patches() -> Arc<Scene> {
    let mut room = Room::new("patches");
    let white = room.material(Material::lambert(Vec3::new(0.8, 0.6, 0.4)));
    let lamp = room.emitter(4.0, 0.3, false);
    room.quad([-1.0, -1.0, -1.0], [0.0, 0.0, 2.0], [2.0, 0.0, 0.0], white);
    room.quad([-1.3, -0.8, -1.0], [0.0, 1.6, 0.0], [0.0, 0.0, 2.0], white);
    room.quad([-0.8, -0.7, -1.4], [1.6, 0.0, 0.0], [0.0, 1.6, 0.0], white);
    room.quad([-0.5, 1.2, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
    room.camera([0.6, 0.1, 2.6], [-0.1, -0.1, 0.0], 55.0);
    room.build()
}

/// Glass and mirror between lamp and camera: Diracs on both sides of every connection, η ≠ 1, smooth normals.
pub fn specular() -> Arc<Scene> {
    let mut room = Room::new("specular");
    let white = room.material(Material::lambert(Vec3::new(0.7, 0.7, 0.6)));
    let glass = room.material(Material::dielectric(Vec3::new(0.9, 1.0, 0.9), 1.5, false));
    let mirror = room.material(Material::mirror(Vec3::new(0.9, 0.8, 0.7)));
    let sheet = room.material(Material::dielectric(Vec3::new(1.0, 0.9, 0.9), 1.4, true));
    let lamp = room.emitter(6.0, 0.5, false);
    room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
    room.quad([-0.4, 0.95, -0.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8], lamp);
    room.sphere([-0.4, -0.5, -0.2], 0.4, 24, true, glass);
    room.sphere([0.45, -0.6, 0.1], 0.35, 24, true, mirror);
    room.quad([0.1, 0.0, -0.6], [0.6, 0.0, 0.0], [0.0, 0.6, 0.1], sheet);
    room.camera([0.0, 0.1, 0.95], [0.0, -0.2, -1.0], 75.0);
    room.build()
}

/// Camera inside a block of glass, shading normals 25° off everywhere: an adjoint slip cannot hide.
pub fn tilted() -> Arc<Scene> {
    let mut room = Room::new("tilted");
    let white = room.material(Material::lambert(Vec3::new(0.7, 0.5, 0.6)));
    let glass = room.material(Material::dielectric(Vec3::splat(0.95), 1.5, false));
    let lamp = room.emitter(5.0, 0.4, true);
    room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
    room.tilt_normals(white, 25.0);
    room.quad([-0.5, 0.6, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], lamp);
    room.cuboid([-0.3, -0.3, 0.2], [0.3, 0.3, 0.8], false, [glass; 6]);
    room.tilt_normals(glass, 8.0);
    room.camera([0.05, 0.0, 0.6], [0.0, -0.1, -1.0], 80.0);
    room.build()
}
