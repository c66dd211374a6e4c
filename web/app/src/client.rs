//! What events record of browser and display.

use mimique_session::Client;
use mimique_study::SortedMap;

use crate::browser::{document, host};
use crate::json;

/// Browser name, its major version and platform class: nothing finer.
pub fn about() -> SortedMap<String, String> {
    json::read(&host::about()).unwrap_or_default()
}

/// The display and the browser, as events record them.
pub fn client() -> Client {
    Client {
        viewport: document::viewport(),
        device_pixel_ratio: document::pixel_ratio(),
        about: about(),
    }
}
