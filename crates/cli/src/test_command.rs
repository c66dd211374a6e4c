//! `mimique test NAME DATA.csv …`: one statistical test on a data file.
//!
//! The tests, their options and their words are those of `mimique-stats`; here they become options of
//! the command line. The result goes to stdout, as text or as JSON with `status` `ok` or `undefined`.
//! What cannot be tested is refused: `error: FILE: column …` on stderr, exit code 2, and with `--json`
//! also `{"status": "refused", "reason": …}` on stdout.

use std::io::Write;
use std::path::PathBuf;

use anyhow::Context;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use mimique_stats::{
    Answer, Arguments, PROCEDURES, Procedure, ProcedureOption, Required, Table, Takes,
};

/// A test that was chosen, its file and what was given for its options.
pub struct Args {
    procedure: &'static Procedure,
    data: PathBuf,
    arguments: Arguments,
}

impl clap::Args for Args {
    fn augment_args(command: Command) -> Command {
        command
            .subcommand_required(true)
            .arg_required_else_help(true)
            .subcommands(PROCEDURES.iter().map(|procedure| subcommand(procedure)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl clap::FromArgMatches for Args {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let chosen = matches.subcommand().and_then(|(name, matches)| {
            Some((*PROCEDURES.iter().find(|procedure| procedure.name == name)?, matches))
        });
        let data = chosen.and_then(|(_, matches)| matches.get_one::<PathBuf>("data"));
        let (Some((procedure, matches)), Some(data)) = (chosen, data) else {
            return Err(clap::Error::new(clap::error::ErrorKind::MissingSubcommand));
        };
        let given = procedure.options.iter().copied().flatten().filter_map(|option| {
            let values = match option.takes {
                Takes::Nothing => matches.get_flag(option.name).then(Vec::new)?,
                _ => matches.get_many::<String>(option.name)?.cloned().collect(),
            };
            Some((option.name.to_owned(), values))
        });
        Ok(Self { procedure, data: data.clone(), arguments: Arguments::new(given) })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// The subcommand of a procedure.
fn subcommand(procedure: &Procedure) -> Command {
    let data = Arg::new("data")
        .value_name("DATA")
        .help("CSV file with a header line")
        .required(true)
        .value_parser(value_parser!(PathBuf));
    Command::new(procedure.name)
        .about(procedure.question)
        .arg(data)
        .args(procedure.options.iter().copied().flatten().map(argument))
}

/// The argument of an option.
fn argument(option: &ProcedureOption) -> Arg {
    let argument = Arg::new(option.name)
        .long(option.name)
        .value_name(option.name.to_uppercase())
        .help(option.help)
        .requires_ifs(
            option.requires.iter().map(|other| (clap::builder::ArgPredicate::IsPresent, *other)),
        )
        .conflicts_with_all(option.excludes);
    let argument = match option.required {
        Required::No => argument,
        Required::Yes => argument.required(true),
        Required::Unless(other) => argument.required_unless_present(other),
    };
    match option.takes {
        Takes::Text => argument,
        Takes::List => argument.value_delimiter(',').num_args(1).action(ArgAction::Append),
        Takes::Nothing => argument.action(ArgAction::SetTrue),
        Takes::OneOf { choices, default } => {
            let words = choices.iter().map(|choice| {
                PossibleValue::new(choice.name).help(choice.meaning).aliases(choice.aliases)
            });
            let argument = argument.value_parser(PossibleValuesParser::new(words));
            match default {
                Some(default) => argument.default_value(default),
                None => argument,
            }
        }
    }
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let answer = args.answer().with_context(|| args.data.display().to_string());
    let mut out = std::io::stdout().lock();
    match answer {
        Ok(answer) if json => writeln!(out, "{}", answer.json)?,
        Ok(answer) => write!(out, "{}", answer.text)?,
        Err(error) => {
            if json {
                let reason = format!("{error:#}");
                writeln!(out, "{}", serde_json::json!({"status": "refused", "reason": reason}))?;
            }
            return Err(error);
        }
    }
    Ok(())
}

impl Args {
    fn answer(&self) -> anyhow::Result<Answer> {
        let bytes = std::fs::read(&self.data)
            .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))?;
        Ok((self.procedure.run)(&Table::parse(bytes)?, &self.arguments)?)
    }
}
