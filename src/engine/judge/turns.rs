//! Who renders next: the image, its reference or one of its rivals; and what is measured of them between two turns.

use super::super::{Job, Session};
use super::basis::Basis;
use super::seats::{Budget, ORDER, Rival, Seat};
use super::track::Track;
use super::{Curve, Curves, Equal, StrategyCurve, TRIAL_BUDGET, Trial, Wanted, Who, need, picture_bytes};
use crate::task;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use web_time::Instant;

/// How long a turn is.
const SLICE: Duration = task::slice(Duration::from_millis(30));
/// What was measured is shown so often.
const OFTEN: Duration = Duration::from_millis(100);

/// Where the window finds what was measured.
pub type Shown = Arc<Mutex<Option<Arc<Curves>>>>;

/// The trial of the image that is rendered.
pub struct Judge {
    job: Job,
    generation: u64,
    trial: Trial,
    basis: Option<Basis>,
    /// States of the references before it.
    states: u32,
    image: Track,
    rivals: Vec<Rival>,
    strategies: Vec<StrategyCurve>,
    refused: Option<u64>,
    turn: usize,
    news: bool,
    next: Instant,
    shown: Shown,
    wake: Arc<dyn Fn() + Send + Sync>,
}

impl Judge {
    /// There is nothing to measure yet.
    pub fn new(job: Job, shown: Shown, wake: Arc<dyn Fn() + Send + Sync>) -> Self {
        let (trial, image, next) = (Trial::default(), Track::default(), Instant::now());
        let (basis, rivals, strategies, refused) = (None, Vec::new(), Vec::new(), None);
        let (generation, states, turn, news) = (0, 0, 0, false);
        Self { job, generation, trial, basis, states, image, rivals, strategies, refused, turn, news, next, shown, wake }
    }

    /// What is to be measured from now on.
    pub fn want(&mut self, trial: Trial) {
        let before = std::mem::replace(&mut self.trial, trial);
        self.news = true;
        let bytes = self.need();
        self.refused = (bytes > TRIAL_BUDGET && self.trial.reference != Wanted::Nothing).then_some(bytes);
        if self.refused.is_some() || self.trial.reference == Wanted::Nothing {
            return self.rest();
        }
        let lacks_layers = self.trial.strategies && self.basis.as_ref().is_some_and(|basis| basis.grows() && !basis.has_layers());
        if self.basis.is_none() || self.trial.reference != before.reference || lacks_layers {
            self.begin();
        }
        self.seat_rivals();
    }

    /// The image is another one.
    pub fn restart(&mut self, job: &Job, generation: u64) {
        (self.job, self.generation) = (job.clone(), generation);
        (self.image, self.strategies) = (Track::default(), Vec::new());
        let Some(basis) = &self.basis else { return };
        self.news = true;
        if !basis.subject.is_of(job) {
            // Whoever wanted it hears of it by the job.
            self.trial.reference = Wanted::Nothing;
            self.rest();
        } else if basis.has_seed(job.settings.seed) {
            self.begin();
        }
        self.seat_rivals();
    }

    /// Bytes taken but for the pictures kept.
    fn need(&self) -> u64 {
        let layers = self.trial.strategies || self.basis.as_ref().is_some_and(Basis::has_layers);
        need(&self.job, &self.trial, layers)
    }

    /// Nothing is measured.
    fn rest(&mut self) {
        self.let_go();
        self.image = Track::default();
        self.rivals.clear();
        self.strategies.clear();
    }

    fn let_go(&mut self) {
        if let Some(old) = self.basis.take() {
            self.states = old.version();
        }
    }

    /// Begins with the reference that is wanted.
    fn begin(&mut self) {
        self.let_go();
        // Without a reference nothing can be measured.
        self.turn = 1;
        self.basis = match &self.trial.reference {
            Wanted::Nothing => None,
            Wanted::Rendered => Basis::rendered(&self.job, self.trial.strategies, self.states).ok(),
            Wanted::Given(picture) => (picture.size == self.job.size).then(|| Basis::given(&self.job, Arc::clone(picture), self.states)),
        };
        self.image.forget_errors();
        self.rivals.iter_mut().for_each(|rival| rival.track.forget_errors());
        self.strategies.clear();
    }

    /// Those rivals that are wanted, as the image is now; who is the same goes on.
    fn seat_rivals(&mut self) {
        let wanted = self.trial.rivals && self.basis.is_some();
        let mut old = std::mem::take(&mut self.rivals);
        for who in Who::RIVALS.into_iter().filter(|_| wanted) {
            let job = who.job(&self.job);
            let same = |rival: &Rival| rival.who == who && is_same(rival.session.job(), &job);
            match old.iter().position(same) {
                Some(at) => self.rivals.push(old.swap_remove(at)),
                // What cannot be rendered has no curve.
                None => self.rivals.extend(Session::for_window(job).ok().map(|session| Rival { who, session, track: Track::default() })),
            }
        }
    }

    /// Somebody's turn. True if it is the image's; else it has been taken.
    pub async fn turn(&mut self, image: &Session) -> bool {
        if self.basis.is_none() {
            return true;
        }
        if self.measure_again() {
            return false;
        }
        let budget = Budget::of(image);
        for _ in ORDER {
            let seat = ORDER[self.turn % ORDER.len()];
            self.turn += 1;
            let taken = match seat {
                Seat::Image => return true,
                Seat::Reference => self.turn_of_reference().await,
                Seat::Rival(who) => self.turn_of_rival(who, budget).await,
            };
            if taken {
                return false;
            }
        }
        true
    }

    async fn turn_of_reference(&mut self) -> bool {
        let Some(basis) = self.basis.as_mut().filter(|basis| basis.grows() && !self.trial.hold) else { return false };
        self.news |= basis.advance(SLICE).await;
        true
    }

    async fn turn_of_rival(&mut self, who: Who, budget: Budget) -> bool {
        let (equal, most) = (self.trial.equal, self.pictures_each());
        let Some(rival) = self.rivals.iter_mut().find(|rival| rival.who == who && rival.has_work(budget, equal)) else { return false };
        let limit = rival.track.limit(rival.session.passes());
        let most_passes = if equal == Equal::Samples { budget.passes.max(1) } else { u32::MAX };
        rival.session.set_limit(limit.min(most_passes));
        rival.session.advance(SLICE).await;
        let rests = !rival.has_work(budget, equal);
        if rival.session.pass_fraction() == 0.0 && rival.track.is_due(rival.session.passes(), rests) {
            rival.session.gather().await;
            rival.track.look(&rival.session, self.basis.as_ref().and_then(Basis::target), most);
            self.news = true;
        }
        true
    }

    /// How many pictures each rendering may keep.
    fn pictures_each(&self) -> usize {
        let left = TRIAL_BUDGET.saturating_sub(self.need()) / picture_bytes(self.job.size).max(1);
        left as usize / (1 + self.rivals.len()) + 1
    }

    /// No pass of the image after this one may be begun before it is looked at.
    pub fn limit(&self, passes: u32) -> u32 {
        if self.basis.is_some() { self.image.limit(passes) } else { u32::MAX }
    }

    /// Looks at the image, if it is time. `paused`: as it stands, if that has not been measured.
    pub async fn look(&mut self, image: &mut Session, paused: bool) {
        if self.basis.is_none() || !self.is_due(image, paused) {
            return;
        }
        image.gather().await;
        let (most, passes) = (self.pictures_each(), image.passes());
        let Some(basis) = &self.basis else { return };
        self.image.look(image, basis.target(), most);
        self.news = true;
        if image.pass_fraction() == 0.0 && passes.is_power_of_two() && basis.has_layers() && basis.weighs_as(&image.job().settings) {
            let seconds = image.spent().0.as_secs_f64();
            for (strategy, error) in basis.strategies(image) {
                let point = [f64::from(passes), seconds, error];
                match self.strategies.iter_mut().find(|curve| curve.strategy == strategy) {
                    Some(curve) => curve.points.push(point),
                    None => self.strategies.push(StrategyCurve { strategy, points: vec![point] }),
                }
            }
        }
    }

    fn is_due(&self, image: &Session, paused: bool) -> bool {
        if paused {
            return image.passes() > 0 && self.image.is_behind(image.parts().0.mean_samples());
        }
        image.pass_fraction() == 0.0 && self.image.is_due(image.passes(), false)
    }

    /// Is there anything to do although nothing is rendered?
    pub fn has_questions(&self, image: &Session) -> bool {
        self.news || (self.basis.is_some() && (self.is_due(image, true) || self.is_stale()))
    }

    fn is_stale(&self) -> bool {
        let Some(target) = self.basis.as_ref().and_then(Basis::target) else { return false };
        self.image.is_stale(target.version) || self.rivals.iter().any(|rival| rival.track.is_stale(target.version))
    }

    /// Measures one point again, if the reference has become better since.
    pub fn measure_again(&mut self) -> bool {
        let Some(target) = self.basis.as_ref().and_then(Basis::target) else { return false };
        let measured = self.image.measure_again(target) || self.rivals.iter_mut().any(|rival| rival.track.measure_again(target));
        self.news |= measured;
        measured
    }

    /// Shows what there is; `rests`: nothing will follow for now.
    pub fn show(&mut self, image: &Session, rests: bool) {
        if !self.news || !(rests || Instant::now() >= self.next) {
            return;
        }
        (self.news, self.next) = (false, Instant::now() + OFTEN);
        let (budget, equal) = (Budget::of(image), self.trial.equal);
        let curve = |who: Who, job: &Job, track: &Track, behind| Curve {
            who,
            points: track.points(),
            lost: job.existence().lost_paths(&job.settings),
            behind,
        };
        let mut runs = vec![curve(Who::Image, image.job(), &self.image, false)];
        runs.extend(self.rivals.iter().map(|x| curve(x.who, x.session.job(), &x.track, x.has_work(budget, equal))));
        let pictures = self.image.pictures() + self.rivals.iter().map(|rival| rival.track.pictures()).sum::<u64>();
        let curves = Curves {
            generation: self.generation,
            reference: self.basis.as_ref().and_then(Basis::reference),
            runs,
            strategies: self.strategies.clone(),
            other_weights: self.basis.as_ref().is_some_and(|basis| basis.has_layers() && !basis.weighs_as(&image.job().settings)),
            refused: self.refused,
            bytes: if self.basis.is_some() { self.need() + pictures * picture_bytes(self.job.size) } else { 0 },
        };
        *self.shown.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(curves));
        (self.wake)();
    }
}

/// Would the two render the same picture?
fn is_same(a: &Job, b: &Job) -> bool {
    let of = |job: &Job| (job.camera, job.pose, job.lens, job.size, job.settings, job.backend);
    Arc::ptr_eq(&a.scene, &b.scene) && of(a) == of(b)
}
