//! Work beside the window: on a thread of its own, or, in a page, which has but one, in turns between two frames.
//!
//! Work is a future. It gives way now and then ([`give_way`]), so that a page can draw and listen, and rests until somebody rings
//! its [`Bell`]. On a thread of its own it need not give way, and what waits may block the thread.

#[cfg(target_arch = "wasm32")]
mod page;
#[cfg(not(target_arch = "wasm32"))]
mod thread;

#[cfg(target_arch = "wasm32")]
pub use page::{Bell, MaybeSend, Task, give_way, painted, spawn};
#[cfg(not(target_arch = "wasm32"))]
pub use thread::{Bell, MaybeSend, Task, block_on, give_way, painted, spawn};

use std::time::Duration;

/// Can something be computed while the window is drawn?
pub const THREADS: bool = cfg!(not(target_arch = "wasm32"));

/// How long work may go on before it gives way: this long on a thread of its own, at most 12 ms in a page.
pub const fn slice(on_a_thread: Duration) -> Duration {
    const TURN: Duration = Duration::from_millis(12);
    if THREADS || on_a_thread.as_nanos() < TURN.as_nanos() { on_a_thread } else { TURN }
}

/// Computes something once. In a page it does so when what is to be seen meanwhile has been painted.
///
/// # Errors
/// If the system gives no thread.
pub fn once(name: &str, work: impl FnOnce() + MaybeSend + 'static) -> std::io::Result<Task> {
    spawn(name, || async move {
        painted().await;
        work();
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    #[test]
    fn a_bell_rung_before_anybody_rests_is_heard() {
        let (bell, (sender, receiver)) = (Bell::default(), channel());
        bell.ring();
        let heard = bell.clone();
        let task = spawn("test", || async move {
            heard.rest(None).await;
            let _ = sender.send(1);
            heard.rest(None).await;
            let _ = sender.send(2);
            heard.rest(Some(Duration::from_millis(5))).await;
            let _ = sender.send(3);
        })
        .unwrap();
        let patience = Duration::from_secs(60);
        assert_eq!(receiver.recv_timeout(patience), Ok(1));
        assert_eq!(receiver.recv_timeout(Duration::from_millis(20)).ok(), None, "nobody has rung again");
        bell.ring();
        assert_eq!((receiver.recv_timeout(patience), receiver.recv_timeout(patience)), (Ok(2), Ok(3)));
        task.join();
    }
}
