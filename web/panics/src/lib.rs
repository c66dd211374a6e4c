//! Panics of the wasm modules: the browser's console gets the whole message, the server's log gets the
//! message without its values, and the place in the source.
//!
//! A formatted message may hold what a participant wrote, so that everything between quotation marks
//! and every digit is left out of the report ([`without_values`]). The report itself is sent by
//! `static/panics.js`.
//!
//! ```
//! let message = "byte index 7 is not a char boundary; it is inside 'é' of `my café`";
//! let reported = mimique_web_panics::without_values(message);
//! assert_eq!(reported, "byte index # is not a char boundary; it is inside '…`");
//! ```

use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen(raw_module = "./panics.js")]
extern "C" {
    /// Writes `whole` into the console and sends the rest to the server.
    #[wasm_bindgen(js_name = reportPanic)]
    fn report_panic(whole: &str, module: &str, backend: &str, message: &str, place: &str);
}

/// Reports every panic of this module from now on. `module` is the name of its file (`app`, `solver`);
/// `backend` is the graphics interface of a canvas (`webgpu`, `webgl2`) and empty elsewhere.
pub fn report_panics(module: &'static str, backend: &'static str) {
    std::panic::set_hook(Box::new(move |panic| {
        let message = without_values(panic.payload_as_str().unwrap_or_default());
        let place = panic.location().map(ToString::to_string).unwrap_or_default();
        report_panic(&panic.to_string(), module, backend, &message, &place);
    }));
}

/// A panic's message without the values that were formatted into it: what stands between the first and
/// the last quotation mark becomes `…`, each digit `#`. Rust's own messages quote every text that they
/// print, and a value's quotation marks lie within those.
pub fn without_values(message: &str) -> String {
    let quotation_mark = |letter: char| matches!(letter, '"' | '\'' | '`');
    let first = message.find(quotation_mark);
    let last = message.rfind(quotation_mark);
    let kept = match (first, last) {
        (Some(first), Some(last)) => [&message[..=first], "…", &message[last..]].concat(),
        _ => message.to_owned(),
    };
    kept.replace(|letter: char| letter.is_ascii_digit(), "#")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The message of a panic, as the hook finds it.
    fn message(panics: impl FnOnce() + std::panic::UnwindSafe) -> String {
        let payload = std::panic::catch_unwind(panics).expect_err("it panics");
        let text = payload.downcast_ref::<String>().cloned();
        text.or_else(|| payload.downcast_ref::<&str>().map(ToString::to_string)).expect("a text")
    }

    #[test]
    fn answers_are_left_out() {
        let answer = "tired \"since\" `Monday` – 42 years";
        let dash = answer.find('–').expect("a dash") + 1;
        let failed: Result<(), (&str, f64)> = std::hint::black_box(Err((answer, 42.0)));
        for message in [
            message(move || drop(answer[..dash].to_owned())),
            message(move || failed.expect("an answer that isn't read")),
            message(move || assert_eq!(answer, "")),
        ] {
            let reported = without_values(&message);
            assert!(message.contains("tired"), "{message}");
            for part in ["tired", "since", "Monday", "42", "years"] {
                assert!(!reported.contains(part), "{reported}");
            }
        }
    }

    #[test]
    fn words_without_values_stay() {
        let empty: &[u8] = &[];
        let message = message(move || assert_ne!(empty[empty.len()..][0], 1));
        let expected = "index out of bounds: the len is # but the index is #";
        assert_eq!(without_values(&message), expected);
        assert_eq!(without_values("a clip without frames"), "a clip without frames");
    }
}
