//! Typographic quotes in the place of straight ones, as word processors write them: the text of a study file in, the
//! first quote that is no JSON out. Inside of texts they are letters like others.

/// A quote that is no JSON, and where it stands: line and column, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct TypographicQuote {
    pub line: usize,
    pub column: usize,
    pub quote: char,
}

/// Quotes that word processors put in the place of `"` and `'`.
const QUOTES: [char; 9] = ['“', '”', '„', '‟', '‘', '’', '‚', '«', '»'];

/// The first typographic quote outside of texts and comments, or in a text that is open at the end of its line:
/// the one that should have closed it.
pub(super) fn find(text: &str) -> Option<TypographicQuote> {
    let mut comment = false;
    for (number, line) in text.lines().enumerate() {
        // The straight quote that a text is within, and the last typographic one since.
        let (mut within, mut last) = (None, None);
        let mut letters = line.chars().enumerate().peekable();
        while let Some((at, letter)) = letters.next() {
            let here = TypographicQuote { line: number + 1, column: at + 1, quote: letter };
            let next = letters.peek().map(|(_, next)| *next);
            match (within, letter) {
                _ if comment => {
                    if letter == '*' && next == Some('/') {
                        letters.next();
                        comment = false;
                    }
                }
                (Some(_), '\\') => drop(letters.next()),
                (Some(open), letter) if letter == open => (within, last) = (None, None),
                (Some(_), letter) if QUOTES.contains(&letter) => last = Some(here),
                (Some(_), _) => {}
                (None, '"' | '\'') => within = Some(letter),
                (None, '/') if next == Some('/') => break,
                (None, '/') if next == Some('*') => {
                    letters.next();
                    comment = true;
                }
                (None, letter) if QUOTES.contains(&letter) => return Some(here),
                (None, _) => {}
            }
        }
        if within.is_some() && last.is_some() && !line.ends_with('\\') {
            return last;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotes_that_open_or_close_are_found_and_those_in_texts_and_comments_are_not() {
        let at = |text: &str| find(text).map(|found| (found.line, found.column, found.quote));
        assert_eq!(at("{ “id”: \"x\" }"), Some((1, 3, '“')));
        assert_eq!(at("{\n  \"id”: 1,\n}"), Some((2, 6, '”')));
        assert_eq!(at("{ \"id\": «x» }"), Some((1, 9, '«')));
        assert_eq!(at("// “no”\n{ /* “no\n”*/ \"id\": \"“x” l’un \\\"\" }"), None);
        assert_eq!(at("{ \"a\": \"no end, no quote }"), None);
    }
}
