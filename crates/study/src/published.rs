//! A study file as it is published with its answers: without what is secret while a study runs, and with the hash under
//! which it was served, so that its answers are known to be its own.

use serde_json::Value;

use crate::canonical::config_hash;
use crate::study_file::Published;

/// The key of a study file.
const KEY: &str = "published";

/// Marks `file`, made of the file `served`, as published. A file without changes stays as it is.
pub fn published(served: &Value, mut file: Value) -> Value {
    let served_hash = answered_hash(served);
    if let Some(keys) = file.as_object_mut() {
        keys.remove(KEY);
        let published_hash = config_hash(&file);
        if served_hash != published_hash {
            let mark = Published { served_hash, published_hash };
            let mark = serde_json::to_value(mark).expect("two texts are JSON");
            file.as_object_mut().expect("an object").insert(KEY.to_owned(), mark);
        }
    }
    file
}

/// The `config_hash` of answers to a study file: that under which it was served, of a published file that was not changed
/// afterwards; else the file's own.
pub fn answered_hash(file: &Value) -> String {
    let mark =
        file.get(KEY).and_then(|mark| serde_json::from_value::<Published>(mark.clone()).ok());
    if let Some(mark) = mark {
        let mut unmarked = file.clone();
        unmarked.as_object_mut().map(|keys| keys.remove(KEY));
        if config_hash(&unmarked) == mark.published_hash {
            return mark.served_hash;
        }
    }
    config_hash(file)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_published_file_has_the_hash_of_the_served_one_until_it_is_changed() {
        let served = json!({ "id": "x", "recruitment": { "completionCode": "C0DE" } });
        let file = published(&served, json!({ "id": "x", "recruitment": {} }));
        assert_eq!(answered_hash(&file), config_hash(&served));
        assert_ne!(config_hash(&file), config_hash(&served));
        // Published again, without more.
        let again = published(&file, json!({ "id": "x" }));
        assert_eq!(answered_hash(&again), config_hash(&served));
        // Other rules make another version of it.
        let mut changed = file;
        changed["exclusions"] = json!({ "incomplete": true });
        assert_eq!(answered_hash(&changed), config_hash(&changed));
        // Without changes there is nothing to mark.
        assert_eq!(published(&served, served.clone()), served);
    }
}
