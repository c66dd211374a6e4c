//! A line as fields and numbers: delimiters, quotes, decimal commas.

use std::borrow::Cow;

use mimique_geometry::Point;

use super::table::frame_number;
use crate::ReadError;

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

/// The fields of one row of a file, and where it stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row<'r> {
    /// Number of the line, from 1.
    pub(crate) line: usize,
    /// What the delimiter parts.
    pub(crate) fields: &'r [Cow<'r, str>],
    /// The delimiter.
    pub(crate) delimiter: Delimiter,
    /// What to do where a field is no number.
    pub(crate) remedy: &'static str,
}

impl Row<'_> {
    /// Refuse a row that has less than `columns`, or values beyond them: its numbers may stand in the
    /// wrong places.
    pub(crate) fn of_width(&self, columns: usize) -> Result<(), ReadError> {
        let surplus = self.fields.iter().skip(columns).any(|f| !f.is_empty());
        if self.fields.len() < columns || surplus {
            return Err(ReadError::at_line(
                self.line,
                "row",
                format!("{} columns where the header has {columns}", self.fields.len()),
                "complete the row or remove it; the file may have been cut short",
            ));
        }
        Ok(())
    }

    /// The text of a column; nothing where the row is shorter.
    pub(crate) fn text(&self, column: usize) -> &str {
        self.fields.get(column).map_or("", AsRef::as_ref)
    }

    /// The number in a column: NaN for a blank, an error for anything else that is none.
    pub(crate) fn number(&self, column: usize) -> Result<f64, ReadError> {
        let field = self.text(column);
        coordinate(field, self.delimiter).ok_or_else(|| {
            ReadError::at_line(
                self.line,
                format!("column {}", column + 1),
                format!("\"{field}\" is not a number"),
                self.remedy,
            )
        })
    }

    /// The frame's number in a column.
    pub(crate) fn frame_number(&self, column: usize) -> Result<u64, ReadError> {
        frame_number(self.number(column)?, self.text(column), self.line)
    }

    /// The point whose coordinates stand in three columns.
    pub(crate) fn point(&self, [x, y, z]: [usize; 3]) -> Result<Point, ReadError> {
        Ok(Point::new(self.number(x)?, self.number(y)?, self.number(z)?))
    }
}

/// The fields of a line, without blanks and quotes around them; at least one.
pub(crate) fn split_fields(line: &str, delimiter: Delimiter) -> Vec<Cow<'_, str>> {
    let separator = delimiter.char();
    let count = line.bytes().filter(|b| char::from(*b) == separator).count();
    let mut fields = Vec::with_capacity(count + 1);
    if !line.contains('"') {
        fields.extend(line.split(separator).map(|f| Cow::Borrowed(f.trim())));
        return fields;
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
        } else if c == separator && !quoted {
            fields.push(Cow::Owned(field.trim().to_owned()));
            field.clear();
        } else {
            field.push(c);
        }
    }
    fields.push(Cow::Owned(field.trim().to_owned()));
    fields
}

/// A decimal number of up to 15 digits, or nothing (NaN), at the start of some bytes, and its
/// length. Such a number is a whole one below 2^53 over a power of ten that is exact: the one
/// division rounds correctly, as any parser must.
fn plain_number(bytes: &[u8]) -> Option<(f64, usize)> {
    const POWERS: [f64; 16] =
        [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15];
    let negative = bytes.first() == Some(&b'-');
    let mut at = usize::from(negative);
    let start = at;
    let (mut whole, mut digits, mut decimals, mut point) = (0_u64, 0_usize, 0_usize, false);
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'0'..=b'9' => {
                whole = whole * 10 + u64::from(byte - b'0');
                digits += 1;
                decimals += usize::from(point);
                if digits > 15 {
                    return None;
                }
            }
            b'.' if !point => point = true,
            _ => break,
        }
        at += 1;
    }
    if digits == 0 {
        return (at == start && !negative).then_some((f64::NAN, 0));
    }
    let value = whole as f64 / POWERS[decimals];
    Some((if negative { -value } else { value }, at))
}

/// The values of a row that holds nothing but plain numbers and blanks: most rows of most files.
/// `false` for any other, which the slow and careful way then reads or refuses.
pub(crate) fn plain_row(
    line: &str,
    delimiter: Delimiter,
    columns: usize,
    values: &mut Vec<f64>,
) -> bool {
    values.clear();
    let mut rest = line.as_bytes();
    loop {
        let Some((value, length)) = plain_number(rest) else { return false };
        values.push(value);
        match rest.get(length) {
            None => return values.len() == columns,
            Some(byte) if char::from(*byte) == delimiter.char() => rest = &rest[length + 1..],
            Some(_) => return false,
        }
        if values.len() == columns {
            return false;
        }
    }
}

/// A coordinate: NaN where the field is blank or a word for missing, `None` where it is not a
/// number.
pub(crate) fn coordinate(field: &str, delimiter: Delimiter) -> Option<f64> {
    if let Some((value, length)) = plain_number(field.as_bytes())
        && length == field.len()
    {
        return Some(value);
    }
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
    fn fields_keep_delimiters_inside_quotes() {
        let fields = split_fields("a, \"b, \"\"c\"\"\" ,d", Delimiter::Comma);
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

    #[test]
    fn plain_numbers_are_those_of_the_standard_parser() {
        for text in [
            "0",
            "-0",
            "7",
            "12.5",
            "-0.0001",
            "1611.3685",
            "999999999999999",
            ".5",
            "5.",
            "123456789.012345",
            "0.1",
            "0.3",
            "-268.8729",
            "4503599627370.49",
        ] {
            let (value, length) = plain_number(text.as_bytes()).unwrap();
            assert_eq!(value.to_bits(), text.parse::<f64>().unwrap().to_bits(), "{text}");
            assert_eq!(length, text.len());
        }
        for text in ["-", ".", "-.", "1234567890123456", "1.2.3,"] {
            let found = plain_number(text.as_bytes());
            assert!(found.is_none_or(|(_, length)| length < text.len()), "{text}: {found:?}");
        }
        assert!(plain_number(b",1").is_some_and(|(v, n)| v.is_nan() && n == 0));
    }
}
