//! How the values of a link are written and read: short, exact (what is read back is the very same number), and never trusted.

use crate::bdpt::{Heuristic, HeuristicKind, MAX_EDGES, Strategy};
use crate::rng::Sampler;
use crate::ui::top_bar::{BETAS, CUTOFFS};
use std::fmt::{Display, LowerExp};
use std::ops::RangeInclusive;
use std::str::FromStr;

/// What was read: the value, and whether it is another one than was written, because that was out of bounds.
pub type Read<T> = Option<(T, bool)>;

/// How a kind of values is written.
pub trait Codec {
    /// The values.
    type Value;
    /// Writes one; nothing at all for what needs no words.
    fn write(&self, value: &Self::Value) -> String;
    /// Reads one; `None` if the text is none.
    fn read(&self, text: &str) -> Read<Self::Value>;
}

/// A number from the first to the second; what lies outside becomes the nearest that does not.
pub struct Between<T>(pub T, pub T);

impl<T: Copy> Between<T> {
    /// What a control of the window can be set to.
    pub const fn within(range: &RangeInclusive<T>) -> Self {
        Self(*range.start(), *range.end())
    }
}

impl<T: Copy + PartialOrd + FromStr + Display + LowerExp> Codec for Between<T> {
    type Value = T;

    fn write(&self, value: &T) -> String {
        short(*value)
    }

    fn read(&self, text: &str) -> Read<T> {
        // Rust knows more words for numbers than people do.
        let written = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte)) || ["inf", "-inf"].contains(&text);
        let large = text.parse::<f64>().ok().filter(|_| written)?;
        match text.parse::<T>() {
            Ok(value) if value < self.0 => Some((self.0, true)),
            Ok(value) if value > self.1 => Some((self.1, true)),
            Ok(value) => Some((value, false)),
            // A whole number in powers of ten, or one that has no place in its type.
            Err(_) if large.fract() == 0.0 || large.is_infinite() => match format!("{large:.0}").parse::<T>() {
                Ok(value) if value >= self.0 && value <= self.1 => Some((value, false)),
                _ => Some((if large < 0.0 { self.0 } else { self.1 }, true)),
            },
            Err(_) => None,
        }
    }
}

/// A number with enough digits to tell it from all others, and in powers of ten where that is much shorter.
pub fn short<T: Display + LowerExp>(value: T) -> String {
    let (plain, powers) = (value.to_string(), format!("{value:e}"));
    if powers.len() + 3 < plain.len() { powers } else { plain }
}

/// One of a few words.
pub struct OneOf<T: 'static>(pub &'static [(T, &'static str)]);

impl<T: Copy + PartialEq> Codec for OneOf<T> {
    type Value = T;

    fn write(&self, value: &T) -> String {
        self.0.iter().find(|(other, _)| other == value).map_or("", |(_, word)| *word).to_owned()
    }

    fn read(&self, text: &str) -> Read<T> {
        self.0.iter().find(|(_, word)| *word == text).map(|(value, _)| (*value, false))
    }
}

/// Yes or no.
pub const SWITCH: OneOf<bool> = OneOf(&[(true, "on"), (false, "off")]);

/// Which of some things there are; "none" of them is a word, too.
pub struct Flags<const N: usize>(pub [&'static str; N]);

impl<const N: usize> Codec for Flags<N> {
    type Value = [bool; N];

    fn write(&self, value: &[bool; N]) -> String {
        let words: Vec<&str> = self.0.iter().zip(value).filter(|(_, on)| **on).map(|(word, _)| *word).collect();
        if words.is_empty() { "none".to_owned() } else { words.join(",") }
    }

    fn read(&self, text: &str) -> Read<[bool; N]> {
        let mut value = [false; N];
        for word in text.split(',').filter(|word| *word != "none") {
            *value.get_mut(self.0.iter().position(|known| *known == word)?)? = true;
        }
        Some((value, false))
    }
}

/// So many values of a kind, with a letter between them.
pub struct Several<C, const N: usize>(pub C, pub char);

impl<C: Codec, const N: usize> Codec for Several<C, N> {
    type Value = [C::Value; N];

    fn write(&self, values: &Self::Value) -> String {
        values.iter().map(|value| self.0.write(value)).collect::<Vec<_>>().join(&self.1.to_string())
    }

    fn read(&self, text: &str) -> Read<Self::Value> {
        let read: Vec<(C::Value, bool)> = text.split(self.1).take(N + 1).map(|word| self.0.read(word)).collect::<Option<_>>()?;
        let bounded = read.iter().any(|(_, bounded)| *bounded);
        let values: Vec<C::Value> = read.into_iter().map(|(value, _)| value).collect();
        Some((values.try_into().ok()?, bounded))
    }
}

/// A value that need not be.
pub struct Maybe<C>(pub C);

impl<C: Codec> Codec for Maybe<C> {
    type Value = Option<C::Value>;

    fn write(&self, value: &Self::Value) -> String {
        value.as_ref().map_or_else(String::new, |value| self.0.write(value))
    }

    fn read(&self, text: &str) -> Read<Self::Value> {
        self.0.read(text).map(|(value, bounded)| (Some(value), bounded))
    }
}

/// A name, of at most so many bytes.
pub struct Name(pub usize);

impl Codec for Name {
    type Value = String;

    fn write(&self, value: &String) -> String {
        value.clone()
    }

    fn read(&self, text: &str) -> Read<String> {
        let good = !text.is_empty() && text.len() <= self.0 && !text.chars().any(char::is_control);
        good.then(|| (text.to_owned(), false))
    }
}

/// A strategy, "s1t2".
pub struct OneStrategy;

impl Codec for OneStrategy {
    type Value = Strategy;

    fn write(&self, value: &Strategy) -> String {
        value.to_string()
    }

    fn read(&self, text: &str) -> Read<Strategy> {
        Strategy::parse(text).filter(|strategy| strategy.edges() as usize <= MAX_EDGES).map(|strategy| (strategy, false))
    }
}

/// The heuristics by their names on the command line.
pub const HEURISTICS: OneOf<HeuristicKind> = OneOf(&[
    (HeuristicKind::Power, "power"),
    (HeuristicKind::Balance, "balance"),
    (HeuristicKind::Max, "max"),
    (HeuristicKind::Cutoff, "cutoff"),
    (HeuristicKind::Uniform, "uniform"),
]);
/// How random numbers go together.
pub const SAMPLERS: OneOf<Sampler> = OneOf(&[(Sampler::Hash, "hash"), (Sampler::Sobol, "sobol")]);
/// What β may be.
pub const BETA: Between<f32> = Between::within(&BETAS);
/// What the cutoff's threshold may be.
pub const CUTOFF: Between<f32> = Between::within(&CUTOFFS);

/// A heuristic with its parameters, "power,2,0.1".
pub struct WholeHeuristic;

impl Codec for WholeHeuristic {
    type Value = Heuristic;

    fn write(&self, value: &Heuristic) -> String {
        [HEURISTICS.write(&value.kind), BETA.write(&value.beta), CUTOFF.write(&value.cutoff)].join(",")
    }

    fn read(&self, text: &str) -> Read<Heuristic> {
        let mut words = text.splitn(3, ',');
        let (kind, _) = HEURISTICS.read(words.next()?)?;
        let ((beta, high), (cutoff, wide)) = (BETA.read(words.next()?)?, CUTOFF.read(words.next()?)?);
        Some((Heuristic { kind, beta, cutoff }, high || wide))
    }
}

/// Text as it may stand behind the # of an address: letters, digits and a few signs as they are, every other byte as %XX.
pub fn encode(text: &str) -> String {
    let mut encoded = String::with_capacity(text.len());
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.~,".contains(&byte) {
            encoded.push(char::from(byte));
        } else {
            encoded.push_str(&format!("%{byte:02X}"));
        }
    }
    encoded
}

/// What that says; `None` if it is no text. What needs no %XX may have it, and the other way round.
pub fn decode(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        rest = after;
        if *first != b'%' {
            bytes.push(*first);
            continue;
        }
        let [high, low, after @ ..] = after else { return None };
        let digit = |byte: u8| char::from(byte).to_digit(16);
        bytes.push((digit(*high)? * 16 + digit(*low)?) as u8);
        rest = after;
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_exactly() {
        let real = Between(f32::MIN, f32::MAX);
        for bits in (0..u32::MAX).step_by(65_521) {
            let value = f32::from_bits(bits);
            if value.is_finite() {
                assert_eq!(real.read(&real.write(&value)).map(|(back, _)| back.to_bits()), Some(bits), "{value:?}");
            }
        }
        assert_eq!([real.write(&0.5), real.write(&1e-30), real.write(&-3e20)], ["0.5", "1e-30", "-3e20"]);
        let whole = Between(0, u32::MAX);
        for value in (0..u32::MAX).step_by(99_991).chain([1000, 30_000, 1_000_000, 4_000_000_000]) {
            assert_eq!(whole.read(&whole.write(&value)), Some((value, false)));
        }
        assert_eq!([whole.write(&30_000), whole.write(&1_000_000)], ["30000", "1e6"]);
        assert_eq!([whole.read("1e3"), whole.read("4294967296")], [Some((1000, false)), Some((u32::MAX, true))]);
        assert_eq!(Between(0.0, f32::INFINITY).read("inf"), Some((f32::INFINITY, false)));
    }

    #[test]
    fn what_is_out_of_bounds_is_brought_in_and_what_is_no_number_is_none() {
        let edges = Between(1u32, 64);
        assert_eq!([edges.read("6"), edges.read("1000"), edges.read("0")], [Some((6, false)), Some((64, true)), Some((1, true))]);
        assert_eq!(
            [edges.read("-5"), edges.read("1e39"), edges.read("99999999999999999999")],
            [(1, true), (64, true), (64, true)].map(Some)
        );
        assert_eq!(["", "nan", "NaN", "6.5", "six", "infinity", "0x10", "6 "].map(|text| edges.read(text)), [None; 8]);
        let real = Between(-20.0f32, 20.0);
        assert_eq!([real.read("1e39"), real.read("-inf"), real.read("nan")], [Some((20.0, true)), Some((-20.0, true)), None]);
    }

    #[test]
    fn only_so_many_values_are_as_many() {
        let two = Several::<_, 2>(Between(0u32, 9), ',');
        assert_eq!([two.read("1,2"), two.read("1,20")], [Some(([1, 2], false)), Some(([1, 9], true))]);
        assert_eq!(["", "1", "1,2,3", "1,,2", "1,x"].map(|text| two.read(text)), [None; 5]);
        let flags = Flags(["a", "b", "c"]);
        assert_eq!([flags.write(&[true, false, true]), flags.write(&[false; 3])], ["a,c", "none"]);
        assert_eq!(
            [flags.read("c,a"), flags.read("none"), flags.read("d")],
            [Some(([true, false, true], false)), Some(([false; 3], false)), None]
        );
    }

    #[test]
    fn a_strategy_has_a_place_in_the_pyramid() {
        assert_eq!(OneStrategy.read("s1t2"), Some((Strategy::new(1, 2), false)));
        assert_eq!(["s65t65", "s0t1", "s33t33", "nonsense"].map(|text| OneStrategy.read(text)), [None; 4]);
    }

    #[test]
    fn any_text_survives_an_address() {
        for text in ["", "red wall", "灯=1&%#+", "a,b-c_d.e~f", "\u{0}\u{7f}"] {
            let encoded = encode(text);
            assert!(encoded.bytes().all(|byte| byte.is_ascii_graphic() && !b"&=#+ ".contains(&byte)), "{encoded}");
            assert_eq!(decode(&encoded).as_deref(), Some(text));
        }
        assert_eq!(["%", "%2", "%zz", "%ff", "a%80"].map(decode), [const { None::<String> }; 5]);
        assert_eq!(decode("灯 (1)").as_deref(), Some("灯 (1)"));
    }
}
