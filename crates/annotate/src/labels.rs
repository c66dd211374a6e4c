//! Labels: a vocabulary, what a word of an annotator means, and intervals that bear labels.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::AnnotateError;

/// What annotators and suggestions write where they do not know.
pub const UNKNOWN: &str = "?";

/// What an interval is: a label, or the way from one to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mark {
    /// A label, by its index.
    Stable(usize),
    /// From one label to another (thesis 4.3.2: `NA`, neutral to anger).
    Transition(usize, usize),
}

/// Frames and what they are.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Marked {
    /// First frame, one past the last.
    pub frames: Range<usize>,
    /// What they are.
    pub mark: Mark,
}

/// The labels of a study and the words that annotators write for them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Vocabulary {
    entries: Vec<(String, String)>,
}

impl Vocabulary {
    /// Labels with their words, sorted by label, by code point. Indices of labels count these.
    pub fn new<L: Into<String>, W: Into<String>>(
        entries: impl IntoIterator<Item = (L, W)>,
    ) -> Self {
        let entries = entries.into_iter().map(|(label, word)| (label.into(), word.into()));
        let mut entries: Vec<(String, String)> = entries.collect();
        entries.sort();
        entries.dedup_by(|b, a| b.0 == a.0);
        Self { entries }
    }

    /// Labels whose words are the labels themselves.
    pub fn of_labels(labels: impl IntoIterator<Item = String>) -> Self {
        Self::new(labels.into_iter().map(|label| (label.clone(), label)))
    }

    /// The words of annotators where nobody has named them: all that are written, but `?` and what is
    /// two of the others joined (`NA`) or about a `>` (`neutral>anger`). Each word is its own label.
    pub fn found_in<'t>(words: impl IntoIterator<Item = &'t str>) -> Self {
        let words: BTreeSet<&str> =
            words.into_iter().filter(|w| !w.is_empty() && *w != UNKNOWN).collect();
        let all = Self::of_labels(words.iter().map(|&word| word.to_owned()));
        let two = |word: &str| all.parts(word).chain(all.named_parts(word)).next().is_some();
        Self::of_labels(words.into_iter().filter(|word| !two(word)).map(str::to_owned))
    }

    /// The labels, by index.
    pub fn labels(&self) -> impl ExactSizeIterator<Item = &str> {
        self.entries.iter().map(|(label, _)| label.as_str())
    }

    /// The word of a label.
    pub fn word(&self, label: usize) -> Option<&str> {
        self.entries.get(label).map(|(_, word)| word.as_str())
    }

    /// What a word means: a label, or a transition, which is two words joined. None for anything
    /// else, and for what can be parted in two ways.
    pub fn read(&self, text: &str) -> Option<Mark> {
        match self.of_word(text) {
            Some(label) => Some(Mark::Stable(label)),
            None => only(self.parts(text)),
        }
    }

    /// The transitions that a text can be: two words joined.
    fn parts(&self, text: &str) -> impl Iterator<Item = Mark> {
        text.char_indices().filter_map(move |(at, _)| {
            let (from, to) = text.split_at(at);
            Some(Mark::Transition(self.of_word(from)?, self.of_word(to)?))
        })
    }

    fn of_word(&self, word: &str) -> Option<usize> {
        self.entries.iter().position(|(_, own)| own == word)
    }

    /// The index of a label.
    pub fn label(&self, name: &str) -> Option<usize> {
        self.entries.iter().position(|(label, _)| label == name)
    }

    /// What a name means: a label's name, or two of them about a `>`.
    pub fn read_name(&self, text: &str) -> Option<Mark> {
        match self.label(text) {
            Some(label) => Some(Mark::Stable(label)),
            None => only(self.named_parts(text)),
        }
    }

    /// The transitions that a text can be: two names about a `>`.
    fn named_parts(&self, text: &str) -> impl Iterator<Item = Mark> {
        text.match_indices('>').filter_map(move |(at, _)| {
            Some(Mark::Transition(self.label(&text[..at])?, self.label(&text[at + 1..])?))
        })
    }

    /// The marks of intervals, in any order, each with what is written there: a word, two joined, or
    /// names as [`Vocabulary::name`] writes them. With `rest`, frames in none of the intervals have
    /// that label.
    ///
    /// # Errors
    /// [`AnnotateError::Interval`] for intervals that are empty, overlap or reach beyond the take.
    pub fn marks(
        &self,
        intervals: &[(Range<usize>, &str)],
        frames: usize,
        rest: Option<usize>,
    ) -> Result<ReadMarks, AnnotateError> {
        let mut sorted: Vec<&(Range<usize>, &str)> = intervals.iter().collect();
        sorted.sort_by_key(|(own, _)| (own.start, own.end));
        apart(sorted.iter().map(|(own, _)| own), frames)?;
        let mut read = ReadMarks::default();
        let mut unknown: BTreeMap<&str, usize> = BTreeMap::new();
        let mut before = 0;
        for (own, text) in sorted {
            if let Some(label) = rest
                && before < own.start
            {
                read.marked.push(Marked { frames: before..own.start, mark: Mark::Stable(label) });
            }
            before = own.end;
            match self.read_name(text).or_else(|| self.read(text)) {
                Some(mark) => read.marked.push(Marked { frames: own.clone(), mark }),
                None => *unknown.entry(text).or_default() += 1,
            }
        }
        if let Some(label) = rest
            && before < frames
        {
            read.marked.push(Marked { frames: before..frames, mark: Mark::Stable(label) });
        }
        read.unknown = unknown.into_iter().map(|(word, n)| (word.to_owned(), n)).collect();
        Ok(read)
    }

    /// The name of a mark: a label's, or two of them about a `>`.
    pub fn name(&self, mark: Mark) -> Option<String> {
        let of = |label: usize| self.entries.get(label).map(|(label, _)| label.clone());
        match mark {
            Mark::Stable(label) => of(label),
            Mark::Transition(from, to) => Some(format!("{}>{}", of(from)?, of(to)?)),
        }
    }
}

/// The only member.
fn only<T>(mut items: impl Iterator<Item = T>) -> Option<T> {
    let first = items.next()?;
    items.next().is_none().then_some(first)
}

/// What an annotator has written of a take, read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReadMarks {
    /// The marks, in order of time.
    pub marked: Vec<Marked>,
    /// Words that are neither a label nor two joined, each once, with how often they stand there:
    /// their frames have no label.
    pub unknown: Vec<(String, usize)>,
}

/// Refuses intervals that are empty, overlap, are out of order, or reach beyond the take.
///
/// # Errors
/// [`AnnotateError::Interval`] with the first such interval.
pub fn check(marked: &[Marked], frames: usize) -> Result<(), AnnotateError> {
    apart(marked.iter().map(|marked| &marked.frames), frames)
}

/// Refuses ranges as [`check`] does.
fn apart<'r>(
    ranges: impl Iterator<Item = &'r Range<usize>>,
    frames: usize,
) -> Result<(), AnnotateError> {
    let mut before = 0;
    for Range { start, end } in ranges {
        if start >= end || *start < before || *end > frames {
            return Err(AnnotateError::Interval { first: *start, end: *end, frames });
        }
        before = *end;
    }
    Ok(())
}

/// The label of every frame; none in transitions and where nothing is marked.
pub(crate) fn by_frame(marked: &[Marked], frames: usize) -> Vec<Option<usize>> {
    let mut labels = vec![None; frames];
    for Marked { frames, mark } in marked {
        if let Mark::Stable(label) = mark {
            labels[frames.clone()].fill(Some(*label));
        }
    }
    labels
}

/// The stable label that an interval shares most frames with, of several the lowest: the truth of
/// an automatic segment. None where it shares frames with none.
pub fn most_shared(marked: &[Marked], segment: &Range<usize>) -> Option<usize> {
    let mut shared: Vec<(usize, usize)> = Vec::new();
    for Marked { frames, mark } in marked {
        let common = frames.end.min(segment.end).saturating_sub(frames.start.max(segment.start));
        let Mark::Stable(label) = *mark else { continue };
        match shared.iter_mut().find(|(own, _)| *own == label) {
            Some((_, sum)) => *sum += common,
            None => shared.push((label, common)),
        }
    }
    let most = shared.into_iter().filter(|(_, n)| *n > 0).max_by_key(|(l, n)| (*n, usize::MAX - l));
    most.map(|(label, _)| label)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words() -> Vocabulary {
        Vocabulary::new([("surprise", "Su"), ("sadness", "Sa"), ("anger", "A"), ("neutral", "N")])
    }

    #[test]
    fn a_word_is_a_label_and_two_are_a_transition() {
        let words = words();
        assert_eq!(words.labels().collect::<Vec<_>>(), ["anger", "neutral", "sadness", "surprise"]);
        assert_eq!(words.read("Su"), Some(Mark::Stable(3)));
        assert_eq!(words.read("NA"), Some(Mark::Transition(1, 0)));
        assert_eq!(words.read("SaSu"), Some(Mark::Transition(2, 3)));
        for unknown in ["", "?", "S", "NAN", "n"] {
            assert_eq!(words.read(unknown), None, "{unknown}");
        }
        let ambiguous = Vocabulary::new([("a", "A"), ("b", "AB"), ("c", "B"), ("d", "BB")]);
        assert_eq!(ambiguous.read("ABB"), None);
        assert_eq!(words.read_name("neutral>anger"), Some(Mark::Transition(1, 0)));
        assert_eq!(words.name(Mark::Transition(1, 0)).unwrap(), "neutral>anger");
        assert_eq!(words.word(0), Some("A"));
    }

    #[test]
    fn words_of_annotators_are_labels_unless_two_are_joined() {
        let found = Vocabulary::found_in(["N", "NA", "A", "Sa", "Su", "SaSu", "?", "", "A>N", "N"]);
        assert_eq!(found.labels().collect::<Vec<_>>(), ["A", "N", "Sa", "Su"]);
        assert_eq!(found.label("Su"), Some(3));
        assert_eq!(Vocabulary::found_in([]).labels().len(), 0);
    }

    #[test]
    fn intervals_are_read_and_what_is_between_is_what_the_user_says() {
        let words = words();
        let given = [(30..40, "Sa"), (5..10, "neutral"), (20..30, "?"), (10..20, "NSa")];
        let stable = |frames, label| Marked { frames, mark: Mark::Stable(label) };
        let way = Marked { frames: 10..20, mark: Mark::Transition(1, 2) };
        let read = words.marks(&given, 50, None).unwrap();
        assert_eq!(read.marked, [stable(5..10, 1), way.clone(), stable(30..40, 2)]);
        assert_eq!(read.unknown, [("?".to_owned(), 1)]);
        let rest = words.marks(&given, 50, Some(1)).unwrap().marked;
        let all = [stable(0..5, 1), stable(5..10, 1), way, stable(30..40, 2), stable(40..50, 1)];
        assert_eq!(rest, all);
        let beyond = words.marks(&given, 39, None).unwrap_err();
        assert_eq!(beyond, AnnotateError::Interval { first: 30, end: 40, frames: 39 });
        assert!(words.marks(&[(0..5, "N"), (4..6, "A")], 9, None).is_err());
    }

    #[test]
    fn the_truth_of_a_segment() {
        let stable = |frames, label| Marked { frames, mark: Mark::Stable(label) };
        let way = Marked { frames: 10..30, mark: Mark::Transition(1, 0) };
        let marked = [stable(0..10, 1), way, stable(30..35, 0), stable(35..40, 1)];
        assert_eq!(check(&marked, 40), Ok(()));
        assert!(check(&marked, 39).is_err() && check(&[stable(3..3, 0)], 9).is_err());
        assert_eq!(most_shared(&marked, &(5..40)), Some(1));
        assert_eq!(most_shared(&marked, &(31..39)), Some(0));
        assert_eq!(most_shared(&marked, &(12..20)), None);
        assert_eq!(by_frame(&marked, 41)[29..31], [None, Some(0)]);
    }
}
