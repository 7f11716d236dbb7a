//! What of a link could not be followed, piece by piece, in words.

use crate::ui::text::{Lang, LinkText, fill};

/// Longest part of a link that is repeated to the person, letters.
const MOST_LETTERS: usize = 32;
/// Most pieces that are named one by one.
const MOST_PIECES: usize = 24;

/// A piece that was not followed as it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ignored {
    /// The piece, "k=1000".
    pub piece: String,
    /// Why.
    pub why: Why,
}

/// Why a piece was not followed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    /// No piece of this name is known.
    Unknown,
    /// What stands there is no value of this piece.
    Unreadable,
    /// It stands there once more.
    Twice,
    /// It was out of bounds: this was taken instead.
    Instead(String),
    /// The scene has no place for it.
    NoPlace,
    /// There is no scene of this name.
    NoScene,
    /// It cannot be rendered; a sentence says why.
    Refused(String),
    /// The link was made by a newer program.
    Newer,
    /// The link was made by a program in which a sample takes another path.
    OtherPaths,
    /// It is about another scene.
    OtherScene,
}

impl Ignored {
    /// A piece, and why it was not followed.
    pub fn new(piece: impl Into<String>, why: Why) -> Self {
        Self { piece: piece.into(), why }
    }

    fn words(&self, lang: Lang) -> String {
        let piece = shortened(&self.piece);
        match &self.why {
            Why::Instead(value) => fill(LinkText::Instead.in_language(lang), &[&piece, &shortened(value)]),
            Why::Refused(sentence) => fill(LinkText::Refused.in_language(lang), &[&piece, sentence]),
            why => {
                let words = match why {
                    Why::Unreadable => LinkText::Unreadable,
                    Why::Twice => LinkText::Twice,
                    Why::NoPlace => LinkText::NoPlace,
                    Why::NoScene => LinkText::NoScene,
                    Why::Newer => LinkText::Newer,
                    Why::OtherPaths => LinkText::OtherPaths,
                    Why::OtherScene => LinkText::OtherScene,
                    _ => LinkText::Unknown,
                };
                fill(words.in_language(lang), &[&piece])
            }
        }
    }
}

/// What stands in a link is no text of ours: not much of it, and nothing that is not a letter or a sign.
fn shortened(text: &str) -> String {
    let plain = |letter: &char| letter.is_alphanumeric() || letter.is_ascii_graphic() || *letter == ' ';
    let mut letters = text.chars().filter(plain);
    let mut short: String = letters.by_ref().take(MOST_LETTERS).collect();
    if letters.next().is_some() {
        short.push('…');
    }
    short
}

/// One message about all of them; `None` if everything was followed.
pub fn sentence(ignored: &[Ignored], lang: Lang) -> Option<String> {
    let mut pieces: Vec<String> = ignored.iter().take(MOST_PIECES).map(|ignored| ignored.words(lang)).collect();
    if let Some(more) = ignored.len().checked_sub(MOST_PIECES).filter(|more| *more > 0) {
        pieces.push(fill(LinkText::AndMore.in_language(lang), &[&more.to_string()]));
    }
    let separator = match lang {
        Lang::En => "; ",
        Lang::Zh => "；",
    };
    (!pieces.is_empty()).then(|| fill(LinkText::Ignored.in_language(lang), &[&pieces.join(separator)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_piece_is_named_and_none_says_much() {
        assert_eq!(sentence(&[], Lang::En), None);
        let long = format!("x={}\u{202e}\n", "y".repeat(500));
        let ignored =
            [Ignored::new("k=1000", Why::Instead("64".into())), Ignored::new("foo", Why::Unknown), Ignored::new(long, Why::Unreadable)];
        let text = sentence(&ignored, Lang::En).unwrap();
        assert!(text.contains("k=1000") && text.contains("64") && text.contains("foo") && text.len() < 250, "{text}");
        assert!(!text.contains('\n') && !text.contains('\u{202e}'));
        let many = vec![Ignored::new("a", Why::Unknown); 1000];
        let text = sentence(&many, Lang::Zh).unwrap();
        assert!(text.contains("976") && text.len() < 3000, "{text}");
    }
}
