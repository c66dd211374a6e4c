//! What problems hold besides single names and numbers, and how it reads in a message.

use std::fmt;
use std::ops::RangeInclusive;

use mimique_locale::counted;
use serde_json::Value;

use super::nearest::nearest;

/// Names to choose from: `"a", "b" or "c"`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Names(Vec<String>);

impl Names {
    pub(super) fn of<T: AsRef<str>>(names: impl IntoIterator<Item = T>) -> Self {
        Self(names.into_iter().map(|name| name.as_ref().to_owned()).collect())
    }
}

impl fmt::Display for Names {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let quoted: Vec<String> = self.0.iter().map(|name| format!("\"{name}\"")).collect();
        match quoted.split_last() {
            None => formatter.write_str("nothing"),
            Some((only, [])) => formatter.write_str(only),
            Some((last, others)) => write!(formatter, "{} or {last}", others.join(", ")),
        }
    }
}

/// The known name that was probably meant, or all that are known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Nearest {
    meant: Option<String>,
    known: Vec<String>,
}

/// Most known names that a remedy lists.
const MOST_LISTED: usize = 24;

impl Nearest {
    pub(super) fn to<T: AsRef<str>>(given: &str, known: impl IntoIterator<Item = T>) -> Self {
        let mut known: Vec<String> =
            known.into_iter().map(|name| name.as_ref().to_owned()).collect();
        known.sort_unstable();
        known.dedup();
        let names: Vec<&str> = known.iter().map(String::as_str).collect();
        Self { meant: nearest(given, &names).map(str::to_owned), known }
    }
}

impl fmt::Display for Nearest {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.meant, self.known.len()) {
            (Some(name), _) => write!(formatter, "did you mean \"{name}\"?"),
            (None, 0) => formatter.write_str("there is none to name; add it first"),
            (None, count) if count > MOST_LISTED => formatter.write_str("name one that is there"),
            (None, _) => write!(formatter, "write {}", Names(self.known.clone())),
        }
    }
}

/// The answers that a question takes, where they can be listed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Known(Vec<String>);

impl Known {
    pub(super) fn of<T: AsRef<str>>(names: impl IntoIterator<Item = T>) -> Self {
        Self(Names::of(names).0)
    }
}

impl fmt::Display for Known {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.is_empty() {
            true => formatter.write_str("write an answer that can be given"),
            false => write!(formatter, "there is {}", Names(self.0.clone())),
        }
    }
}

/// How many are wanted: `2`, `1 to 3`, `at least 1`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Count(pub(super) RangeInclusive<usize>);

impl fmt::Display for Count {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (*self.0.start(), *self.0.end()) {
            (least, usize::MAX) => write!(formatter, "at least {least}"),
            (least, most) if least == most => write!(formatter, "{least}"),
            (least, most) => write!(formatter, "{least} to {most}"),
        }
    }
}

/// A number of things that are called so: `1 label`, `2 labels`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counted(pub(crate) usize, pub(crate) &'static str);

impl fmt::Display for Counted {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&counted(self.0, self.1))
    }
}

/// A value of the file, cut short where it is long.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown(pub(super) Value);

/// Most characters of a value in a message.
const LONGEST_SHOWN: usize = 40;

impl fmt::Display for Shown {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = self.0.to_string();
        match text.char_indices().nth(LONGEST_SHOWN) {
            Some((end, _)) => write!(formatter, "{}...", &text[..end]),
            None => formatter.write_str(&text),
        }
    }
}

/// A type of JSON values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the types of JSON, whole numbers apart")]
pub enum JsonType {
    Text,
    WholeNumber,
    Number,
    Boolean,
    List,
    Object,
}

impl JsonType {
    /// By the name that a JSON Schema has for it; none for `null`.
    pub(super) fn of_schema(name: &str) -> Option<Self> {
        Some(match name {
            "string" => Self::Text,
            "integer" => Self::WholeNumber,
            "number" => Self::Number,
            "boolean" => Self::Boolean,
            "array" => Self::List,
            "object" => Self::Object,
            _ => return None,
        })
    }

    /// Whether a value is of this type.
    pub(super) fn has(self, value: &Value) -> bool {
        match self {
            Self::Text => value.is_string(),
            Self::WholeNumber => value.is_i64() || value.is_u64(),
            Self::Number => value.is_number(),
            Self::Boolean => value.is_boolean(),
            Self::List => value.is_array(),
            Self::Object => value.is_object(),
        }
    }
}

impl fmt::Display for JsonType {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Text => "text",
            Self::WholeNumber => "a whole number",
            Self::Number => "a number",
            Self::Boolean => "true or false",
            Self::List => "a list [...]",
            Self::Object => "an object {...}",
        })
    }
}

/// What belongs in the place of a value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Wanted {
    /// A value of one of these types.
    Types(Vec<JsonType>),
    /// One of these words.
    Words(Names),
}

impl fmt::Display for Wanted {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Types(types) => {
                let types: Vec<String> = types.iter().map(JsonType::to_string).collect();
                formatter.write_str(&types.join(" or "))
            }
            Self::Words(words) => write!(formatter, "one of {words}"),
        }
    }
}
