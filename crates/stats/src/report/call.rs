//! How a number was computed, as a call that scripts in R and Python can make too.

/// One argument.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Argument {
    Text(String),
    List(Vec<String>),
    Number(usize),
}

/// A function of `analysis.R` and `analysis.py` with its arguments.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Call {
    pub function: &'static str,
    pub arguments: Vec<Argument>,
}

impl Call {
    pub(crate) fn new(function: &'static str) -> Self {
        Self { function, arguments: Vec::new() }
    }

    pub(crate) fn text(mut self, text: &str) -> Self {
        self.arguments.push(Argument::Text(text.to_owned()));
        self
    }

    pub(crate) fn list(mut self, items: &[String]) -> Self {
        self.arguments.push(Argument::List(items.to_vec()));
        self
    }

    pub(crate) fn number(mut self, number: usize) -> Self {
        self.arguments.push(Argument::Number(number));
        self
    }
}
