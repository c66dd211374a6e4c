//! The policy of a page whose styles stand in itself (the statistical report is one file): they are
//! allowed by their hashes, so that nothing else inline is.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use sha2::{Digest, Sha256};

/// Nothing but the page's own styles.
pub(crate) fn report_policy(page: &str) -> String {
    let mut hashes: Vec<String> = styles(page)
        .map(|style| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(style.as_bytes()))))
        .collect();
    hashes.sort();
    hashes.dedup();
    if hashes.is_empty() {
        hashes.push("'none'".to_owned());
    }
    format!(
        "default-src 'none'; style-src {}; frame-ancestors 'none'; base-uri 'none'; \
         form-action 'none'",
        hashes.join(" ")
    )
}

/// The text of every style element.
fn styles(page: &str) -> impl Iterator<Item = &str> {
    page.split("<style").skip(1).filter_map(|rest| {
        let (_, text) = rest.split_once('>')?;
        Some(text.split_once("</style>")?.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_style_is_allowed_by_its_hash() {
        let page = "<style>a{}</style><svg><style id=\"x\">b{}</style></svg><style>a{}</style>";
        assert_eq!(styles(page).collect::<Vec<_>>(), ["a{}", "b{}", "a{}"]);
        let policy = report_policy(page);
        assert_eq!(policy.matches("sha256-").count(), 2, "{policy}");
        assert!(!policy.contains("unsafe"), "{policy}");
        assert!(report_policy("<p>").contains("style-src 'none'"));
    }
}
