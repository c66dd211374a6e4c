//! What can be wrong with a method's parameters: a code with its values, and the words for people.

use std::fmt;

use serde::Serialize;

use crate::method::names::Method;
use crate::parameters::group::Group;
use crate::parameters::kind::{Kind, NamesOf, Range};

/// Something wrong in a method's parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct SpecError {
    /// The parameter, by its key in JSON; `method` for the method itself.
    pub field: String,
    /// The entry of a list or an object that it is about: an index or a name.
    pub entry: Option<String>,
    /// What is wrong with it.
    pub fault: SpecFault,
}

/// What is wrong with a parameter, with the value and what would be right.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "fault", rename_all = "kebab-case", rename_all_fields = "camelCase")]
pub enum SpecFault {
    /// The method is not an object.
    NotAnObject,
    /// No method is named.
    MethodMissing,
    /// No method has this name.
    UnknownMethod {
        /// The name.
        found: String,
    },
    /// No parameter has this name.
    UnknownParameter,
    /// The value is not of the parameter's kind.
    WrongKind {
        /// The value as JSON.
        found: String,
        /// What it should be.
        expected: Kind,
    },
    /// The word is none of the parameter's.
    UnknownWord {
        /// The word.
        found: String,
        /// Those that it may be.
        words: &'static [&'static str],
    },
    /// The number is out of the parameter's range.
    OutOfRange {
        /// The number.
        value: f64,
        /// What it may be.
        range: Range,
        /// What 0 stands for, where that needs to be said.
        zero: Option<&'static str>,
    },
    /// The ends of an interval are not finite, or in the wrong order.
    NoInterval {
        /// The two ends.
        value: [f64; 2],
    },
    /// The method does not use the parameter.
    NotUsed {
        /// The method.
        method: Method,
    },
    /// The two methods cannot be blended.
    NotBlended {
        /// The method.
        method: Method,
        /// The one to blend it with.
        second: Method,
    },
    /// The parameter has no effect beside another one.
    NoEffect {
        /// The value.
        value: String,
        /// Why, as a clause: `only zones have a radius`.
        because: &'static str,
    },
    /// kS and kB are both 0.
    NoThinShell,
    /// Markers are met exactly, so that one cannot count more than another.
    MetExactly {
        /// The importance that was given.
        importance: f64,
    },
    /// A shape is locked twice.
    LockedTwice {
        /// The shape.
        shape: String,
    },
    /// A shape is locked and has bounds.
    LockedAndBounded {
        /// The shape.
        shape: String,
    },
    /// The avatar or the marker map does not have this name.
    UnknownName {
        /// Whose name it should be.
        of: NamesOf,
        /// The name.
        found: String,
        /// Those that are there.
        known: Vec<String>,
    },
    /// No marker that counts is moved by a shape.
    NothingMoves,
}

impl SpecError {
    /// A fault of a parameter as a whole.
    pub fn of(field: &str, fault: SpecFault) -> SpecError {
        SpecError { field: field.to_owned(), entry: None, fault }
    }

    /// The JSON pointer (RFC 6901) from the method to the value: `/bounds/jawOpen`; empty for the
    /// method as a whole.
    pub fn pointer(&self) -> String {
        if matches!(self.fault, SpecFault::NotAnObject | SpecFault::MethodMissing) {
            return String::new();
        }
        let steps = std::iter::once(&self.field).chain(&self.entry);
        steps.map(|step| format!("/{}", step.replace('~', "~0").replace('/', "~1"))).collect()
    }

    /// A stable word for what is wrong, for programs: `out-of-range`.
    pub fn code(&self) -> &'static str {
        match self.fault {
            SpecFault::NotAnObject | SpecFault::WrongKind { .. } => "wrong-type",
            SpecFault::MethodMissing => "missing-key",
            SpecFault::UnknownMethod { .. } | SpecFault::UnknownWord { .. } => "unknown-word",
            SpecFault::UnknownParameter => "unknown-key",
            SpecFault::OutOfRange { .. } | SpecFault::NoInterval { .. } => "out-of-range",
            SpecFault::NotUsed { .. } => "not-used",
            SpecFault::NotBlended { .. } => "not-blended",
            SpecFault::NoEffect { .. } => "no-effect",
            SpecFault::NoThinShell => "no-thin-shell",
            SpecFault::MetExactly { .. } => "met-exactly",
            SpecFault::LockedTwice { .. } => "locked-twice",
            SpecFault::LockedAndBounded { .. } => "locked-and-bounded",
            SpecFault::UnknownName { .. } => "unknown-name",
            SpecFault::NothingMoves => "nothing-moves",
        }
    }

    /// What is wrong, with the value, in English.
    pub fn message(&self) -> String {
        match &self.fault {
            SpecFault::NotAnObject => "is not an object {...}".to_owned(),
            SpecFault::MethodMissing => "is missing".to_owned(),
            SpecFault::UnknownMethod { found } => format!("unknown method '{found}'"),
            SpecFault::UnknownParameter => "unknown parameter".to_owned(),
            SpecFault::WrongKind { found, .. } => format!("is {found}"),
            SpecFault::UnknownWord { found, .. } => format!("is '{found}'"),
            SpecFault::OutOfRange { value, .. } => format!("is {value}"),
            SpecFault::NoInterval { value: [low, high] } => format!("is [{low}, {high}]"),
            SpecFault::NotUsed { method } => format!("'{method}' does not use it"),
            SpecFault::NotBlended { method, second } => {
                format!("'{method}' cannot be blended with '{second}'")
            }
            SpecFault::NoEffect { value, because } => format!("is {value}, but {because}"),
            SpecFault::NoThinShell => "kS and kB are both 0, which leaves no thin shell".to_owned(),
            SpecFault::MetExactly { importance } => {
                format!("is {importance}, but markers are met exactly where stiffness is 0")
            }
            SpecFault::LockedTwice { shape } => format!("'{shape}' is named twice"),
            SpecFault::LockedAndBounded { shape } => format!("'{shape}' has bounds too"),
            SpecFault::UnknownName { of, found, .. } => format!("no {} '{found}'", of.one()),
            SpecFault::NothingMoves => {
                "no marker with importance above 0 is moved by a shape".to_owned()
            }
        }
    }

    /// What the value may be instead: methods, words, names, or the parameters that the method takes.
    pub fn alternatives(&self) -> Vec<&str> {
        match &self.fault {
            SpecFault::UnknownMethod { .. } => Method::ALL.map(Method::name).to_vec(),
            SpecFault::UnknownWord { words, .. } => words.to_vec(),
            SpecFault::NotUsed { method } => method.parameters(),
            SpecFault::NotBlended { method, .. } => (Method::ALL.into_iter())
                .filter(|other| other != method && other.uses(Group::Blend))
                .map(Method::name)
                .collect(),
            SpecFault::UnknownName { known, .. } => known.iter().map(String::as_str).collect(),
            _ => Vec::new(),
        }
    }

    /// What to do about it, in English.
    pub fn remedy(&self) -> String {
        match &self.fault {
            SpecFault::NotAnObject => "write {\"method\": \"lsts\"}".to_owned(),
            SpecFault::MethodMissing => "name a method, for example lsts".to_owned(),
            SpecFault::UnknownMethod { .. } => {
                format!("use one of {}", self.alternatives().join(", "))
            }
            SpecFault::UnknownParameter => "correct its name or remove it".to_owned(),
            SpecFault::WrongKind { expected, .. } => format!("give {expected}"),
            SpecFault::UnknownWord { words, .. } => format!("use {}", alternatives(words)),
            SpecFault::OutOfRange { range, zero: None, .. } => format!("give a number {range}"),
            SpecFault::OutOfRange { range, zero: Some(zero), .. } => {
                format!("give a number {range} (0: {zero})")
            }
            SpecFault::NoInterval { .. } => "give two numbers, the lower one first".to_owned(),
            SpecFault::NotUsed { .. } => match self.alternatives().as_slice() {
                [] => "remove it (it takes none)".to_owned(),
                taken => format!("remove it (it takes {})", taken.join(", ")),
            },
            SpecFault::NotBlended { .. } => {
                format!("name one of {}", self.alternatives().join(", "))
            }
            SpecFault::NoEffect { .. } => "remove it".to_owned(),
            SpecFault::NoThinShell => "make one positive".to_owned(),
            SpecFault::MetExactly { .. } => {
                "give stiffness above 0, or importance 0 to leave the marker out".to_owned()
            }
            SpecFault::LockedTwice { .. } => "name it once".to_owned(),
            SpecFault::LockedAndBounded { .. } => "lock it or bound it, not both".to_owned(),
            SpecFault::UnknownName { known, .. } => format!("use names of {}", known.join(", ")),
            SpecFault::NothingMoves => "give one of them importance".to_owned(),
        }
    }
}

/// `alpha: is 1.5; give a number between 0 and 1`.
impl fmt::Display for SpecError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.field)?;
        if let Some(entry) = &self.entry {
            write!(f, ".{entry}")?;
        }
        write!(f, ": {}; {}", self.message(), self.remedy())
    }
}

impl std::error::Error for SpecError {}

/// What to give: `a number`.
impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Number => f.write_str("a number"),
            Kind::WholeNumber => f.write_str("a whole number of 0 or more"),
            Kind::Interval => f.write_str("two numbers [low, high]"),
            Kind::Word(words) => write!(f, "one of the words {}", alternatives(words)),
            Kind::Names => f.write_str("a list of names"),
            Kind::NumberByName => f.write_str("an object with a number for each name"),
            Kind::IntervalByName => f.write_str("an object with [low, high] for each name"),
        }
    }
}

/// `a, b or c`.
fn alternatives(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [others @ .., last] => format!("{} or {last}", others.join(", ")),
    }
}
