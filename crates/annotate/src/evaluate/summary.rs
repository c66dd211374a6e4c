//! All takes of an evaluation together: scores, their intervals, the majority's scores beside them.

use std::collections::BTreeMap;

use serde::Serialize;

use super::{Comparison, Counts, FEWEST, Judged, Score, Scores, draws, intervals};
use crate::calibration::Reliability;
use crate::{AnnotateError, AnnotatedTake, Mark, Marked};

/// An evaluation in short.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// What is counted of all takes together.
    pub counts: Counts,
    /// Its scores.
    pub scores: Scores,
    /// The interval of each score; none where there is too little to resample.
    pub intervals: Option<Vec<Interval>>,
    /// The commonest true label, and what answering it for every take from end to end would score;
    /// none where no frame has a stable label.
    pub majority: Option<(usize, Scores)>,
    /// The counts of each person, by name.
    pub persons: Vec<(String, Counts)>,
    /// Of each frame's most probable label: as the scores have it, and by the temperature.
    pub reliability: [Reliability; 2],
}

/// The 95 % percentile interval of a score; none where no resample defines it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    /// The score.
    pub score: Score,
    /// Its lower and upper end.
    pub ends: Option<[f64; 2]>,
}

/// Resamples of takes or persons.
const RESAMPLES: usize = 2000;
/// Level of the intervals.
const LEVEL: f64 = 0.95;

/// Add up what was judged of some takes. Takes are resampled, or whole persons; fewer than
/// [`FEWEST`] of them have no intervals.
///
/// # Errors
/// [`AnnotateError::Count`] when nothing was judged.
pub fn summary(
    takes: &[AnnotatedTake],
    judged: &[Judged],
    labels: usize,
    by_person: bool,
    seed: u64,
) -> Result<Summary, AnnotateError> {
    let all: Vec<Counts> = judged.iter().map(|judged| judged.counts.clone()).collect();
    let Some(counts) = Counts::pooled(&all) else {
        return Err(AnnotateError::Count { what: "takes judged", found: 0, expected: 1 });
    };
    let mut of_person: BTreeMap<&str, Vec<&Counts>> = BTreeMap::new();
    for own in judged {
        of_person.entry(&takes[own.take].person).or_default().push(&own.counts);
    }
    let pooled =
        |(person, own): (&str, Vec<&Counts>)| Some((person.to_owned(), Counts::pooled(own)?));
    let persons: Vec<(String, Counts)> = of_person.into_iter().filter_map(pooled).collect();
    let units =
        if by_person { persons.iter().map(|(_, counts)| counts.clone()).collect() } else { all };
    let mut reliability = [Reliability::default(), Reliability::default()];
    for own in judged {
        reliability.iter_mut().zip(&own.reliability).for_each(|(sum, own)| sum.add(own));
    }
    Ok(Summary {
        scores: counts.scores(),
        intervals: all_intervals(&units, seed)?,
        majority: majority(takes, judged, &counts, labels)?,
        counts,
        persons,
        reliability,
    })
}

fn all_intervals(units: &[Counts], seed: u64) -> Result<Option<Vec<Interval>>, AnnotateError> {
    if units.len() < FEWEST {
        return Ok(None);
    }
    let draws = draws(units.len(), RESAMPLES, seed)?;
    let ends = intervals(units, &draws, LEVEL, &Score::ALL)?;
    let all = Score::ALL.into_iter().zip(ends).map(|(score, ends)| Interval { score, ends });
    Ok(Some(all.collect()))
}

/// What answering the commonest true label for every take would score.
fn majority(
    takes: &[AnnotatedTake],
    judged: &[Judged],
    counts: &Counts,
    labels: usize,
) -> Result<Option<(usize, Scores)>, AnnotateError> {
    let truths: Vec<u64> = counts.confusion.rows().map(|row| row.iter().sum()).collect();
    let Some(most) = truths.iter().copied().max().filter(|&most| most > 0) else { return Ok(None) };
    let label = truths.iter().position(|&n| n == most).unwrap_or(0);
    let mut always = Vec::with_capacity(judged.len());
    for own in judged {
        let AnnotatedTake { take, marked, .. } = &takes[own.take];
        let frames = take.frames();
        let tolerance = 0;
        let whole = [Marked { frames: 0..frames, mark: Mark::Stable(label) }];
        always.push(Comparison { labels, frames, tolerance }.counts(marked, &whole)?);
    }
    Ok(Counts::pooled(&always).map(|counts| (label, counts.scores())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::{Candidate, Cut, Fold, check_folds, held_out, leave_out};
    use crate::{Decoding, ForestOptions, Lesson, Method, Take};
    use mimique_test_support::Random;

    /// Eight seconds at 30 Hz of three faces, two seconds neutral, then three each of two others, which
    /// lie elsewhere for every person.
    fn take(person: usize, number: u64) -> AnnotatedTake {
        let mut random = Random::new(100 * person as u64 + number);
        let shift = 0.05 * person as f64;
        let faces = [[0.0, 0.0], [0.7, 0.1], [0.1, 0.8]];
        let label = |f: usize| match f {
            0..60 => 0,
            60..150 => 1 + (number as usize) % 2,
            _ => 2 - (number as usize) % 2,
        };
        let values =
            (0..240).flat_map(|f| faces[label(f)].map(|w| w + shift + 0.03 * random.normal()));
        let marked = [0..60, 60..150, 150..240]
            .map(|frames| Marked { mark: Mark::Stable(label(frames.start)), frames });
        AnnotatedTake {
            name: format!("{person}-{number}"),
            person: format!("p{person}"),
            kind: String::new(),
            take: Take::new(values.collect(), 2, 30.0).unwrap(),
            marked: marked.to_vec(),
        }
    }

    fn candidate(own_person: bool) -> Candidate {
        let lesson = Lesson {
            channel: "affect".to_owned(),
            labels: ["neutral", "a", "b"].map(str::to_owned).to_vec(),
            shapes: ["x", "y"].map(str::to_owned).to_vec(),
            method: Method::Forest(ForestOptions { trees: 20, ..ForestOptions::default() }),
            thinned_to_hz: Some(10.0),
            decoding: Decoding::default(),
        };
        let cuts = vec![Cut::Found(lesson.decoding.clone())];
        Candidate { lesson, cuts, own_person, calibrated: true }
    }

    #[test]
    fn planted_faces_are_found_in_takes_and_persons_that_are_held_out() {
        let takes: Vec<AnnotatedTake> =
            (0..3).flat_map(|person| (0..2).map(move |number| take(person, number))).collect();
        let by_take: Vec<Fold> = leave_out(&[0, 1, 2, 3, 4, 5]).unwrap();
        check_folds(3, &takes, &by_take).unwrap();
        for own_person in [false, true] {
            let candidate = candidate(own_person);
            assert!(candidate.can_learn(&takes, &by_take));
            let judged = held_out(&candidate, &takes, &by_take, &|_| ()).unwrap().remove(0);
            let numbers: Vec<usize> = judged.iter().map(|judged| judged.take).collect();
            assert_eq!(numbers, [0, 1, 2, 3, 4, 5]);
            let found = summary(&takes, &judged, 3, false, 1).unwrap();
            assert!(found.scores.frames.accuracy.unwrap() > 0.97);
            assert_eq!(found.scores.segments.f1[2], Some(1.0));
            let (label, majority) = found.majority.unwrap();
            assert_eq!(label, 1);
            assert!((majority.frames.accuracy.unwrap() - 0.375).abs() < 1e-12);
            assert_eq!(majority.frames.kappa, Some(0.0));
            assert!(
                majority.segments.f1[2].unwrap() < 0.01 && majority.borders.recall == Some(0.0)
            );
            assert_eq!(found.persons.len(), 3);
            let own = &found.intervals.unwrap()[0];
            let [low, high] = own.ends.unwrap();
            let accuracy = found.scores.frames.accuracy.unwrap();
            assert!(own.score == Score::Accuracy && low <= accuracy && accuracy <= high);
            assert_eq!(found.reliability[1].n(), 6 * 240);
        }
        // Three persons are too few for intervals, whoever is held out.
        let persons: Vec<&str> = takes.iter().map(|take| take.person.as_str()).collect();
        let folds = leave_out(&persons).unwrap();
        let judged = held_out(&candidate(false), &takes, &folds, &|_| ()).unwrap().remove(0);
        assert_eq!(summary(&takes, &judged, 3, true, 1).unwrap().intervals, None);
        // Nobody is left to learn from.
        assert!(!candidate(true).can_learn(&takes, &folds));
        assert!(held_out(&candidate(true), &takes, &folds, &|_| ()).is_err());
    }

    #[test]
    fn true_segments_are_labelled_as_a_whole_and_threads_do_not_matter() {
        let takes: Vec<AnnotatedTake> = (0..4).map(|number| take(0, number)).collect();
        let folds = leave_out(&[0, 1, 2, 3]).unwrap();
        let candidate = Candidate { cuts: vec![Cut::True], calibrated: false, ..candidate(false) };
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| held_out(&candidate, &takes, &folds, &|_| ()).unwrap())
        };
        let found = on(1);
        assert_eq!(found, on(3));
        let found = summary(&takes, &found[0], 3, false, 1).unwrap();
        assert_eq!((found.scores.labelled.n, found.scores.labelled.accuracy), (12, Some(1.0)));
        assert_eq!(found.scores.segments.weighted_iou, Some(1.0));
    }

    #[test]
    fn a_label_that_is_held_out_as_a_whole_is_refused() {
        let mut takes: Vec<AnnotatedTake> = (0..4).map(|number| take(0, number)).collect();
        for (number, take) in takes.iter_mut().enumerate() {
            if number > 1 {
                take.marked.truncate(1);
            }
        }
        let folds = [Fold { train: vec![2, 3], test: vec![0, 1] }];
        let expected = AnnotateError::HeldOut { label: 1, take: 0 };
        assert_eq!(check_folds(3, &takes, &folds).unwrap_err(), expected);
    }
}
