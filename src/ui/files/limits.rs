//! How much can be read into the memory of a page, and what keeps files from being read.

use super::super::format::mebibytes;
use super::super::text::{FilesText, Lang, fill};

/// Most bytes of a file.
pub const MOST_OF_ONE: u64 = 256 << 20;
/// Most bytes of the files that are given together.
pub const MOST_TOGETHER: u64 = 512 << 20;
/// Most files that are given together.
pub const MOST_FILES: usize = 1000;

/// Why files could not be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A file has too many bytes.
    TooLarge(String, u64),
    /// All of them together have.
    TooMuch(u64),
    /// They are too many.
    TooMany,
    /// There is no memory for so many bytes of a file.
    NoMemory(String, u64),
    /// A file cannot be read, and what the system says of that.
    Unreadable(String, String),
}

impl Trouble {
    /// What is wrong, and what to do.
    pub fn sentence(&self, lang: Lang) -> String {
        let say = |text: FilesText, parts: &[&str]| fill(text.in_language(lang), parts);
        match self {
            Self::TooLarge(name, bytes) => say(FilesText::TooLarge, &[name, &mebibytes(*bytes), &mebibytes(MOST_OF_ONE)]),
            Self::TooMuch(bytes) => say(FilesText::TooMuch, &[&mebibytes(*bytes), &mebibytes(MOST_TOGETHER)]),
            Self::TooMany => say(FilesText::TooMany, &[&MOST_FILES.to_string()]),
            Self::NoMemory(name, bytes) => say(FilesText::NoMemory, &[name, &mebibytes(*bytes)]),
            Self::Unreadable(name, why) => say(FilesText::Unreadable, &[name, why]),
        }
    }
}

/// Refuses files by their names and sizes, before they are read.
///
/// # Errors
/// If one of them, or all together, are too large, or they are too many.
pub fn check<'a>(files: impl IntoIterator<Item = (&'a str, u64)>) -> Result<(), Trouble> {
    let (mut together, mut count) = (0u64, 0);
    for (name, bytes) in files {
        if bytes > MOST_OF_ONE {
            return Err(Trouble::TooLarge(name.to_owned(), bytes));
        }
        (together, count) = (together + bytes, count + 1);
    }
    match () {
        () if count > MOST_FILES => Err(Trouble::TooMany),
        () if together > MOST_TOGETHER => Err(Trouble::TooMuch(together)),
        () => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_file_and_all_together_have_their_limits() {
        const MIB: u64 = 1 << 20;
        assert_eq!(check([("a", 256 * MIB), ("b", 256 * MIB)]), Ok(()));
        assert_eq!(check([("a", 1), ("b", 256 * MIB + 1)]), Err(Trouble::TooLarge("b".into(), 256 * MIB + 1)));
        assert_eq!(check([("a", 256 * MIB), ("b", 256 * MIB), ("c", 1)]), Err(Trouble::TooMuch(512 * MIB + 1)));
        assert_eq!(check((0..MOST_FILES).map(|_| ("a", 1))), Ok(()));
        assert_eq!(check((0..=MOST_FILES).map(|_| ("a", 1))), Err(Trouble::TooMany));
    }

    #[test]
    fn the_sentence_names_the_file_its_size_and_the_limit() {
        let sentence = Trouble::TooLarge("big.glb".into(), (256 << 20) + 1).sentence(Lang::En);
        assert!(["big.glb", "257 MiB", "256 MiB", "make it smaller"].iter().all(|part| sentence.contains(part)), "{sentence}");
        let sentence = Trouble::NoMemory("big.glb".into(), 200 << 20).sentence(Lang::En);
        assert!(["big.glb", "200 MiB"].iter().all(|part| sentence.contains(part)), "{sentence}");
        let sentence = Trouble::Unreadable("gone.glb".into(), "it moved".into()).sentence(Lang::En);
        assert!(["gone.glb cannot be read", "it moved"].iter().all(|part| sentence.contains(part)), "{sentence}");
        let sentence = Trouble::TooMuch(600 << 20).sentence(Lang::Zh);
        assert!(["600 MiB", "512 MiB"].iter().all(|part| sentence.contains(part)), "{sentence}");
    }
}
