//! How far loading is: the loader writes it, whoever waits looks at it from another thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering::Relaxed};

/// What the loader is at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// It reads the file and those it names.
    #[default]
    Reading,
    /// It reads the meshes; counted in nodes that show one.
    Meshes,
    /// It decodes the images.
    Images,
    /// It builds the hierarchy; `total` triangles.
    Building,
}

const STAGES: [Stage; 4] = [Stage::Reading, Stage::Meshes, Stage::Images, Stage::Building];

/// A handle on the progress of one loading; clones see the same.
#[derive(Clone, Debug, Default)]
pub struct Progress(Arc<Counters>);

#[derive(Debug, Default)]
struct Counters {
    stage: AtomicU8,
    done: AtomicU64,
    total: AtomicU64,
}

impl Progress {
    /// A stage of `total` things begins.
    pub fn begin(&self, stage: Stage, total: usize) {
        self.0.done.store(0, Relaxed);
        self.0.total.store(total as u64, Relaxed);
        self.0.stage.store(stage as u8, Relaxed);
    }

    /// One more thing is done.
    pub fn advance(&self) {
        self.0.done.fetch_add(1, Relaxed);
    }

    /// The stage, how many of its things are done, and how many there are.
    pub fn now(&self) -> (Stage, u64, u64) {
        let stage = STAGES[usize::from(self.0.stage.load(Relaxed)).min(STAGES.len() - 1)];
        (stage, self.0.done.load(Relaxed), self.0.total.load(Relaxed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clone_sees_what_the_loader_writes() {
        let (writer, reader) = {
            let progress = Progress::default();
            (progress.clone(), progress)
        };
        assert_eq!(reader.now(), (Stage::Reading, 0, 0));
        for stage in STAGES {
            writer.begin(stage, 7);
            writer.advance();
            assert_eq!(reader.now(), (stage, 1, 7));
        }
    }
}
