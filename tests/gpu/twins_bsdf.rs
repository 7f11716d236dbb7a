//! Twins: how surfaces scatter, every kind of material in both modes, with one normal and with two.
//!
//! The microfacets' D(h) depends on the half vector's distance from the normal in units of α, and divides by cosines: what
//! rounding does to it grows with 1/α and with 1/cos, and so do the bounds.

use crate::compare::{Worst, direction, random};
use crate::harness::{Work, gpu};
use crate::scenes;
use crate::table::{Table, bits};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::{Vec2, Vec3};
use bdpt_explorer::scene::TransportMode::{Importance, Radiance};
use bdpt_explorer::scene::{Bsdf, BsdfSample, COAT, CONDUCTOR, Look, Material, TransportMode};

const BSDF: &str = "fn run_row(row: u32) {
    var material = load_material(0u);
    material.kind = in_u(row, 0u);
    material.ior = in_f(row, 1u);
    material.f0 = in_v(row, 2u);
    material.f90 = in_f(row, 5u);
    let look = Look(in_v(row, 6u), in_f(row, 9u), in_f(row, 10u), 1.0, vec2<f32>(0.0));
    let bsdf = bsdf_at(in_v(row, 11u), in_v(row, 14u), look, material);
    let w_in = in_v(row, 17u);
    let mode = in_u(row, 23u);
    let e = bsdf_evaluate(bsdf, w_in, in_v(row, 20u), mode);
    out_v(row, 0u, e.f);
    out_f(row, 3u, e.forward);
    out_f(row, 4u, e.reverse);
    let s = bsdf_sample(bsdf, w_in, mode, in_f(row, 24u), in_2(row, 25u));
    out_u(row, 5u, u32(s.some));
    out_u(row, 6u, u32(s.delta));
    out_v(row, 7u, s.w);
    out_v(row, 10u, s.f);
    out_f(row, 13u, s.pdf_fwd_psa);
    out_f(row, 14u, s.pdf_rev_psa);
}";

/// A bend at a surface.
struct Bend {
    material: Material,
    look: Look,
    normals: [Vec3; 2],
    w_in: Vec3,
    w_out: Vec3,
    mode: TransportMode,
    u: [f32; 3],
}

impl Bend {
    fn new(i: usize) -> Self {
        let ([r, g, b, roughness], [metallic, ior, tilt, _]) = (random(1, i), random(2, i));
        let color = Vec3::new(r, g, b);
        let ior = 1.1 + ior;
        let material = match i % 6 {
            0 => Material::lambert(color),
            1 => Material::mirror(color),
            2 => Material::dielectric(color, ior, false),
            3 => Material::dielectric(color, ior, true),
            4 => Material::conductor(color, roughness),
            _ => Material::coat(color, roughness, if i % 12 < 6 { 0.0 } else { metallic }, ior),
        };
        let n_g = direction(3, i);
        let n_s = if (i / 6).is_multiple_of(2) { n_g } else { (n_g + direction(4, i) * (tilt * 0.7)).normalize() };
        let w_in = direction(5, i);
        let mut w_out = direction(6, i);
        if !i.is_multiple_of(3) {
            // Near the mirrored direction, where microfacets have their peak.
            w_out = (n_s * (2.0 * n_s.dot(w_in)) - w_in + w_out * (roughness * roughness)).normalize();
        }
        let [u, v, component, mode] = random(7, i);
        let mode = if mode < 0.5 { Radiance } else { Importance };
        Self { material, look: Look::of(&material), normals: [n_g, n_s], w_in, w_out, mode, u: [component, u, v] }
    }

    fn row(&self) -> Vec<f32> {
        let (m, l) = (&self.material, &self.look);
        let mut row = vec![bits(m.kind), m.ior];
        row.extend(m.f0.to_array());
        row.push(m.f90);
        row.extend(l.color.to_array());
        row.extend([l.roughness, l.metallic]);
        for v in [self.normals[0], self.normals[1], self.w_in, self.w_out] {
            row.extend(v.to_array());
        }
        row.push(bits(if self.mode == Radiance { 0 } else { 1 }));
        row.extend(self.u);
        row
    }

    fn bsdf(&self) -> Bsdf<'_> {
        Bsdf::new(self.normals[0], self.normals[1], &self.material, &self.look)
    }

    fn sample(&self, change: [f32; 3]) -> Option<BsdfSample> {
        let u: [f32; 3] = std::array::from_fn(|k| (self.u[k] + change[k]).clamp(0.0, 1.0f32.next_down()));
        self.bsdf().sample(self.w_in, self.mode, u[0], Vec2::new(u[1], u[2]))
    }

    /// Does a small change of a number lead to another decision?
    fn is_marginal(&self) -> bool {
        let own = self.sample([0.0; 3]);
        (0..6).any(|k| {
            let mut change = [0.0; 3];
            change[k / 2] = if k % 2 == 0 { 1e-5 } else { -1e-5 };
            match (&own, self.sample(change)) {
                (Some(a), Some(b)) => a.delta != b.delta || (a.w - b.w).length() > 0.1,
                (None, None) => false,
                _ => true,
            }
        })
    }

    /// By how much rounding grows: 1/α of microfacets, 1/cos of every bend.
    fn growth(&self, w_out: Vec3) -> f32 {
        let cos = |w: Vec3| self.normals.iter().map(|n| n.dot(w).abs()).fold(f32::MAX, f32::min);
        let glossy = matches!(self.material.kind, CONDUCTOR | COAT);
        (if glossy { 1.0 / Material::alpha(self.look.roughness) } else { 1.0 }) + 1.0 / cos(self.w_in).min(cos(w_out))
    }
}

#[test]
fn surfaces_scatter_alike() {
    let Some(gpu) = gpu("surfaces_scatter_alike") else { return };
    let work = Work::new(Job::new(scenes::patches()));
    let bends: Vec<Bend> = (0..18_000).map(Bend::new).collect();
    let table: Vec<f32> = bends.iter().flat_map(Bend::row).collect();
    let run = |change| {
        let out = Table { gpu, work: &work, change }.run(BSDF, 27, 15, &table);
        let mut all = [
            Worst::new("eval, over 1/α + 1/cos", 32.0),
            Worst::new("pdf_psa both ways, over 1/α + 1/cos", 32.0),
            Worst::new("sample: at all, delta", 0.0),
            // √(1 − r²) and √cos²θₜ lose half of the digits at worst: √(8 ε).
            Worst::new("sample: w", 8192.0),
            Worst::new("sample: f and densities, over 1/α + 1/cos", 256.0),
        ];
        let (mut marginal, mut kinds) = (0, [0; 6]);
        for (row, bend) in out.iter().zip(&bends) {
            let (w_l, w_e) = bend.mode.light_eye(bend.w_in, bend.w_out);
            let bsdf = bend.bsdf();
            let growth = bend.growth(bend.w_out);
            let expected = bsdf.eval(w_l, w_e).to_array();
            let densities = [bsdf.pdf_psa(bend.w_in, bend.w_out, bend.mode), bsdf.pdf_psa(bend.w_out, bend.w_in, bend.mode.reversed())];
            let [eval, pdf, decision, direction, rest] = &mut all;
            let largest = |list: &[f32]| list.iter().fold(1e-20f32, |most, x| most.max(x.abs()));
            // Not closer to the tangent plane than rounding can tell.
            if growth < 1e5 {
                eval.within(&row[..3], &expected, largest(&expected) * growth);
                pdf.within(&row[3..5], &densities, largest(&densities) * growth);
            }
            if bend.is_marginal() {
                marginal += 1;
                continue;
            }
            let own = bend.sample([0.0; 3]);
            decision.exact(&[row[5].to_bits(), row[6].to_bits()], &[u32::from(own.is_some()), u32::from(own.is_some_and(|s| s.delta))]);
            if let Some(own) = own {
                kinds[bend.material.kind as usize] += 1;
                direction.within(&row[7..10], &own.w.to_array(), 1.0);
                let expected = [own.f.to_array().to_vec(), vec![own.pdf_fwd_psa, own.pdf_rev_psa]].concat();
                let growth = bend.growth(own.w);
                if growth < 1e4 {
                    rest.within(&row[10..15], &expected, largest(&expected) * growth);
                }
            }
        }
        if change.is_none() {
            println!("{kinds:?} samples of the kinds, {marginal} left out as too near to another decision");
        }
        assert!(marginal < bends.len() / 50 && kinds.iter().all(|&n| n > 700), "{marginal} {kinds:?}");
        all
    };
    run(None).iter().for_each(Worst::finish);
    for change in [
        ("MIN_SHARE: f32 = 0.1", "MIN_SHARE: f32 = 0.2"),
        ("2.0 * f / (1.0 + f)", "2.0 * f / (1.001 + f)"),
        ("select(1.0 / ray.eta, ray.eta, mode == IMPORTANCE)", "select(ray.eta, 1.0 / ray.eta, mode == IMPORTANCE)"),
        ("d / (cos_in + smith_in)", "d / (cos_in + smith_out)"),
    ] {
        assert!(run(Some(change)).iter().any(|worst| !worst.holds()), "{change:?} goes unnoticed");
    }
}
