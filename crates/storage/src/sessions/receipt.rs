//! The receipt: HMAC-SHA-256 over every stored event, proof of what the server holds.

use hmac::{Hmac, KeyInit, Mac};
use sha2::Sha256;

/// Feeds events, in order of sequence, to the receipt.
pub(crate) struct ReceiptHasher {
    mac: Hmac<Sha256>,
}

impl ReceiptHasher {
    pub fn new(key: &[u8], study_id: &str, participant: u64) -> Self {
        let mut mac = Hmac::<Sha256>::new_from_slice(key).expect("HMAC takes keys of every length");
        mac.update(b"mimique receipt 1\n");
        mac.update(&(study_id.len() as u64).to_le_bytes());
        mac.update(study_id.as_bytes());
        mac.update(&participant.to_le_bytes());
        Self { mac }
    }

    pub fn add(&mut self, sequence: u64, at_ms: f64, body: &str) {
        self.mac.update(&sequence.to_le_bytes());
        self.mac.update(&at_ms.to_bits().to_le_bytes());
        self.mac.update(&(body.len() as u64).to_le_bytes());
        self.mac.update(body.as_bytes());
    }

    pub fn finish(self) -> String {
        hex::encode(self.mac.finalize().into_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn receipt(key: &[u8], events: &[(u64, f64, &str)]) -> String {
        let mut hasher = ReceiptHasher::new(key, "demo", 7);
        for (sequence, at_ms, body) in events {
            hasher.add(*sequence, *at_ms, body);
        }
        hasher.finish()
    }

    #[test]
    fn a_receipt_changes_with_key_order_and_content() {
        let events = [(0, 1.0, "{}"), (1, 2.0, "{\"a\":1}")];
        let base = receipt(b"key", &events);
        assert_eq!(base, receipt(b"key", &events));
        assert_ne!(base, receipt(b"other", &events));
        assert_ne!(base, receipt(b"key", &events[..1]));
        assert_ne!(base, receipt(b"key", &[(0, 1.0, "{}"), (1, 2.5, "{\"a\":1}")]));
    }
}
