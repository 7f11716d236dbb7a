//! What the pyramid's cells show, cells in large, and two images compared.

/// What a person chose about them.
#[derive(Clone, Debug, Default)]
pub struct StudyState {}
