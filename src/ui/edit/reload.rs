//! Notices that the file of the scene on show has changed on disk.

use std::path::Path;
use std::time::{Duration, SystemTime};
use web_time::Instant;

/// How often the file is looked at.
pub const INTERVAL: Duration = Duration::from_secs(1);

/// What tells one version of a file from another.
type Stamp = Option<(SystemTime, u64)>;

/// The file that is followed.
#[derive(Debug, Default)]
pub struct Reload {
    name: String,
    stamp: Stamp,
    looked: Option<Instant>,
}

impl Reload {
    /// A scene is about to be read: from this version on, a change counts.
    pub fn reading(name: &str) -> Self {
        Self { name: name.to_owned(), stamp: stamp(name), looked: Some(Instant::now()) }
    }

    /// Is this scene a file that can change?
    pub fn follows(&self, name: &str) -> bool {
        self.name == name && self.stamp.is_some()
    }

    /// Has the file of this scene changed since it was read? Asked in every pass, it looks once a second.
    pub fn changed(&mut self, name: &str) -> bool {
        if !self.follows(name) || self.looked.is_some_and(|last| last.elapsed() < INTERVAL) {
            return false;
        }
        self.looked = Some(Instant::now());
        // A file that is gone for a moment, while it is written anew, has no new version yet.
        let now = stamp(name);
        now.is_some() && now != self.stamp
    }
}

fn stamp(name: &str) -> Stamp {
    let metadata = std::fs::metadata(Path::new(name)).ok().filter(std::fs::Metadata::is_file)?;
    Some((metadata.modified().ok()?, metadata.len()))
}
