//! E-mail addresses of accounts.

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
