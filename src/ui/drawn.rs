//! What draws the window in a page, and why it is not WebGPU. The page's address may ask for something: `?renderer=webgpu`,
//! `webgl` or `cpu`.

use super::text::{Lang, WebText, fill};
use crate::engine::Backend;

/// What the window is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Draws {
    /// WebGPU; the renderer can use it, too.
    WebGpu,
    /// WebGL 2, which cannot trace paths.
    WebGl,
}

/// What the page's address asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    /// Nothing: the best there is.
    Any,
    /// The window and the image by WebGPU.
    WebGpu,
    /// The window by WebGL 2, and the image by the CPU.
    WebGl,
    /// The image by the CPU.
    Cpu,
}

impl Wish {
    /// Reads the value of `renderer` in the address.
    ///
    /// # Errors
    /// If there is no such renderer: the value.
    pub fn read(value: Option<&str>) -> Result<Self, &str> {
        match value {
            None | Some("") => Ok(Self::Any),
            Some("webgpu") => Ok(Self::WebGpu),
            Some("webgl") => Ok(Self::WebGl),
            Some("cpu") => Ok(Self::Cpu),
            Some(other) => Err(other),
        }
    }

    /// The value that asks for it.
    fn name(self) -> &'static str {
        match self {
            Self::Any => "",
            Self::WebGpu => "webgpu",
            Self::WebGl => "webgl",
            Self::Cpu => "cpu",
        }
    }
}

/// Why the window is not drawn with WebGPU.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    /// The address asks for something else.
    Asked,
    /// The page came over plain HTTP.
    NotSecure,
    /// The browser does not know it.
    NoWebGpu,
    /// The browser gives no adapter.
    Refused,
    /// It could not be started, or was lost again and again: what the browser says.
    Failed(String),
}

/// How the window is drawn, and who renders the image unless a person chooses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// What the window is drawn with.
    pub by: Draws,
    /// Why that is not WebGPU, if so.
    pub why: Option<Why>,
    /// What was asked for.
    pub wish: Wish,
    /// Who renders the image whatever the preferences say, until a person chooses.
    pub renders: Option<Backend>,
}

impl Drawn {
    /// The window drawn by `by`, for a reason if that is not WebGPU.
    pub fn new(by: Draws, why: Option<Why>, wish: Wish) -> Self {
        let renders = match (by, wish) {
            (Draws::WebGl, _) | (_, Wish::Cpu) => Some(Backend::Cpu),
            (Draws::WebGpu, Wish::WebGpu) => Some(Backend::Gpu),
            (Draws::WebGpu, _) => None,
        };
        Self { by, why, wish, renders }
    }

    /// What is to be known about it, in a sentence; `None` if all is as usual.
    pub fn sentence(&self, lang: Lang) -> Option<String> {
        let what = match (self.by, self.renders) {
            (Draws::WebGl, Some(_)) => WebText::WebGlAndCpu,
            (Draws::WebGl, None) => WebText::WebGl,
            (Draws::WebGpu, Some(Backend::Cpu)) => WebText::Cpu,
            (Draws::WebGpu, Some(_)) => WebText::WebGpu,
            (Draws::WebGpu, None) => return None,
        };
        let asked = || fill(WebText::Asked.in_language(lang), &[self.wish.name()]);
        let why = match &self.why {
            None | Some(Why::Asked) => asked(),
            Some(Why::NotSecure) => WebText::NotSecure.in_language(lang).to_owned(),
            Some(Why::NoWebGpu) => WebText::NoWebGpu.in_language(lang).to_owned(),
            Some(Why::Refused) => WebText::Refused.in_language(lang).to_owned(),
            Some(Why::Failed(error)) => fill(WebText::Failed.in_language(lang), &[error]),
        };
        Some(fill(what.in_language(lang), &[&why]))
    }

    /// Is it less than what was asked for?
    pub fn disappoints(&self) -> bool {
        self.wish == Wish::WebGpu && self.by != Draws::WebGpu
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_asks_for_a_renderer() {
        let read = [None, Some(""), Some("webgpu"), Some("webgl"), Some("cpu"), Some("vulkan"), Some("CPU")].map(Wish::read);
        let any = Ok(Wish::Any);
        assert_eq!(read, [any, any, Ok(Wish::WebGpu), Ok(Wish::WebGl), Ok(Wish::Cpu), Err("vulkan"), Err("CPU")]);
        for wish in [Wish::WebGpu, Wish::WebGl, Wish::Cpu] {
            assert_eq!(Wish::read(Some(wish.name())), Ok(wish));
        }
    }

    #[test]
    fn who_renders_follows_from_what_draws_and_what_is_asked_for() {
        let renders = |by, wish| Drawn::new(by, None, wish).renders;
        assert_eq!(renders(Draws::WebGpu, Wish::Any), None);
        assert_eq!(renders(Draws::WebGpu, Wish::WebGpu), Some(Backend::Gpu));
        assert_eq!(renders(Draws::WebGpu, Wish::Cpu), Some(Backend::Cpu));
        for wish in [Wish::Any, Wish::WebGpu, Wish::WebGl, Wish::Cpu] {
            assert_eq!(renders(Draws::WebGl, wish), Some(Backend::Cpu));
        }
    }

    #[test]
    fn the_sentence_says_why_in_both_languages() {
        assert_eq!(Drawn::new(Draws::WebGpu, None, Wish::Any).sentence(Lang::En), None);
        let failed = Why::Failed("device lost".to_owned());
        let cases = [
            (Draws::WebGpu, None, Wish::Cpu, "?renderer=cpu"),
            (Draws::WebGpu, None, Wish::WebGpu, "?renderer=webgpu"),
            (Draws::WebGl, Some(Why::Asked), Wish::WebGl, "?renderer=webgl"),
            (Draws::WebGl, Some(Why::NotSecure), Wish::Any, "HTTPS"),
            (Draws::WebGl, Some(Why::NoWebGpu), Wish::Any, "WebGPU"),
            (Draws::WebGl, Some(Why::Refused), Wish::WebGpu, "WebGPU"),
            (Draws::WebGl, Some(failed), Wish::Any, "device lost"),
        ];
        for (by, why, wish, part) in cases {
            let drawn = Drawn::new(by, why, wish);
            for lang in [Lang::En, Lang::Zh] {
                let sentence = drawn.sentence(lang).unwrap();
                assert!(sentence.contains(part) && !sentence.contains("{}"), "{sentence}");
            }
        }
    }

    #[test]
    fn only_a_wish_for_webgpu_can_be_disappointed() {
        assert!(Drawn::new(Draws::WebGl, Some(Why::Refused), Wish::WebGpu).disappoints());
        assert!(!Drawn::new(Draws::WebGl, Some(Why::Refused), Wish::Any).disappoints());
        assert!(!Drawn::new(Draws::WebGpu, None, Wish::WebGpu).disappoints());
    }
}
