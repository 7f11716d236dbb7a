//! What is selected, in words: a page shows it as real HTML, which is the way in for who does not see the window. Numbers are
//! written as the inspector writes them; attributes (`data-…`) hold them in full.

use super::live::Live;
use super::state::State;
use super::text::{InspectText, Lang, SummaryText, Text, fill};
use super::widgets::{full_name, pair, role_name};
use super::{error, format, inspector, status_bar};
use crate::bdpt::record::{PathRecord, StrategyRecord};
use crate::bdpt::{Existence, Strategy};
use crate::engine::Frame;
use crate::math::Vec3;

/// What is summed up.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The sample.
    pub record: &'a PathRecord,
    /// Which strategies there are.
    pub existence: &'a Existence,
    /// The picture, once its first pass is complete.
    pub frame: Option<&'a Frame>,
}

/// An attribute: its name after `data-`, and its value.
pub type Data = (&'static str, String);

/// A row of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Its cells; the first one names it.
    pub cells: Vec<String>,
    /// Its attributes.
    pub data: Vec<Data>,
    /// Is it the selected one?
    pub chosen: bool,
}

/// A piece of the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Block {
    /// The name of what follows.
    Heading(String),
    /// A sentence.
    Line(String),
    /// A numbered list, from 0.
    List(Vec<String>),
    /// A table.
    Table {
        /// What it is about.
        caption: String,
        /// The names of its columns.
        head: Vec<String>,
        /// Its rows.
        rows: Vec<Row>,
    },
}

/// The whole; by default there is nothing to say.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Its language.
    pub lang: Lang,
    /// What is read out when it changes: one sentence.
    pub now: String,
    /// The selected path, and the strategies beside it; they change with the selection.
    pub path: Vec<Block>,
    /// Who renders, how far; changes all the time.
    pub rendering: Vec<Block>,
    /// The attributes of the whole.
    pub data: Vec<Data>,
}

/// The summary of what is on show; `None` while there is no sample.
pub fn now(state: &State, live: &Live) -> Option<Summary> {
    let frame = live.frame().filter(|frame| live.first_pass().is_none() && frame.size == state.size);
    let subject = Subject { record: live.record(state)?, existence: &live.existence(), frame: frame.map(|frame| &**frame) };
    let mut summary = of(state, &subject);
    summary.rendering.extend(error::summary(state, live));
    Some(summary)
}

/// The summary of a sample.
pub fn of(state: &State, subject: &Subject<'_>) -> Summary {
    let Subject { record, frame, .. } = *subject;
    let [x, y] = record.pixel.map(|v| v.to_string());
    let strategy = state.selection.strategy;
    let name = full_name(strategy, state.prefs.lang);
    let outcome = outcome(state, subject, strategy);
    let mut data = vec![("pixel", format!("{x},{y}")), ("sample", record.sample.to_string()), ("scene", record.scene.clone())];
    data.push(("strategy", format!("{},{}", strategy.s, strategy.t)));
    if let Some(frame) = frame {
        // As the page's address names them.
        let renderer = if frame.stats.backend == "gpu" { "webgpu" } else { "cpu" };
        data.extend([("renderer", renderer.to_owned()), ("spp", frame.stats.spp.to_string())]);
        data.extend(mean(record, frame).map(|mean| ("mean", full(mean.to_array()))));
    }
    Summary {
        lang: state.prefs.lang,
        now: fill(state.say(SummaryText::Now), &[&x, &y, &record.sample.to_string(), &name, &outcome]),
        path: path(state, subject),
        rendering: rendering(state, subject),
        data,
    }
}

/// What the strategy brings, or why nothing.
fn outcome(state: &State, subject: &Subject<'_>, strategy: Strategy) -> String {
    match subject.record.strategies.iter().find(|x| x.strategy() == strategy) {
        Some(found) => match inspector::why_not(state, subject.existence, found) {
            Some(why) => why,
            None => fill(state.say(SummaryText::Carries), &[&weight(found), &format::rgb(found.contribution)]),
        },
        None => inspector::absence(state, subject.existence, strategy).unwrap_or_else(|| state.say(Text::NotInRecord).to_owned()),
    }
}

fn weight(strategy: &StrategyRecord) -> String {
    format::weight(f64::from(strategy.mis_weight))
}

fn path(state: &State, subject: &Subject<'_>) -> Vec<Block> {
    let Subject { record, .. } = *subject;
    let (strategy, [width, height]) = (state.selection.strategy, record.size.map(|v| v.to_string()));
    let [x, y] = record.pixel.map(|v| v.to_string());
    let scene = [&record.scene, &width, &height, &record.seed.to_string(), &record.max_edges.to_string()];
    let sum = format::rgb(record.on_its_pixel(|strategy| !state.hidden.contains(strategy)).to_array());
    let mut blocks = vec![
        Block::Heading(fill(state.say(Text::InspectorTitle), &[&x, &y])),
        Block::Line(fill(state.say(SummaryText::Scene), &scene.map(String::as_str))),
        Block::Line(format!("{} {}: {}", state.say(Text::Sample), record.sample, fill(state.say(Text::SampleAdds), &[&sum]))),
        Block::Heading(fill(state.say(SummaryText::Selected), &[&full_name(strategy, state.prefs.lang)])),
        Block::Line(outcome(state, subject, strategy)),
    ];
    if let Some(found) = record.strategies.iter().find(|x| x.strategy() == strategy).filter(|x| !x.vertices.is_empty()) {
        blocks.push(Block::Line(state.say(SummaryText::Vertices).to_owned()));
        blocks.push(Block::List((0..found.vertices.len()).filter_map(|index| vertex(state, found, index)).collect()));
    }
    blocks.push(strategies(state, subject));
    blocks
}

/// A vertex of the selected path: its names, what it is, where it is.
fn vertex(state: &State, strategy: &StrategyRecord, index: usize) -> Option<String> {
    let found = strategy.vertices.get(index)?;
    let vertex = &found.vertex;
    let place = match vertex.kind {
        "infinity" => format!("{} {}", state.say(Text::Direction), format::direction(vertex.n_g)),
        _ => format!("{} m", format::position(vertex.position)),
    };
    let fresh = if vertex.kind == "lens" { Text::FreshLens } else { Text::FreshPoint };
    let remarks = [
        found.fresh.then(|| state.say(fresh)),
        vertex.delta.then(|| state.say(SummaryText::Dirac)),
        (index == state.selection.vertex).then(|| state.say(SummaryText::Chosen)),
    ];
    let words: Vec<String> =
        std::iter::once(inspector::what(state, vertex)).chain(remarks.into_iter().flatten().map(str::to_owned)).chain([place]).collect();
    let name = format!("{} = {}", format::indexed('x', index), inspector::own_name(strategy, index));
    Some(fill(state.say(SummaryText::Vertex), &[&name, &words.join("; ")]))
}

/// Every strategy of the sample.
fn strategies(state: &State, subject: &Subject<'_>) -> Block {
    let head = [state.say(Text::HeadStrategy), "(s,t)", state.say(SummaryText::Light), state.say(Text::HeadWeight)];
    let contribution = format!("{} {}, W m⁻² sr⁻¹", state.say(Text::HeadContribution), state.say(InspectText::HeadContribution));
    let rows = subject.record.strategies.iter().map(|x| {
        let strategy = x.strategy();
        let hidden = if inspector::is_hidden(state, x) { state.say(Text::SpokenHidden) } else { "" };
        let light = match inspector::why_not(state, subject.existence, x) {
            Some(why) => format!("{why}{hidden}"),
            None => format!("{}{hidden}", state.say(SummaryText::Yes)),
        };
        let numbers = if x.feasible { [weight(x), format::rgb(x.contribution)] } else { ["–".to_owned(), "–".to_owned()] };
        let [w, c] = numbers;
        let data = [("s", x.s.to_string()), ("t", x.t.to_string()), ("feasible", x.feasible.to_string())];
        let numbers = [("weight", x.mis_weight.to_string()), ("contribution", full(x.contribution))];
        Row {
            cells: vec![role_name(strategy, state.prefs.lang), pair(strategy), light, w, c],
            data: data.into_iter().chain(numbers).collect(),
            chosen: strategy == state.selection.strategy,
        }
    });
    Block::Table {
        caption: state.say(SummaryText::Strategies).to_owned(),
        rows: rows.collect(),
        head: head.into_iter().map(str::to_owned).chain([contribution]).collect(),
    }
}

fn rendering(state: &State, subject: &Subject<'_>) -> Vec<Block> {
    let mut blocks = vec![Block::Heading(state.say(SummaryText::Rendering).to_owned())];
    let Some(frame) = subject.frame else {
        blocks.push(Block::Line(state.say(SummaryText::NoMean).to_owned()));
        return blocks;
    };
    if let Some(mean) = mean(subject.record, frame) {
        let passes = format!("{:.0}", frame.stats.spp.floor());
        blocks.push(Block::Line(fill(state.say(SummaryText::Mean), &[&passes, &format::rgb(mean.to_array())])));
    }
    blocks.extend(status_bar::renderer(state, &frame.stats).into_iter().map(Block::Line));
    blocks
}

fn mean(record: &PathRecord, frame: &Frame) -> Option<Vec3> {
    crate::film::picture::pixel_of(frame.size, &frame.image, record.pixel)
}

/// Three numbers from which the same floats are read again.
fn full(value: [f32; 3]) -> String {
    value.map(|v| v.to_string()).join(",")
}

/// The blocks as HTML; headings are of the second level.
pub fn html(blocks: &[Block]) -> String {
    blocks.iter().map(block).collect()
}

fn block(block: &Block) -> String {
    match block {
        Block::Heading(text) => format!("<h2>{}</h2>", escaped(text)),
        Block::Line(text) => format!("<p>{}</p>", escaped(text)),
        Block::List(items) => {
            let items: String = items.iter().map(|item| format!("<li>{}</li>", escaped(item))).collect();
            format!("<ol start=\"0\">{items}</ol>")
        }
        Block::Table { caption, head, rows } => {
            let head: String = head.iter().map(|name| format!("<th scope=\"col\">{}</th>", escaped(name))).collect();
            let rows: String = rows.iter().map(row).collect();
            format!("<table><caption>{}</caption><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>", escaped(caption))
        }
    }
}

fn row(row: &Row) -> String {
    let data: String = row.data.iter().map(|(name, value)| format!(" data-{name}=\"{}\"", escaped(value))).collect();
    let chosen = if row.chosen { " aria-current=\"true\"" } else { "" };
    let cells = row.cells.iter().enumerate().map(|(index, cell)| match index {
        0 => format!("<th scope=\"row\">{}</th>", escaped(cell)),
        _ => format!("<td>{}</td>", escaped(cell)),
    });
    format!("<tr{data}{chosen}>{}</tr>", cells.collect::<String>())
}

/// Text as it may stand in HTML, in quotes, too. (Names come from people's files.)
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_from_files_are_no_html() {
        let name = "<img src=x onerror=\"alert(1)\">&".to_owned();
        let rows = vec![Row { cells: vec![name.clone(); 2], data: vec![("scene", name.clone())], chosen: true }];
        let table = Block::Table { caption: name.clone(), head: vec![name.clone()], rows };
        let text = html(&[Block::Heading(name.clone()), Block::Line(name.clone()), Block::List(vec![name]), table]);
        assert!(!text.contains("<img") && !text.contains("=\"alert") && !text.contains("&\""), "{text}");
        assert_eq!(text.matches("&lt;img").count(), 8);
    }
}
