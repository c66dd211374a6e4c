//! What events record of browser and display.

use std::collections::BTreeMap;

use mimique_session::Client;

use crate::browser::{document, host};

/// Browser name, its major version and platform class: nothing finer.
pub fn about() -> BTreeMap<String, String> {
    serde_json::from_str(&host::about()).unwrap_or_default()
}

/// The display and the browser, as events record them.
pub fn client() -> Client {
    Client {
        viewport: document::viewport(),
        device_pixel_ratio: document::pixel_ratio(),
        about: about(),
    }
}
