//! A study file as it is published with its answers: without what is secret while a study runs, and with the hash under
//! which it was served, so that its answers are known to be its own.

use serde_json::Value;

use crate::canonical::config_hash;
use crate::study_file::Published;

/// The key of a study file.
const KEY: &str = "published";

/// Marks `file`, made of the file `served`, as published. A file without changes stays as it is.
pub fn published(served: &Value, mut file: Value) -> Value {
    let served_hashes = answer_hashes(served);
    if let Some(keys) = file.as_object_mut() {
        keys.remove(KEY);
        let published_hash = config_hash(&file);
        if !served_hashes.contains(&published_hash) {
            let mark = Published { served_hashes, published_hash };
            let mark = serde_json::to_value(mark).expect("texts are JSON");
            file.as_object_mut().expect("an object").insert(KEY.to_owned(), mark);
        }
    }
    file
}

/// Each `config_hash` that answers to a study file can have: those under which it was served, of a published file that was
/// not changed afterwards, and, last, the file's own, which its answers have when it is served itself.
pub fn answer_hashes(file: &Value) -> Vec<String> {
    let mark =
        file.get(KEY).and_then(|mark| serde_json::from_value::<Published>(mark.clone()).ok());
    let mut hashes = Vec::new();
    if let Some(mark) = mark {
        let mut unmarked = file.clone();
        unmarked.as_object_mut().map(|keys| keys.remove(KEY));
        if config_hash(&unmarked) == mark.published_hash {
            hashes = mark.served_hashes;
        }
    }
    hashes.push(config_hash(file));
    hashes
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_published_file_has_the_hash_of_the_served_one_until_it_is_changed() {
        let served = json!({ "id": "x", "recruitment": { "completionCode": "C0DE" } });
        let file = published(&served, json!({ "id": "x", "recruitment": {} }));
        assert_eq!(answer_hashes(&file), [config_hash(&served), config_hash(&file)]);
        assert_ne!(config_hash(&file), config_hash(&served));
        // Other rules make another version of it.
        let mut changed = file;
        changed["exclusions"] = json!({ "incomplete": true });
        assert_eq!(answer_hashes(&changed), [config_hash(&changed)]);
        // Without changes there is nothing to mark.
        assert_eq!(published(&served, served.clone()), served);
    }

    #[test]
    fn a_published_file_that_is_served_again_and_published_has_the_hashes_of_both() {
        let served = json!({ "id": "x", "recruitment": { "completionCode": "C0DE" } });
        let first = published(&served, json!({ "id": "x" }));
        // A replication takes a code of its own: another version, whose answers are not those of the first.
        let mut replication = first.clone();
        replication["recruitment"] = json!({ "completionCode": "NEW" });
        assert_eq!(answer_hashes(&replication), [config_hash(&replication)]);
        // Served as it was published, then published with fewer keys.
        let mut fewer = first.clone();
        fewer["title"] = json!("X");
        let second = published(&first, fewer);
        let known = [config_hash(&served), config_hash(&first), config_hash(&second)];
        assert_eq!(answer_hashes(&second), known);
    }
}
