//! The pictures that are on show and compared in a pass of the window, and what they hold.

use super::super::live::Live;
use super::super::state::State;
use super::source::{find, quantity};
use super::{Display, Missing, Sourced};
use crate::film::difference::Metric;
use crate::math::Vec3;
use std::borrow::Cow;

/// The two pictures of this pass, as far as they are there.
#[derive(Clone)]
pub struct Pair {
    /// What is on show.
    pub display: Display,
    /// A.
    pub a: Result<Sourced, Missing>,
    /// B, if anything is compared.
    pub b: Option<Result<Sourced, Missing>>,
}

impl Pair {
    /// Finds both.
    pub fn find(state: &State, live: &Live) -> Self {
        let compare = &state.compare;
        Self { display: compare.display(), a: find(state, live, compare.a), b: compare.second().map(|b| find(state, live, b)) }
    }

    /// Do A and B hold different quantities, so that they have no difference?
    pub fn is_odd(&self, state: &State) -> bool {
        let b = state.compare.second();
        b.is_some_and(|b| quantity(state, state.compare.a) != quantity(state, b))
    }

    /// The values that a pixel shows; `right`: of the line that splits the view. `None` where there is no picture.
    pub fn value(&self, pixel: [u32; 2], right: bool, metric: Metric) -> Option<Value> {
        let of = |x: &Result<Sourced, Missing>| x.as_ref().ok()?.content.value(pixel);
        let b = || of(self.b.as_ref()?);
        match self.display {
            Display::A => of(&self.a),
            Display::B => b(),
            Display::Split => {
                if right {
                    b()
                } else {
                    of(&self.a)
                }
            }
            Display::Difference => {
                let (a, b) = (of(&self.a)?.rgb(), b()?.rgb());
                Some(if metric == Metric::Signed { Value::Colour(a - b) } else { Value::Number(metric.of(a, b)) })
            }
        }
    }
}

impl Pair {
    /// The pixels on show; of a difference, its size in every channel. `None` where there is no picture.
    pub fn shown_pixels(&self, metric: Metric) -> Option<Cow<'_, [Vec3]>> {
        let a = self.a.as_ref().ok().map(|x| x.content.pixels());
        let b = self.b.as_ref().and_then(|x| Some(x.as_ref().ok()?.content.pixels()));
        match self.display {
            Display::A | Display::Split => a,
            Display::B => b,
            Display::Difference => {
                let size = |(a, b): (&Vec3, &Vec3)| Vec3::splat(metric.of(*a, *b).abs());
                Some(a?.iter().zip(b?.iter()).map(size).collect())
            }
        }
    }
}

/// What a pixel holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Linear red, green and blue.
    Colour(Vec3),
    /// A number.
    Number(f32),
}

impl Value {
    /// The same as three channels.
    pub fn rgb(self) -> Vec3 {
        match self {
            Self::Colour(rgb) => rgb,
            Self::Number(value) => Vec3::splat(value),
        }
    }

    /// Its numbers.
    pub fn numbers(self) -> Vec<f32> {
        match self {
            Self::Colour(rgb) => rgb.to_array().to_vec(),
            Self::Number(value) => vec![value],
        }
    }
}
