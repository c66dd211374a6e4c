//! Labels: a vocabulary, what a word of an annotator means, and intervals that bear labels.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::AnnotateError;

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
        let of = |word: &str| self.entries.iter().position(|(_, own)| own == word);
        if let Some(label) = of(text) {
            return Some(Mark::Stable(label));
        }
        let parts = text.char_indices().filter_map(|(at, _)| {
            let (from, to) = text.split_at(at);
            Some(Mark::Transition(of(from)?, of(to)?))
        });
        only(parts)
    }

    /// What a name means: a label's name, or two of them about a `>`.
    pub fn read_name(&self, text: &str) -> Option<Mark> {
        let of = |name: &str| self.entries.iter().position(|(label, _)| label == name);
        if let Some(label) = of(text) {
            return Some(Mark::Stable(label));
        }
        only(
            text.match_indices('>').filter_map(|(at, _)| {
                Some(Mark::Transition(of(&text[..at])?, of(&text[at + 1..])?))
            }),
        )
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

/// The frame of a time: milliseconds times rate / 1000, halves up.
pub fn frame_of_ms(ms: u64, rate_hz: f64) -> usize {
    (ms as f64 * rate_hz / 1000.0 + 0.5).floor() as usize
}

/// Refuses intervals that are empty, overlap, are out of order, or reach beyond the take.
///
/// # Errors
/// [`AnnotateError::Interval`] with the first such interval.
pub fn check(marked: &[Marked], frames: usize) -> Result<(), AnnotateError> {
    let mut before = 0;
    for Marked { frames: Range { start, end }, .. } in marked {
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
    fn frames_of_times_and_the_truth_of_a_segment() {
        assert_eq!([frame_of_ms(25, 60.0), frame_of_ms(24, 60.0), frame_of_ms(0, 60.0)], [2, 1, 0]);
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
