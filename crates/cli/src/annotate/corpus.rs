//! Annotated takes, read: every file of `takes.csv` and what its words mean.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use anyhow::{anyhow, bail};
use mimique_annotate::labels::UNKNOWN;
use mimique_annotate::{AnnotatedTake, Take, Vocabulary, columns};

use super::intervals::{self, Intervals};
use super::rounded;
use super::takes_table::{TakeLine, TakesTable};
use crate::capture_options::CaptureOptions;
use crate::motion::{self, Motion};

/// Options.
#[derive(clap::Args)]
pub struct CorpusOptions {
    /// Table of takes: weights,labels,person,kind; files are named from its folder
    takes: PathBuf,
    /// Tier of the ELAN documents
    #[arg(long, value_name = "NAME")]
    pub tier: Option<String>,
    /// The labels and the words that annotators write for them (by default every word that is not two
    /// others joined)
    #[arg(long, value_name = "LABEL=WORD,LABEL=WORD", value_delimiter = ',')]
    words: Vec<LabelWord>,
    /// Label of all frames that no annotator has marked (by default they have none)
    #[arg(long, value_name = "LABEL")]
    rest: Option<String>,
    #[command(flatten)]
    read: CaptureOptions,
}

/// `LABEL=WORD`, or a label that is its own word.
#[derive(Debug, Clone)]
struct LabelWord(String, String);

impl FromStr for LabelWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (label, word) = text.split_once('=').unwrap_or((text, text));
        let (label, word) = (label.trim(), word.trim());
        if label.is_empty() || word.is_empty() || word == UNKNOWN {
            return Err("give LABEL=WORD, as anger=A".to_owned());
        }
        Ok(Self(label.to_owned(), word.to_owned()))
    }
}

/// The takes.
pub struct Corpus {
    /// The table that names them.
    pub file: PathBuf,
    /// The takes, their columns those of the first.
    pub takes: Vec<AnnotatedTake>,
    /// The line of each in the table.
    pub lines: Vec<u64>,
    /// The labels.
    pub labels: Vec<String>,
    /// Names of the columns.
    pub shapes: Vec<String>,
    /// What the labels are of.
    pub channel: String,
    /// What the table says of its takes.
    pub description: Vec<String>,
    /// What is to be said of the files.
    pub notes: Vec<String>,
}

/// A take as its files have it.
struct TakeFiles {
    motion: Motion,
    intervals: Intervals,
}

/// What is said of the files of a take: file and note.
fn notes(line: &TakeLine, motion: &Motion, intervals: &Intervals) -> Vec<(String, String)> {
    let of = |file: &Path, note: &String| (file.display().to_string(), note.clone());
    let of_motion = motion.notes.iter().map(|note| of(&line.weights, note));
    of_motion.chain(intervals.note.iter().map(|note| of(&line.labels, note))).collect()
}

/// What is said of files, once where it is said of several.
fn together(told: Vec<(String, String)>) -> Vec<String> {
    let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (file, note) in told {
        files.entry(note).or_default().push(file);
    }
    let said = files.into_iter().map(|(note, files)| match &files[..] {
        [file] => format!("{file}: {note}"),
        files => format!("{} files: {note}", files.len()),
    });
    said.collect()
}

impl CorpusOptions {
    /// Reads all files.
    pub fn read(&self) -> anyhow::Result<Corpus> {
        let TakesTable { lines, description } = TakesTable::read(&self.takes)?;
        let mut files: Vec<TakeFiles> = Vec::with_capacity(lines.len());
        for line in &lines {
            let motion = motion::read_comparable(&line.weights, &self.read)?;
            if let Some(first) = files.first() {
                self.same_rate(line, &motion, &first.motion)?;
            }
            let rate_hz = files.first().map_or(motion.rate_hz, |first| first.motion.rate_hz);
            let intervals = intervals::read(&line.labels, self.tier.as_deref(), rate_hz)?;
            files.push(TakeFiles { motion, intervals });
        }
        let vocabulary = self.vocabulary(&files)?;
        let mut corpus = Corpus {
            file: self.takes.clone(),
            takes: Vec::with_capacity(lines.len()),
            lines: lines.iter().map(|line| line.line).collect(),
            labels: vocabulary.labels().map(str::to_owned).collect(),
            shapes: files[0].motion.names.clone(),
            channel: self.tier.clone().unwrap_or_else(|| "labels".to_owned()),
            description,
            notes: Vec::new(),
        };
        let rate_hz = files[0].motion.rate_hz;
        let mut unknown: BTreeMap<String, usize> = BTreeMap::new();
        let mut told = Vec::new();
        for (line, TakeFiles { motion, intervals }) in lines.iter().zip(files) {
            told.extend(notes(line, &motion, &intervals));
            let take = corpus.columns_of(line, motion, rate_hz)?;
            let written: Vec<_> = intervals
                .intervals
                .iter()
                .map(|(own, word)| (own.clone(), word.as_str()))
                .collect();
            let rest = self.rest.as_deref().and_then(|rest| vocabulary.label(rest));
            let read = vocabulary.marks(&written, take.frames(), rest);
            let read = read.map_err(|e| anyhow!("{}: {e}", line.labels.display()))?;
            for (word, count) in read.unknown {
                *unknown.entry(word).or_default() += count;
            }
            corpus.takes.push(AnnotatedTake {
                name: line.name.clone(),
                person: line.person.clone(),
                kind: line.kind.clone(),
                take,
                marked: read.marked,
            });
        }
        corpus.notes = together(told);
        if !unknown.is_empty() {
            let told: Vec<String> =
                unknown.iter().map(|(word, count)| format!("{word:?} ({count})")).collect();
            corpus.notes.push(format!("words that are no label: {}", told.join(", ")));
        }
        corpus.refuse_twice()?;
        Ok(corpus)
    }

    fn same_rate(&self, line: &TakeLine, own: &Motion, first: &Motion) -> anyhow::Result<()> {
        if (own.rate_hz - first.rate_hz).abs() > 1e-3 * first.rate_hz {
            bail!(
                "{}: line {}: {} has {} Hz, the first take {}; bring all takes to one rate",
                self.takes.display(),
                line.line,
                line.weights.display(),
                rounded(own.rate_hz),
                rounded(first.rate_hz)
            );
        }
        Ok(())
    }

    /// The labels and their words: as given, or all that are written.
    fn vocabulary(&self, files: &[TakeFiles]) -> anyhow::Result<Vocabulary> {
        let rest = self.rest.as_deref();
        if self.words.is_empty() {
            let written = files.iter().flat_map(|own| &own.intervals.intervals);
            let words = written.map(|(_, word)| word.as_str()).chain(rest);
            return Ok(Vocabulary::found_in(words));
        }
        let entries = self.words.iter().map(|LabelWord(label, word)| (label.clone(), word.clone()));
        let vocabulary = Vocabulary::new(entries);
        if vocabulary.labels().len() < self.words.len() {
            bail!("--words: a label twice; give each label one word");
        }
        if let Some(rest) = rest.filter(|rest| vocabulary.label(rest).is_none()) {
            bail!("--rest: {rest:?} is none of the labels of --words; add it there");
        }
        Ok(vocabulary)
    }
}

impl Corpus {
    /// The take with the columns of the first, matched by name.
    fn columns_of(&self, line: &TakeLine, motion: Motion, rate_hz: f64) -> anyhow::Result<Take> {
        let blame = |e: mimique_annotate::AnnotateError| {
            anyhow!("{}: line {}: {}: {e}", self.file.display(), line.line, line.weights.display())
        };
        let kept = columns(&self.shapes, &motion.names).map_err(blame)?;
        let take = Take::new(motion.values, motion.names.len(), rate_hz).map_err(blame)?;
        take.columns(&kept).map_err(blame)
    }

    /// Refuses the same motion twice: it would be learnt from and tested.
    fn refuse_twice(&self) -> anyhow::Result<()> {
        let mut seen: BTreeMap<String, u64> = BTreeMap::new();
        for (take, line) in self.takes.iter().zip(&self.lines) {
            if let Some(before) = seen.insert(take.learnt().weights, *line) {
                bail!(
                    "{}: line {line}: {} is the same motion as that of line {before}, which would then be \
                     learnt from and tested; leave one out",
                    self.file.display(),
                    take.name
                );
            }
        }
        Ok(())
    }

    /// Refuses lines whose column says nothing.
    pub fn needs(&self, column: &str, of: fn(&AnnotatedTake) -> &str) -> anyhow::Result<()> {
        match self.takes.iter().zip(&self.lines).find(|(take, _)| of(take).is_empty()) {
            Some((_, line)) => bail!(
                "{}: line {line}: column {column} says nothing; fill it, or use --split take",
                self.file.display()
            ),
            None => Ok(()),
        }
    }
}
