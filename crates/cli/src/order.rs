//! `mimique order`: the exact trial order that a participant gets.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Context as _;
use mimique_study::{Draw, OrderedItem, order};

use crate::study_file::load;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study file (JSON, comments allowed)
    study: PathBuf,
    /// Place in the balance of conditions, as in the export's column `slot` (the participant's number
    /// where nobody was replaced)
    #[arg(long, short = 'k', visible_alias = "slot")]
    participant: u64,
    /// Condition, as in the export's column `assigned_condition`; needed where the study has conditions
    #[arg(long)]
    condition: Option<String>,
    /// Seed instead of the study's own
    #[arg(long)]
    seed: Option<u64>,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let file = args.study.display();
    let (value, study) = load(&args.study)?;
    let config_hash = mimique_study::config_hash(&value);
    let seed = args.seed.unwrap_or(study.seed);
    let conditions = study
        .sequence
        .conditions_for(args.condition.as_deref())
        .with_context(|| format!("{file}"))?;
    let condition = match conditions.as_slice() {
        [] => None,
        [only] => Some(*only),
        several => anyhow::bail!(
            "{file}: /sequence: the order depends on the participant's condition; add --condition {}",
            several.join(" or --condition ")
        ),
    };
    let draw = Draw { seed, config_hash: &config_hash, participant: args.participant, condition };
    let items = order(&study.projection(), draw).with_context(|| format!("{file}"))?;

    let mut out = std::io::stdout().lock();
    if json {
        let text = serde_json::json!({
            "study": study.id,
            "seed": seed,
            "config_hash": config_hash,
            "participant": args.participant,
            "condition": condition,
            "order": items,
        });
        writeln!(out, "{}", serde_json::to_string_pretty(&text)?)?;
        return Ok(());
    }
    let mut trials = 0;
    for item in &items {
        match item {
            OrderedItem::Trial { trial, clip, beside, panel, .. } => {
                trials += 1;
                let clip = match beside {
                    Some(right) => format!("{clip} | {right}"),
                    None if panel.is_empty() => clip.clone(),
                    None => panel.join(" | "),
                };
                writeln!(out, "{trials:>4}  {clip:<24}  {trial}")?;
            }
            OrderedItem::Component { component } => writeln!(out, "   -  {component}")?,
        }
    }
    Ok(())
}
