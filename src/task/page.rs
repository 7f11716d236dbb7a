//! Tasks in a page: each goes on in a turn of the browser's event loop. One that gives way waits while the page is hidden, and for
//! ever once it has failed.

use js_sys::{Function, Promise};
use std::future::{Future, poll_fn};
use std::pin::pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Poll, Waker};
use std::time::Duration;
use wasm_bindgen::JsValue;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::MessageChannel;

/// How often a hidden page looks whether it is still hidden.
const HIDDEN: Duration = Duration::from_millis(250);

/// There are no threads to send anything to.
pub trait MaybeSend {}
impl<T> MaybeSend for T {}

/// Work that has been started; without this handle it goes on all the same.
#[derive(Debug)]
pub struct Task(());

impl Task {
    /// Nobody can wait for another in a page.
    pub fn join(self) {}
}

/// Starts work: the future that `work` makes.
///
/// # Errors
/// Never.
pub fn spawn<F: Future<Output = ()> + 'static>(_name: &str, work: impl FnOnce() -> F + MaybeSend + 'static) -> std::io::Result<Task> {
    spawn_local(work());
    Ok(Task(()))
}

/// Lets the page draw and listen, and waits while nobody looks at it.
pub async fn give_way() {
    next_turn().await;
    while hidden() {
        sleep(HIDDEN).await;
    }
}

/// Waits until the page has been painted.
pub async fn painted() {
    let frame = |resolve: Function| match web_sys::window() {
        Some(window) if !hidden() => drop(window.request_animation_frame(&resolve)),
        _ => drop(resolve.call0(&JsValue::NULL)),
    };
    // The first one ends before the painting, the second after it.
    wait(frame).await;
    wait(frame).await;
    give_way().await;
}

/// A turn of the event loop without the 4 ms that browsers add to a timer.
async fn next_turn() {
    let Ok(channel) = MessageChannel::new() else { return sleep(Duration::ZERO).await };
    wait(|resolve| {
        channel.port1().set_onmessage(Some(&resolve));
        drop(channel.port2().post_message(&JsValue::NULL));
    })
    .await;
    channel.port1().close();
}

async fn sleep(time: Duration) {
    wait(|resolve| {
        if let Some(window) = web_sys::window() {
            drop(window.set_timeout_with_callback_and_timeout_and_arguments_0(&resolve, time.as_millis() as i32));
        }
    })
    .await;
}

/// Waits until the function given to `start` is called.
async fn wait(mut start: impl FnMut(Function)) {
    drop(JsFuture::from(Promise::new(&mut |resolve, _| start(resolve))).await);
}

/// Does nobody look at the page, or has the program ended (`web/loader.js`)?
fn hidden() -> bool {
    let document = web_sys::window().and_then(|window| window.document());
    let ended = |root: web_sys::Element| root.has_attribute("data-ended");
    document.is_some_and(|document| document.hidden() || document.document_element().is_some_and(ended))
}

/// Wakes work that rests.
#[derive(Clone, Debug, Default)]
pub struct Bell(Arc<Mutex<Rope>>);

/// Has it been rung, and who rests?
type Rope = (bool, Option<Waker>);

impl Bell {
    /// Ends the rest, or the next one.
    pub fn ring(&self) {
        let waker = {
            let mut bell = self.rope();
            bell.0 = true;
            bell.1.take()
        };
        if let Some(waker) = waker {
            waker.wake();
        }
    }

    fn rope(&self) -> MutexGuard<'_, Rope> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Rests until the bell rings, or for so long.
    pub async fn rest(&self, most: Option<Duration>) {
        let mut timer = pin!(async {
            match most {
                Some(most) => sleep(most).await,
                None => std::future::pending().await,
            }
        });
        poll_fn(|context| {
            let mut bell = self.rope();
            if std::mem::take(&mut bell.0) {
                return Poll::Ready(());
            }
            bell.1 = Some(context.waker().clone());
            timer.as_mut().poll(context)
        })
        .await;
    }
}
