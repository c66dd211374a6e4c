//! How fast a face changes, and which peaks of that are borders: what `segment` and `annotate` ask.

use std::str::FromStr;

use anyhow::bail;
use mimique_stimulus::{ActivityOptions, BorderRule, Literal};

/// Options of the energy in which borders are looked for (thesis 4.4, 4.5).
#[derive(clap::Args)]
pub struct BorderOptions {
    /// Unit of time in which velocity and acceleration are added: in 0.01 s the velocity decides, in 0.1 s
    /// both count [default: 0.01]
    #[arg(long, value_name = "SECONDS")]
    time_unit: Option<f64>,
    /// Cut-off of the low-pass before borders are looked for [default: 4]
    #[arg(long, value_name = "HZ")]
    cutoff: Option<f64>,
    /// Let shapes that shut or turn the eyes count for borders
    #[arg(long)]
    blinks_and_gaze: bool,
}

impl BorderOptions {
    /// The options over those that hold where nothing is asked for.
    pub fn over(&self, default: ActivityOptions) -> anyhow::Result<ActivityOptions> {
        for (option, value) in [("--time-unit", self.time_unit), ("--cutoff", self.cutoff)] {
            if let Some(value) = value.filter(|v| !(*v > 0.0 && v.is_finite())) {
                bail!("{option}: {value}; give a number above 0");
            }
        }
        Ok(ActivityOptions {
            time_unit_s: self.time_unit.unwrap_or(default.time_unit_s),
            cutoff_hz: self.cutoff.unwrap_or(default.cutoff_hz),
            blinks_and_gaze: self.blinks_and_gaze || default.blinks_and_gaze,
        })
    }

    /// The options.
    pub fn options(&self) -> anyhow::Result<ActivityOptions> {
        self.over(ActivityOptions::default())
    }
}

/// `peaks` or `literal`.
#[derive(Debug, Clone, Copy)]
pub struct Rule(pub BorderRule);

impl FromStr for Rule {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "peaks" => Ok(Self(BorderRule::Peaks)),
            "literal" => Ok(Self(BorderRule::Literal(Literal::default()))),
            _ => Err("give peaks or literal".to_owned()),
        }
    }
}
