//! Saving: pictures, the path, its diagram, the table.

/// What is being saved.
#[derive(Clone, Debug, Default)]
pub struct ExportState {}
