//! Twins: the camera. Bounds as in `twins`; the very rim of the lens is a matter of rounding, and left out.

use crate::compare::{Worst, direction, random};
use crate::harness::{Work, gpu};
use crate::table::Table;
use crate::{emitters_scenes, scenes};
use bdpt_explorer::engine::Job;
use bdpt_explorer::math::Vec2;

const CAMERA: &str = "fn run_row(row: u32) {
    let u = in_2(row, 0u);
    let raster = in_2(row, 2u);
    let lens = sample_lens(u);
    out_v(row, 0u, lens);
    let w = camera_direction(raster, lens);
    out_v(row, 3u, w);
    let back = project(w, lens);
    out_2(row, 6u, back.at);
    out_f(row, 8u, pdf_direction_psa_on_film(w));
    out_f(row, 9u, w_e_1_on_film(w));
    out_u(row, 10u, u32(inside_film(back.at)));
    let crossed = cross_lens(in_v(row, 4u), in_v(row, 7u));
    out_u(row, 11u, u32(crossed.some));
    out_v(row, 12u, crossed.point);
    out_f(row, 15u, inside_cell(u32(raster.x), u.x));
}";

#[test]
fn the_camera() {
    let Some(gpu) = gpu("the_camera") else { return };
    for (scene, pinhole) in [(emitters_scenes::wide_lens(), false), (scenes::builtin("cornell"), true)] {
        let work = Work::new(Job { size: [48, 32], ..Job::new(scene) });
        let view = &work.view;
        let radius = view.lens.radius;
        let mut inputs = Vec::new();
        for i in 0..3000 {
            let [u, v, x, y] = random(8, i);
            let raster = Vec2::new(x * 48.0, y * 32.0);
            // From a point in front, to about the lens.
            let to = view.position + direction(9, i) * (radius * 1.5);
            let origin = view.position + view.axis * 2.0 + direction(10, i);
            inputs.push((Vec2::new(u, v), raster, origin, (to - origin).normalize() * if i % 9 == 0 { -1.0 } else { 1.0 }));
        }
        let table: Vec<f32> = inputs
            .iter()
            .flat_map(|(u, raster, origin, w)| [&u.to_array()[..], &raster.to_array(), &origin.to_array(), &w.to_array()].concat())
            .collect();
        let run = |change| {
            let out = Table { gpu, work: &work, change }.run(CAMERA, 10, 16, &table);
            let mut all = [
                Worst::new("sample_lens", 32.0),
                Worst::new("direction", 64.0),
                Worst::new("project", 64.0),
                Worst::new("pdf_direction_psa", 64.0),
                Worst::new("cross_lens at all", 0.0),
                // A pinhole is met by no ray at random, and its point is its place.
                Worst::new("cross_lens", 128.0),
                Worst::new("inside_cell", 0.0),
            ];
            for (row, &(u, raster, origin, w)) in out.iter().zip(&inputs) {
                let [lens, direction, project, pdf, crosses, point, cell] = &mut all;
                let at = view.sample_lens(u);
                let size = view.position.abs().max_element() + radius;
                lens.within(&row[..3], &at.to_array(), size);
                let out_w = view.direction(raster, at);
                direction.within(&row[3..6], &out_w.to_array(), 1.0);
                project.within(&row[6..8], &view.project(out_w, at).unwrap().to_array(), 48.0);
                pdf.relative(&row[8..10], &[view.pdf_direction_psa_on_film(out_w), view.w_e_1_on_film(out_w)]);
                let crossed = view.cross_lens(origin, w);
                // How far from the middle of the lens: its very rim is a matter of rounding.
                let towards = (view.position - origin).dot(view.axis) / w.dot(view.axis);
                let from_middle = (origin + w * towards - view.position).length();
                if (from_middle - radius).abs() > 1e-3 * radius {
                    crosses.exact(&[row[11].to_bits()], &[u32::from(crossed.is_some())]);
                    if let Some(crossed) = crossed {
                        point.within(&row[12..15], &crossed.to_array(), size);
                    }
                }
                let x = raster.x as u32;
                cell.relative(&row[15..], &[(x as f32 + u.x).min(((x + 1) as f32).next_down())]);
            }
            all
        };
        println!("{}", work.job.scene.name);
        run(None).iter().filter(|worst| !pinhole || !worst.is_empty()).for_each(Worst::finish);
        if !pinhole {
            for change in [
                ("sample_disk(u) * control.params.lens_radius", "sample_disk(u) * 0.69"),
                ("(1.0 - at.y) * 0.5", "(1.0 - at.y) * 0.501"),
                ("distance > 0.0)", "distance > 2.0)"),
            ] {
                assert!(run(Some(change)).iter().any(|worst| !worst.holds()), "{change:?} goes unnoticed");
            }
        }
    }
}
