//! A picture that can be shown, by what it is; found anew in every pass, because most of them change while one looks.

use super::super::format;
use super::super::live::Live;
use super::super::state::State;
use super::super::study::mode_texts;
use super::super::text::{ErrorText, Lang, Text, ViewText, fill};
use super::super::widgets::full_name;
use super::{About, Kept, Rendered};
use crate::bdpt::{HeuristicKind, Settings, Strategy, StrategySet};
use crate::engine::{self, Frame, Mode, Values};
use crate::film::picture::{Picture, pixel_of};
use crate::film::scale::Scale;
use crate::math::Vec3;
use std::borrow::Cow;
use std::sync::Arc;

/// Which picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// The image being rendered.
    Image,
    /// A strategy's, in full size.
    Strategy(Strategy, Mode),
    /// A kept one, by its number.
    Kept(u32),
    /// The reference that is rendered meanwhile.
    Reference,
}

/// Its pixels.
#[derive(Clone)]
pub enum Content {
    /// The image.
    Frame(Arc<Frame>),
    /// A strategy's.
    Engine(Arc<engine::Picture>),
    /// A kept one, with the scale of its numbers if it holds numbers.
    Kept(Arc<Picture>, Option<Scale>),
}

impl Content {
    /// Size, pixels.
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Frame(frame) => frame.size,
            Self::Engine(picture) => picture.size,
            Self::Kept(picture, _) => picture.size,
        }
    }

    /// What it holds at a pixel; `None` outside.
    pub fn value(&self, at: [u32; 2]) -> Option<super::Value> {
        let size = self.size();
        let colour = |pixels: &[Vec3]| pixel_of(size, pixels, at).map(super::Value::Colour);
        match self {
            Self::Frame(frame) => colour(&frame.image),
            Self::Kept(picture, None) => colour(&picture.pixels),
            Self::Kept(picture, Some(_)) => pixel_of(size, &picture.pixels, at).map(|grey| super::Value::Number(grey.x)),
            Self::Engine(picture) => match &picture.values {
                Values::Colour(pixels) => colour(pixels),
                Values::Scalar(numbers) => {
                    let inside = at[0] < size[0] && at[1] < size[1];
                    let index = at[1] as usize * size[0] as usize + at[0] as usize;
                    numbers.get(index).filter(|_| inside).map(|number| super::Value::Number(*number))
                }
            },
        }
    }

    /// Its pixels as colours; numbers are grey.
    pub fn pixels(&self) -> Cow<'_, [Vec3]> {
        match self {
            Self::Frame(frame) => Cow::Borrowed(&frame.image),
            Self::Kept(picture, _) => Cow::Borrowed(&picture.pixels),
            Self::Engine(picture) => match &picture.values {
                Values::Colour(pixels) => Cow::Borrowed(pixels),
                Values::Scalar(numbers) => numbers.iter().map(|number| Vec3::splat(*number)).collect(),
            },
        }
    }

    /// The scale of its numbers, if it holds numbers instead of colours.
    pub fn scale(&self) -> Option<Scale> {
        if let Self::Kept(_, scale) = self {
            return *scale;
        }
        let Self::Engine(picture) = self else { return None };
        let engine::Source::Strategy(_, mode) = picture.source else { return None };
        if mode.is_colour() {
            return None;
        }
        match mode {
            Mode::Weight => Some(Scale::linear([0.0, 1.0])),
            _ => Some(picture.range.and_then(Scale::logarithmic).unwrap_or(Scale::linear([0.0, 1.0]))),
        }
    }
}

/// A picture, and what tells it from an older state of itself.
#[derive(Clone)]
pub struct Sourced {
    /// Which one.
    pub source: Source,
    /// Differs where the pixels do.
    pub stamp: [u64; 2],
    /// The pixels.
    pub content: Content,
}

/// Why there is no picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// It is being made.
    Coming,
    /// It has another size than the film.
    Size([u32; 2]),
    /// The strategy does not take part.
    NotThere,
}

/// Does a strategy take part in what is rendered?
pub fn takes_part(state: &State, live: &Live, strategy: Strategy) -> bool {
    let settings = &state.settings;
    strategy.edges() <= settings.max_edges && settings.strategies.contains(strategy) && live.existence().absence(strategy).is_none()
}

/// Finds a picture.
pub fn find(state: &State, live: &Live, source: Source) -> Result<Sourced, Missing> {
    let found = match source {
        Source::Image => {
            let frame = live.frame().ok_or(Missing::Coming)?;
            Sourced { source, stamp: [0, live.frame_number()], content: Content::Frame(Arc::clone(frame)) }
        }
        Source::Strategy(strategy, mode) => {
            if !takes_part(state, live, strategy) {
                return Err(Missing::NotThere);
            }
            let asked = live.engine().and_then(|engine| engine.picture(engine::Source::Strategy(strategy, mode)));
            let picture = asked.ok_or(Missing::Coming)?;
            Sourced { source, stamp: [picture.generation, picture.spp.to_bits()], content: Content::Engine(picture) }
        }
        Source::Kept(id) => {
            let kept = state.compare.kept.iter().find(|kept| kept.id == id).ok_or(Missing::NotThere)?;
            Sourced { source, stamp: [0, u64::from(id)], content: Content::Kept(Arc::clone(&kept.picture), kept.scale) }
        }
        Source::Reference if state.compare.reference != Some(source) => return Err(Missing::NotThere),
        Source::Reference => {
            let reference = live.reference().ok_or(Missing::Coming)?;
            Sourced { source, stamp: [0, u64::from(reference.version)], content: Content::Kept(reference.picture, None) }
        }
    };
    match found.content.size() {
        size if size == state.size => Ok(found),
        // The image follows in a moment.
        _ if !matches!(source, Source::Kept(_)) => Err(Missing::Coming),
        size => Err(Missing::Size(size)),
    }
}

/// What a picture's values are: radiances (of the image, a strategy or a file), or what else a strategy's picture shows.
pub fn quantity(state: &State, source: Source) -> Option<Mode> {
    match source {
        Source::Strategy(_, mode) if !mode.is_colour() => Some(mode),
        Source::Kept(id) => match state.compare.kept.iter().find(|kept| kept.id == id).map(|kept| &kept.about) {
            Some(About::Rendered(rendered)) if rendered.source != source => quantity(state, rendered.source),
            _ => None,
        },
        _ => None,
    }
}

/// A mode's name.
fn mode_name(mode: Mode, lang: Lang) -> &'static str {
    mode_texts(mode)[0].in_language(lang)
}

/// A few words: "image", "(2,2) weighted", "kept 3".
pub fn short_name(state: &State, source: Source) -> String {
    match source {
        Source::Image => state.say(ViewText::TheImage).to_owned(),
        Source::Strategy(strategy, mode) => format!("({},{}) {}", strategy.s, strategy.t, mode_name(mode, state.prefs.lang)),
        Source::Kept(id) => match state.compare.kept.iter().find(|kept| kept.id == id) {
            Some(Kept { about: About::File(name), .. }) => name.clone(),
            _ => fill(state.say(ViewText::KeptNumber), &[&id.to_string()]),
        },
        Source::Reference => state.say(ErrorText::Reference).to_owned(),
    }
}

/// All there is to say: which picture, by which estimator, of how many samples in which time.
pub fn name(state: &State, live: &Live, source: Source) -> String {
    let what = match source {
        Source::Strategy(strategy, mode) => format!("{}, {}", full_name(strategy, state.prefs.lang), mode_name(mode, state.prefs.lang)),
        _ => short_name(state, source),
    };
    match rendered(state, live, source) {
        Some(rendered) => format!("{what} · {}", describe(&rendered, source, state.prefs.lang)),
        None => what,
    }
}

/// What a picture was rendered with, if it was; `None` while the picture on show is still that of the job before.
pub fn rendered(state: &State, live: &Live, source: Source) -> Option<Rendered> {
    if let Source::Kept(id) = source {
        let kept = state.compare.kept.iter().find(|kept| kept.id == id)?;
        return match &kept.about {
            About::Rendered(rendered) => Some((**rendered).clone()),
            About::File(_) => None,
        };
    }
    let (frame, engine) = (live.frame()?, live.engine()?);
    if frame.generation != engine.generation() {
        return None;
    }
    // What is counted or rendered beside the image has samples of its own.
    let (spp, seconds) = match source {
        Source::Reference => {
            let reference = live.reference()?;
            (f64::from(reference.spp), Some(reference.seconds))
        }
        Source::Strategy(strategy, mode) => {
            let picture = engine.picture(engine::Source::Strategy(strategy, mode))?;
            (picture.spp, (mode == Mode::Weighted).then_some(frame.stats.seconds))
        }
        _ => (frame.stats.spp, Some(frame.stats.seconds)),
    };
    let job = engine.job();
    let right = source == Source::Reference;
    let settings = if right { Settings { strategies: StrategySet::ALL, ..job.settings } } else { job.settings };
    Some(Rendered {
        source,
        scene: job.scene.name.clone(),
        edited: !job.scene.edits.is_empty(),
        moved: job.pose.is_some(),
        lens: job.lens,
        settings,
        hidden: if right { 0 } else { state.left_out(&live.existence()).0 },
        spp,
        seconds,
    })
}

/// "BDPT · power β = 2 · 64 spp · 3.2 s"; what is shown itself needs no second word of what it is.
fn describe(rendered: &Rendered, shown: Source, lang: Lang) -> String {
    let mut words = Vec::new();
    if let (Source::Kept(_), Source::Strategy(strategy, mode)) = (shown, rendered.source) {
        words.push(format!("({},{}) {}", strategy.s, strategy.t, mode_name(mode, lang)));
    }
    words.extend(changes(rendered, lang));
    words.push(integrator(&rendered.settings.strategies, lang).to_owned());
    words.push(heuristic(&rendered.settings, lang));
    if rendered.hidden > 0 {
        words.push(fill(Text::HiddenCount.in_language(lang), &[&rendered.hidden.to_string()]));
    }
    let spp = samples(rendered.spp);
    words.push(match rendered.seconds {
        Some(seconds) => fill(ViewText::SppAndTime.in_language(lang), &[&spp, &format::short(seconds)]),
        None => fill(ViewText::Spp.in_language(lang), &[&spp]),
    });
    words.join(" · ")
}

/// What was other than the scene's file has it: "edited scene", "camera moved", "lens 0.0200 m, focus 3.00 m".
fn changes(rendered: &Rendered, lang: Lang) -> Vec<String> {
    let metres = |length: f32| if length.is_finite() { format::short(f64::from(length)) } else { "∞".to_owned() };
    let words = |said: bool, text: ViewText| said.then(|| text.in_language(lang).to_owned());
    let lens = rendered.lens.map(|lens| match lens.radius {
        0.0 => Text::Pinhole.in_language(lang).to_owned(),
        radius => fill(ViewText::ChosenLens.in_language(lang), &[&metres(radius), &metres(lens.focus_distance)]),
    });
    [words(rendered.edited, ViewText::EditedScene), words(rendered.moved, ViewText::CameraMoved), lens].into_iter().flatten().collect()
}

/// Samples per pixel, whole where they are.
pub fn samples(spp: f64) -> String {
    if (spp - spp.round()).abs() < 0.05 { format!("{spp:.0}") } else { format!("{spp:.1}") }
}

/// A set of strategies by the integrator that it is.
pub fn integrator(set: &StrategySet, lang: Lang) -> &'static str {
    if *set == StrategySet::ALL {
        Text::IntegratorAll.in_language(lang)
    } else if *set == StrategySet::path_tracer() {
        Text::IntegratorPt.in_language(lang)
    } else if *set == StrategySet::light_tracer() {
        Text::IntegratorLt.in_language(lang)
    } else {
        ViewText::SomeStrategies.in_language(lang)
    }
}

fn heuristic(settings: &Settings, lang: Lang) -> String {
    let (text, parameter) = match settings.heuristic.kind {
        HeuristicKind::Power => (Text::Power, format!(" β = {}", settings.heuristic.beta)),
        HeuristicKind::Balance => (Text::Balance, String::new()),
        HeuristicKind::Max => (Text::Max, String::new()),
        HeuristicKind::Cutoff => (Text::Cutoff, format!(" A = {}", settings.heuristic.cutoff)),
        HeuristicKind::Uniform => (Text::Uniform, String::new()),
    };
    format!("{}{parameter}", text.in_language(lang))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Lens;

    #[test]
    fn a_label_says_estimator_samples_and_time() {
        let mut rendered = Rendered {
            source: Source::Image,
            scene: "cornell".into(),
            edited: false,
            moved: false,
            lens: None,
            settings: Settings::default(),
            hidden: 0,
            spp: 64.0,
            seconds: Some(3.21),
        };
        assert_eq!(describe(&rendered, Source::Kept(1), Lang::En), "BDPT · power β = 2 · 64 spp, 3.21 s");
        rendered.settings.strategies = StrategySet::path_tracer();
        rendered.settings.heuristic.kind = HeuristicKind::Balance;
        (rendered.hidden, rendered.spp, rendered.seconds) = (2, 1.25, None);
        rendered.source = Source::Strategy(Strategy::new(1, 2), Mode::Raw);
        assert_eq!(describe(&rendered, Source::Kept(1), Lang::En), "(1,2) unweighted C* · PT · balance · 2 hidden · 1.2 spp");
        (rendered.edited, rendered.moved, rendered.hidden, rendered.source) = (true, true, 0, Source::Image);
        rendered.lens = Some(Lens { radius: 0.02, focus_distance: f32::INFINITY });
        let changed = "edited scene · camera moved · lens 0.0200 m, focus ∞ m · PT · balance · 1.2 spp";
        assert_eq!(describe(&rendered, Source::Kept(1), Lang::En), changed);
        rendered.lens = Some(Lens { radius: 0.0, focus_distance: 1.0 });
        assert!(describe(&rendered, Source::Kept(1), Lang::Zh).starts_with("场景已更改 · 相机已移动 · 针孔"));
    }
}
