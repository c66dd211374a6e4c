//! `--decode` and what it decides: how labels of frames become segments.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{anyhow, bail};
use mimique_annotate::{Decode, Decoding, LabelPath, Segmentation, Take};
use mimique_stimulus::{ActivityOptions, BorderRule};

use super::intervals;
use super::method::AsIn;
use crate::border_options::{BorderOptions, Rule};

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Name {
    /// The most probable path of labels that stay
    Path,
    /// Segments of the take, each labelled by the mean of its frames
    Segments,
    /// Each frame by itself
    Frames,
}

/// `peaks`, `literal`, or a file of segments.
#[derive(Debug, Clone)]
enum Segments {
    Rule(BorderRule),
    File(PathBuf),
}

impl FromStr for Segments {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(text.parse().map_or_else(|_| Self::File(text.into()), |Rule(rule)| Self::Rule(rule)))
    }
}

/// The heading of what a decoding decides.
const HEADING: &str = "Segments";

/// Options.
#[derive(clap::Args)]
pub struct DecodeOptions {
    /// How labels of frames become segments [default: path]
    #[arg(long, value_name = "NAME", help_heading = HEADING)]
    decode: Option<Name>,
    /// Mean time that a label stays (path, and hmm) [default: 2]
    #[arg(long, value_name = "SECONDS", help_heading = HEADING)]
    pub stay: Option<f64>,
    /// Segments to be labelled: peaks, literal, or a file (.csv, .eaf); says --decode segments
    /// [default: peaks]
    #[arg(long, value_name = "peaks|literal|FILE", help_heading = HEADING)]
    segments: Option<Segments>,
    #[command(flatten, next_help_heading = HEADING)]
    borders: BorderOptions,
}

/// A decoding, or segments that a file gives.
pub enum Chosen {
    /// Of every take.
    Decoding(Decoding),
    /// Of the take that the file is of.
    Given(PathBuf),
}

impl DecodeOptions {
    /// Whether nothing is asked for.
    pub fn is_default(&self) -> bool {
        self.decode.is_none() && self.stay.is_none() && self.segments.is_none()
    }

    /// The decoding.
    pub fn chosen(&self, as_in: Option<AsIn>) -> anyhow::Result<Chosen> {
        if let Some(stay) = self.stay.filter(|stay| !(*stay > 0.0 && stay.is_finite())) {
            bail!("--stay: {stay}; give seconds above 0");
        }
        let thesis = as_in == Some(AsIn::Thesis);
        let by_segments = self.segments.is_some() || thesis;
        let name = self.decode.unwrap_or(if by_segments { Name::Segments } else { Name::Path });
        if name != Name::Segments && self.segments.is_some() {
            bail!("--segments: only --decode segments labels given segments; leave one out");
        }
        Ok(Chosen::Decoding(match name {
            Name::Path => {
                let default = LabelPath::default();
                let mean_stay_s = self.stay.unwrap_or(default.mean_stay_s);
                Decoding::Path(LabelPath { mean_stay_s, ..default })
            }
            Name::Frames => Decoding::Frames,
            Name::Segments => {
                let default = match thesis {
                    true => Segmentation::as_in_the_thesis(),
                    false => Segmentation::default(),
                };
                let rule = match &self.segments {
                    Some(Segments::File(file)) => return Ok(Chosen::Given(file.clone())),
                    Some(Segments::Rule(rule)) => *rule,
                    None => default.rule,
                };
                let activity: ActivityOptions = self.borders.over(default.activity)?;
                Decoding::Segments(Segmentation { activity, rule })
            }
        }))
    }

    /// The decoding of every take of a corpus: a file is of one take alone.
    pub fn of_all(&self, as_in: Option<AsIn>) -> anyhow::Result<Decoding> {
        match self.chosen(as_in)? {
            Chosen::Decoding(decoding) => Ok(decoding),
            Chosen::Given(file) => {
                bail!("--segments: {}: a file is of one take; use peaks or literal", file.display())
            }
        }
    }
}

impl Chosen {
    /// What it is for a take.
    pub fn of(&self, take: &Take, shapes: &[String], tier: Option<&str>) -> anyhow::Result<Decode> {
        match self {
            Self::Decoding(decoding) => Ok(decoding.of(take, shapes)?),
            Self::Given(file) => Ok(Decode::Segments(given(file, tier, take)?)),
        }
    }
}

/// The segments of a file, in order of time and inside the take.
fn given(file: &Path, tier: Option<&str>, take: &Take) -> anyhow::Result<Vec<Range<usize>>> {
    let read = intervals::read(file, tier, take.rate_hz)?;
    let mut segments: Vec<Range<usize>> =
        read.intervals.into_iter().map(|(frames, _)| frames).collect();
    segments.sort_by_key(|segment| (segment.start, segment.end));
    if let Some(pair) = segments.windows(2).find(|pair| pair[1].start < pair[0].end) {
        return Err(anyhow!(
            "{}: frames {}:{} and {}:{} overlap; shorten one",
            file.display(),
            pair[0].start,
            pair[0].end,
            pair[1].start,
            pair[1].end
        ));
    }
    match segments.last().filter(|last| last.end > take.frames()) {
        Some(last) => bail!(
            "{}: frames {}:{} of {}; give the segments of this take",
            file.display(),
            last.start,
            last.end,
            take.frames()
        ),
        None => Ok(segments),
    }
}
