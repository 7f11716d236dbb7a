//! The textures of the cells that show a survey's pictures: tone mapped or in false colour, a few of them in a pass of the window.

use super::scale;
use crate::bdpt::Strategy;
use crate::engine::{CellStudy, Study, Values};
use crate::film::colourmap::viridis;
use crate::film::tonemap::{ToneMap, fitting_exposure, to_srgb8};
use crate::ui::state::{Gain, State};
use eframe::egui::{Color32, ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;
use web_time::Instant;

/// Time a pass of the window may spend on them.
const BUDGET: Duration = Duration::from_millis(4);

/// What a texture was made from.
struct Made {
    study: Arc<Study>,
    look: (f32, ToneMap, Gain),
}

/// The textures on show.
#[derive(Default)]
pub struct CellTextures {
    slots: HashMap<Strategy, (TextureHandle, Made)>,
    pass: u64,
    spent: Duration,
}

impl CellTextures {
    /// A cell's texture; an older one of the same mode if the time of this pass is used up.
    pub fn texture(&mut self, ctx: &Context, state: &State, study: &Arc<Study>, cell: &CellStudy) -> Option<TextureId> {
        if self.pass != ctx.cumulative_pass_nr() {
            (self.pass, self.spent) = (ctx.cumulative_pass_nr(), Duration::ZERO);
        }
        let look = (state.exposure, state.tonemap, state.prefs.gain);
        let old = self.slots.get(&cell.strategy).filter(|(_, made)| made.study.mode == study.mode);
        let fresh = old.is_some_and(|(_, made)| Arc::ptr_eq(&made.study, study) && made.look == look);
        if fresh || self.spent >= BUDGET {
            if !fresh {
                ctx.request_repaint();
            }
            return old.map(|(texture, _)| texture.id());
        }
        let began = Instant::now();
        let image = develop(state, study, cell)?;
        let options = if study.mode.is_colour() { TextureOptions::LINEAR } else { TextureOptions::NEAREST };
        let made = Made { study: Arc::clone(study), look };
        let id = match self.slots.remove(&cell.strategy) {
            Some((mut texture, _)) => {
                texture.set(image, options);
                let id = texture.id();
                self.slots.insert(cell.strategy, (texture, made));
                id
            }
            None => {
                let texture = ctx.load_texture("study", image, options);
                let id = texture.id();
                self.slots.insert(cell.strategy, (texture, made));
                id
            }
        };
        self.spent += began.elapsed();
        Some(id)
    }
}

/// A cell's picture as it is shown; `None` if there is none.
fn develop(state: &State, study: &Study, cell: &CellStudy) -> Option<ColorImage> {
    let pixels: Vec<Color32> = match &cell.values {
        Values::Colour(pixels) => {
            let exposure = if state.prefs.gain == Gain::Each { fitting_exposure(pixels) } else { state.exposure };
            pixels.iter().map(|&radiance| rgb(to_srgb8(radiance, exposure, state.tonemap))).collect()
        }
        Values::Scalar(values) => {
            let scale = scale(state, study, cell);
            // Where there is no number, the ground is seen.
            let place = |value: f32| value.is_finite().then(|| scale.and_then(|scale| scale.place(value)).unwrap_or(0.0));
            values.iter().map(|&value| place(value).map_or(Color32::TRANSPARENT, |place| rgb(viridis(place)))).collect()
        }
    };
    (!pixels.is_empty()).then(|| ColorImage::new(cell.size.map(|n| n as usize), pixels))
}

fn rgb([r, g, b]: [u8; 3]) -> Color32 {
    Color32::from_rgb(r, g, b)
}
