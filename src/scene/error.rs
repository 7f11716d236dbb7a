//! Why a scene could not be loaded: always the file, the element in it, and the reason.

use std::fmt;
use std::path::Path;

/// A scene that could not be loaded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneError {
    /// The file, as the user named it.
    pub file: String,
    /// The element in it ("mesh 2 'Lamp', primitive 0"), empty if it is the file as a whole.
    pub element: String,
    /// What is wrong, and what to do.
    pub reason: String,
}

impl SceneError {
    /// An error about the file as a whole.
    pub fn file(file: &Path, reason: impl Into<String>) -> Self {
        Self { file: file.display().to_string(), element: String::new(), reason: reason.into() }
    }

    /// An error about one element of a file.
    pub fn element(file: &Path, element: impl Into<String>, reason: impl Into<String>) -> Self {
        Self { element: element.into(), ..Self::file(file, reason) }
    }
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // One line, whatever a library underneath has to say.
        let reason = self.reason.split_whitespace().collect::<Vec<_>>().join(" ");
        if self.element.is_empty() { write!(f, "{}: {reason}", self.file) } else { write!(f, "{}: {}: {reason}", self.file, self.element) }
    }
}

impl std::error::Error for SceneError {}
