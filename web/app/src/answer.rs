//! Whose word an answer is: Mimique's own server's, or that of something on the way.
//!
//! A proxy, a captive portal or a firewall answers too, with any status and a page of its own. Only a
//! [`Refusal`] is the server's word; everything else is a network that does not work, and what waits
//! is kept and sent again.

use mimique_session::wire::Refusal;

/// Why a request brought nothing.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// No answer, one that says to come back later, or one that is not the server's: worth another
    /// try.
    Unreachable(String),
    /// The server understood and refuses: trying again changes nothing.
    Refused(Refusal),
    /// Something on the way, such as a proxy, forwards no body of this size: less at a time may pass.
    TooLarge,
}

/// What an answer means that is not what was asked for: its status, and its body where that is a
/// refusal as Mimique's server writes it.
pub fn failure(status: u16, refusal: Option<Refusal>) -> Failure {
    // Too early, too many, too late: the server wants us to come back.
    let later = status >= 500 || matches!(status, 408 | 425 | 429);
    match refusal {
        Some(refusal) if !later && status >= 400 => Failure::Refused(refusal),
        None if status == 413 => Failure::TooLarge,
        _ => Failure::Unreachable(["HTTP ", &status.to_string()].concat()),
    }
}

/// A refusal that this page finds itself.
pub fn refusal(code: &str, message: &str, remedy: &str) -> Refusal {
    let [code, message, remedy] = [code, message, remedy].map(str::to_owned);
    Refusal { code, message, remedy, sequences: Vec::new() }
}

/// Whether the server says that it has the session no more: only then is it forgotten here.
pub fn is_gone(refusal: &Refusal) -> bool {
    matches!(refusal.code.as_str(), "unknown-session" | "withdrawn")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As `network` reads it.
    fn judged(status: u16, body: &str) -> Failure {
        failure(status, serde_json::from_str(body).ok())
    }

    #[test]
    fn the_servers_own_refusal_is_its_word() {
        let body =
            r#"{"code":"unknown-session","message":"no session","remedy":"reload the page"}"#;
        let Failure::Refused(refusal) = judged(404, body) else { panic!("it is the server's") };
        assert!(is_gone(&refusal));
        for code in ["bad-request", "too-large", "not-found", "unknown-study", "event-conflict"] {
            let Failure::Refused(refusal) = judged(400, &body.replace("unknown-session", code))
            else {
                panic!("{code} is the server's")
            };
            assert!(!is_gone(&refusal), "{code} forgets nothing");
        }
        // A server that is busy says so in the same words.
        for status in [408, 425, 429, 500, 503] {
            assert!(matches!(judged(status, body), Failure::Unreachable(_)), "{status}");
        }
    }

    #[test]
    fn a_proxys_limit_of_a_body_is_no_fault_of_the_network() {
        let proxy = "<title>413 Request Entity Too Large</title>";
        assert_eq!(judged(413, proxy), Failure::TooLarge);
        let own = r#"{"code":"too-large","message":"a body","remedy":"shorten it"}"#;
        assert!(matches!(judged(413, own), Failure::Refused(_)));
    }

    #[test]
    fn what_stands_on_the_way_ends_nothing() {
        let bodies = [
            "<!doctype html><title>403 Forbidden</title>",
            "",
            "null",
            r#"{"error":"blocked by policy"}"#,
            r#"{"code":403,"message":"blocked","remedy":""}"#,
            r#"{"code":"blocked","message":"by policy"}"#,
        ];
        for status in [200, 302, 400, 401, 403, 404, 407, 410, 451, 502] {
            for body in bodies {
                let found = judged(status, body);
                assert_eq!(found, Failure::Unreachable(format!("HTTP {status}")), "{body}");
            }
        }
    }
}
