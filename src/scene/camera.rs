//! The camera: a thin lens (or a pinhole) at `position` looking along `axis`, and its film on the plane at distance 1.
//!
//! ```text
//! a segment of slope m = ω_xy/ω_z through the lens point l lands at p = m + l/d          d = focus distance; pinhole: l = 0
//! P_A(z₀) = W_e⁽⁰⁾(z₀) = 1/A_lens                        (pinhole: z₀ is discrete, probability 1)
//! P_σ⊥(z₀→z₁) = [p ∈ film] / (A_film cos⁴θ)              W_e⁽¹⁾ = [p ∈ pixel j] / (A_px cos⁴θ)
//! ```
//! with θ the angle between the segment and the axis, and A_film, A_px areas on the plane at distance 1 (m² at 1 m, i.e. pure
//! numbers), *not* on the plane of focus. A lens is a disk that light walks cross; it blocks nothing.

use super::Scene;
use super::sphere::Sphere;
use crate::math::{PI, Vec2, Vec3, sample_disk};
use serde::{Deserialize, Serialize};

/// How a camera gathers light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lens {
    /// Radius of the aperture, m; 0 is a pinhole.
    pub radius: f32,
    /// Distance of the plane that is sharp, along the axis, m; may be infinite. A pinhole does not use it.
    pub focus_distance: f32,
}

/// A camera as the file has it; its picture's width follows from the size chosen for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name in the file, or one we made up.
    pub name: String,
    /// Centre of the lens, m, relative to the scene's origin.
    pub position: Vec3,
    /// To the right of the picture (unit).
    pub right: Vec3,
    /// To the top of the picture (unit).
    pub up: Vec3,
    /// Viewing direction (unit).
    pub axis: Vec3,
    /// Vertical field of view, radians.
    pub yfov: f32,
    /// Its lens.
    pub lens: Lens,
}

/// A camera with a film of a given size.
#[derive(Clone, Debug)]
pub struct View {
    /// The camera's name.
    pub name: String,
    /// Centre of the lens, m.
    pub position: Vec3,
    right: Vec3,
    up: Vec3,
    /// Viewing direction (unit).
    pub axis: Vec3,
    /// The lens.
    pub lens: Lens,
    /// Film size, pixels.
    pub size: [u32; 2],
    half_extent: Vec2,
    inverse_half_extent: Vec2,
    per_pass: f32,
    inverse_focus: f32,
    /// How far before the lens edges to it end, m: what lies in its very plane is in nobody's way.
    pub clearance: f32,
    /// The sphere around the scene and the lens.
    pub sphere: Sphere,
    /// 1/(πR²) of that sphere, m⁻²: the density, per area across it, of light that comes from infinity.
    pub pdf_disk_area: f32,
}

/// The axes of a picture, for another renderer.
#[derive(Clone, Copy, Debug)]
pub struct Axes {
    /// To the right (unit).
    pub right: Vec3,
    /// To the top (unit).
    pub up: Vec3,
    /// Half the film on the plane at distance 1.
    pub half_extent: Vec2,
    /// Its reciprocal.
    pub inverse_half_extent: Vec2,
    /// 1/focus distance, m⁻¹; 0 of a pinhole.
    pub inverse_focus: f32,
}

impl View {
    /// The view of `scene` through `camera` on a film of `width` × `height` pixels.
    pub fn new(scene: &Scene, camera: &Camera, [width, height]: [u32; 2]) -> Self {
        let tan_y = (0.5 * camera.yfov).tan();
        let half_extent = Vec2::new(tan_y * width as f32 / height as f32, tan_y);
        let lens = camera.lens;
        let sphere = match lens.radius {
            0.0 => scene.sphere,
            radius => scene.sphere.around(camera.position, radius),
        };
        Self {
            name: camera.name.clone(),
            position: camera.position,
            right: camera.right,
            up: camera.up,
            axis: camera.axis,
            lens,
            size: [width, height],
            half_extent,
            inverse_half_extent: half_extent.recip(),
            per_pass: 1.0 / (width as f32 * height as f32),
            inverse_focus: if lens.radius > 0.0 { 1.0 / lens.focus_distance } else { 0.0 },
            sphere,
            clearance: 4.0 * f32::EPSILON * (camera.position.abs().max_element() + scene.sphere.radius),
            pdf_disk_area: 1.0 / (PI * sphere.radius * sphere.radius),
        }
    }

    /// What the picture's axes are made of.
    pub fn axes(&self) -> Axes {
        let Self { right, up, half_extent, inverse_half_extent, inverse_focus, .. } = *self;
        Axes { right, up, half_extent, inverse_half_extent, inverse_focus }
    }

    /// Is the lens a disk (else a pinhole)?
    #[inline]
    pub fn has_lens(&self) -> bool {
        self.lens.radius > 0.0
    }

    /// P_A(z₀): 1/A_lens, m⁻²; of a pinhole, the probability 1.
    #[inline]
    pub fn pdf_lens_area(&self) -> f32 {
        if self.has_lens() { 1.0 / (PI * self.lens.radius * self.lens.radius) } else { 1.0 }
    }

    /// A point on the lens, with density [`View::pdf_lens_area`].
    #[inline]
    pub fn sample_lens(&self, u: Vec2) -> Vec3 {
        if !self.has_lens() {
            return self.position;
        }
        let l = sample_disk(u) * self.lens.radius;
        self.position + self.right * l.x + self.up * l.y
    }

    /// Where, on the axes of the picture, a point of the lens lies, m.
    #[inline]
    fn on_lens(&self, point: Vec3) -> Vec2 {
        let offset = point - self.position;
        Vec2::new(offset.dot(self.right), offset.dot(self.up))
    }

    /// The point where a ray that comes from in front meets the lens.
    #[inline]
    pub fn cross_lens(&self, origin: Vec3, direction: Vec3) -> Option<Vec3> {
        let towards = -direction.dot(self.axis);
        let distance = (origin - self.position).dot(self.axis) / towards;
        if !(towards > 0.0 && distance > 0.0) {
            return None;
        }
        let l = self.on_lens(origin + direction * distance);
        (l.length_squared() <= self.lens.radius * self.lens.radius).then(|| self.position + self.right * l.x + self.up * l.y)
    }

    /// l/d: how far a point of the lens shifts the picture on the plane at distance 1.
    #[inline]
    fn shift(&self, lens_point: Vec3) -> Vec2 {
        if self.has_lens() { self.on_lens(lens_point) * self.inverse_focus } else { Vec2::ZERO }
    }

    /// Number of pixels, which is also n_i: eye subpaths, and light subpaths, per pass over the full film.
    #[inline]
    pub fn pixels(&self) -> f32 {
        self.size[0] as f32 * self.size[1] as f32
    }

    /// 1/n_i, what one evaluation of a technique counts in a pass.
    #[inline]
    pub fn per_pass(&self) -> f32 {
        self.per_pass
    }

    /// A_film on the plane at distance 1.
    #[inline]
    pub fn film_area(&self) -> f32 {
        4.0 * self.half_extent.x * self.half_extent.y
    }

    /// A_px on the plane at distance 1.
    #[inline]
    pub fn pixel_area(&self) -> f32 {
        self.film_area() / self.pixels()
    }

    /// The unit direction from a point of the lens through a raster position (pixels, y down).
    #[inline]
    pub fn direction(&self, raster: Vec2, lens_point: Vec3) -> Vec3 {
        let x = (2.0 * raster.x / self.size[0] as f32 - 1.0) * self.half_extent.x;
        let y = (1.0 - 2.0 * raster.y / self.size[1] as f32) * self.half_extent.y;
        let m = Vec2::new(x, y) - self.shift(lens_point);
        (self.right * m.x + self.up * m.y + self.axis).normalize()
    }

    /// Where the direction `w` from a point of the lens meets the film, in pixels; `None` behind the camera. It may lie
    /// outside.
    #[inline]
    pub fn project(&self, w: Vec3, lens_point: Vec3) -> Option<Vec2> {
        let z = w.dot(self.axis);
        if z <= 0.0 {
            return None;
        }
        let p = Vec2::new(w.dot(self.right), w.dot(self.up)) * (1.0 / z) + self.shift(lens_point);
        let at = p * self.inverse_half_extent;
        Some(Vec2::new((at.x + 1.0) * 0.5 * self.size[0] as f32, (1.0 - at.y) * 0.5 * self.size[1] as f32))
    }

    /// The pixel of a raster position; `None` outside the film.
    #[inline]
    pub fn pixel(&self, raster: Vec2) -> Option<[u32; 2]> {
        let inside = raster.x >= 0.0 && raster.y >= 0.0 && raster.x < self.size[0] as f32 && raster.y < self.size[1] as f32;
        inside.then_some([raster.x as u32, raster.y as u32])
    }

    /// P_σ⊥(z₀→w), the density of an eye subpath's first direction over the whole film, sr⁻¹; 0 outside it.
    #[inline]
    pub fn pdf_direction_psa(&self, w: Vec3, lens_point: Vec3) -> f32 {
        match self.project(w, lens_point).and_then(|raster| self.pixel(raster)) {
            Some(_) => self.pdf_direction_psa_on_film(w),
            None => 0.0,
        }
    }

    /// [`View::pdf_direction_psa`] for a direction that is known to meet the film.
    #[inline]
    pub fn pdf_direction_psa_on_film(&self, w: Vec3) -> f32 {
        let cos = w.dot(self.axis);
        1.0 / (self.film_area() * (cos * cos) * (cos * cos))
    }

    /// W_e⁽¹⁾(z₁→z₀) of the pixel that `w` (from a point of the lens) is known to meet, sr⁻¹.
    #[inline]
    pub fn w_e_1_on_film(&self, w: Vec3) -> f32 {
        self.pdf_direction_psa_on_film(w) * self.pixels()
    }
}
