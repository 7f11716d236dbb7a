//! The hierarchy against brute force, at every scale, and its watertightness.

use super::*;
use crate::math::Vec2;
use crate::rng::SampleId;
use crate::scene::{NONE, builtin};
use glam::Vec3Swizzles;

/// Numbers in [0, 1)⁴, the i-th four of a test's own stream.
fn random(stream: u32, i: u32) -> [f32; 4] {
    SampleId { x: 0, y: 0, sample: i, seed: stream, ..SampleId::default() }.numbers(0)
}

/// A point of the cube [−1, 1]³.
fn in_cube(stream: u32, i: u32) -> Vec3 {
    let [x, y, z, _] = random(stream, i);
    Vec3::new(x, y, z) * 2.0 - 1.0
}

fn triangle(p0: Vec3, p1: Vec3, p2: Vec3) -> Triangle {
    Triangle { p0, material: 0, p1, light: NONE, p2, attributes: NONE }
}

/// The watertight test of one triangle, as the paper has it.
fn hit(ray: &Ray, triangle: &Triangle, index: u32, t_max: f32) -> Option<Hit> {
    // The ray's largest axis becomes z; x and y are swapped where z points backwards, to keep the winding.
    let d = ray.direction;
    let z = d.abs().max_position();
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let (x, y) = if d[z] < 0.0 { (y, x) } else { (x, y) };
    let scale = 1.0 / d[z];
    let sheared = |p: Vec3| {
        let p = [p[x] - ray.origin[x], p[y] - ray.origin[y], p[z] - ray.origin[z]];
        [p[0] - p[2] * (d[x] * scale), p[1] - p[2] * (d[y] * scale), p[2]]
    };
    let [a, b, c] = [triangle.p0, triangle.p1, triangle.p2].map(sheared);
    let mut e = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]];
    if e.contains(&0.0) {
        let [a, b, c] = [a, b, c].map(|p| p.map(f64::from));
        e = [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]].map(|e| e as f32);
    }
    let det = e[0] + e[1] + e[2];
    if e.iter().any(|&e| e < 0.0) && e.iter().any(|&e| e > 0.0) || det == 0.0 {
        return None;
    }
    let distance = scale * (e[0] * a[2] + e[1] * b[2] + e[2] * c[2]) * (1.0 / det);
    (distance > 0.0 && distance < t_max).then(|| Hit { triangle: index, distance, b1: e[1] * (1.0 / det), b2: e[2] * (1.0 / det) })
}

/// The nearest hit by trying every triangle.
fn brute_force(triangles: &[Triangle], ray: &Ray) -> Option<Hit> {
    let mut best: Option<Hit> = None;
    for (index, triangle) in triangles.iter().enumerate() {
        best = hit(ray, triangle, index as u32, best.map_or(f32::MAX, |hit| hit.distance)).or(best);
    }
    best
}

/// Every leaf's triangles lie in the boxes above it, and every triangle in exactly one leaf.
fn check_tree(nodes: &[Node], depth: u32, triangles: &[Triangle]) {
    let mut seen = vec![0; triangles.len()];
    let mut stack = vec![(0usize, nodes[0])];
    while let Some((index, above)) = stack.pop() {
        let node = nodes[index];
        assert!(node.count as usize <= LEAF_SIZE);
        assert!(node.min.cmpge(above.min).all() && node.max.cmple(above.max).all());
        for i in node.first..node.first + node.count {
            let t = &triangles[i as usize];
            assert!([t.p0, t.p1, t.p2].iter().all(|p| p.cmpge(node.min).all() && p.cmple(node.max).all()));
            seen[i as usize] += 1;
        }
        if node.count == 0 {
            stack.extend([(node.first as usize, node), (node.first as usize + 1, node)]);
        }
    }
    assert!(seen.iter().all(|&n| n == 1));
    assert!(depth as usize <= STACK_SIZE && depth == depth_of(nodes));
}

/// Rays of all kinds through a scene: at random, along axes, along diagonals, nearly along axes, from vertices' planes.
fn rays(triangles: &[Triangle], stream: u32, count: u32, scale: f32) -> impl Iterator<Item = Ray> {
    let tiny = [0.0, -0.0, 1e-45, -1e-40, 1e-30, -1e-20, 1e-8];
    (0..count).map(move |i| {
        let t = &triangles[(random(stream, i)[3] * triangles.len() as f32) as usize];
        let mut direction = in_cube(stream + 1, i);
        if i % 4 > 0 {
            let axis = (i / 4) as usize % 3;
            direction[axis] = tiny[i as usize % 7];
            if i % 4 > 1 {
                direction[(axis + 1) % 3] = tiny[i as usize % 5];
            }
        }
        let target = if i % 3 == 0 {
            (t.p0 + t.p1 + t.p2) / 3.0
        } else if i % 3 == 1 {
            t.p0
        } else {
            t.p0.lerp(t.p1, 0.5)
        };
        let direction = direction.normalize();
        Ray { origin: target - direction * (scale * random(stream + 2, i)[0]), direction }
    })
}

/// Hits agree with brute force for all rays; how many there were.
fn check_hits(triangles: &[Triangle], stream: u32, count: u32, scale: f32) -> u32 {
    let mut own = triangles.to_vec();
    let bvh = Bvh::build(&mut own);
    check_hits_of(&bvh, &own, stream, count, scale)
}

/// The same for a tree that is there.
fn check_hits_of(bvh: &Bvh, own: &[Triangle], stream: u32, count: u32, scale: f32) -> u32 {
    check_tree(&bvh.nodes, bvh.depth, own);
    let mut hits = 0;
    for ray in rays(own, stream, count, scale) {
        let (found, expected) = (bvh.closest_hit(&ray), brute_force(own, &ray));
        assert_eq!(found.is_some(), expected.is_some(), "{ray:?} at scale {scale}");
        // Where triangles cross or overlap, which is nearer is a matter of rounding.
        let gap = found.zip(expected).map_or(0.0, |(f, e)| (f.distance - e.distance).abs());
        assert!(gap <= 2e-5 * scale, "{ray:?} at scale {scale}: {found:?} {expected:?}");
        // What was found is what the definition says of that triangle, bit for bit.
        assert_eq!(found.and_then(|f| hit(&ray, &own[f.triangle as usize], f.triangle, f32::MAX)), found, "{ray:?} at scale {scale}");
        let segment = Segment { from: ray.origin, to: ray.origin + ray.direction * (scale * random(stream + 3, hits)[0]) };
        assert_eq!(bvh.any_hit(&segment), bvh.closest_hit_on_segment(&segment, |_| true).is_some(), "{segment:?}");
        hits += u32::from(found.is_some());
    }
    hits
}

#[test]
fn hits_equal_brute_force_at_all_scales_and_offsets() {
    let mut hits = 0;
    for round in 0..60 {
        let scale = 10f32.powi(round as i32 % 10 - 3);
        let offset = if round % 3 == 0 { in_cube(99, round) * (scale * 1000.0) } else { Vec3::ZERO };
        let size = if round % 2 == 0 { 0.1 } else { 1.0 };
        let triangles: Vec<_> = (0..1 + round * round / 8)
            .map(|i| {
                let centre = in_cube(10 + round, 4 * i);
                let corner = |j| (centre + in_cube(10 + round, 4 * i + j) * size) * scale + offset;
                triangle(corner(1), corner(2), corner(3))
            })
            .collect();
        hits += check_hits(&triangles, 1000 + 4 * round, 3000, scale * 3.0);
    }
    assert!(hits > 60_000, "{hits}");
}

/// A ray that meets a box exactly (in f64) is told to meet it, by the narrowest margin and from a thousand times as far as the box is wide.
#[test]
fn no_box_that_the_exact_ray_meets_is_left_out() {
    let mut narrow = 0;
    for i in 0..300_000 {
        let (low, size) = (in_cube(41, i), in_cube(42, i).abs());
        let high = low + if i % 2 == 0 { size } else { size * Vec3::new(1e-6, 1.0, 1.0) };
        // A point near one of its edges.
        let [u, v, w, inside] = random(43, i);
        let (along, axis) = (Vec3::new(u, v.round(), w.round()), i as usize % 3);
        let along = [along, along.zxy(), along.yzx()][axis];
        let target = low + (high - low) * (along * (1.0 - 1e-6 * inside) + 0.5e-6 * inside);
        let direction = (target - in_cube(44, i) * 10f32.powi(i as i32 % 4)).normalize();
        let origin = target - direction * 10f32.powi(i as i32 % 4);
        let distances = |corner: Vec3| (corner.as_dvec3() - origin.as_dvec3()) / direction.as_dvec3();
        let (a, b) = (distances(low), distances(high));
        let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
        if direction.min_element() == 0.0 || !(0.0 <= enter && enter <= leave) {
            continue;
        }
        let mut quad = quads::Quad::EMPTY;
        quad.bounds = [low, high].map(|corner| corner.to_array().map(glam::Vec4::splat));
        let (met, _) = PreparedRay::new(origin, direction).enter(&quad, f32::MAX);
        assert_eq!(met & 1, 1, "{i}: {low} to {high} from {origin} along {direction}");
        narrow += u32::from(leave < enter * (1.0 + 1e-7));
    }
    assert!(narrow > 1000, "{narrow} by a margin that f32 rounds");
}

#[test]
fn flat_grids_and_boxes_in_the_axes_planes() {
    // Faces in the planes of the boxes, rays inside those planes and along them.
    for scale in [1e-3f32, 1.0, 1e6] {
        let mut triangles = Vec::new();
        for i in 0..6u32 {
            for j in 0..6u32 {
                let at = |x: u32, y: u32| Vec3::new(x as f32 / 3.0 - 1.0, 0.0, y as f32 / 3.0 - 1.0) * scale;
                triangles.push(triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1)));
                triangles.push(triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1)));
                let up = Vec3::Y * scale;
                triangles.push(triangle(at(i, j), at(i, j) + up, at(i + 1, j)));
            }
        }
        assert!(check_hits(&triangles, 7, 20_000, scale * 2.0) > 10_000);
    }
}

#[test]
fn slivers() {
    let needle = |i| {
        let (p, d) = (in_cube(5, 2 * i), in_cube(5, 2 * i + 1));
        triangle(p, p + d, p + d * 0.5 + in_cube(6, i) * 1e-6)
    };
    check_hits(&(0..500).map(needle).collect::<Vec<_>>(), 8, 20_000, 2.0);
}

#[test]
fn degenerate_input_builds() {
    let one = triangle(Vec3::ZERO, Vec3::X, Vec3::Y);
    for count in [1, 2, 3, 5, 1000] {
        assert!(check_hits(&vec![one; count], 11, 2000, 2.0) > 100);
    }
    let row = (0..300).map(|i| triangle(Vec3::ZERO, Vec3::X * (i + 1) as f32, Vec3::Y)).collect::<Vec<_>>();
    check_hits(&row, 12, 2000, 300.0);
    let shrinking = (0..120).map(|i| 2f32.powi(-i)).map(|s| triangle(Vec3::ZERO, Vec3::X * s, Vec3::Y * s)).collect::<Vec<_>>();
    check_hits(&shrinking, 13, 2000, 1.0);
    let points = vec![triangle(Vec3::ONE, Vec3::ONE, Vec3::ONE); 100];
    assert_eq!(check_hits(&points, 14, 2000, 1.0), 0);
    assert!(Bvh::build(&mut Vec::new()).closest_hit(&Ray { origin: Vec3::ZERO, direction: Vec3::X }).is_none());
}

#[test]
fn a_refitted_tree_holds_what_has_moved() {
    let corner = |i: u32, j: u32| in_cube(15, 4 * i) + in_cube(15, 4 * i + j) * 0.1;
    let mut triangles: Vec<_> = (0..400).map(|i| triangle(corner(i, 1), corner(i, 2), corner(i, 3))).collect();
    let bvh = Bvh::build(&mut triangles);
    for (triangle, i) in triangles.iter_mut().zip(0..) {
        let by = in_cube(16, i) * 0.3;
        (triangle.p0, triangle.p1, triangle.p2) = (triangle.p0 + by, triangle.p1 + by, triangle.p2 + by);
    }
    assert!(check_hits_of(&bvh.refitted(&triangles), &triangles, 17, 10_000, 2.0) > 5000);
    // Negative control: the boxes from before.
    let missed = rays(&triangles, 17, 10_000, 2.0).filter(|ray| bvh.closest_hit(ray).is_none() && brute_force(&triangles, ray).is_some());
    assert!(missed.count() > 100);
}

#[test]
fn a_segment_without_length_meets_nothing() {
    let mut triangles = vec![triangle(Vec3::ZERO, Vec3::X, Vec3::Y)];
    let bvh = Bvh::build(&mut triangles);
    for p in [Vec3::ZERO, Vec3::new(0.25, 0.25, 0.0), Vec3::ONE] {
        assert!(!bvh.any_hit(&Segment { from: p, to: p }));
    }
}

#[test]
fn the_balanced_tree_is_a_tree_and_shallow() {
    for count in [1u32, 6, 7, 13, 1000, 4097] {
        let make = |i| triangle(in_cube(1, 3 * i), in_cube(1, 3 * i + 1), in_cube(1, 3 * i + 2));
        for triangles in [(0..count).map(make).collect::<Vec<_>>(), vec![make(0); count as usize]] {
            let (nodes, order) = by_halves(&triangles);
            let ordered: Vec<_> = order.iter().map(|&i| triangles[i as usize]).collect();
            let depth = depth_of(&nodes);
            check_tree(&nodes, depth, &ordered);
            assert!(depth <= 2 + count.ilog2());
        }
    }
}

#[test]
fn no_ray_escapes_a_closed_sphere() {
    // 10⁶ rays from inside at the vertices and the edges, where triangles meet.
    let (stacks, slices) = (24u32, 32u32);
    let at = |stack: u32, slice: u32| {
        let (sin_t, cos_t) = (std::f32::consts::PI * stack as f32 / stacks as f32).sin_cos();
        let (sin_p, cos_p) = (std::f32::consts::TAU * (slice % slices) as f32 / slices as f32).sin_cos();
        // Both poles are single points.
        if stack.is_multiple_of(stacks) { Vec3::new(0.0, cos_t, 0.0) } else { Vec3::new(sin_t * cos_p, cos_t, sin_t * sin_p) }
    };
    for (scale, offset) in [(1.0, Vec3::ZERO), (1e-3, Vec3::ZERO), (1e6, Vec3::ZERO), (1.0, Vec3::new(1000.0, -500.0, 250.0))] {
        let mut triangles = Vec::new();
        for (i, j) in (0..stacks).flat_map(|i| (0..slices).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)].map(|p| p * scale + offset);
            triangles.extend([triangle(a, b, c), triangle(a, c, d)].into_iter().filter(|t| t.p0 != t.p1 && t.p1 != t.p2));
        }
        let bvh = Bvh::build(&mut triangles);
        for i in 0..250_000 {
            let origin = in_cube(21, i) * (0.5 * scale) + offset;
            let direction = (edge_point(&triangles, i) - origin).normalize();
            assert!(bvh.closest_hit(&Ray { origin, direction }).is_some(), "ray {i} escapes at scale {scale}");
        }
    }
}

/// A vertex, or a point on an edge, of the i-th or so triangle.
fn edge_point(triangles: &[Triangle], i: u32) -> Vec3 {
    let [pick, along, _, _] = random(22, i);
    let t = &triangles[(pick * triangles.len() as f32) as usize];
    let (a, b) = [(t.p0, t.p1), (t.p1, t.p2), (t.p2, t.p0)][i as usize % 3];
    if i.is_multiple_of(2) { a } else { a.lerp(b, along) }
}

#[test]
fn no_ray_escapes_the_cornell_box() {
    let scene = builtin::open("cornell").unwrap();
    let half = scene.origin.as_vec3();
    let mut tried = 0;
    for i in 0..3_000_000 {
        let target = edge_point(&scene.triangles, i);
        // At the walls, but not at the rim of the open front.
        let on_wall = target.x.abs() > half.x - 1e-6 || target.y.abs() > half.y - 1e-6 || target.z > half.z - 1e-6;
        if !on_wall || target.z < 0.01 - half.z {
            continue;
        }
        let origin = in_cube(31, i) * half * 0.95;
        let direction = (target - origin).normalize();
        assert!(scene.bvh.closest_hit(&Ray { origin, direction }).is_some(), "ray {i} escapes");
        tried += 1;
    }
    assert!(tried > 1_000_000, "{tried}");
}

/// Mray/s of one core: `cargo test --release --lib bvh -- --ignored --nocapture`.
#[test]
#[ignore = "a measurement"]
fn throughput() {
    use crate::math::{Frame, offset_ray_origin, sample_cosine_hemisphere};
    for name in ["cornell", "cornell-spheres"] {
        let scene = builtin::open(name).unwrap();
        let (mut rays, mut segments) = (Vec::new(), Vec::new());
        let start = Ray { origin: scene.cameras[0].position, direction: scene.cameras[0].axis };
        let mut ray = start;
        for i in 0..2_000_000 {
            let u = random(41, i);
            let Some(p) = scene.intersect(&ray) else {
                let spread = Vec3::new(u[0] - 0.5, u[1] - 0.5, 0.0) * 0.7;
                ray = Ray { direction: (start.direction + spread).normalize(), ..start };
                continue;
            };
            if let Some(light) = scene.lights.choose(Vec2::new(u[2], u[3])) {
                let q = scene.lights.point_on::<crate::scene::General>(&scene, &scene.lights.list[light as usize], Vec2::new(u[3], u[0]));
                let w = (q.position - p.position).normalize();
                let (from, to) = (offset_ray_origin(p.position, p.error, p.n_g, w), offset_ray_origin(q.position, q.error, q.n_g, -w));
                segments.push(Segment { from, to });
            }
            let facing = if p.n_g.dot(ray.direction) < 0.0 { p.n_g } else { -p.n_g };
            let direction = Frame::around(facing).to_world(sample_cosine_hemisphere(Vec2::new(u[0], u[1])));
            ray = Ray { origin: offset_ray_origin(p.position, p.error, p.n_g, direction), direction };
            rays.push(ray);
        }
        let measure = |count: usize, run: &dyn Fn() -> usize| {
            let seconds = (0..5).map(|_| {
                let start = std::time::Instant::now();
                std::hint::black_box(run());
                start.elapsed().as_secs_f64()
            });
            count as f64 * 1e-6 / seconds.fold(f64::MAX, f64::min)
        };
        let closest = measure(rays.len(), &|| rays.iter().filter(|r| scene.bvh.closest_hit(r).is_some()).count());
        let any = measure(segments.len(), &|| segments.iter().filter(|s| scene.bvh.any_hit(s)).count());
        println!("{name}: {closest:.1} Mray/s closest hit, {any:.1} Mray/s any hit, one core");
    }
}
