//! What holds of any bytes as an ELAN document. Shared by `tests/it/elan.rs` and the fuzz target `eaf`.

use mimique_stimulus::{EafAnnotation, EafDocument};

/// Reads bytes as an ELAN document and writes tiers into what is one; panics where that is not
/// answered as promised.
pub fn read_anyhow(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let document = match EafDocument::parse(&text) {
        Ok(document) => document,
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains(": ") && text.contains("; "), "{text}");
            return;
        }
    };
    assert_eq!(document.text(), text, "what is read stays as it is");
    let mut all = 0;
    for tier in document.tiers() {
        for a in &tier.annotations {
            assert!(a.start_ms <= a.end_ms, "{a:?}");
        }
        all += tier.annotations.len();
        for s in document.segments(&tier.id, 200.0).unwrap_or_default().segments {
            assert!(!s.label.trim().is_empty() && s.clip.start < s.clip.end, "{s:?}");
        }
    }
    assert!(all <= text.len(), "no more annotations than characters");
    let clips = [
        EafAnnotation { start_ms: 5, end_ms: 900, value: "joy <&> \"'".to_owned() },
        EafAnnotation { start_ms: 900, end_ms: 901, value: "fear".to_owned() },
    ];
    let names = document.tiers().iter().map(|t| t.id.clone()).take(8);
    for name in names.chain(["clips".to_owned()]) {
        let Ok(with) = document.with_tier(&name, &clips) else { continue };
        assert_eq!(with.tier(&name).map(|t| &t.annotations[..]), Some(&clips[..]), "{name:?}");
        let others = |d: &EafDocument| -> Vec<_> {
            d.tiers().iter().filter(|t| t.id != name).cloned().collect()
        };
        assert_eq!(others(&with), others(&document), "the other tiers stay");
        assert_eq!(EafDocument::parse(with.text()).ok().as_ref(), Some(&with));
    }
}
