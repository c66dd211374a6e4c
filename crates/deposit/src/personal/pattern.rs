//! What a text looks like that says who somebody is or where: addresses, numbers, identifiers.

use std::net::IpAddr;

/// What a value looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Pattern {
    /// `name@host.org`.
    EmailAddress,
    /// A telephone number, with or without the country.
    PhoneNumber,
    /// `https://…`, `www.…`.
    WebAddress,
    /// An address of IP, version 4 or 6.
    NetworkAddress,
    /// What a browser calls itself, with all its versions: an export has name, major version and class alone.
    UserAgent,
    /// 24 hexadecimal digits, as Prolific names people.
    PlatformIdentifier,
}

impl Pattern {
    /// What it is called.
    pub fn words(self) -> &'static str {
        match self {
            Self::EmailAddress => "looks like an e-mail address",
            Self::PhoneNumber => "looks like a telephone number",
            Self::WebAddress => "looks like a web address",
            Self::NetworkAddress => "looks like an IP address",
            Self::UserAgent => "looks like a browser's user agent",
            Self::PlatformIdentifier => "looks like an identifier of a recruiting service",
        }
    }
}

/// Whether a text has what a pattern stands for.
type Test = fn(&str) -> bool;

/// What is in a text, each once.
pub fn patterns(text: &str) -> Vec<Pattern> {
    let tests: [(Pattern, Test); 6] = [
        (Pattern::EmailAddress, has_email_address),
        (Pattern::PhoneNumber, has_phone_number),
        (Pattern::WebAddress, has_web_address),
        (Pattern::NetworkAddress, has_network_address),
        (Pattern::UserAgent, has_user_agent),
        (Pattern::PlatformIdentifier, has_platform_identifier),
    ];
    tests.into_iter().filter(|(_, test)| test(text)).map(|(pattern, _)| pattern).collect()
}

fn has_email_address(text: &str) -> bool {
    let of_name = |letter: char| letter.is_alphanumeric() || "._%+-".contains(letter);
    text.match_indices('@').any(|(at, _)| {
        let named = text[..at].ends_with(of_name);
        let host: &str = text[at + 1..]
            .split(|letter: char| !(letter.is_alphanumeric() || ".-".contains(letter)))
            .next()
            .unwrap_or_default();
        let ending = host.trim_end_matches('.').rsplit_once('.');
        named && ending.is_some_and(|(host, end)| !host.is_empty() && end.chars().count() >= 2)
    })
}

fn has_web_address(text: &str) -> bool {
    let small = text.to_lowercase();
    ["http://", "https://", "ftp://", "www."].iter().any(|start| small.contains(start))
}

fn has_network_address(text: &str) -> bool {
    let of_address = |letter: char| letter.is_ascii_hexdigit() || ".:".contains(letter);
    text.split(|letter| !of_address(letter)).any(|word| {
        let word = word.trim_end_matches(['.', ':']);
        // `::` alone is an address, and a mark of punctuation.
        let is_long = word.chars().filter(char::is_ascii_hexdigit).count() >= 4;
        is_long && word.parse::<IpAddr>().is_ok()
    })
}

fn has_user_agent(text: &str) -> bool {
    let engines = ["Mozilla/", "AppleWebKit/", "Gecko/", "Opera/"];
    engines.iter().any(|engine| text.contains(engine))
}

fn has_platform_identifier(text: &str) -> bool {
    let words = text.split(|letter: char| !letter.is_ascii_alphanumeric());
    let mut words = words.filter(|word| word.len() == 24);
    words.any(|word| {
        let digits = word.bytes().filter(u8::is_ascii_digit).count();
        word.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f')) && digits >= 4
    })
}

fn has_phone_number(text: &str) -> bool {
    let of_number = |letter: char| letter.is_ascii_digit() || "+ ()-./\u{a0}".contains(letter);
    text.split(|letter| !of_number(letter)).any(|run| is_phone_number(run.trim()))
}

/// Whether a run of digits and what may stand between them is a telephone number.
fn is_phone_number(run: &str) -> bool {
    let groups: Vec<&str> = run
        .split(|letter: char| !letter.is_ascii_digit())
        .filter(|group| !group.is_empty())
        .collect();
    let digits: usize = groups.iter().map(|group| group.len()).sum();
    let is_decimal = run.contains('.') && run.parse::<f64>().is_ok();
    if is_decimal || digits > 15 {
        return false;
    }
    let lengths: Vec<usize> = groups.iter().map(|group| group.len()).collect();
    let international = run.starts_with('+') && digits >= 8;
    // Of a country: `06 12 34 56 78`, `(020) 7946 0958`. A list of decimals begins with a single 0.
    let first = groups.first().copied().unwrap_or_default();
    let national = first.starts_with('0') && first.len() >= 2 && (9..=13).contains(&digits);
    let north_american = lengths == [3, 3, 4] && run.contains(['-', '(', '.']);
    international || national || north_american
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_says_who_somebody_is_is_found() {
        for (text, found) in [
            ("write to marie.dupont@univ-lyon.fr please", Pattern::EmailAddress),
            ("jean@exämple.de.", Pattern::EmailAddress),
            ("06 12 34 56 78", Pattern::PhoneNumber),
            ("call 0612345678", Pattern::PhoneNumber),
            ("+33 6 12 34 56 78", Pattern::PhoneNumber),
            ("+1 (555) 123-4567", Pattern::PhoneNumber),
            ("555-123-4567", Pattern::PhoneNumber),
            ("02.41.22.10.00", Pattern::PhoneNumber),
            ("see HTTPS://me.example/about", Pattern::WebAddress),
            ("www.example.org", Pattern::WebAddress),
            ("192.168.1.20", Pattern::NetworkAddress),
            ("from 2001:db8::8a2e:370:7334.", Pattern::NetworkAddress),
            ("Mozilla/5.0 (X11; Linux x86_64) AppleWebKit/537.36", Pattern::UserAgent),
            ("5f2b1c9e8a7d6c5b4a392817", Pattern::PlatformIdentifier),
        ] {
            assert!(patterns(text).contains(&found), "{text}: {found:?}, not {:?}", patterns(text));
        }
    }

    #[test]
    fn what_exports_are_full_of_is_nobody() {
        for text in [
            "",
            "5923.6",
            "0.123456789012",
            "[0.1, 0.25, 0.333333333]",
            "0.5 0.25 0.125 0.0625 1.5",
            "2026-11-27",
            "2026-11-27T10:20:30.123Z",
            "10:20:30",
            "412x860",
            "faces/anger2.box",
            "chrome 142 desktop",
            "20261121",
            "1234567890",
            "12 of 24, 3-4 times",
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855",
            "aaaaaaaaaaaaaaaaaaaaaaaa",
            "I was @ home: fine",
            "1.5.2",
            "{\"unit\":4,\"onset_s\":0.123456789,\"peak_s\":0.4}",
        ] {
            assert_eq!(patterns(text), [], "{text}");
        }
    }
}
