//! Meshes as they come: slivers, triangles without area, walls that lie twice in one place, mirrored transforms, closed glass.

use crate::glb::{Glb, Shape, emitter, lambert};
use crate::lab::{LEVEL, NONE, compare, each_sample, job, over_seeds, rendered};
use crate::scenes::{self, Room};
use crate::stats::{Moments, z_between, z_limit};
use bdpt_explorer::bdpt::{Reason, Settings, Strategy, StrategySet};
use bdpt_explorer::math::{DVec3, Vec3};
use bdpt_explorer::scene::parts::PartTriangle;
use bdpt_explorer::scene::{Material, Overrides, Scene, gltf};
use serde_json::json;
use std::sync::Arc;

/// A furnace whose walls are cut into strips from a third of a wall to 10⁻⁹ of it wide, among them some of no width at all; every
/// `left_out`th strip is missing.
fn furnace_of_slivers(left_out: usize) -> (Arc<Scene>, usize) {
    let mut room = Room::new("slivers");
    let m = room.emitter(2.0, 0.6, false);
    room.cuboid([-1.0; 3], [1.0, 1.2, 1.4], true, [m; 6]);
    let walls: Vec<PartTriangle> = std::mem::take(&mut room.parts().triangles);
    // Where the strips end: the same cuts on every wall, so that walls meet edge to edge.
    let mut cuts: Vec<f64> = (0..200).map(|i| f64::from(i) / 200.0 + if i % 3 == 0 { 0.0 } else { 1e-9 }).collect();
    cuts.extend((0..100).map(|i| 0.3 + 1e-7 * f64::from(i)));
    cuts.extend((0..40).map(|i| 0.7 + 10f64.powf(-9.0 + 0.2 * f64::from(i))));
    cuts.extend([0.5, 0.5, 0.5, 1.0]);
    cuts.sort_by(f64::total_cmp);
    let mut strips = 0;
    for pair in walls.chunks(2) {
        let [p, p_u, p_uv] = pair[0].corners;
        let at = |t: f64| [p.lerp(p_u, t), (p + p_uv - p_u).lerp(p_uv, t)];
        for ends in cuts.windows(2) {
            let ([a, b], [d, c]) = (at(ends[0]), at(ends[1]));
            strips += 1;
            if left_out == 0 || strips % left_out > 0 {
                let flat = |corners: [DVec3; 3]| PartTriangle { corners, ..pair[0] };
                room.parts().triangles.extend([flat([a, d, c]), flat([a, c, b])]);
            }
        }
    }
    // As meshes have them: corners that are the same, or in a line.
    let flat = |corners: [DVec3; 3]| PartTriangle { corners, ..walls[0] };
    let (a, b) = (walls[0].corners[0], walls[0].corners[1]);
    room.parts().triangles.extend([flat([a, a, a]), flat([a, b, b]), flat([a, b, a.midpoint(b)])]);
    room.camera([0.1, 0.2, 0.3], [1.0, 0.3, -0.4], 60.0);
    let parts = std::mem::take(room.parts());
    let all = parts.triangles.len();
    let scene = Scene::assemble(parts).expect("it assembles");
    let dropped = all - scene.triangles.len();
    (Arc::new(scene), dropped)
}

/// Would have caught: slivers whose normals or probabilities are not finite, cracks between them, triangles without area as lights.
#[test]
fn walls_of_slivers_are_walls() {
    let exact = 2.0 * (1.0 - 0.6f64.powi(4)) / 0.4;
    let settings = Settings { max_edges: 4, ..Settings::default() };
    let found = |left_out| {
        let (scene, dropped) = furnace_of_slivers(left_out);
        let moments = over_seeds(&scene, [16, 16], settings, (24, 24));
        let (n, lights) = (scene.triangles.len(), scene.lights.list.len());
        println!("{n} triangles, {dropped} dropped: {:.4} ± {:.4} of {exact:.4}", moments.mean(), moments.error());
        assert!(dropped >= 15 && n > 3000 && lights == n, "{n} {dropped} {lights}");
        moments
    };
    let (whole, limit) = (found(0), z_limit(LEVEL, 1));
    assert!(whole.z(exact).abs() < limit, "{}", whole.mean());
    // Negative control: one strip of a hundred is a slit.
    assert!(found(100).z(exact).abs() > limit);
}

/// All walls twice in the same place: the very same picture, bit for bit, where the copies are the same triangles. With the other
/// winding, or another order of corners, a normal may be rounded another way, and other directions are drawn: the same mean. Would
/// have caught: connections blocked by the other wall, an offset that lands between the two.
#[test]
fn walls_that_lie_twice_in_one_place_are_one_wall() {
    let scene = |copies: &[[usize; 3]], lift: f64| {
        let mut room = Room::new("twice");
        let white = room.material(Material::lambert(Vec3::new(0.7, 0.6, 0.5)));
        let metal = room.material(Material::conductor(Vec3::splat(0.8), 0.5));
        let lamp = room.emitter(5.0, 0.3, true);
        room.cuboid([-1.0; 3], [1.0; 3], true, [white; 6]);
        room.quad([-0.6, -0.4, -0.3], [0.7, 0.2, 0.0], [0.0, 0.1, 0.6], metal);
        let once = room.parts().triangles.clone();
        for order in copies {
            let copy = |t: &PartTriangle| PartTriangle { corners: order.map(|i| t.corners[i] + lift), ..*t };
            room.parts().triangles.extend(once.iter().map(copy));
        }
        room.quad([-0.3, 0.8, -0.3], [0.6, 0.0, 0.0], [0.0, 0.0, 0.6], lamp);
        room.camera([0.1, 0.0, 0.9], [0.0, -0.2, -1.0], 70.0);
        room.build()
    };
    let settings = Settings { max_edges: 5, ..Settings::default() };
    let image = |scene: &Arc<Scene>| rendered(job(scene, [24, 24], settings), 8).image();
    let once = scene(&[], 0.0);
    assert!(image(&scene(&[[0, 1, 2]], 0.0)) == image(&once), "in the same order");
    let bright = |scene: &Arc<Scene>, seed: u32| over_seeds(scene, [16, 16], Settings { seed, ..settings }, (16, 24));
    let (reference, limit) = (bright(&once, 0), z_limit(LEVEL, 3));
    for (copies, what) in [(&[[1, 2, 0]][..], "corners in turn"), (&[[0, 2, 1]], "the other side out"), (&[[0, 1, 2], [2, 1, 0]], "thrice")]
    {
        let found = bright(&scene(copies, 0.0), 1000);
        let z = z_between(&found, &reference);
        println!("{what}: {:.5} ± {:.5} of {:.5}, z = {z:.2}", found.mean(), found.error(), reference.mean());
        assert!(z.abs() < limit, "{what}: {z}");
    }
    // Negative control: copies a little way off are other walls, and take light.
    let apart = bright(&scene(&[[0, 1, 2]], 2e-2), 1000);
    assert!(z_between(&apart, &reference).abs() > limit, "{} {}", apart.mean(), reference.mean());
}

/// A one-sided lamp under mirrored nodes: it shines to the side on which it is hit. Would have caught: a negative scale that turns the
/// normal for what is emitted and not for what is hit (pbrt-v3 #229).
#[test]
fn mirrored_lamps_shine_to_the_side_on_which_they_are_hit() {
    let scene = |scale: [f64; 3], normals: Option<Vec<[f32; 3]>>| {
        let mut glb = Glb::new("mirrored");
        let (white, lamp) = (glb.material(lambert("white", [0.6; 3])), glb.material(emitter("lamp", [0.0; 3], [1.0; 3], 3.0)));
        glb.object("floor", &Shape::quad([[-2.0, -1.0, 2.0], [2.0, -1.0, 2.0], [2.0, -1.0, -2.0], [-2.0, -1.0, -2.0]]), white);
        glb.object("wall", &Shape::quad([[-2.0, -1.0, -2.0], [2.0, -1.0, -2.0], [2.0, 3.0, -2.0], [-2.0, 3.0, -2.0]]), white);
        // It faces the camera, and is its own mirror image but for its front.
        let square = Shape::quad([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]]);
        let node = glb.object("lamp", &Shape { normals, ..square }, lamp);
        glb.json["nodes"][node]["scale"] = json!(scale);
        glb.camera("camera", [0.0, 0.2, 3.0], [0.0, -5.0], 0.9);
        Arc::new(gltf::load_bytes("mirrored.glb", &glb.bytes(), &Overrides::default()).unwrap())
    };
    let settings = Settings { max_edges: 3, ..Settings::default() };
    let mut brightness = Vec::new();
    // Mirrored along x and y it looks at the camera as before, along z it looks away.
    let scales = [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [1.0, -1.0, 1.0], [-1.0, -1.0, -1.0], [1.0, 1.0, -1.0]];
    // With normals of its own, that lean a little, too.
    let leaning = || Some([-0.2, 0.2, 0.1, -0.1].map(|x| [x, 0.5 * x, 0.97]).to_vec());
    for (scale, normals) in scales.iter().flat_map(|&scale| [(scale, None), (scale, leaning())]) {
        let (faces, scene) = (scale[2] > 0.0, scene(scale, normals));
        // The mistake: what is hit faces the other way than what emits.
        let compared = compare(&job(&scene, [24, 24], settings), 80_000, |_, _, x, value| if x.s == 0 { 0.0 } else { value });
        match faces {
            true => compared.holds(&format!("scaled by {scale:?}")),
            false => assert!(compared.right.0 < compared.limit, "{scale:?}: {compared:?}"),
        }
        assert!(compared.pairs >= 2);
        brightness.push(over_seeds(&scene, [24, 24], Settings { max_edges: 1, ..settings }, (12, 8)));
    }
    for (seen, scale) in brightness.iter().zip(scales.iter().flat_map(|scale| [scale, scale])) {
        assert!(if scale[2] > 0.0 {
            z_between(seen, &brightness[0]).abs() < z_limit(LEVEL, 6) && seen.mean() > 0.1
        } else {
            seen.mean() == 0.0
        });
    }
}

/// A lamp in closed glass: no connection passes the glass, and eye paths alone agree with all strategies. Would have caught: shadow
/// rays that pass glass as if it were air, besides the paths that are refracted (LuxCore #576, #671), or lose its tint (appleseed #2383).
#[test]
fn no_connection_passes_closed_glass() {
    let scene = scenes::lamp_in_glass();
    let settings = Settings { max_edges: 4, ..Settings::default() };
    let eye = StrategySet::where_(|x| x.s == 0);
    let reference = over_seeds(&scene, [16, 16], Settings { strategies: eye, ..settings }, (24, 96));
    let (mut all, mut leaking, mut blocked) = (Moments::default(), Moments::default(), 0u32);
    for seed in 0..24 {
        let (mut right, mut wrong, samples) = (0.0, 0.0, 4096);
        each_sample(&job(&scene, [16, 16], Settings { seed: 100 + seed, ..settings }), samples, |context, sample| {
            for strategy in Strategy::all(4, false) {
                match sample.evaluate(context, strategy) {
                    Ok(c) => right += f64::from((c.contribution_unweighted * c.mis_weight).element_sum()) / 3.0,
                    Err(Reason::Blocked) if strategy.s == 1 && strategy.t >= 2 => {
                        // The mistake: next-event estimation straight through, in the room outside.
                        let (y, z) = (sample.light_vertices(strategy)[0], *sample.eye_vertices(strategy).last().unwrap());
                        let ((w, g), light) = (y.edge_to(&z), &context.scene.lights.list[y.light as usize]);
                        let f = z.bsdf::<bdpt_explorer::scene::General>(context.scene).eval(-w, z.w_prev);
                        let value = y.alpha * light.l_e_1(y.n_g, w) * f * z.alpha * (g * context.view.per_pass());
                        wrong += f64::from(value.element_sum()) / 3.0;
                        blocked += 1;
                    }
                    Err(_) => {}
                }
            }
        });
        all.add(right / f64::from(samples));
        leaking.add((right + wrong) / f64::from(samples));
    }
    let limit = z_limit(LEVEL, 1);
    println!("by eye paths {:.4} ± {:.4}, by all {:.4} ± {:.4}", reference.mean(), reference.error(), all.mean(), all.error());
    println!("through the glass as well: {:.4} ± {:.4}, {blocked} connections", leaking.mean(), leaking.error());
    assert!(z_between(&reference, &all).abs() < limit && blocked > 1000);
    assert!(z_between(&reference, &leaking).abs() > limit, "the mistake goes unnoticed");
    let compared = compare(&job(&scene, [16, 16], settings), 60_000, NONE);
    assert!(compared.pairs > 0 && compared.right.0 < compared.limit, "{compared:?}");
}
