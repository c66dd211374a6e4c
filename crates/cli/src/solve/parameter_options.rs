//! The options of the methods' parameters, built from the solver's table: an option a parameter, under
//! the heading of its group.

use std::str::FromStr as _;

use anyhow::{anyhow, bail};
use clap::{Arg, ArgAction, ArgMatches, Command};
use mimique_solver::{Kind, NamesOf, PARAMETERS, Parameter, Quantity};
use serde_json::{Map, Value, json};

use super::values::Length;

/// What was given of the parameters: each with its texts.
#[derive(Debug, Clone, Default)]
pub struct ParameterOptions(Vec<(&'static Parameter, Vec<String>)>);

impl ParameterOptions {
    /// The parameters as a method's JSON has them, without the method. A text that is no value of the
    /// parameter's kind stays a text, which the reader of the method then refuses.
    pub(super) fn to_json(&self) -> anyhow::Result<Map<String, Value>> {
        let mut values = Map::new();
        for (row, texts) in &self.0 {
            values.insert(row.key.to_owned(), value(row, texts)?);
        }
        Ok(values)
    }
}

impl clap::FromArgMatches for ParameterOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let mut given = Self::default();
        given.update_from_arg_matches(matches)?;
        Ok(given)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        for row in PARAMETERS {
            if let Some(texts) = matches.get_many::<String>(row.key) {
                self.0.retain(|(known, _)| known.key != row.key);
                self.0.push((row, texts.cloned().collect()));
            }
        }
        Ok(())
    }
}

impl clap::Args for ParameterOptions {
    fn augment_args(command: Command) -> Command {
        PARAMETERS.iter().fold(command, |command, row| command.arg(option(row)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

/// The option of a parameter.
fn option(row: &'static Parameter) -> Arg {
    let several = matches!(row.kind, Kind::Names | Kind::NumberByName | Kind::IntervalByName);
    let option = Arg::new(row.key)
        .long(row.option())
        .value_name(value_name(row))
        .help(help(row))
        .help_heading(row.about.group.heading())
        .allow_hyphen_values(true)
        .conflicts_with("settings")
        .action(if several { ArgAction::Append } else { ArgAction::Set });
    if row.kind == Kind::Names { option.value_delimiter(',') } else { option }
}

fn value_name(row: &Parameter) -> String {
    let one = match row.about.names_of {
        Some(NamesOf::Markers) => "MARKER",
        Some(NamesOf::Shapes) | None => "SHAPE",
    };
    match (row.kind, row.about.quantity) {
        (Kind::Number, Quantity::Metres) => "LENGTH".to_owned(),
        (Kind::Number, Quantity::Hertz) => "HZ".to_owned(),
        (Kind::Number, Quantity::Milliseconds) => "MS".to_owned(),
        (Kind::Number | Kind::WholeNumber, _) => "NUMBER".to_owned(),
        (Kind::Interval, _) => "LOW:HIGH".to_owned(),
        (Kind::Word(words), _) => words.join("|"),
        (Kind::Names, _) => format!("{one},{one}"),
        (Kind::NumberByName, _) => format!("{one}=NUMBER"),
        (Kind::IntervalByName, _) => format!("{one}=LOW:HIGH"),
    }
}

/// The help of an option: what it does, how it is written, which numbers it takes, its default.
fn help(row: &Parameter) -> String {
    let mut text = row.help.trim_end_matches('.').to_owned();
    match (row.kind, row.about.quantity) {
        (Kind::Number, Quantity::Metres) => text += ", with its unit as 12mm",
        (Kind::NumberByName | Kind::IntervalByName, _) => text += "; may be given again",
        _ => {}
    }
    let range = row.about.range.to_string();
    if !range.is_empty() {
        text += &format!("; {range}");
    }
    if let (Some(word), Some(zero)) = (row.about.zero_word, row.about.zero) {
        text += &format!("; {word}: {zero}");
    } else if let Some(zero) = row.about.zero {
        text += &format!("; 0: {zero}");
    }
    match row.default_text() {
        Some(default) => format!("{text} [default: {default}]"),
        None => text,
    }
}

/// The value that texts of the command line stand for.
fn value(row: &Parameter, texts: &[String]) -> anyhow::Result<Value> {
    let option = row.option();
    let by_name = |of: fn(&str) -> Value| -> anyhow::Result<Value> {
        let mut map = Map::new();
        for text in texts {
            let Some((name, value)) = text.split_once('=') else {
                bail!("--{option}: {text:?}; give it as {}", value_name(row));
            };
            if map.insert(name.to_owned(), of(value)).is_some() {
                bail!("--{option}: {name} is given twice; give it once");
            }
        }
        Ok(Value::Object(map))
    };
    let only = texts.last().map_or("", String::as_str);
    match row.kind {
        Kind::Number if Some(only) == row.about.zero_word => Ok(json!(0)),
        Kind::Number if row.about.quantity == Quantity::Metres => {
            let length =
                Length::from_str(only).map_err(|e| anyhow!("--{option}: {only:?}; {e}"))?;
            Ok(json!(length.0))
        }
        Kind::Number => Ok(number(only)),
        Kind::WholeNumber => Ok(only.parse::<u64>().map_or_else(|_| json!(only), |x| json!(x))),
        Kind::Interval => Ok(interval(only)),
        Kind::Word(_) => Ok(json!(only)),
        Kind::Names => Ok(json!(texts)),
        Kind::NumberByName => by_name(number),
        Kind::IntervalByName => by_name(interval),
    }
}

/// A finite number; the text itself where it is none.
fn number(text: &str) -> Value {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => json!(number),
        _ => json!(text),
    }
}

/// `LOW:HIGH`.
fn interval(text: &str) -> Value {
    match text.split_once(':') {
        Some((low, high)) => json!([number(low), number(high)]),
        None => json!(text),
    }
}
