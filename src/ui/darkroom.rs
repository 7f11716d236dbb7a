//! The image view's pictures as textures: developed by a task of their own, and only when a picture or the way it is shown has
//! changed; until a new print is ready the old one stays.

use super::compare::{Content, Display, Pair, Source, Sourced, Value};
use super::state::State;
use crate::film::colourmap::{false_colour, signed, viridis};
use crate::film::difference::{Figures, Metric, figures};
use crate::film::scale::Scale;
use crate::film::tonemap::Look;
use crate::math::Vec3;
use crate::task;
use eframe::egui::{self, Color32, ColorImage, TextureFilter, TextureHandle, TextureId, TextureOptions};
use std::sync::mpsc::{Receiver, channel};

/// What is no number: found in no scale, and in few pictures.
const MARK: Color32 = Color32::from_rgb(0xff, 0x00, 0xff);
/// Where there is no number to show.
const NOTHING: Color32 = Color32::from_gray(0x30);

/// How a pixel becomes a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recipe {
    /// A picture.
    Look(Look),
    /// Numbers.
    Number(Scale),
    /// A difference, at an exposure (stops).
    Difference(Metric, f32),
}

impl Recipe {
    /// How the state shows a picture.
    pub fn of(state: &State, content: &Content) -> Self {
        content.scale().map_or(Self::Look(state.look()), Self::Number)
    }

    /// The colour of a value; `None` if it is no finite number.
    pub fn colour(self, value: Value) -> Option<Color32> {
        let number = |value: Value| match value {
            Value::Number(number) => number,
            Value::Colour(rgb) => rgb.element_sum() / 3.0,
        };
        let [r, g, b] = match self {
            // A mean over no samples.
            Self::Number(_) if number(value).is_nan() => return Some(NOTHING),
            _ if !value.rgb().is_finite() => return None,
            Self::Look(look) => look.rgb8(value.rgb()),
            Self::Number(scale) => match number(value) {
                0.0 => [0; 3],
                number => viridis(scale.place(number).unwrap_or(0.0)),
            },
            Self::Difference(Metric::Signed, ev) => signed(number(value) * ev.exp2()),
            Self::Difference(_, ev) => false_colour(number(value) * ev.exp2()),
        };
        Some(Color32::from_rgb(r, g, b))
    }
}

/// What is on show, and how; of a split view, A. `None` where there is no picture.
pub fn on_show(state: &State, pair: &Pair) -> Option<(Vec<Content>, Recipe)> {
    let content = |found: &Result<Sourced, _>| found.as_ref().ok().map(|found| found.content.clone());
    let (a, b) = (content(&pair.a), pair.b.as_ref().and_then(content));
    let alone = |content: Content| (Recipe::of(state, &content), content);
    let (recipe, content) = match pair.display {
        Display::A | Display::Split => alone(a?),
        Display::B => alone(b?),
        Display::Difference => return Some((vec![a?, b?], Recipe::Difference(state.compare.metric, state.exposure))),
    };
    Some((vec![content], recipe))
}

/// Which of the view's pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// A.
    A,
    /// B.
    B,
    /// What they differ by.
    Difference,
}

/// What a print is made from.
#[derive(Clone, PartialEq)]
struct Key {
    from: Vec<(Source, [u64; 2])>,
    recipe: Recipe,
}

struct Order {
    place: Place,
    key: Key,
    contents: Vec<Content>,
}

/// A picture that is ready.
struct Ready {
    place: Place,
    key: Key,
    developed: Developed,
}

/// A picture in the colours of the screen.
pub struct Developed {
    /// Itself.
    pub image: ColorImage,
    marked: usize,
    figures: Option<Figures>,
}

#[derive(Default)]
struct Slot {
    texture: Option<TextureHandle>,
    asked: Option<Key>,
    shown: Option<Key>,
    marked: usize,
    figures: Option<Figures>,
}

/// A picture on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Print {
    /// Its texture.
    pub texture: TextureId,
    /// Pixels that hold no finite number.
    pub marked: usize,
    /// Of a difference.
    pub figures: Option<Figures>,
}

/// The view's pictures, and the task that develops them.
pub struct Darkroom {
    slots: [Slot; 3],
    orders: async_channel::Sender<Order>,
    ready: Receiver<Ready>,
}

impl Darkroom {
    /// Starts the task; it ends with this value.
    pub fn new(ctx: &egui::Context) -> Self {
        let (orders, inbox) = async_channel::unbounded::<Order>();
        let (outbox, ready) = channel();
        let ctx = ctx.clone();
        let work = || async move {
            while let Ok(Order { place, key, contents }) = inbox.recv().await {
                task::give_way().await;
                let developed = develop(&contents, key.recipe);
                if outbox.send(Ready { place, key, developed }).is_err() {
                    return;
                }
                ctx.request_repaint();
            }
        };
        // Without a thread there are no pictures.
        drop(task::spawn("pictures", work));
        Self { slots: Default::default(), orders, ready }
    }

    /// Takes in the prints that are ready.
    pub fn collect(&mut self, ctx: &egui::Context) {
        for Ready { place, key, developed } in self.ready.try_iter() {
            let Developed { image, marked, figures } = developed;
            let slot = &mut self.slots[place as usize];
            // Enlarged, a picture shows its pixels.
            let options = TextureOptions { magnification: TextureFilter::Nearest, ..TextureOptions::LINEAR };
            match &mut slot.texture {
                Some(texture) => texture.set(image, options),
                None => slot.texture = Some(ctx.load_texture("view", image, options)),
            }
            (slot.shown, slot.marked, slot.figures) = (Some(key), marked, figures);
        }
    }

    /// A picture on its own, as far as it is ready; while a new state of it is made, the last one.
    pub fn picture(&mut self, state: &State, place: Place, source: Source, found: Option<&Sourced>) -> Option<Print> {
        if let Some(found) = found {
            self.order(place, &[found], Recipe::of(state, &found.content));
        }
        self.print(place, &[source])
    }

    /// What the two pictures differ by.
    pub fn difference(&mut self, state: &State, pair: &Pair) -> Option<Print> {
        let sources = [state.compare.a, state.compare.second()?];
        if let (Ok(a), Some(Ok(b))) = (&pair.a, &pair.b) {
            self.order(Place::Difference, &[a, b], Recipe::Difference(state.compare.metric, state.exposure));
        }
        self.print(Place::Difference, &sources)
    }

    fn order(&mut self, place: Place, found: &[&Sourced], recipe: Recipe) {
        let key = Key { from: found.iter().map(|x| (x.source, x.stamp)).collect(), recipe };
        let slot = &mut self.slots[place as usize];
        // One at a time: what has become stale meanwhile is never made.
        if slot.asked.as_ref() != Some(&key) && slot.asked == slot.shown {
            let order = Order { place, key: key.clone(), contents: found.iter().map(|x| x.content.clone()).collect() };
            if self.orders.try_send(order).is_ok() {
                slot.asked = Some(key);
            }
        }
    }

    /// The newest print, if it is of these.
    fn print(&self, place: Place, sources: &[Source]) -> Option<Print> {
        let slot = &self.slots[place as usize];
        let same = slot.shown.as_ref()?.from.iter().map(|(source, _)| source).eq(sources);
        let texture = slot.texture.as_ref().filter(|_| same)?.id();
        Some(Print { texture, marked: slot.marked, figures: slot.figures })
    }
}

/// Develops a picture, or the difference of two.
pub fn develop(contents: &[Content], recipe: Recipe) -> Developed {
    let size = contents.first().map_or([0; 2], Content::size);
    let pictures: Vec<_> = contents.iter().map(Content::pixels).collect();
    let (mut marked, mut compared) = (0, None);
    let mut colour = |value: Value| {
        recipe.colour(value).unwrap_or_else(|| {
            marked += 1;
            MARK
        })
    };
    let pixels = match (&pictures[..], recipe) {
        ([a, b], Recipe::Difference(metric, _)) => {
            compared = Some(figures(size, a, b));
            let value = |(a, b): (&Vec3, &Vec3)| if b.is_finite() { Value::Number(metric.of(*a, *b)) } else { Value::Number(f32::NAN) };
            a.iter().zip(b.iter()).map(value).map(&mut colour).collect()
        }
        (all, _) => all.first().map_or(Vec::new(), |pixels| pixels.iter().map(|rgb| colour(Value::Colour(*rgb))).collect()),
    };
    let image = ColorImage::new(size.map(|n| n as usize), pixels);
    Developed { image, marked, figures: compared }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::picture::Picture;
    use std::sync::Arc;

    fn order(pictures: &[Vec<Vec3>], recipe: Recipe) -> Developed {
        let content = |pixels: &Vec<Vec3>| Content::Kept(Arc::new(Picture { size: [3, 1], pixels: pixels.clone() }), None);
        develop(&pictures.iter().map(content).collect::<Vec<_>>(), recipe)
    }

    #[test]
    fn what_is_no_number_is_marked_and_counted() {
        let pixels = vec![Vec3::NAN, Vec3::splat(0.5), Vec3::INFINITY];
        let ready = order(std::slice::from_ref(&pixels), Recipe::Look(Look::default()));
        assert_eq!((ready.marked, ready.image.pixels[0], ready.image.pixels[2]), (2, MARK, MARK));
        assert_eq!(ready.image.pixels[1], Color32::from_gray(188));
        let ready = order(&[pixels, vec![Vec3::ZERO; 3]], Recipe::Difference(Metric::Signed, 0.0));
        assert_eq!((ready.marked, ready.figures.map(|x| x.left_out)), (2, Some(2)));
    }

    #[test]
    fn a_difference_has_the_sign_of_a() {
        let (a, b) = (vec![Vec3::ONE, Vec3::ZERO, Vec3::ONE], vec![Vec3::ZERO, Vec3::ONE, Vec3::ONE]);
        let ready = order(&[a, b], Recipe::Difference(Metric::Signed, 0.0));
        let [more, less, same] = [0, 1, 2].map(|i| ready.image.pixels[i]);
        assert!(more.r() > more.b() && less.b() > less.r());
        assert_eq!(same, Color32::BLACK);
        assert_eq!(ready.figures.map(|x| (x.mean, x.max_absolute)), Some((0.0, 1.0)));
    }

    #[test]
    fn a_mean_over_nothing_is_not_an_error() {
        let recipe = Recipe::Number(Scale::linear([0.0, 1.0]));
        assert_eq!(recipe.colour(Value::Number(f32::NAN)), Some(NOTHING));
        assert_eq!(recipe.colour(Value::Number(f32::INFINITY)), None);
        assert_eq!(recipe.colour(Value::Number(0.0)), Some(Color32::BLACK));
    }
}
