//! Tasks where there are threads.

pub use pollster::block_on;
use std::future::{Future, ready};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// What can go to a thread.
pub trait MaybeSend: Send {}
impl<T: Send> MaybeSend for T {}

/// Work that has been started; without this handle it goes on all the same.
#[derive(Debug)]
pub struct Task(JoinHandle<()>);

impl Task {
    /// Waits for its end.
    pub fn join(self) {
        drop(self.0.join());
    }
}

/// Starts work: the future that `work` makes, on its own thread.
///
/// # Errors
/// If the system gives no thread.
pub fn spawn<F: Future<Output = ()>>(name: &str, work: impl FnOnce() -> F + MaybeSend + 'static) -> std::io::Result<Task> {
    std::thread::Builder::new().name(name.to_owned()).spawn(move || block_on(work())).map(Task)
}

/// Lets others go on for a moment.
pub fn give_way() -> impl Future<Output = ()> {
    ready(())
}

/// Waits until the window has been painted.
pub fn painted() -> impl Future<Output = ()> {
    ready(())
}

/// Wakes work that rests.
#[derive(Clone, Debug, Default)]
pub struct Bell(Arc<(Mutex<bool>, Condvar)>);

impl Bell {
    /// Ends the rest, or the next one.
    pub fn ring(&self) {
        *self.0.0.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.0.1.notify_one();
    }

    /// Rests until the bell rings, or for so long.
    pub async fn rest(&self, most: Option<Duration>) {
        let rung = self.0.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut rung = match most {
            None => self.0.1.wait_while(rung, |rung| !*rung).unwrap_or_else(PoisonError::into_inner),
            Some(most) => self.0.1.wait_timeout_while(rung, most, |rung| !*rung).unwrap_or_else(PoisonError::into_inner).0,
        };
        *rung = false;
    }
}
