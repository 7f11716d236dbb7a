//! What checks say: sentences with places for values, so that the window can say them in another language.

use serde::{Serialize, Serializer};
use std::fmt;

/// A table of sentences: `phrases! { Key: "English with {} places"; … }`.
macro_rules! phrases {
    ($($key:ident: $en:literal;)*) => {
        /// A sentence; a `{}` stands for a value, in order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs, reason = "each one says what it means")]
        pub enum Phrase { $($key,)* }

        impl Phrase {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$key,)*];

            /// The sentence in English.
            pub const fn text(self) -> &'static str {
                match self { $(Self::$key => $en,)* }
            }
        }
    };
}

phrases! {
    // Verdicts.
    Passed: "passed";
    Failed: "failed";
    SomeIsMissing: "light is missing";
    TooFew: "not enough samples";
    DoesNotApply: "does not apply";
    // Names.
    NameReplay: "Replay";
    NamePairwise: "Strategies in pairs";
    NameFurnace: "Furnace";
    NameIntegrators: "BDPT = PT = LT";
    NameFinite: "Finite numbers";
    NameGpu: "CPU = GPU";
    NameMissing: "Missing light";
    // What they mean.
    AboutReplay: "Every sampled path is rebuilt from its points alone by every strategy that could have made it: they must agree on its densities and its light, and the weights, each computed on its own, must sum to 1.";
    AboutPairwise: "For every path length, any two strategies must find the same light on the paths that both can make.";
    AboutFurnace: "In a closed room of one diffuse material that glows everywhere, paths of k edges carry exactly L_e ρ^(k−1).";
    AboutIntegrators: "All strategies together, the path tracer's and the light tracer's must find the same light, on the paths that the latter two both can make, all over the picture.";
    AboutFinite: "No contribution, under any weights, may be infinite, no number at all, or negative, and no splat too large to count.";
    AboutGpu: "Both renderers draw the same samples: nearly all their pixels must be equal.";
    AboutMissing: "Some light no strategy in use can bring, however long it renders, such as a point light seen in a mirror by a pinhole. How much? All strategies together say, and where none helps, lights without extent are blurred a little.";
    // What was measured.
    MeasuredReplay: "{} paths rebuilt {} times: p differs by {} at most, f by {}, Σw from 1 by {} (relative; bound {}, which {} paths exceed)";
    MeasuredPairwise: "{} pairs judged, the largest |z| is {} (bound {}, level {} over all pairs); {} pairs had not enough samples";
    MeasuredFurnace: "radiance {} ± {}, exactly {} on paths of at most {} edges; the largest |z| over all lengths is {} (bound {}, level {})";
    MeasuredIntegrators: "PT finds {} ± {} of the light of BDPT, LT {} ± {}; {} comparisons, the largest |z| is {} (bound {}, level {})";
    MeasuredFinite: "{} contributions: {} not finite, {} negative, {} weights outside 0…1; {} passes under {} kinds of weights: {} left out, {} too large";
    MeasuredGpu: "{} of {} values equal to {} after {} passes (at least {} must be); {}";
    MeasuredNothingMissing: "strategies in use make every kind of path of at most {} edges: nothing is missing";
    MeasuredMissing: "about {} % of the light (95 %: {} to {} %), on paths of at most {} edges: {}";
    MeasuredMissingBlurred: "{}; lights without extent are blurred to {} % of the scene's radius, which with half of that would be {} %";
    MeasuredMissingTooRare: "no strategy in use can make {}, but only {} such paths were found in {} samples: too few to say how much is missing";
    // Why a check does not apply.
    OneStrategy: "for no path length are there two strategies that could be compared";
    NoLightAtAll: "the scene has no light";
    NoFamily: "one of the path tracer and the light tracer can make no paths here";
    FurnaceMaterial: "not all surfaces are of one plain diffuse material that emits";
    FurnaceLights: "there are other lights than glowing surfaces";
    FurnaceOpen: "the room is not closed, or not all of it glows inwards";
    OnlyLongOnesMissing: "only paths of more than {} edges are missing, which are not looked at";
    GpuCannot: "the GPU does not render here. {}.";
    // What failures mean, and where to look.
    WrongDensity: "Two strategies disagree about the density of the same path (ln p differs by {}): the weights are wrong, and where that p divides f, so is the image.";
    LookDensity: "A path with k = {} made by {}, rebuilt as {}: {} differs most. src/bdpt/path.rs: p_{s+1}/p_s = p_light[s]/p_eye[s] (Veach 10.9); walks in src/bdpt/walk.rs.";
    WrongWeights: "The weights of one path, each computed by its own strategy, sum to 1 ± {}: light is lost or counted twice.";
    LookWeights: "A path with k = {} made by {}. src/bdpt/mis.rs: w_s = (n_s p_s)^β / Σ_i (n_i p_i)^β; what goes into it, src/bdpt/path.rs.";
    WrongLight: "Two strategies find different light on the same path (ln f differs by {}): one of them is too bright or too dark.";
    LookLight: "A path with k = {} made by {}, rebuilt as {}. src/bdpt/connect.rs: C*_{s,t} = α^L_s c_{s,t} α^E_t / n, f = C* n p; f must not depend on who made the path (src/scene/bsdf.rs).";
    WrongForms: "The renderers' fast form of a weight differs from its definition by {}.";
    LookForms: "A path with k = {} made by {}, seen as {}. src/bdpt/mis.rs: mis_weight against mis_weights_by_definition.";
    Impossible: "A strategy that cannot make a path has a weight on it: its share of the light is lost.";
    LookImpossible: "A path with k = {} made by {}, the weight of {}. src/bdpt/path.rs: `samplable`; src/bdpt/mis.rs.";
    NotRebuilt: "A strategy that should be able to make a path cannot rebuild it ({} of {}).";
    LookNotRebuilt: "A path with k = {} made by {}, to be rebuilt as {}. src/bdpt/replay.rs says where it stops; src/bdpt/visibility.rs, if the edge is blocked one way only.";
    WrongPair: "On paths with k = {}, {} finds {} ± {} of the light that {} finds: one of the two has a wrong density or a wrong contribution.";
    LookPair: "Most suspicious is {}, which takes part in {} of {} failed pairs. {}";
    LookEither: "Only these two are apart: either may be wrong. {}: {} {}: {}";
    LookHitsLight: "src/bdpt/path.rs, join_at_light, and src/scene/light.rs: L_e and P_A(x₀).";
    LookNextEvent: "src/bdpt/ends.rs: the fresh light end; src/bdpt/connect.rs: c_{1,t}.";
    LookLightTracer: "src/bdpt/connect.rs, lens_factor, and src/scene/camera.rs: W_e and P_σ⊥.";
    LookHitsLens: "src/bdpt/crossing.rs: p = m + l/d, W_e / n.";
    LookConnect: "src/bdpt/connect.rs: c_{s,t} = f G V f; src/scene/bsdf.rs.";
    WrongFurnace: "Paths with k = {} carry {} ± {} where they must carry {}: light is lost or counted twice.";
    WrongFurnaceSum: "All lengths together carry {} ± {} where they must carry {}: light is lost or counted twice.";
    LookFurnace: "src/bdpt/mis.rs and path.rs (weights), src/bdpt/context.rs (survival: q must be in p both ways), src/scene/bsdf/lambert.rs. Run `replay` and `pairwise`, which say which strategy.";
    WrongIntegrator: "{} finds {} ± {} of the light of all strategies, in {}: on the same paths.";
    LookIntegrator: "Of the strategies that {} has for itself, the one that brings most of the light there is {}. Run `pairwise`, which compares each.";
    WholePicture: "the whole picture";
    PartOfPicture: "the pixels from {} to {}";
    WrongFinite: "{} contributions were {}: they are left out of the image, whose light is then missing, or spoil it.";
    NotFinite: "no finite numbers";
    Negative: "negative";
    WeightOutside: "weighted by less than 0 or more than 1";
    LeftOut: "left out while rendering";
    TooLarge: "too large to be counted as splats";
    LookFinite: "{} under the {} weights. src/bdpt/connect.rs: G of a short edge, a density that is 0 or overflows f32.";
    LookSplat: "src/bdpt/render.rs, splat_quantum; src/film/mod.rs: 2⁶³ quanta a pass.";
    WrongGpu: "The renderers agree in {} of all values only: a kernel computes something else.";
    LightIsMissing: "The picture is darker than the scene: no strategy in use can make {}, however many samples are taken.";
    LookAperture: "Open the aperture: light then runs into the lens (t = 0).";
    LookExtent: "Give the lights an extent: eye paths then run into them (s = 0).";
    LookTakeIn: "Take removed strategies in again.";
    Both: "{} {}";
    LookGpu: "Largest difference at pixel {} of the {} picture. shaders/*.wgsl against its twin of the same name in src/; tests/gpu finds the function.";
}

/// A sentence with its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// The sentence.
    pub phrase: Phrase,
    /// What stands in its places.
    pub values: Vec<Value>,
}

/// What stands in a place of a sentence.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// The same in every language: a number, a name.
    Plain(String),
    /// A sentence of its own.
    Said(Box<Said>),
}

impl Said {
    /// A sentence whose values are the same in every language.
    pub fn new(phrase: Phrase, values: &[&dyn fmt::Display]) -> Self {
        Self { phrase, values: values.iter().map(|value| Value::Plain(value.to_string())).collect() }
    }

    /// One value more.
    pub fn with(mut self, value: Self) -> Self {
        self.values.push(Value::Said(Box::new(value)));
        self
    }

    /// One plain value more.
    pub fn and(mut self, value: &dyn fmt::Display) -> Self {
        self.values.push(Value::Plain(value.to_string()));
        self
    }

    /// The sentence in the language that `text` speaks.
    pub fn told(&self, text: &impl Fn(Phrase) -> &'static str) -> String {
        let mut parts = text(self.phrase).split("{}");
        let mut told = parts.next().unwrap_or_default().to_owned();
        let mut values = self.values.iter();
        for part in parts {
            match values.next() {
                Some(Value::Plain(value)) => told.push_str(value),
                Some(Value::Said(said)) => told.push_str(&said.told(text)),
                None => {}
            }
            told.push_str(part);
        }
        told
    }
}

impl From<Phrase> for Said {
    fn from(phrase: Phrase) -> Self {
        Self { phrase, values: Vec::new() }
    }
}

impl fmt::Display for Said {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.told(&Phrase::text))
    }
}

impl Serialize for Said {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Three digits: "0.0314", "3.1e-7"; ∞ for what is not finite.
pub fn short(x: f64) -> String {
    let size = x.abs();
    match size {
        _ if !x.is_finite() => "∞".to_owned(),
        0.0 => "0".to_owned(),
        _ if (1e-3..1e5).contains(&size) => format!("{x:.*}", (2 - size.log10().floor() as i32).max(0) as usize),
        _ => format!("{x:.1e}"),
    }
}

/// Four decimals, for ratios near 1.
pub fn ratio(x: f64) -> String {
    if x.is_finite() { format!("{x:.4}") } else { "∞".to_owned() }
}

/// "next event (1,2)" is long for a table; "(1,2)" says as much.
pub fn pair(s: u32, t: u32) -> String {
    format!("({s},{t})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_are_filled_in_order_and_inside_each_other() {
        let inner = Said::new(Phrase::PartOfPicture, &[&"0,0", &"9,9"]);
        let outer = Said::new(Phrase::WrongIntegrator, &[&"PT", &"0.5", &"0.1"]).with(inner);
        assert_eq!(
            outer.to_string(),
            "PT finds 0.5 ± 0.1 of the light of all strategies, in the pixels from 0,0 to 9,9: on the same paths."
        );
        assert_eq!(Said::from(Phrase::Passed).to_string(), "passed");
    }

    #[test]
    fn numbers_are_short_and_always_readable() {
        let texts = [0.0, 1.0, 0.0123, 123.4, -4.56, 1.234e-7, 2.0e9, f64::NAN, f64::INFINITY].map(short);
        assert_eq!(texts, ["0", "1.00", "0.0123", "123", "-4.56", "1.2e-7", "2.0e9", "∞", "∞"]);
    }
}
