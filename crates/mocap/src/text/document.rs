//! A text file as lines and fields: encodings, line ends, delimiters, quotes, decimal commas.

use std::borrow::Cow;

/// A decoded text file.
pub(crate) struct Document<'a> {
    text: Cow<'a, str>,
}

impl<'a> Document<'a> {
    /// Decode UTF-8, UTF-16 (with its byte order mark) or, when it is neither, Latin-1.
    pub(crate) fn decode(bytes: &'a [u8]) -> Self {
        let text = match bytes {
            [0xff, 0xfe, rest @ ..] => Cow::Owned(utf16(rest, u16::from_le_bytes)),
            [0xfe, 0xff, rest @ ..] => Cow::Owned(utf16(rest, u16::from_be_bytes)),
            _ => {
                let rest = bytes.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(bytes);
                match std::str::from_utf8(rest) {
                    Ok(text) => Cow::Borrowed(text),
                    Err(_) => Cow::Owned(rest.iter().map(|&b| char::from(b)).collect()),
                }
            }
        };
        Self { text }
    }

    /// Bytes of the text.
    pub(crate) fn length(&self) -> usize {
        self.text.len()
    }

    /// Lines with their number (1 = the first), without line ends (`\n`, `\r\n` or `\r`).
    pub(crate) fn lines(&self) -> impl Iterator<Item = (usize, &str)> {
        let end = if self.text.contains('\n') { '\n' } else { '\r' };
        self.text
            .split(end)
            .enumerate()
            .map(move |(i, line)| (i + 1, line.strip_suffix('\r').unwrap_or(line)))
    }
}

/// Decode UTF-16 code units; an odd last byte is dropped.
fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> String {
    let units = bytes.as_chunks::<2>().0.iter().map(|pair| unit(*pair));
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

/// What separates fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Delimiter {
    Comma,
    Semicolon,
    Tab,
}

impl Delimiter {
    /// The delimiter of a header line: the one that occurs most, tabs before semicolons before
    /// commas where they tie.
    pub(crate) fn of(line: &str) -> Self {
        let count = |c: char| line.matches(c).count();
        let (tabs, semicolons, commas) = (count('\t'), count(';'), count(','));
        if tabs > 0 && tabs >= semicolons && tabs >= commas {
            Self::Tab
        } else if semicolons > 0 && semicolons >= commas {
            Self::Semicolon
        } else {
            Self::Comma
        }
    }

    /// The character.
    pub(crate) fn char(self) -> char {
        match self {
            Self::Comma => ',',
            Self::Semicolon => ';',
            Self::Tab => '\t',
        }
    }

    /// Whether a comma inside a field can only be a decimal comma.
    pub(crate) fn allows_decimal_comma(self) -> bool {
        self != Self::Comma
    }
}

/// Split a line into fields, without blanks and quotes around them, into `fields`.
pub(crate) fn split_fields<'l>(
    line: &'l str,
    delimiter: Delimiter,
    fields: &mut Vec<Cow<'l, str>>,
) {
    fields.clear();
    if !line.contains('"') {
        fields.extend(line.split(delimiter.char()).map(|f| Cow::Borrowed(f.trim())));
        return;
    }
    let mut field = String::new();
    let mut quoted = false;
    let mut characters = line.chars().peekable();
    while let Some(c) = characters.next() {
        if c == '"' {
            if quoted && characters.peek() == Some(&'"') {
                characters.next();
                field.push('"');
            } else {
                quoted = !quoted;
            }
        } else if c == delimiter.char() && !quoted {
            fields.push(Cow::Owned(field.trim().to_owned()));
            field.clear();
        } else {
            field.push(c);
        }
    }
    fields.push(Cow::Owned(field.trim().to_owned()));
}

/// A coordinate: NaN where the field is blank or a word for missing, `None` where it is not a
/// number.
pub(crate) fn coordinate(field: &str, delimiter: Delimiter) -> Option<f64> {
    if let Ok(value) = field.parse::<f64>() {
        return Some(if value.is_finite() { value } else { f64::NAN });
    }
    if matches!(
        field.to_ascii_lowercase().as_str(),
        "" | "na"
            | "n/a"
            | "null"
            | "none"
            | "-"
            | "-nan"
            | "nan(ind)"
            | "-nan(ind)"
            | "1.#qnan"
            | "-1.#ind"
    ) {
        return Some(f64::NAN);
    }
    if delimiter.allows_decimal_comma() && field.matches(',').count() == 1 {
        return field.replace(',', ".").parse().ok().filter(|v: &f64| v.is_finite());
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decodes_every_encoding_to_the_same_lines() {
        let text = "a,b\r\n1,2\r\n";
        let utf16: Vec<u8> = [0xff, 0xfe]
            .into_iter()
            .chain(text.encode_utf16().flat_map(u16::to_le_bytes))
            .collect();
        let marked: Vec<u8> = [0xef, 0xbb, 0xbf].into_iter().chain(text.bytes()).collect();
        for bytes in [text.as_bytes(), &utf16, &marked, b"a,b\r1,2\r", b"a,b\n1,2\n"] {
            let document = Document::decode(bytes);
            let lines: Vec<_> = document.lines().collect();
            assert_eq!(lines, [(1, "a,b"), (2, "1,2"), (3, "")]);
        }
        assert_eq!(Document::decode(b"caf\xe9").lines().next(), Some((1, "café")));
    }

    #[test]
    fn fields_keep_delimiters_inside_quotes() {
        let mut fields = Vec::new();
        split_fields("a, \"b, \"\"c\"\"\" ,d", Delimiter::Comma, &mut fields);
        assert_eq!(fields, ["a", "b, \"c\"", "d"]);
    }

    #[test]
    fn a_decimal_comma_is_read_where_commas_do_not_separate() {
        assert_eq!(coordinate("1,5", Delimiter::Semicolon), Some(1.5));
        assert_eq!(coordinate("1,5", Delimiter::Comma), None);
        assert!(coordinate("NaN", Delimiter::Tab).is_some_and(f64::is_nan));
        assert!(coordinate("", Delimiter::Tab).is_some_and(f64::is_nan));
        assert_eq!(coordinate("12a", Delimiter::Tab), None);
    }
}
