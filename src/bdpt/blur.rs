//! Lights without extent, blurred a little: what an eye subpath that nothing can be connected to would see of them.
//!
//! A point light at x shines on a vertex z from one direction alone, that of x, and no eye subpath finds it. Blurred, it is a ball
//! of radius r that shines on z from a cone, as much in all; a light at infinity is one that looks as large as that ball does at R:
//!
//! ```text
//! L(ω→z) = I(x→z) V(x,z)/(d² Ω)   where sinθ < r/d,      Ω = 2π(1 − √(1 − (r/d)²)),   θ between ω and the direction of x
//! L(ω→z) = E V(z)/Ω               where sinθ < r/R       with that Ω; R the radius of the scene
//! ```
//! V is that of x itself, and the ball is in nobody's way: what is blurred is the direction alone, and as r → 0, light that comes to
//! z by way of x becomes exact wherever what reaches the eye from z does not jump with the direction.

use super::context::Context;
use super::vertex::Vertex;
use super::visibility::visibility;
use crate::math::{PI, Vec3};
use crate::scene::Shape;

/// L that arrives at `from` against `direction`, of all lights without extent, blurred to balls of each of these parts of the
/// scene's radius; W m⁻² sr⁻¹.
pub fn radiance<F: Shape, const N: usize>(context: &Context<F>, from: &Vertex, direction: Vec3, blurs: [f32; N]) -> [Vec3; N] {
    let (scene, radius) = (context.scene, context.scene.sphere.radius);
    let mut seen = [Vec3::ZERO; N];
    for (index, light) in scene.lights.list.iter().enumerate().filter(|(_, light)| light.is_dirac()) {
        let x = context.light_vertex(index as u32);
        let (w, _) = x.edge_to(from);
        let in_front = w.dot(direction) < 0.0 && from.n_g.dot(w) * from.n_g.dot(direction) < 0.0;
        // Far from it, the cone is narrow; inside the ball, it is all that lies in front.
        let away = if light.is_infinite() { radius * radius } else { (from.position - light.position).length_squared() };
        let cones = blurs.map(|blur| (blur * radius).powi(2) / away);
        let sine_squared = w.cross(direction).length_squared();
        if !in_front || cones.iter().all(|cone| sine_squared >= *cone) {
            continue;
        }
        let spread = if light.is_infinite() { 1.0 } else { away };
        let arrives = light.l_e_0() * (light.l_e_1(x.n_g, w) * visibility(context, &x, from, w) / spread);
        for (seen, cone) in seen.iter_mut().zip(cones).filter(|(_, cone)| sine_squared < *cone) {
            *seen += arrives / solid_angle(cone);
        }
    }
    seen
}

/// Ω of the cone whose sine squared is given; from 1 on, half of all directions.
fn solid_angle(sine_squared: f32) -> f32 {
    let x = sine_squared.min(1.0);
    2.0 * PI * x / (1.0 + (1.0 - x).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cones_have_their_solid_angle() {
        for degrees in [0.01f64, 1.0, 30.0, 89.0] {
            let exact = 4.0 * std::f64::consts::PI * (0.5 * degrees.to_radians()).sin().powi(2);
            let found = f64::from(solid_angle(degrees.to_radians().sin().powi(2) as f32));
            assert!((found / exact - 1.0).abs() < 1e-4, "{degrees}°: {found} instead of {exact}");
        }
        assert_eq!(solid_angle(7.0), 2.0 * PI);
    }
}
