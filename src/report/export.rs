//! What there is to take away of a sample: the record as JSON, its tables as CSV, its diagram as SVG. The command line and the
//! window write the very same bytes.

pub(super) mod csv;
mod svg;
pub(super) mod svg_parts;

pub use csv::{strategies_csv, vertices_csv};
pub use svg::diagram_svg;

use crate::bdpt::record::StrategyRecord;
use crate::bdpt::{PathRecord, Strategy};

/// The record as `inspect --json` prints it; the message says what could not be written.
pub fn record_json(record: &PathRecord) -> Result<String, String> {
    serde_json::to_string_pretty(record).map(|json| json + "\n").map_err(|error| error.to_string())
}

/// The strategy to draw large where none was chosen: the one that contributes most; one that stays in its pixel, if there is any.
pub fn brightest(record: &PathRecord) -> Option<Strategy> {
    let size = |x: &StrategyRecord| (x.strategy().stays_in_pixel(), x.contribution.iter().sum::<f32>());
    let order = |a: (bool, f32), b: (bool, f32)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1));
    record.strategies.iter().filter(|x| x.feasible).max_by(|a, b| order(size(a), size(b))).map(StrategyRecord::strategy)
}

/// A file's name without its ending for what is saved of a sample: scene, pixel and sample.
pub fn file_stem(scene: &str, pixel: [u32; 2], sample: u32) -> String {
    format!("{}-x{}y{}-s{sample}", scene_stem(scene), pixel[0], pixel[1])
}

/// A scene's name as a part of a file's name: of a path the file, and only letters that every system takes.
pub fn scene_stem(scene: &str) -> String {
    let file = scene.rsplit(['/', '\\']).next().unwrap_or_default();
    let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
    let plain: String = stem.chars().map(|c| if c.is_alphanumeric() || c == '-' || c == '_' { c } else { '-' }).collect();
    if plain.is_empty() { "scene".to_owned() } else { plain }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_hold_what_every_system_takes() {
        assert_eq!(file_stem("cornell", [12, 3], 4), "cornell-x12y3-s4");
        assert_eq!(scene_stem("/home/me/my scene: 2.glb"), "my-scene--2");
        assert_eq!(scene_stem("a\\b.gltf"), "b");
        assert_eq!(scene_stem(""), "scene");
    }
}
