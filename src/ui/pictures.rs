//! The textures of the image and of the pyramid's cells. They are tone mapped on a thread of their own, and only when a new
//! frame, exposure or tone map asks for it; until a new one is ready the old one stays.

use super::state::{Gain, State};
use super::study::textures::CellTextures;
use crate::bdpt::Strategy;
use crate::engine::Frame;
use crate::film::tonemap::{ToneMap, to_srgb8};
use crate::math::Vec3;
use eframe::egui::{self, Color32, ColorImage, TextureFilter, TextureHandle, TextureId, TextureOptions};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Which picture: the image, or a strategy's cell.
type Target = Option<Strategy>;

/// What a texture is made from.
#[derive(Clone, Copy, PartialEq)]
struct Key {
    frame: u64,
    exposure: f32,
    tonemap: ToneMap,
    gain: Gain,
}

struct Request {
    target: Target,
    key: Key,
    frame: Arc<Frame>,
}

/// A picture on show, and the one asked for.
#[derive(Default)]
struct Slot {
    texture: Option<TextureHandle>,
    shown: Option<Key>,
    asked: Option<Key>,
}

/// The pictures on show, and the thread that makes them.
pub struct Pictures {
    /// Those of the cells that show what was counted.
    pub cells: CellTextures,
    slots: HashMap<Target, Slot>,
    requests: Sender<Request>,
    ready: Receiver<(Target, Key, ColorImage)>,
}

impl Pictures {
    /// Starts the thread; it ends with this value.
    pub fn new(ctx: &egui::Context) -> Self {
        let (requests, inbox) = channel();
        let (outbox, ready) = channel();
        let ctx = ctx.clone();
        std::thread::spawn(move || develop(&inbox, &outbox, &ctx));
        Self { cells: CellTextures::default(), slots: HashMap::new(), requests, ready }
    }

    /// Takes in the pictures that are ready.
    pub fn collect(&mut self, ctx: &egui::Context) {
        for (target, key, pixels) in self.ready.try_iter() {
            let slot = self.slots.entry(target).or_default();
            // Enlarged, the image shows its pixels; a cell is a smooth miniature.
            let magnification = if target.is_none() { TextureFilter::Nearest } else { TextureFilter::Linear };
            let options = TextureOptions { magnification, ..TextureOptions::LINEAR };
            match &mut slot.texture {
                Some(texture) => texture.set(pixels, options),
                None => slot.texture = Some(ctx.load_texture("picture", pixels, options)),
            }
            slot.shown = Some(key);
        }
    }

    /// The image (`target` is `None`) or a cell of the frame with this number, as far as it is ready.
    pub fn texture(&mut self, state: &State, frame: &Arc<Frame>, number: u64, target: Target) -> Option<TextureId> {
        let gain = if target.is_none() { Gain::Same } else { state.prefs.gain };
        let key = Key { frame: number, exposure: state.exposure, tonemap: state.tonemap, gain };
        let slot = self.slots.entry(target).or_default();
        // One at a time: what has become stale meanwhile is never made.
        if slot.asked != Some(key) && slot.asked == slot.shown {
            let request = Request { target, key, frame: Arc::clone(frame) };
            if self.requests.send(request).is_ok() {
                slot.asked = Some(key);
            }
        }
        slot.texture.as_ref().map(TextureHandle::id)
    }
}

fn develop(inbox: &Receiver<Request>, outbox: &Sender<(Target, Key, ColorImage)>, ctx: &egui::Context) {
    for Request { target, key, frame } in inbox {
        let thumbnail = target.and_then(|strategy| frame.thumbnails.iter().find(|x| x.strategy == strategy));
        let (size, pixels) = thumbnail.map_or((frame.size, &frame.image), |x| (x.size, &x.pixels));
        let exposure = if key.gain == Gain::Each { own_exposure(pixels) } else { key.exposure };
        let colour = |radiance: &Vec3| {
            let [r, g, b] = to_srgb8(*radiance, exposure, key.tonemap);
            Color32::from_rgb(r, g, b)
        };
        let image = ColorImage::new(size.map(|n| n as usize), pixels.iter().map(colour).collect());
        if outbox.send((target, key, image)).is_err() {
            return;
        }
        ctx.request_repaint();
    }
}

/// The exposure that shows a picture's bright parts (its 99th percentile) just below white.
fn own_exposure(pixels: &[Vec3]) -> f32 {
    let mut lit: Vec<f32> = pixels.iter().map(|p| p.max_element()).filter(|v| *v > 0.0 && v.is_finite()).collect();
    if lit.is_empty() {
        return 0.0;
    }
    let index = (lit.len() - 1) * 99 / 100;
    let (_, bright, _) = lit.select_nth_unstable_by(index, f32::total_cmp);
    (0.9 / *bright).log2()
}

/// A colour's hue at full brightness: what a swatch shows of a contribution that may be of any size.
pub fn hue(rgb: [f32; 3]) -> Color32 {
    let colour = Vec3::from(rgb);
    let largest = colour.max_element();
    if largest > 0.0 && largest.is_finite() {
        let [r, g, b] = to_srgb8(colour / largest, 0.0, ToneMap::Srgb);
        Color32::from_rgb(r, g, b)
    } else {
        Color32::TRANSPARENT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_is_exposed_for_its_bright_parts() {
        assert_eq!(own_exposure(&[Vec3::ZERO; 4]), 0.0);
        let pixels: Vec<Vec3> = (1..=100).map(|i| Vec3::splat(i as f32 * 1e-3)).collect();
        assert!((own_exposure(&pixels).exp2() * 0.099 - 0.9).abs() < 1e-3);
    }

    #[test]
    fn a_swatch_shows_hue_not_size() {
        assert_eq!(hue([2e-9, 0.0, 0.0]), Color32::from_rgb(255, 0, 0));
        assert_eq!(hue([0.0; 3]), Color32::TRANSPARENT);
    }
}
