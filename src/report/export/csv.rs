//! Tables of a sample as RFC 4180 has them: commas, quotes where needed, lines that end with CR LF, a head with units. Numbers are
//! written as `inspect --json` writes them: the shortest digits that read back as the same number. What is not there is empty.

use crate::bdpt::PathRecord;
use crate::bdpt::record::{Measure, PathVertexRecord, StrategyRecord, VertexRecord};
use crate::report::role_name;
use std::fmt::Display;

/// Radiance.
const RADIANCE: &str = "W m^-2 sr^-1";

/// A table under way.
#[derive(Default)]
pub struct Table {
    /// The lines so far.
    pub text: String,
    /// Does the line have a field already?
    begun: bool,
}

impl Table {
    /// Adds a field.
    pub fn field(&mut self, value: impl Display) {
        if self.begun {
            self.text.push(',');
        }
        self.begun = true;
        let value = value.to_string();
        if value.contains(['"', ',', '\r', '\n']) {
            self.text += &format!("\"{}\"", value.replace('"', "\"\""));
        } else {
            self.text += &value;
        }
    }

    /// Adds a field, empty where there is no value.
    pub fn maybe(&mut self, value: Option<impl Display>) {
        match value {
            Some(value) => self.field(value),
            None => self.field(""),
        }
    }

    fn three(&mut self, values: Option<[impl Display + Copy; 3]>) {
        (0..3).for_each(|i| self.maybe(values.map(|v| v[i])));
    }

    /// Ends the line.
    pub fn end(&mut self) {
        self.text += "\r\n";
        self.begun = false;
    }

    /// Three columns of a colour.
    fn rgb_head(&mut self, name: &str, unit: &str) {
        ["r", "g", "b"].into_iter().for_each(|channel| self.field(format!("{name}_{channel} [{unit}]")));
    }
}

/// The strategies: one line each.
pub fn strategies_csv(record: &PathRecord) -> String {
    let mut table = Table::default();
    ["s", "t", "edges", "role", "feasible", "reason", "raster_x [px]", "raster_y [px]", "log10_p", "visibility", "mis_weight"]
        .into_iter()
        .for_each(|name| table.field(name));
    table.rgb_head("connection_term", "1");
    table.rgb_head("contribution_unweighted", RADIANCE);
    table.rgb_head("contribution", RADIANCE);
    table.end();
    for strategy in &record.strategies {
        strategy_line(&mut table, strategy);
    }
    table.text
}

fn strategy_line(table: &mut Table, x: &StrategyRecord) {
    table.field(x.s);
    table.field(x.t);
    table.field(x.strategy().edges());
    table.field(role_name(x.strategy()));
    table.field(x.feasible);
    table.maybe(x.reason_text);
    (0..2).for_each(|i| table.maybe(x.raster.map(|raster| raster[i])));
    table.maybe(x.p);
    table.maybe(x.visibility);
    table.field(x.mis_weight);
    table.three(Some(x.connection_term));
    table.three(Some(x.contribution_unweighted));
    table.three(Some(x.contribution));
    table.end();
}

/// The vertices: those of both subpaths, then those of every strategy's full path.
pub fn vertices_csv(record: &PathRecord) -> String {
    let mut table = Table::default();
    ["path", "index", "name", "kind", "light", "material", "model", "x [m]", "y [m]", "z [m]"]
        .into_iter()
        .for_each(|name| table.field(name));
    ["n_g_x", "n_g_y", "n_g_z", "n_s_x", "n_s_y", "n_s_z", "alpha_r", "alpha_g", "alpha_b"].into_iter().for_each(|name| table.field(name));
    ["measure", "pdf_fwd", "pdf_rev", "p_light", "p_eye", "delta", "survival", "opacity", "edge_length [m]", "edge_geometry_term"]
        .into_iter()
        .for_each(|name| table.field(name));
    table.end();
    for (path, letter, subpath) in [("light", 'y', &record.light), ("eye", 'z', &record.eye)] {
        for (index, vertex) in subpath.vertices.iter().enumerate() {
            vertex_line(&mut table, [path, &format!("{letter}{index}")], (index, vertex), None);
        }
    }
    for strategy in &record.strategies {
        let path = strategy.strategy().to_string();
        for (index, vertex) in strategy.vertices.iter().enumerate() {
            vertex_line(&mut table, [&path, &format!("x{index}")], (index, &vertex.vertex), Some(vertex));
        }
    }
    table.text
}

fn vertex_line(table: &mut Table, [path, name]: [&str; 2], (index, v): (usize, &VertexRecord), joined: Option<&PathVertexRecord>) {
    table.field(path);
    table.field(index);
    table.field(name);
    table.field(v.kind);
    table.maybe(v.light_name.as_deref().or(v.light));
    table.maybe(v.material.as_deref());
    table.maybe(v.model);
    table.three(Some(v.position));
    table.three(Some(v.n_g));
    table.three(Some(v.n_s));
    table.three(Some(v.alpha));
    table.field(match v.measure {
        Measure::Area => "m^-2",
        Measure::SolidAngle => "sr^-1",
        Measure::Discrete => "probability",
    });
    table.field(v.pdf_fwd);
    table.maybe(v.pdf_rev);
    table.maybe(joined.and_then(|joined| joined.p_light));
    table.maybe(joined.and_then(|joined| joined.p_eye));
    table.field(v.delta);
    table.field(v.survival);
    table.maybe(v.look.map(|look| look.opacity));
    table.maybe(v.edge.and_then(|edge| edge.length));
    table.maybe(v.edge.and_then(|edge| edge.geometry_term));
    table.end();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_quoted_where_they_must_be() {
        let mut table = Table::default();
        ["plain", "a,b", "say \"hi\"", "two\nlines"].into_iter().for_each(|text| table.field(text));
        table.maybe(None::<f32>);
        table.field(0.1f32);
        table.end();
        assert_eq!(table.text, "plain,\"a,b\",\"say \"\"hi\"\"\",\"two\nlines\",,0.1\r\n");
    }
}
