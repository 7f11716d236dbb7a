//! One kernel for steps and whole walks: rows begin at a given vertex, or at the start of a subpath.

use crate::harness::Work;
use crate::table::{Table, bits, load, store};
use bdpt_explorer::bdpt::walk::Step;
use bdpt_explorer::bdpt::{End, Vertex};
use bdpt_explorer::gpu::Gpu;
use bdpt_explorer::math::Vec3;
use bdpt_explorer::rng::SampleId;
use bdpt_explorer::scene::TransportMode;

/// Most vertices that a row has room for.
pub const ROOM: usize = 10;

const VERTEX: usize = size_of::<Vertex>() / 4;
const INPUTS: usize = VERTEX + 7 + 9;
const OUTPUTS: usize = VERTEX + 7 + 3 + 2 + 2 * ROOM;

/// What a row asks for.
#[derive(Clone, Copy)]
pub enum Ask {
    /// One step from the given vertex, number `last` of its subpath.
    Step { from: Vertex, step: Step, last: u32 },
    /// The first vertex of a subpath, and its first step.
    Start,
    /// A whole subpath.
    Walk,
}

/// A row.
#[derive(Clone, Copy)]
pub struct Row {
    pub ask: Ask,
    pub mode: TransportMode,
    pub id: SampleId,
    pub max_vertices: u32,
}

/// What the device answers.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The vertex stepped to, or that of the start.
    pub vertex: Vertex,
    /// The step after it.
    pub step: Step,
    pub pushed: bool,
    /// `None` if the walk goes on.
    pub end: Option<End>,
    /// Of the vertex before.
    pub pdf_rev_area: f32,
    /// Of a whole walk: end, and the vertices' triangles and flags.
    pub walk: (Option<End>, Vec<[u32; 2]>),
}

fn body() -> String {
    let at = VERTEX as u32;
    let (last, step) = (load("Vertex", "last", 0), load("Step", "step", VERTEX));
    let (vertex, taken) = (store("Vertex", "last", 0), store("Step", "step", VERTEX));
    let result = VERTEX + 7;
    let walk = result + 3;
    format!(
        "fn note(row: u32, i: u32, v: Vertex) {{
            out_u(row, {walk}u + 2u + 2u * i, v.triangle);
            out_u(row, {walk}u + 3u + 2u * i, v.flags);
        }}
        fn keep(row: u32, last: Vertex, step: Step) {{\n{vertex}\n{taken}\n}}
        fn run_row(row: u32) {{
            var last: Vertex;
            {last}
            var step: Step;
            // A step's padding is nobody's.
            {step}
            let first = {at}u + 7u;
            let id = SampleId(in_u(row, first), in_u(row, first + 1u), in_u(row, first + 2u), in_u(row, first + 3u), in_u(row, first + 8u));
            let mode = in_u(row, first + 4u);
            var count = in_u(row, first + 5u) + 1u;
            let most = in_u(row, first + 6u);
            let ask = in_u(row, first + 7u);
            if ask > 0u {{
                count = 1u;
                if mode == IMPORTANCE {{
                    last = sample_light_vertex(id, BLOCK_LIGHT_START, BLOCK_LIGHT_PLACE);
                    step = light_start(id, &last);
                }} else {{
                    let u = numbers(id, BLOCK_EYE_START);
                    last = lens_vertex(sample_lens(u.zw));
                    step = eye_start(last, vec2<f32>(inside_cell(id.x, u.x), inside_cell(id.y, u.y)));
                }}
                note(row, 0u, last);
            }}
            var walked: Walked;
            walked.end = END_MAX_EDGES;
            if mode == IMPORTANCE && ask > 0u && (step.pdf_fwd_psa <= 0.0 || all(last.alpha == vec3<f32>(0.0))) {{
                walked.end = END_ABSORBED;
            }} else if ask != 1u {{
                while count < most {{
                    walked = walk_step(&step, mode, id, last, count - 1u, count + 1u == most);
                    if walked.pushed {{
                        last = walked.vertex;
                        note(row, count, last);
                        count++;
                    }}
                    if ask == 0u || walked.end != END_NONE {{
                        break;
                    }}
                }}
            }}
            keep(row, last, step);
            out_u(row, {result}u, u32(walked.pushed));
            out_u(row, {result}u + 1u, walked.end);
            out_f(row, {result}u + 2u, walked.pdf_rev_area);
            out_u(row, {walk}u, walked.end);
            out_u(row, {walk}u + 1u, count);
        }}"
    )
}

fn end_of(code: u32) -> Option<End> {
    [None, Some(End::MaxEdges), Some(End::Escaped), Some(End::Roulette), Some(End::Absorbed), Some(End::NoLight)][code as usize]
}

/// Asks the device.
pub fn ask(gpu: &Gpu, work: &Work, rows: &[Row], change: Option<(&str, &str)>) -> Vec<Answer> {
    let mut table = Vec::with_capacity(rows.len() * INPUTS);
    for Row { ask, mode, id, max_vertices } in rows {
        assert!(*max_vertices as usize <= ROOM);
        let nothing = Step { direction: Vec3::Z, pdf_fwd_psa: 0.0, alpha: Vec3::ZERO };
        let (code, from, step, last) = match *ask {
            Ask::Step { from, step, last } => (0, from, step, last),
            Ask::Start => (1, bytemuck::Zeroable::zeroed(), nothing, 0),
            Ask::Walk => (2, bytemuck::Zeroable::zeroed(), nothing, 0),
        };
        table.extend_from_slice(bytemuck::cast_slice(std::slice::from_ref(&from)));
        table.extend(step.direction.to_array());
        table.push(step.pdf_fwd_psa);
        table.extend(step.alpha.to_array());
        let mode = u32::from(*mode == TransportMode::Importance);
        table.extend([id.x, id.y, id.sample, id.seed, mode, last, *max_vertices, code, id.sampler as u32].map(bits));
    }
    let out = Table { gpu, work, change }.run(&body(), INPUTS, OUTPUTS, &table);
    out.iter().map(|row| answer(row)).collect()
}

fn answer(row: &[f32]) -> Answer {
    let word = |k: usize| row[k].to_bits();
    let v = |k: usize| Vec3::new(row[k], row[k + 1], row[k + 2]);
    let (result, walk) = (VERTEX + 7, VERTEX + 10);
    let count = (word(walk + 1) as usize).min(ROOM);
    Answer {
        vertex: *bytemuck::from_bytes(bytemuck::cast_slice(&row[..VERTEX])),
        step: Step { direction: v(VERTEX), pdf_fwd_psa: row[VERTEX + 3], alpha: v(VERTEX + 4) },
        pushed: word(result) == 1,
        end: end_of(word(result + 1)),
        pdf_rev_area: row[result + 2],
        walk: (end_of(word(walk)), (0..count).map(|i| [word(walk + 2 + 2 * i), word(walk + 3 + 2 * i)]).collect()),
    }
}
