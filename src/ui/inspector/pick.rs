//! A vertex of a subpath is selected as a vertex of a path: of the selected strategy's if it goes through it, else of the strategy
//! that ends its subpath there.

use crate::bdpt::record::PathVertexRecord;
use crate::bdpt::{PathRecord, Strategy};
use crate::ui::state::State;

/// The vertices of the selected strategy's path.
fn path<'a>(state: &State, record: &'a PathRecord) -> &'a [PathVertexRecord] {
    let strategy = record.strategies.iter().find(|x| x.strategy() == state.selection.strategy);
    strategy.map(|x| &x.vertices[..]).unwrap_or_default()
}

/// y_i as x_i of the selected path, if that goes through it.
pub fn selected_light(state: &State, record: &PathRecord, i: usize) -> bool {
    let s = state.selection.strategy.s as usize;
    i < s && state.selection.vertex == i && path(state, record).get(i).is_none_or(|x| !x.fresh)
}

/// z_j as x_{k−j} of the selected path, if that goes through it.
pub fn selected_eye(state: &State, record: &PathRecord, j: usize) -> bool {
    let (t, k) = (state.selection.strategy.t as usize, state.selection.strategy.edges() as usize);
    j < t && state.selection.vertex + j == k && path(state, record).get(k - j).is_none_or(|x| !x.fresh)
}

/// Selects y_i.
pub fn light_vertex(state: &mut State, record: &PathRecord, i: usize) {
    let Strategy { s, t } = state.selection.strategy;
    let fresh = path(state, record).get(i).is_some_and(|x| x.fresh);
    let s = if i < s as usize && !fresh { s } else { (i as u32 + 1).max(if record.fresh_ends { 2 } else { 1 }) };
    let t = t.max(1).min((record.max_edges + 1).saturating_sub(s));
    select(state, Strategy::new(s, t), i);
}

/// Selects z_j.
pub fn eye_vertex(state: &mut State, record: &PathRecord, j: usize) {
    let Strategy { s, t } = state.selection.strategy;
    let k = state.selection.strategy.edges() as usize;
    let fresh = k.checked_sub(j).and_then(|i| path(state, record).get(i)).is_some_and(|x| x.fresh);
    let least = if record.fresh_ends && record.lens_radius > 0.0 { 2 } else { 1 };
    let t = if j < t as usize && !fresh { t } else { (j as u32 + 1).max(least) };
    // A path has an edge: a lone z₀ makes none.
    let s = s.min((record.max_edges + 1).saturating_sub(t)).max(2u32.saturating_sub(t));
    let strategy = Strategy::new(s, t);
    select(state, strategy, strategy.edges() as usize - j);
}

fn select(state: &mut State, strategy: Strategy, vertex: usize) {
    state.select_strategy(strategy);
    state.selection.vertex = vertex;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::{self, Job};
    use crate::scene::builtin;
    use crate::ui::state::Preferences;
    use std::sync::Arc;

    #[test]
    fn every_vertex_of_both_subpaths_can_be_selected_from_any_strategy() {
        let job = Job { size: [32, 32], ..Job::new(Arc::new(builtin::open("bokeh").unwrap())) };
        let all: Vec<Strategy> = Strategy::all(6, true).collect();
        for sample in 0..6 {
            let record = engine::record(&job, [16, 20], sample).unwrap();
            for strategy in &all {
                let mut state = State::new(Preferences::default(), [32, 32]);
                for i in 0..record.light.vertices.len().min(6) {
                    state.select_strategy(*strategy);
                    light_vertex(&mut state, &record, i);
                    assert!(selected_light(&state, &record, i) && state.selection.strategy.edges() <= 6, "y{i} from {strategy}");
                }
                for j in 0..record.eye.vertices.len() {
                    state.select_strategy(*strategy);
                    eye_vertex(&mut state, &record, j);
                    assert!(selected_eye(&state, &record, j) && state.selection.strategy.edges() <= 6, "z{j} from {strategy}");
                }
            }
        }
    }
}
