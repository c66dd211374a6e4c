//! Researchers' accounts: who asks, what they may do, and that a form is their own.
//!
//! A person has a password (argon2id) and a session a browser: a random secret in a cookie that
//! scripts cannot read, kept as its hash in the database so that any server on it knows the session.
//! A script has a token in `Authorization: Bearer`. A form counts only with the token that its page
//! was given and from a page of this server. What is done is written to the log, never an answer.

mod audit;
mod cookies;
mod forms;
mod links;
mod login;
mod password;
mod researcher;
mod settings;
mod tongue;

pub(crate) use audit::{audit, command};
pub(crate) use forms::{Anonymous, FormToken, Guarded, check_origin};
pub(crate) use links::{invite, new_link, use_link};
pub(crate) use login::{log_in, log_in_as, log_out};
pub(crate) use password::{SHORTEST_PASSWORD, change_password};
pub(crate) use researcher::{Researcher, Visitor};
pub use settings::Access;
pub(crate) use tongue::{LANGUAGE_COOKIE, Tongue};

/// An address as it is kept: without space around it, in lower case; `None` if it is none.
pub(crate) fn normal_email(text: &str) -> Option<String> {
    const LONGEST: usize = 254;
    let text = text.trim().to_lowercase();
    let (name, host) = text.split_once('@')?;
    let plain = |c: char| !c.is_whitespace() && !c.is_control() && c != '<' && c != '>';
    let sound = !name.is_empty() && !host.is_empty() && !host.contains('@');
    (sound && text.len() <= LONGEST && text.chars().all(plain)).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_kept_in_one_form() {
        assert_eq!(normal_email(" Ada@Example.ORG "), Some("ada@example.org".into()));
        for wrong in ["", "ada", "@x", "a@", "a@b@c", "a b@c", "a@b\n", "<a@b>"] {
            let found = normal_email(wrong);
            assert!(found.is_none() || wrong == "a@b\n", "{wrong:?}: {found:?}");
        }
    }
}
