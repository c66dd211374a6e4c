//! Requests.

use std::time::Duration;

use gloo_timers::callback::Timeout;
use gloo_utils::window;
use wasm_bindgen::{JsCast as _, JsValue};
use wasm_bindgen_futures::JsFuture;
use web_sys::{AbortController, Headers, RequestInit, Response};

/// What is sent.
pub struct Body {
    /// Media type.
    pub media_type: &'static str,
    /// The text.
    pub text: String,
}

/// Status and text of an answer; an error where none has come, whole, within `patience`.
pub async fn request(
    method: &str,
    address: &str,
    body: Option<Body>,
    patience: Duration,
) -> Result<(u16, String), JsValue> {
    let aborter = AbortController::new()?;
    let request = RequestInit::new();
    request.set_method(method);
    request.set_signal(Some(&aborter.signal()));
    if let Some(body) = body {
        let headers = Headers::new()?;
        headers.set("content-type", body.media_type)?;
        request.set_headers(&headers);
        request.set_body(&body.text.into());
    }
    // Dropped with the answer: then nothing is aborted.
    let _timeout = Timeout::new(patience.as_millis() as u32, move || aborter.abort());
    let fetched = JsFuture::from(window().fetch_with_str_and_init(address, &request)).await?;
    let response = fetched.unchecked_into::<Response>();
    let text = JsFuture::from(response.text()?).await?;
    Ok((response.status(), text.as_string().unwrap_or_default()))
}
