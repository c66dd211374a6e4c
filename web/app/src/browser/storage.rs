//! The browser's `localStorage`, which a person may have forbidden. (gloo-storage panics there.)

use gloo_utils::window;
use web_sys::Storage;

fn storage() -> Option<Storage> {
    window().local_storage().ok().flatten()
}

/// A value; none where nothing is stored, or nothing may be.
pub fn load(key: &str) -> Option<String> {
    storage()?.get_item(key).ok().flatten()
}

/// Stores a value; false where the browser stores nothing.
pub fn save(key: &str, value: &str) -> bool {
    storage().is_some_and(|storage| storage.set_item(key, value).is_ok())
}

/// Forgets a value.
pub fn forget(key: &str) {
    if let Some(storage) = storage() {
        // Where it cannot be removed nothing was stored.
        let _ = storage.remove_item(key);
    }
}
