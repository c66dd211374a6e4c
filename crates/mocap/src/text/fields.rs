//! A line as fields and numbers: delimiters, quotes, decimal commas.

use std::borrow::Cow;

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
}
