//! What the address of the page says: which study, which language, which condition, who recruited the
//! participant.
//!
//! `/s/demo/?lang=fr&condition=…&PROLIFIC_PID=…&STUDY_ID=…&SESSION_ID=…`
use std::collections::BTreeMap;

/// What the address says.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Address {
    /// Identifier of the study.
    pub study: String,
    /// Language asked for (`?lang=`).
    pub language: Option<String>,
    /// Condition of the participant (`?condition=`); named twice it is both, with a comma.
    pub condition: Option<String>,
    /// Every other parameter, as recruiting sites add them.
    pub recruitment: BTreeMap<String, String>,
}

/// Most parameters kept, and most characters of one: an address is not a place for data.
const MOST_PARAMETERS: usize = 16;
const MOST_CHARACTERS: usize = 200;

impl Address {
    /// Reads a path and a query (with or without `?`). `None` if the path is not that of a study.
    pub fn parse(path: &str, query: &str) -> Option<Self> {
        let mut parts = path.split('/').filter(|part| !part.is_empty());
        if parts.next() != Some("s") {
            return None;
        }
        Some(Self::of_study(&decode(parts.next()?), query))
    }

    /// The address of a study whose name the page itself gives (hosted without the server).
    pub fn of_study(study: &str, query: &str) -> Self {
        let mut address = Self { study: study.to_owned(), ..Self::default() };
        for pair in query.trim_start_matches('?').split('&').filter(|pair| !pair.is_empty()) {
            let (name, value) = pair.split_once('=').unwrap_or((pair, ""));
            let (name, value) = (decode(name), decode(value));
            match name.as_str() {
                "lang" => address.language = Some(value),
                "condition" => {
                    let condition = address.condition.get_or_insert_default();
                    if !condition.is_empty() {
                        condition.push(',');
                    }
                    condition.extend(value.chars().take(MOST_CHARACTERS));
                }
                "backend" => {}
                _ if name.chars().count() > MOST_CHARACTERS
                    || address.recruitment.len() >= MOST_PARAMETERS => {}
                _ => {
                    address.recruitment.insert(name, value.chars().take(MOST_CHARACTERS).collect());
                }
            }
        }
        address
    }
}

/// Percent-decoding with `+` as a blank; what is not UTF-8 becomes the replacement character.
fn decode(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, tail @ ..] = rest {
        rest = tail;
        match (first, tail) {
            (b'+', _) => bytes.push(b' '),
            (b'%', [high, low, after @ ..]) if hex(*high).is_some() && hex(*low).is_some() => {
                bytes.push(hex(*high).unwrap_or(0) * 16 + hex(*low).unwrap_or(0));
                rest = after;
            }
            (byte, _) => bytes.push(*byte),
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

fn hex(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).and_then(|value| u8::try_from(value).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn address_of_a_recruiting_site() {
        let address = Address::parse("/s/demo/", "?lang=fr&PROLIFIC_PID=a%2Fb+c&backend=webgl2&x")
            .expect("a study's address");
        assert_eq!(address.study, "demo");
        assert_eq!(address.language.as_deref(), Some("fr"));
        assert_eq!(address.recruitment["PROLIFIC_PID"], "a/b c");
        assert_eq!(address.recruitment["x"], "");
        assert_eq!(address.recruitment.len(), 2);
    }

    #[test]
    fn address_that_names_a_condition() {
        let condition = |query| Address::of_study("a", query).condition;
        assert_eq!(condition("?x=1"), None);
        assert_eq!(condition("?condition=with+hint%21").as_deref(), Some("with hint!"));
        assert_eq!(condition("?condition").as_deref(), Some(""));
        // However many parameters stand before it, and never one of two.
        let many: String = (0..100).map(|i| format!("p{i}=1&")).collect();
        let address = Address::of_study("a", &format!("{many}condition=a&condition=b"));
        assert_eq!(address.condition.as_deref(), Some("a,b"));
        assert!(!address.recruitment.contains_key("condition"));
    }

    #[test]
    fn address_that_is_none() {
        assert_eq!(Address::parse("/", ""), None);
        assert_eq!(Address::parse("/s/", ""), None);
        assert_eq!(Address::parse("/preview/demo", ""), None);
    }

    #[test]
    fn address_with_too_much_is_cut() {
        let query = (0..100).map(|i| format!("p{i}={}", "y".repeat(500))).collect::<Vec<_>>();
        let address = Address::parse("/s/a", &query.join("&")).expect("a study's address");
        assert_eq!(address.recruitment.len(), MOST_PARAMETERS);
        assert!(address.recruitment.values().all(|value| value.len() == MOST_CHARACTERS));
        assert_eq!(Address::parse("/s/%zz%4", "").expect("a study's address").study, "%zz%4");
    }
}
