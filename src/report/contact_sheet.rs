//! The pyramid as one picture to look at: the image, and below it a row per path length k, a cell per strategy (s,t).
//!
//! A cell shows the strategy's weighted image C_{s,t} at the exposure of the whole, so that the cells add up to what stands
//! at the top; a row too dark for that is brightened by whole stops, and says so. Cf. Veach 1997, figure 10.2.

use super::canvas::{Canvas, Color, Style, fit, resample, text_width};
use super::role_name;
use crate::bdpt::Strategy;
use crate::film::Rect;
use crate::film::save::Window;
use crate::film::tonemap::ToneMap;
use crate::math::Vec3;

const BACKGROUND: Color = [30, 31, 34];
const CELL_BACKGROUND: Color = [0, 0, 0];
const BRIGHT: Color = [236, 236, 236];
const DIM: Color = [158, 160, 166];

const MARGIN: u32 = 36;
/// Width of the column with the row headings.
const HEADINGS: u32 = 104;
const GAP: u32 = 14;
/// Room for the two lines under a cell, and the space to the next row.
const LABELS: u32 = 38;
const ROW_GAP: u32 = 26;
/// The title's two lines.
const TITLE: u32 = 74;
/// Most stops by which a dark row is brightened.
const MOST_STOPS: f64 = 10.0;

/// What the sheet says about the whole.
#[derive(Clone, Debug)]
pub struct Heading {
    /// The scene.
    pub title: String,
    /// Everything that made the picture: size, samples, K, heuristic, seed.
    pub details: String,
    /// Exposure of the whole, stops.
    pub exposure_ev: f32,
    /// Tone curve of the whole and the cells.
    pub tonemap: ToneMap,
}

struct Cell {
    strategy: Strategy,
    pixels: Vec<Vec3>,
    /// Sum over pixels and channels.
    energy: f64,
}

/// A sheet in the making: the layers are scaled down as they come, none is kept at full size.
pub struct ContactSheet {
    heading: Heading,
    window: Window,
    /// Size of a cell's box, and of the image within.
    cell: Rect,
    picture: Rect,
    whole: Vec<Vec3>,
    cells: Vec<Cell>,
}

impl ContactSheet {
    /// A sheet of the film's `image`, for strategies of at most `max_edges` edges.
    pub fn new(heading: Heading, window: Window, image: &[Vec3], max_edges: u32) -> Self {
        let [width, height] = window.size();
        let wide = (1600 / (max_edges + 1)).clamp(96, 176);
        let tall = (f64::from(wide) * f64::from(height) / f64::from(width)).clamp(0.4 * f64::from(wide), 1.25 * f64::from(wide)) as u32;
        let cell = Rect { x: 0, y: 0, width: wide, height: tall };
        let picture = fit(Rect { x: 0, y: 0, width: 480, height: 480 }, [width, height]);
        let picture = Rect { x: MARGIN, y: MARGIN + TITLE, ..picture };
        let whole = resample(window.pick(image), window.size(), [picture.width, picture.height]);
        Self { heading, window, cell, picture, whole, cells: Vec::new() }
    }

    /// Adds a strategy's weighted image (the full film's pixels).
    pub fn add(&mut self, strategy: Strategy, film: &[Vec3]) {
        let image = fit(self.cell, self.window.size());
        let energy = self.window.pick(film).map(|pixel| f64::from(pixel.element_sum())).sum();
        let pixels = resample(self.window.pick(film), self.window.size(), [image.width, image.height]);
        self.cells.push(Cell { strategy, pixels, energy });
    }

    /// Draws the sheet.
    pub fn draw(&self) -> Canvas {
        let rows = self.rows();
        let widest = rows.iter().map(|row| row.len() as u32).max().unwrap_or(0);
        let pyramid = HEADINGS + widest * (self.cell.width + GAP);
        let text = text_width(14.0, &self.details()).max(self.picture.width as f32 + 40.0 + self.explanation_width()) as u32;
        let width = 2 * MARGIN + pyramid.max(text);
        let top = self.picture.y + self.picture.height + 40;
        let height = top + rows.len() as u32 * (self.cell.height + LABELS + ROW_GAP) - ROW_GAP + MARGIN;
        let mut canvas = Canvas::new([width, height], BACKGROUND);
        self.draw_head(&mut canvas);
        for (index, row) in rows.iter().enumerate() {
            let y = top + index as u32 * (self.cell.height + LABELS + ROW_GAP);
            let indent = (widest - row.len() as u32) * (self.cell.width + GAP) / 2;
            self.draw_row(&mut canvas, row, y, MARGIN + HEADINGS + indent);
        }
        canvas
    }

    /// The cells by path length, shortest first; lengths without a strategy have no row.
    fn rows(&self) -> Vec<Vec<&Cell>> {
        let mut cells: Vec<_> = self.cells.iter().collect();
        cells.sort_by_key(|cell| cell.strategy.index());
        cells.chunk_by(|a, b| a.strategy.edges() == b.strategy.edges()).map(<[_]>::to_vec).collect()
    }

    fn details(&self) -> String {
        format!("{} · {:+.1} EV, {} tone curve", self.heading.details, self.heading.exposure_ev, self.heading.tonemap)
    }

    fn explanation(&self) -> [&'static str; 7] {
        [
            "The picture is the sum of the cells below.",
            "",
            "A row holds the paths of k edges.",
            "Cell (s,t): s vertices walked from the light, t from the eye,",
            "joined, and weighted against the other ways to make the path.",
            "Percentages are shares of the picture's energy.",
            "A row marked +n EV is shown n stops brighter than the picture.",
        ]
    }

    fn explanation_width(&self) -> f32 {
        self.explanation().iter().map(|line| text_width(15.0, line)).fold(0.0, f32::max)
    }

    fn draw_head(&self, canvas: &mut Canvas) {
        let x = MARGIN as f32;
        canvas.text(x, MARGIN as f32 - 6.0, Style { size: 30.0, color: BRIGHT }, &self.heading.title);
        canvas.text(x, MARGIN as f32 + 34.0, Style { size: 14.0, color: DIM }, &self.details());
        canvas.image(self.picture, &self.whole, self.heading.exposure_ev, self.heading.tonemap);
        let beside = (self.picture.x + self.picture.width + 28) as f32;
        for (index, line) in self.explanation().iter().enumerate() {
            let color = if index == 0 { BRIGHT } else { DIM };
            canvas.text(beside, self.picture.y as f32 + 22.0 * index as f32, Style { size: 15.0, color }, line);
        }
    }

    fn draw_row(&self, canvas: &mut Canvas, row: &[&Cell], y: u32, left: u32) {
        let stops = self.stops(row);
        let edges = row.first().map_or(0, |cell| cell.strategy.edges());
        let (x, top) = (MARGIN as f32, y as f32);
        canvas.text(x, top, Style { size: 19.0, color: BRIGHT }, &format!("k = {edges}"));
        canvas.text(x, top + 24.0, Style { size: 14.0, color: DIM }, &format!("({edges} edge{})", if edges == 1 { "" } else { "s" }));
        if stops > 0.0 {
            canvas.text(x, top + 43.0, Style { size: 14.0, color: DIM }, &format!("{stops:+.0} EV"));
        }
        for (index, cell) in row.iter().enumerate() {
            let rect = Rect { x: left + index as u32 * (self.cell.width + GAP), y, ..self.cell };
            self.draw_cell(canvas, cell, rect, stops);
        }
    }

    fn draw_cell(&self, canvas: &mut Canvas, cell: &Cell, rect: Rect, stops: f32) {
        let (middle, below) = ((rect.x + rect.width / 2) as f32, (rect.y + rect.height) as f32);
        canvas.fill(rect, CELL_BACKGROUND);
        if cell.energy > 0.0 {
            canvas.image(fit(rect, self.window.size()), &cell.pixels, self.heading.exposure_ev + stops, self.heading.tonemap);
        } else {
            canvas.text_centred(middle, (rect.y + rect.height / 2) as f32 - 9.0, Style { size: 15.0, color: DIM }, "no energy");
        }
        let Strategy { s, t } = cell.strategy;
        let numbers = format!("({s},{t}) · {}", percent(cell.energy / self.energy()));
        canvas.text_centred(middle, below + 4.0, Style { size: 15.0, color: BRIGHT }, &role_name(cell.strategy));
        canvas.text_centred(middle, below + 22.0, Style { size: 14.0, color: DIM }, &numbers);
    }

    fn energy(&self) -> f64 {
        self.cells.iter().map(|cell| cell.energy).sum()
    }

    /// Whole stops that lift the row's strongest cell to about the picture's mean.
    fn stops(&self, row: &[&Cell]) -> f32 {
        let strongest = row.iter().map(|cell| cell.energy).fold(0.0, f64::max);
        if strongest > 0.0 { (self.energy() / strongest).log2().floor().clamp(0.0, MOST_STOPS) as f32 } else { 0.0 }
    }
}

/// A share as text that never rounds something to nothing.
fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p >= 9.95 => format!("{p:.0} %"),
        p if p >= 0.05 => format!("{p:.1} %"),
        p if p > 0.0 => "< 0.1 %".to_owned(),
        _ => "0 %".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of made-up discs; `size` is the film's.
    fn sheet(size: [u32; 2], max_edges: u32, lens: bool) -> ContactSheet {
        let disc = |strategy: Strategy| -> Vec<Vec3> {
            let (cx, cy) = (0.2 + 0.1 * strategy.s as f32, 0.2 + 0.1 * strategy.t as f32);
            let pixels = (0..size[0] * size[1]).map(|i| ((i % size[0]) as f32 / size[0] as f32, (i / size[0]) as f32 / size[1] as f32));
            let glow = |(x, y): (f32, f32)| (-30.0 * ((x - cx).powi(2) + (y - cy).powi(2))).exp() * 0.5f32.powi(strategy.edges() as i32);
            let lit = if strategy == Strategy::new(2, 3) { 0.0 } else { 1.0 };
            pixels.map(|at| Vec3::new(1.0, 0.8, 0.5 + 0.1 * strategy.s as f32) * (lit * glow(at))).collect()
        };
        let layers: Vec<_> = Strategy::all(max_edges, lens).map(|strategy| (strategy, disc(strategy))).collect();
        let image: Vec<Vec3> = (0..layers[0].1.len()).map(|i| layers.iter().map(|(_, layer)| layer[i]).sum()).collect();
        let details = "512×512 · 64 spp · K = 6 · power heuristic, β = 2 · seed 0".to_owned();
        let heading = Heading { title: "cornell".to_owned(), details, exposure_ev: 0.0, tonemap: ToneMap::Srgb };
        let mut sheet = ContactSheet::new(heading, Window::full(size), &image, max_edges);
        layers.iter().for_each(|(strategy, layer)| sheet.add(*strategy, layer));
        sheet
    }

    #[test]
    fn a_sheet_has_a_row_per_length_and_a_cell_per_strategy() {
        let cells = |lens: bool| sheet([60, 40], 6, lens).rows().iter().map(Vec::len).collect::<Vec<_>>();
        assert_eq!(cells(false), [2, 3, 4, 5, 6, 7]);
        assert_eq!(cells(true), [3, 4, 5, 6, 7, 8], "t = 0 is the last one of its row");
        let sheet = sheet([60, 40], 6, true);
        let canvas = sheet.draw();
        assert_eq!(canvas.rgb.len() as u32, 3 * canvas.size[0] * canvas.size[1]);
        if let Some(path) = std::env::var_os("CONTACT_SHEET") {
            crate::film::save::save_png(path.as_ref(), canvas.size, &canvas.rgb).unwrap();
        }
    }

    #[test]
    fn odd_sizes_draw() {
        for (size, max_edges) in [([1, 1], 1), ([1, 300], 2), ([300, 1], 3), ([3, 2], 20)] {
            sheet(size, max_edges, true).draw();
        }
    }

    #[test]
    fn shares_as_text() {
        let texts = [1.0, 0.382, 0.0312, 0.00001, 0.0].map(percent);
        assert_eq!(texts, ["100 %", "38 %", "3.1 %", "< 0.1 %", "0 %"]);
    }
}
