//! What a language asks of spaces.

use std::borrow::Cow;

use super::primary_language;

/// French marks that stand after a space, and its quotation marks.
const FRENCH: [(&str, &str); 6] = [
    (" ?", "\u{a0}?"),
    (" !", "\u{a0}!"),
    (" ;", "\u{a0};"),
    (" :", "\u{a0}:"),
    ("« ", "«\u{a0}"),
    (" »", "\u{a0}»"),
];

/// The text with spaces that do not break where the language wants them: in French no line begins with
/// a question mark, though keyboards write an ordinary space before it.
pub fn typeset<'a>(language: &str, text: &'a str) -> Cow<'a, str> {
    let mut text = Cow::Borrowed(text);
    if primary_language(language) != "fr" {
        return text;
    }
    for (written, set) in FRENCH {
        if text.contains(written) {
            text = Cow::Owned(text.replace(written, set));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_french_line_can_begin_with_its_mark() {
        assert_eq!(
            typeset("fr-BE", "« Joie » : certain ? Oui !"),
            "«\u{a0}Joie\u{a0}»\u{a0}: certain\u{a0}? Oui\u{a0}!"
        );
        assert_eq!(typeset("en", "A : B ?"), "A : B ?");
    }
}
