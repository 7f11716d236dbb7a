//! The textures of the cells that show a survey's pictures: tone mapped or in false colour, a few of them in a pass of the window.

use super::scale;
use crate::bdpt::Strategy;
use crate::engine::{CellStudy, Study, Values};
use crate::film::colourmap::viridis;
use crate::film::tonemap::{Look, fitting_exposure};
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
    look: (Look, Gain),
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
        let look = (state.look(), state.prefs.gain);
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
            let look = match state.prefs.gain {
                Gain::Same => state.look(),
                Gain::Each => Look { exposure_ev: fitting_exposure(pixels), offset: 0.0, ..state.look() },
            };
            pixels.iter().map(|&radiance| rgb(look.rgb8(radiance))).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::Mode;
    use crate::math::Vec3;
    use crate::ui::state::Preferences;

    #[test]
    fn cells_are_shown_with_the_views_offset_unless_each_has_its_own_gain() {
        let values = Values::Colour(vec![Vec3::splat(0.25)]);
        let cell =
            CellStudy { strategy: Strategy::new(1, 2), outcomes: Default::default(), size: [1, 1], values, range: None, share: None };
        let study = Study { generation: 0, mode: Mode::Raw, spp: 1.0, block: 1, cells: vec![cell.clone()], range: None, pixel: None };
        let mut state = State::new(Preferences::default(), [1, 1]);
        (state.exposure, state.view.offset) = (1.0, 0.125);
        let mut pixel = |gain| {
            state.prefs.gain = gain;
            develop(&state, &study, &cell).unwrap().pixels[0]
        };
        assert_eq!(pixel(Gain::Same), rgb(Look::default().rgb8(Vec3::splat(0.625))));
        assert_eq!(pixel(Gain::Each), rgb(Look::default().rgb8(Vec3::splat(0.9))));
    }
}
