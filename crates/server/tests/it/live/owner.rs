//! An owner whose scripts reach the researchers' addresses.

use mimique_storage::{AccountLink, LinkPurpose, Role, Storage};

use crate::study;

/// The first owner, with this token.
pub async fn add_owner(storage: &Storage, token: &str) {
    let link = AccountLink {
        purpose: LinkPurpose::FirstOwner,
        email: String::new(),
        role: Role::Owner,
        study_id: None,
        expires_ms: i64::MAX,
    };
    storage.add_link("link", &link, 0).await.unwrap();
    let owner = storage.use_link("link", "owner@example.org", "no password", 1).await.unwrap();
    let hash = study::sha256(token);
    storage.add_token(&hash, owner.unwrap().key, "script", Role::Owner, 1).await.unwrap();
}
