//! The textures of the pyramid's cells. They are tone mapped by a task of their own, and only when a new
//! frame, exposure or tone map asks for it; until a new one is ready the old one stays.

use super::state::{Gain, State};
use super::study::textures::CellTextures;
use crate::bdpt::Strategy;
use crate::engine::Frame;
use crate::film::tonemap::{Look, ToneMap, fitting_exposure, to_srgb8};
use crate::math::Vec3;
use crate::task;
use eframe::egui::{self, Color32, ColorImage, TextureHandle, TextureId, TextureOptions};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// What a texture is made from.
#[derive(Clone, Copy, PartialEq)]
struct Key {
    frame: u64,
    look: Look,
    gain: Gain,
}

struct Request {
    strategy: Strategy,
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

/// The pictures on show, and the task that makes them.
pub struct Pictures {
    /// Those of the cells that show what was counted.
    pub cells: CellTextures,
    slots: HashMap<Strategy, Slot>,
    requests: async_channel::Sender<Request>,
    ready: Receiver<(Strategy, Key, ColorImage)>,
}

impl Pictures {
    /// Starts the task; it ends with this value.
    pub fn new(ctx: &egui::Context) -> Self {
        let (requests, inbox) = async_channel::unbounded();
        let (outbox, ready) = channel();
        let ctx = ctx.clone();
        // Without a thread there are no pictures.
        drop(task::spawn("thumbnails", || develop(inbox, outbox, ctx)));
        Self { cells: CellTextures::default(), slots: HashMap::new(), requests, ready }
    }

    /// Takes in the pictures that are ready.
    pub fn collect(&mut self, ctx: &egui::Context) {
        for (strategy, key, pixels) in self.ready.try_iter() {
            let slot = self.slots.entry(strategy).or_default();
            let options = TextureOptions::LINEAR;
            match &mut slot.texture {
                Some(texture) => texture.set(pixels, options),
                None => slot.texture = Some(ctx.load_texture("picture", pixels, options)),
            }
            slot.shown = Some(key);
        }
    }

    /// A cell of the frame with this number, as far as it is ready.
    pub fn texture(&mut self, state: &State, frame: &Arc<Frame>, number: u64, strategy: Strategy) -> Option<TextureId> {
        let key = Key { frame: number, look: state.look(), gain: state.prefs.gain };
        let slot = self.slots.entry(strategy).or_default();
        // One at a time: what has become stale meanwhile is never made.
        let there = || frame.thumbnails.iter().any(|x| x.strategy == strategy);
        if slot.asked != Some(key) && slot.asked == slot.shown && there() {
            let request = Request { strategy, key, frame: Arc::clone(frame) };
            if self.requests.try_send(request).is_ok() {
                slot.asked = Some(key);
            }
        }
        slot.texture.as_ref().map(TextureHandle::id)
    }
}

async fn develop(inbox: async_channel::Receiver<Request>, outbox: Sender<(Strategy, Key, ColorImage)>, ctx: egui::Context) {
    while let Ok(Request { strategy, key, frame }) = inbox.recv().await {
        task::give_way().await;
        let Some(thumbnail) = frame.thumbnails.iter().find(|x| x.strategy == strategy) else { continue };
        let pixels = &thumbnail.pixels;
        let look = match key.gain {
            Gain::Same => key.look,
            Gain::Each => Look { exposure_ev: fitting_exposure(pixels), offset: 0.0, ..key.look },
        };
        let colour = |radiance: &Vec3| {
            let [r, g, b] = look.rgb8(*radiance);
            Color32::from_rgb(r, g, b)
        };
        let size = thumbnail.size;
        let image = ColorImage::new(size.map(|n| n as usize), pixels.iter().map(colour).collect());
        if outbox.send((strategy, key, image)).is_err() {
            return;
        }
        ctx.request_repaint();
    }
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
    fn a_swatch_shows_hue_not_size() {
        assert_eq!(hue([2e-9, 0.0, 0.0]), Color32::from_rgb(255, 0, 0));
        assert_eq!(hue([0.0; 3]), Color32::TRANSPARENT);
    }
}
