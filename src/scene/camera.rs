//! The camera: a pinhole at `position` looking along `axis`, and its film on the plane at distance 1.
//!
//! ```text
//! P_σ⊥(z₀→z₁) = [p ∈ film] / (A_film cos⁴θ)        W_e⁽ʲ⁾ = [p ∈ pixel j] / (A_px cos⁴θ)
//! ```
//! with θ the angle between the segment and the axis, p where it meets the plane at distance 1, and A_film, A_px areas on
//! that plane (m² at 1 m, i.e. pure numbers).

use crate::math::{Vec2, Vec3};

/// A camera as the file has it; its picture's width follows from the size chosen for it.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Name in the file, or one we made up.
    pub name: String,
    /// Centre of projection, m, relative to the scene's origin.
    pub position: Vec3,
    /// To the right of the picture (unit).
    pub right: Vec3,
    /// To the top of the picture (unit).
    pub up: Vec3,
    /// Viewing direction (unit).
    pub axis: Vec3,
    /// Vertical field of view, radians.
    pub yfov: f32,
}

/// A camera with a film of a given size.
#[derive(Clone, Debug)]
pub struct View {
    /// The camera's name.
    pub name: String,
    /// Centre of projection, m.
    pub position: Vec3,
    right: Vec3,
    up: Vec3,
    /// Viewing direction (unit).
    pub axis: Vec3,
    /// Film size, pixels.
    pub size: [u32; 2],
    half_extent: Vec2,
    per_pass: f32,
}

impl View {
    /// The view through `camera` on a film of `width` × `height` pixels.
    pub fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let tan_y = (0.5 * camera.yfov).tan();
        let per_pass = 1.0 / (width as f32 * height as f32);
        let half_extent = Vec2::new(tan_y * width as f32 / height as f32, tan_y);
        Self {
            name: camera.name.clone(),
            position: camera.position,
            right: camera.right,
            up: camera.up,
            axis: camera.axis,
            size: [width, height],
            half_extent,
            per_pass,
        }
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

    /// The unit direction through a raster position (pixels, y down).
    #[inline]
    pub fn direction(&self, raster: Vec2) -> Vec3 {
        let x = (2.0 * raster.x / self.size[0] as f32 - 1.0) * self.half_extent.x;
        let y = (1.0 - 2.0 * raster.y / self.size[1] as f32) * self.half_extent.y;
        (self.right * x + self.up * y + self.axis).normalize()
    }

    /// Where the direction `w` from the lens meets the film, in pixels; `None` behind the camera. It may lie outside.
    #[inline]
    pub fn project(&self, w: Vec3) -> Option<Vec2> {
        let z = w.dot(self.axis);
        if z <= 0.0 {
            return None;
        }
        let x = w.dot(self.right) / (z * self.half_extent.x);
        let y = w.dot(self.up) / (z * self.half_extent.y);
        Some(Vec2::new((x + 1.0) * 0.5 * self.size[0] as f32, (1.0 - y) * 0.5 * self.size[1] as f32))
    }

    /// The pixel of a raster position; `None` outside the film.
    #[inline]
    pub fn pixel(&self, raster: Vec2) -> Option<[u32; 2]> {
        let inside = raster.x >= 0.0 && raster.y >= 0.0 && raster.x < self.size[0] as f32 && raster.y < self.size[1] as f32;
        inside.then_some([raster.x as u32, raster.y as u32])
    }

    /// P_σ⊥(z₀→w), the density of an eye subpath's first direction over the whole film, sr⁻¹; 0 outside it.
    #[inline]
    pub fn pdf_direction_psa(&self, w: Vec3) -> f32 {
        match self.project(w).and_then(|raster| self.pixel(raster)) {
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

    /// W_e⁽ʲ⁾(z₁→z₀) of the pixel j that `w` (from the lens) meets, sr⁻¹; 0 outside the film.
    #[inline]
    pub fn w_e(&self, w: Vec3) -> f32 {
        self.pdf_direction_psa(w) * self.pixels()
    }
}
