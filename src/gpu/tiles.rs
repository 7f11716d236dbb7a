//! How the film and the work are cut so that every piece fits a binding.
//!
//! A *tile* is a run of rows with all their layers: pixel layers as f32, splat layers as 64-bit counters in two words, both
//! [layer][channel][pixel]. A *batch* is what is traced at once: every n-th row of a tile, so that a first look shows all of it.

use super::GpuError;
use super::params::{Batch, SplatRecord};
use crate::bdpt::Vertex;
use crate::film::Layers;

/// Most bytes the film may take on the device.
pub const FILM_BUDGET: u64 = if cfg!(target_arch = "wasm32") { 256 << 20 } else { 1 << 30 };
/// Most pairs of a batch: more would not make a large device busier.
const MOST_PAIRS: u64 = 1 << 20;
/// Most bytes a batch's light vertices may take.
const MOST_VERTEX_BYTES: u64 = 512 << 20;

/// What a film needs.
#[derive(Clone, Copy, Debug)]
pub struct Need {
    /// Film size, pixels.
    pub size: [u32; 2],
    /// Its layers.
    pub layers: Layers,
    /// Most vertices of a light subpath.
    pub light_vertices: u64,
    /// Most splats of a light subpath.
    pub splats: u64,
}

/// The film's tiles, and the largest batch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tiles {
    /// Film size, pixels.
    pub size: [u32; 2],
    /// Rows of each tile; the last may have fewer.
    pub rows: u32,
    /// Most rows of a batch.
    pub batch_rows: u32,
    /// Bytes of a pixel's pixel layers.
    pub pixel_bytes: u64,
    /// Bytes of a pixel's splat layers.
    pub splat_bytes: u64,
}

impl Tiles {
    /// Cuts a film so that no piece exceeds `binding` bytes.
    ///
    /// # Errors
    /// If the film exceeds `budget` bytes, or a single row a binding.
    pub fn new(need: &Need, binding: u64, budget: u64) -> Result<Self, GpuError> {
        let [width, height] = need.size.map(u64::from);
        let (pixel_bytes, splat_bytes) = (12 * need.layers.pixel as u64, 24 * need.layers.splat as u64);
        let film = width * height * (pixel_bytes + splat_bytes);
        if film > budget {
            return Err(GpuError::TooLarge { what: "the film with its layers", need: film, have: budget });
        }
        // Light vertices and splat records of a batch.
        let vertices = width * need.light_vertices.max(1) * size_of::<Vertex>() as u64;
        let records = width * need.splats.max(1) * size_of::<SplatRecord>() as u64 + super::HEADER;
        let row = width * pixel_bytes.max(splat_bytes);
        let largest = row.max(vertices).max(records);
        if largest > binding {
            let what = if largest == row { "a single row of the film" } else { "the light subpaths of a single row" };
            return Err(GpuError::TooLarge { what, need: largest, have: binding });
        }
        let rows = (binding / row).min(height);
        let most =
            (binding.min(MOST_VERTEX_BYTES) / vertices).min((binding - super::HEADER) / (records - super::HEADER)).min(MOST_PAIRS / width);
        Ok(Self { size: need.size, rows: rows as u32, batch_rows: most.clamp(1, rows) as u32, pixel_bytes, splat_bytes })
    }

    /// First row and number of rows of each tile.
    pub fn list(&self) -> Vec<(u32, u32)> {
        let height = self.size[1];
        (0..height).step_by(self.rows as usize).map(|first| (first, self.rows.min(height - first))).collect()
    }

    /// Pixels of a tile of so many rows.
    pub fn pixels(&self, rows: u32) -> u32 {
        rows * self.size[0]
    }

    /// The batches of a pass, of at most so many rows each, with the number of each one's tile.
    pub fn batches(&self, rows: u32) -> Vec<(usize, Batch)> {
        let rows = rows.clamp(1, self.batch_rows);
        let of_tile = |(tile, (first, count)): (usize, (u32, u32))| {
            let step = count.div_ceil(rows);
            (0..step).map(move |phase| {
                let batch = Batch {
                    pass_number: 0,
                    first_row: first + phase,
                    row_step: step,
                    pairs: (count - phase).div_ceil(step) * self.size[0],
                    tile_row: first,
                    tile_pixels: self.pixels(count),
                    sample: 0,
                    _pad0: 0,
                };
                (tile, batch)
            })
        };
        self.list().into_iter().enumerate().flat_map(of_tile).collect()
    }
}

/// The rows of a batch.
pub fn rows_of(batch: &Batch, width: u32) -> impl Iterator<Item = u32> + use<> {
    (batch.first_row..).step_by(batch.row_step as usize).take((batch.pairs / width) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEED: Need = Need { size: [512, 512], layers: Layers { pixel: 21, splat: 7 }, light_vertices: 7, splats: 6 };

    #[test]
    fn every_row_is_in_one_batch() {
        for (binding, rows) in [(128 << 20, 1000), (128 << 20, 7), (3 << 20, 5), (600_000, 1)] {
            let tiles = Tiles::new(&NEED, binding, 1 << 30).unwrap();
            let mut seen = vec![0; 512];
            for (tile, batch) in tiles.batches(rows) {
                let (first, count) = tiles.list()[tile];
                for row in rows_of(&batch, 512) {
                    assert!(row >= first && row < first + count && batch.tile_row == first);
                    seen[row as usize] += 1;
                }
                assert!(u64::from(batch.tile_pixels) * tiles.pixel_bytes.max(tiles.splat_bytes) <= binding);
                assert!(u64::from(batch.pairs) * 7 * 128 <= binding);
            }
            assert!(seen.iter().all(|&n| n == 1));
        }
    }

    #[test]
    fn what_does_not_fit_is_said() {
        let error = |binding, budget| Tiles::new(&NEED, binding, budget).unwrap_err().to_string();
        assert_eq!(error(128 << 20, 64 << 20), "the film with its layers would take 105 MiB of graphics memory, 64 MiB are allowed");
        assert!(error(100_000, 1 << 30).starts_with("the light subpaths of a single row"));
    }
}
