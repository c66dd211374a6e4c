//! `mimique test NAME DATA.csv …`: one statistical test on a data file.
//!
//! The result goes to stdout, as text or as JSON with `status` `ok` or `undefined`. What cannot be
//! tested is refused: `error: FILE: column …` on stderr, exit code 2, and with `--json` also
//! `{"status": "refused", "reason": …}` on stdout.

mod options;
mod text;

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Subcommand;
use mimique_stats::{
    Adjustment, Blocks, Contingency, Factor, Labelled, Numbers, Outcome, Refusal, Table,
    WilcoxonOptions, adjust_all, aligned_rank_transform, chi_square, confusion, describe, friedman,
    kruskal_wallis, mann_whitney, paired_differences, scheirer_ray_hare, spearman, wilcoxon,
};
use serde::Serialize;

use options::{Adjust, Direction, PostHoc, SsType, Variant};

/// Options.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    test: Test,
}

/// Each test with its options. Levels are in numeric order if all are numbers, else alphabetical;
/// `--levels` chooses some and sets their order. 'a | b' is a minus b.
#[derive(Subcommand)]
enum Test {
    /// Do independent groups differ? With Dunn's comparisons of all pairs
    KruskalWallis {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of numbers
        #[arg(long)]
        response: String,
        /// Column that tells the groups apart
        #[arg(long)]
        group: String,
        /// Groups to use, in this order
        #[arg(long, value_delimiter = ',')]
        levels: Vec<String>,
        /// Comparisons of pairs to print
        #[arg(long)]
        posthoc: Option<PostHoc>,
        /// Correction of those comparisons
        #[arg(long, default_value = "holm")]
        adjust: Adjust,
    },
    /// Do pairs differ? Wilcoxon's signed rank test
    Wilcoxon {
        /// CSV file with a header line
        data: PathBuf,
        /// First column of each pair
        #[arg(long, requires = "y", conflicts_with_all = ["difference", "response"])]
        x: Option<String>,
        /// Second column of each pair
        #[arg(long, requires = "x")]
        y: Option<String>,
        /// Column of differences
        #[arg(long, conflicts_with = "response")]
        difference: Option<String>,
        /// Column of numbers of a long table
        #[arg(long, requires = "group", requires = "pair")]
        response: Option<String>,
        /// Column that tells the two sides of a pair apart
        #[arg(long, requires = "response")]
        group: Option<String>,
        /// The two sides: differences are the first minus the second
        #[arg(long, value_delimiter = ',', requires = "group")]
        levels: Vec<String>,
        /// Column, or several with commas between, that tells which rows make a pair
        #[arg(long, requires = "response")]
        pair: Option<String>,
        /// Zeros, ties and approximation [default: exact-pratt up to 200 differences, else
        /// asymptotic-pratt]
        #[arg(long)]
        variant: Option<Variant>,
        /// Continuity correction of the asymptotic variants
        #[arg(long)]
        continuity: bool,
        /// Direction
        #[arg(long, default_value = "two-sided")]
        alternative: Direction,
    },
    /// Do two independent groups differ?
    MannWhitney {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of numbers
        #[arg(long)]
        response: String,
        /// Column that tells the groups apart
        #[arg(long)]
        group: String,
        /// The two groups: U is of the first
        #[arg(long, value_delimiter = ',')]
        levels: Vec<String>,
    },
    /// Do two factors, or their combination, matter? Two-way analysis of ranks
    ScheirerRayHare {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of numbers
        #[arg(long)]
        response: String,
        /// Two columns
        #[arg(long, value_delimiter = ',', num_args = 1, required = true)]
        factors: Vec<String>,
        /// Type of the sums of squares
        #[arg(long, default_value = "2")]
        ss: SsType,
    },
    /// Are two factors independent? Pearson's chi-square
    ChiSquare {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of the rows
        #[arg(long, required_unless_present = "counts", requires = "columns")]
        rows: Option<String>,
        /// Column of the columns
        #[arg(long, required_unless_present = "counts", requires = "rows")]
        columns: Option<String>,
        /// The file is the table itself: labels in the first column, counts in the others
        #[arg(long, conflicts_with_all = ["rows", "columns"])]
        counts: bool,
    },
    /// Do two variables rise together? Spearman's rho, with Kendall's tau-b
    Spearman {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of numbers
        #[arg(long)]
        x: String,
        /// Column of numbers
        #[arg(long)]
        y: String,
    },
    /// Do groups differ within blocks? With Iman and Davenport's F and Quade's test
    Friedman {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of numbers, one a block and group
        #[arg(long)]
        response: String,
        /// Column that tells the groups apart
        #[arg(long)]
        group: String,
        /// Column of the blocks (participants), or several with commas between
        #[arg(long)]
        block: String,
        /// Groups to use, in this order
        #[arg(long, value_delimiter = ',')]
        levels: Vec<String>,
    },
    /// Effects and interactions of two or three factors within blocks, on aligned ranks
    AlignedRankTransform {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of numbers
        #[arg(long)]
        response: String,
        /// Two or three columns
        #[arg(long, value_delimiter = ',', num_args = 1, required = true)]
        factors: Vec<String>,
        /// Column of the blocks (participants)
        #[arg(long)]
        block: String,
    },
    /// Mean, median, spread, quartiles
    Describe {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of numbers
        #[arg(long)]
        response: String,
        /// Describe each level of this column
        #[arg(long)]
        by: Option<String>,
    },
    /// What was shown against what was answered: accuracy, recall, precision, kappa
    Confusion {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of what was shown
        #[arg(long)]
        truth: String,
        /// Column of what was answered
        #[arg(long)]
        answer: String,
    },
    /// Correct p-values for the number of comparisons
    Adjust {
        /// CSV file with a header line
        data: PathBuf,
        /// Column of p-values
        #[arg(long)]
        p: String,
    },
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let path = args.test.data().to_owned();
    let answer = read(&path)
        .and_then(|table| args.test.answer(&table))
        .with_context(|| path.display().to_string());
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

fn read(path: &Path) -> anyhow::Result<Table> {
    let bytes = std::fs::read(path)
        .map_err(|error| anyhow::anyhow!("cannot be read ({error}); check the path"))?;
    Ok(Table::parse(bytes)?)
}

/// A result in both forms.
struct Answer {
    json: String,
    text: String,
}

fn answer<T: Serialize>(
    outcome: &Outcome<T>,
    words: impl FnOnce(&T) -> String,
) -> anyhow::Result<Answer> {
    let text = match outcome {
        Outcome::Ok(result) => words(result),
        Outcome::Undefined { reason } => format!("undefined: {reason}\n"),
    };
    Ok(Answer { json: serde_json::to_string_pretty(outcome)?, text })
}

/// `status` ok and the result's own fields.
fn certain<T: Serialize>(result: T, words: impl FnOnce(&T) -> String) -> anyhow::Result<Answer> {
    answer(&Outcome::Ok(result), words)
}

fn with_levels(factor: Factor, levels: &[String]) -> Result<Factor, Refusal> {
    if levels.is_empty() { Ok(factor) } else { factor.restricted(levels) }
}

/// The factors that `--factors A,B` names.
fn factors(table: &Table, names: &[String]) -> Result<Vec<Factor>, Refusal> {
    names.iter().map(|name| table.factor(name)).collect()
}

/// Descriptions by level, as a result of its own.
#[derive(Serialize)]
struct DescribedGroups {
    test: &'static str,
    by: String,
    groups: Labelled<Outcome<mimique_stats::Description>>,
}

impl Test {
    fn data(&self) -> &Path {
        match self {
            Self::KruskalWallis { data, .. }
            | Self::Wilcoxon { data, .. }
            | Self::MannWhitney { data, .. }
            | Self::ScheirerRayHare { data, .. }
            | Self::ChiSquare { data, .. }
            | Self::Spearman { data, .. }
            | Self::Friedman { data, .. }
            | Self::AlignedRankTransform { data, .. }
            | Self::Describe { data, .. }
            | Self::Confusion { data, .. }
            | Self::Adjust { data, .. } => data,
        }
    }

    fn answer(self, table: &Table) -> anyhow::Result<Answer> {
        match self {
            Self::KruskalWallis { response, group, levels, posthoc, adjust, .. } => {
                let group = with_levels(table.factor(&group)?, &levels)?;
                let outcome = kruskal_wallis(&table.numbers(&response)?, &group)?;
                let adjustment: Adjustment = adjust.into();
                answer(&outcome, |result| {
                    text::kruskal_wallis(result, posthoc.map(|PostHoc::Dunn| adjustment))
                })
            }
            Self::Wilcoxon {
                x,
                y,
                difference,
                response,
                group,
                levels,
                pair,
                variant,
                continuity,
                alternative,
                ..
            } => {
                let differences = match (x, y, difference, response, group, pair) {
                    (Some(x), Some(y), ..) => {
                        paired_differences(&table.numbers(&x)?, &table.numbers(&y)?)
                    }
                    (_, _, Some(difference), ..) => table.numbers(&difference)?,
                    (.., Some(response), Some(group), Some(pair)) => {
                        pair_differences(table, &response, &group, &levels, &pair)?
                    }
                    _ => anyhow::bail!(Refusal::Options {
                        problem: "no pairs are named".to_owned(),
                        remedy: "give --x X --y Y, or --difference D, or --response R --group G --levels A,B --pair P".to_owned(),
                    }),
                };
                let options = WilcoxonOptions {
                    variant: variant.map(Into::into).unwrap_or_default(),
                    continuity,
                    alternative: alternative.into(),
                };
                answer(&wilcoxon(&differences, options)?, |result| {
                    text::wilcoxon(result, &differences.name)
                })
            }
            Self::MannWhitney { response, group, levels, .. } => {
                let group = with_levels(table.factor(&group)?, &levels)?;
                answer(&mann_whitney(&table.numbers(&response)?, &group)?, text::mann_whitney)
            }
            Self::ScheirerRayHare { response, factors: names, ss, .. } => {
                let factors = factors(table, &names)?;
                let [first, second] = factors.as_slice() else {
                    anyhow::bail!(Refusal::Options {
                        problem: format!("--factors names {} columns", factors.len()),
                        remedy: "name two, with a comma between".to_owned(),
                    })
                };
                let response = table.numbers(&response)?;
                answer(
                    &scheirer_ray_hare(&response, [first, second], ss.into())?,
                    text::scheirer_ray_hare,
                )
            }
            Self::ChiSquare { rows, columns, counts, .. } => {
                let contingency = match (rows, columns) {
                    (Some(rows), Some(columns)) if !counts => {
                        Contingency::of(&table.factor(&rows)?, &table.factor(&columns)?)?
                    }
                    _ => Contingency::from_table(table)?,
                };
                certain(chi_square(&contingency)?, text::chi_square)
            }
            Self::Spearman { x, y, .. } => {
                answer(&spearman(&table.numbers(&x)?, &table.numbers(&y)?)?, text::spearman)
            }
            Self::Friedman { response, group, block, levels, .. } => {
                let group = with_levels(table.factor(&group)?, &levels)?;
                let block = table.combined_factor(&block)?;
                let blocks = Blocks::of(&table.numbers(&response)?, &group, &block)?;
                answer(&friedman(&blocks), text::friedman)
            }
            Self::AlignedRankTransform { response, factors: names, block, .. } => {
                let factors = factors(table, &names)?;
                let factors: Vec<&Factor> = factors.iter().collect();
                let block = table.combined_factor(&block)?;
                answer(
                    &aligned_rank_transform(&table.numbers(&response)?, &factors, &block)?,
                    text::aligned_rank_transform,
                )
            }
            Self::Describe { response, by: None, .. } => {
                answer(&describe(&table.numbers(&response)?.values), |result| {
                    text::describe(&[("", result)])
                })
            }
            Self::Describe { response, by: Some(by), .. } => {
                let response = table.numbers(&response)?;
                let factor = table.factor(&by)?;
                factor.require_levels(1)?;
                let groups = (0..factor.levels.len() as u32).map(|level| {
                    let values: Vec<f64> = (0..factor.codes.len())
                        .filter(|&row| factor.codes[row] == level)
                        .map(|row| response.values[row])
                        .collect();
                    describe(&values)
                });
                let groups = Labelled::zip(&factor.levels, groups.collect::<Vec<_>>());
                certain(DescribedGroups { test: "describe", by, groups }, |result| {
                    text::described_groups(&result.groups)
                })
            }
            Self::Confusion { truth, answer, .. } => certain(
                confusion(&table.factor(&truth)?, &table.factor(&answer)?)?,
                text::confusion,
            ),
            Self::Adjust { p, .. } => {
                let column = table.numbers(&p)?;
                if let Some(row) = (0..table.rows()).find(|&row| {
                    !(0.0..=1.0).contains(&column.values[row]) && !column.values[row].is_nan()
                }) {
                    anyhow::bail!(Refusal::column(
                        &p,
                        format!(
                            "line {}: {} is no probability",
                            table.line(row),
                            column.values[row]
                        ),
                        "give numbers from 0 to 1",
                    ));
                }
                certain(adjust_all(&column.values), text::adjusted)
            }
        }
    }
}

/// Differences of the two levels of `group` within `pair`.
fn pair_differences(
    table: &Table,
    response: &str,
    group: &str,
    levels: &[String],
    pair: &str,
) -> anyhow::Result<Numbers> {
    let factor = with_levels(table.factor(group)?, levels)?;
    if factor.levels.len() != 2 {
        anyhow::bail!(Refusal::column(
            group,
            format!("{} levels, a pair has two sides", factor.levels.len()),
            "choose two with --levels A,B",
        ));
    }
    let blocks = Blocks::of(&table.numbers(response)?, &factor, &table.combined_factor(pair)?)?;
    Ok(blocks.differences(0, 1))
}
