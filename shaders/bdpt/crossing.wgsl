// t = 0, where a light subpath crosses the lens: twin of src/bdpt/crossing.rs.

// The vertex at which a step crosses the lens, if the walk came so far: where it ended, if not at infinity, lies beyond.
fn crossing(from_vertex: Vertex, walked: Walked, taken: Step) -> Arrived {
    var step = taken;
    let to = walked.vertex;
    if walked.pushed {
        step = Step(-to.w_prev, to.pdf_fwd_area / (to.geometry_prev * vertex_opacity(to)), to.alpha);
    }
    let lens_point = cross_lens(from_vertex.position, step.direction);
    var none: Arrived;
    if !lens_point.some {
        return none;
    }
    let arrived = arrive_at_lens(from_vertex, step, lens_point.point);
    if !arrived.some {
        return none;
    }
    let room = control.params.clearance / abs(dot3(arrived.vertex.w_prev, arrived.vertex.n_g));
    let along_target = dot3(to.position - from_vertex.position, step.direction);
    let along_lens = dot3(lens_point.point - from_vertex.position, step.direction);
    if !walked.pushed || along_target > along_lens - room {
        return arrived;
    }
    return none;
}

fn arrive_at_lens(from_vertex: Vertex, step: Step, point: vec3<f32>) -> Arrived {
    var lens = lens_vertex(point);
    let edge = edge_to(from_vertex, lens);
    let geometry = edge.geometry * seen_through(from_vertex, lens, edge.w);
    let pdf = step.pdf_fwd_psa * geometry;
    lens.alpha = step.alpha;
    lens.w_prev = -edge.w;
    lens.pdf_fwd_area = pdf;
    lens.pdf_rev_area = control.params.pdf_lens_area;
    lens.geometry_prev = geometry;
    return Arrived(pdf > 0.0 && is_finite(pdf), lens);
}
