//! Time: the page's clock, waits, and the frames of the display.

use std::time::Duration;

use gloo_timers::future::TimeoutFuture;
use gloo_utils::window;
use js_sys::Promise;
use wasm_bindgen_futures::JsFuture;

/// The page's clock: milliseconds since 1970, never running backwards within one load.
pub fn now() -> f64 {
    window().performance().map_or(0.0, |clock| clock.time_origin() + clock.now())
}

/// When an event happened, on that clock.
pub fn time_of(event: &web_sys::Event) -> f64 {
    window().performance().map_or(0.0, |clock| clock.time_origin() + event.time_stamp())
}

/// Waits.
pub async fn sleep(time: Duration) {
    TimeoutFuture::new(time.as_millis() as u32).await;
}

/// Waits for the next frame of the display.
pub async fn next_frame() {
    let frame = Promise::new(&mut |done, _| {
        // A window that draws no more never comes to its next frame, and neither does who waits for it.
        let _ = window().request_animation_frame(&done);
    });
    let _ = JsFuture::from(frame).await;
}

/// Waits for the first paint of what stands on the page now.
pub async fn painted() {
    next_frame().await;
    next_frame().await;
}
