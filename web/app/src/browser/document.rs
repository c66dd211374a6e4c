//! The document: its root, language, title and address, and the size of its window.

use gloo_utils::{document, document_element, window};
use wasm_bindgen::JsCast as _;
use web_sys::{HtmlDialogElement, HtmlElement, Node};

use crate::address::Address;

/// Where the pages stand. What the HTML has there stays until [`clear`].
pub fn root() -> Node {
    match document().get_element_by_id("app") {
        Some(place) => place.into(),
        None => gloo_utils::body().into(),
    }
}

/// Takes away what the HTML has where the pages stand.
pub fn clear() {
    root().set_text_content(None);
}

/// Opens or closes the dialog of the page.
pub fn dialog(open: bool) {
    let found = document().query_selector("dialog").ok().flatten();
    let Some(dialog) = found.and_then(|found| found.dyn_into::<HtmlDialogElement>().ok()) else {
        return;
    };
    match (dialog.open(), open) {
        (false, true) => drop(dialog.show_modal()),
        (true, false) => dialog.close(),
        _ => {}
    }
}

/// ISO 639 codes of the languages that are written from right to left.
const RIGHT_TO_LEFT: [&str; 15] =
    ["ar", "arc", "ckb", "dv", "fa", "he", "iw", "ks", "nqo", "ps", "sd", "syr", "ug", "ur", "yi"];

fn is_right_to_left(language: &str) -> bool {
    let language = language.to_ascii_lowercase().replace('_', "-");
    let primary = language.split('-').next().unwrap_or_default();
    RIGHT_TO_LEFT.contains(&primary) || language.starts_with("ku-arab")
}

/// Says language, direction of writing and title of the document.
pub fn describe(language: &str, title: &str) {
    if let Ok(root) = document_element().dyn_into::<HtmlElement>() {
        root.set_lang(language);
        root.set_dir(if is_right_to_left(language) { "rtl" } else { "ltr" });
    }
    if !title.is_empty() {
        document().set_title(title);
    }
}

/// The document's language.
pub fn language() -> String {
    document_element().get_attribute("lang").unwrap_or_default()
}

/// The languages that the browser asks for, the dearest first.
pub fn languages() -> Vec<String> {
    window().navigator().languages().iter().filter_map(|each| each.as_string()).collect()
}

/// The path of the document's address.
pub fn path() -> String {
    window().location().pathname().unwrap_or_default()
}

/// The query of the document's address, with its `?`.
pub fn query() -> String {
    window().location().search().unwrap_or_default()
}

/// The parameters with which the participant arrived.
pub fn arrival() -> Address {
    Address::of_study("", &query())
}

/// Where the study is if no server answers: address of the site's file, and the study's name.
pub fn site() -> Option<(String, String)> {
    let meta = document().query_selector("meta[name=mimique-site]").ok().flatten()?;
    Some((meta.get_attribute("content")?, meta.get_attribute("data-study")?))
}

/// The run that another program, which hosts the site, has begun for this participant: its own page of the study, in
/// this browser too.
pub fn run() -> Option<String> {
    let meta = document().query_selector("meta[name=mimique-site]").ok().flatten()?;
    meta.get_attribute("data-run")
}

/// Goes to another address.
pub fn go(address: &str) {
    // Where the browser does not go, the link is there to be pressed.
    let _ = window().location().set_href(address);
}

/// Loads the page again.
pub fn reload() {
    // Where the browser does not reload, the person does.
    let _ = window().location().reload();
}

/// Percent-encoded, as a part of an address.
pub fn encode(text: &str) -> String {
    js_sys::encode_uri_component(text).into()
}

/// Device pixels per CSS pixel.
pub fn pixel_ratio() -> f64 {
    window().device_pixel_ratio()
}

/// Width and height of the window in CSS pixels.
pub fn viewport() -> [u32; 2] {
    [window().inner_width(), window().inner_height()].map(|length| {
        let length = length.ok().and_then(|length| length.as_f64());
        length.unwrap_or(0.0) as u32
    })
}
