//! The points of one rendering's curve: at 1, 2, 4, … samples per pixel its picture is kept, to be measured again; the point after the last
//! of these moves on.

use super::super::Session;
use super::Point;
use crate::film::error::Error;
use crate::math::Vec3;
use std::time::Duration;
use web_time::Instant;

/// The moving point moves at most so often.
const OFTEN: Duration = Duration::from_millis(200);
/// And looking takes at most this part of the time.
const PART: u32 = 10;

/// A state of the reference.
#[derive(Clone, Copy)]
pub struct Target<'a> {
    /// Its pixels.
    pub pixels: &'a [Vec3],
    /// Its number, from 1.
    pub version: u32,
}

struct Mark {
    point: Point,
    /// Against which state of the reference it was measured; 0: none.
    version: u32,
    pixels: Option<Vec<Vec3>>,
    kept: bool,
}

impl Mark {
    fn measure(&mut self, target: Target) {
        if let Some(pixels) = &self.pixels {
            (self.point.error, self.version) = (Error::between(pixels, target.pixels), target.version);
        }
    }
}

/// The points of a curve.
#[derive(Default)]
pub struct Track {
    marks: Vec<Mark>,
    due: Option<Instant>,
}

impl Track {
    /// No pass after this one may be begun before it is looked at.
    pub fn limit(&self, passes: u32) -> u32 {
        let next = passes.saturating_add(1);
        if self.due.is_none_or(|due| Instant::now() >= due) { next } else { next.checked_next_power_of_two().unwrap_or(u32::MAX) }
    }

    /// Is it to be looked at after so many passes? `rests`: no other will follow for now.
    pub fn is_due(&self, passes: u32, rests: bool) -> bool {
        let timed = || self.due.is_none_or(|due| Instant::now() >= due);
        passes > 0 && self.is_behind(f64::from(passes)) && (rests || passes.is_power_of_two() || timed())
    }

    /// Is its last point of fewer samples?
    pub fn is_behind(&self, spp: f64) -> bool {
        self.marks.last().is_none_or(|mark| mark.point.spp < spp)
    }

    /// Looks at the rendering, whose film is complete; at most so many pictures are kept.
    pub fn look(&mut self, session: &Session, target: Option<Target>, most: usize) {
        let began = Instant::now();
        let spp = session.parts().0.mean_samples();
        let point = Point { spp, seconds: session.spent().0.as_secs_f64(), error: Error::default() };
        if self.marks.last().is_some_and(|mark| !mark.kept) {
            self.marks.pop();
        }
        let kept = spp.fract() == 0.0 && (spp as u32).is_power_of_two();
        let mut mark = Mark { point, version: 0, pixels: Some(session.image()), kept };
        if let Some(target) = target {
            mark.measure(target);
        }
        self.marks.push(mark);
        let pictures = self.marks.iter().filter(|mark| mark.pixels.is_some()).count();
        if pictures > most.max(1)
            && let Some(oldest) = self.marks.iter_mut().find(|mark| mark.pixels.is_some())
        {
            oldest.pixels = None;
        }
        self.due = Some(Instant::now() + (began.elapsed() * PART).max(OFTEN));
    }

    /// Measures one point again that was measured against another state of the reference. False if there is none.
    pub fn measure_again(&mut self, target: Target) -> bool {
        let stale = |mark: &&mut Mark| mark.pixels.is_some() && mark.version != target.version;
        // The last one is looked at most.
        let Some(mark) = self.marks.iter_mut().rev().find(stale) else { return false };
        mark.measure(target);
        true
    }

    /// Is there one that [`Self::measure_again`] would measure?
    pub fn is_stale(&self, version: u32) -> bool {
        self.marks.iter().any(|mark| mark.pixels.is_some() && mark.version != version)
    }

    /// The reference is another one: what was measured is so no more.
    pub fn forget_errors(&mut self) {
        self.marks.retain(|mark| mark.pixels.is_some());
        self.marks.iter_mut().for_each(|mark| mark.version = 0);
    }

    /// What has been measured.
    pub fn points(&self) -> Vec<Point> {
        self.marks.iter().filter(|mark| mark.version > 0).map(|mark| mark.point).collect()
    }

    /// Pictures kept.
    pub fn pictures(&self) -> u64 {
        self.marks.iter().filter(|mark| mark.pixels.is_some()).count() as u64
    }
}
