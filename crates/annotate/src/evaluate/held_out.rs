//! What candidates say of takes that they have not learnt from.

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;

use super::{Comparison, Counts, Fold};
use crate::calibration::Reliability;
use crate::labels::by_frame;
use crate::numbers::highest;
use crate::{
    AnnotateError, AnnotatedTake, Answer, Decode, Decoding, Lesson, Mark, Marked, Model, Rows,
    Suggested, Temperature,
};

/// What is evaluated: what is learnt, and how takes are cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// What is learnt.
    pub lesson: Lesson,
    /// How takes are cut: each way is told by itself.
    pub cuts: Vec<Cut>,
    /// Learn only from takes of the person who is tested (thesis 4.4.3: each signer alone).
    pub own_person: bool,
    /// Find a temperature from takes that are held out of those that are learnt from.
    pub calibrated: bool,
}

/// How a take that is tested is cut.
#[derive(Debug, Clone, PartialEq)]
pub enum Cut {
    /// By the model.
    Found(Decoding),
    /// As the annotator cut it: its stable stretches (thesis 4.5, the manual segments).
    True,
}

/// What was said of a take, held against its truth.
#[derive(Debug, Clone, PartialEq)]
pub struct Judged {
    /// Which take.
    pub take: usize,
    /// What was said.
    pub answer: Answer,
    /// What it is worth.
    pub counts: Counts,
    /// Of each frame's most probable label: as the scores have it, and by the temperature.
    pub reliability: [Reliability; 2],
    /// The temperature.
    pub temperature: Temperature,
}

/// Borders within this of each other are one, seconds.
const TOLERANCE_S: f64 = 0.15;

impl Candidate {
    /// Whether something can be learnt for every take: two labels at least, from takes of the same
    /// person where persons are learnt by themselves.
    pub fn can_learn(&self, takes: &[AnnotatedTake], folds: &[Fold]) -> bool {
        let shown = |train: &[usize], label: usize| train.iter().any(|&t| takes[t].shows(label));
        let labels = 0..self.lesson.labels.len();
        let enough = |train: &[usize]| labels.clone().filter(|&l| shown(train, l)).count() > 1;
        self.groups(takes, folds).iter().all(|(train, _)| enough(train))
    }

    /// Which takes test what is learnt from which: of each fold, and of each person of it where persons
    /// are learnt by themselves.
    fn groups(&self, takes: &[AnnotatedTake], folds: &[Fold]) -> Vec<(Vec<usize>, Vec<usize>)> {
        let mut groups = Vec::new();
        for Fold { train, test } in folds {
            if !self.own_person {
                groups.push((train.clone(), test.clone()));
                continue;
            }
            let mut persons: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
            for &take in test {
                persons.entry(&takes[take].person).or_default().push(take);
            }
            for (person, test) in persons {
                let own = train.iter().copied().filter(|&take| takes[take].person == person);
                groups.push((own.collect(), test));
            }
        }
        groups
    }
}

/// Every take that a fold tests, by a model and a temperature that have seen none of the fold's test
/// takes: for each of the candidate's cuts the takes in their order. `done` is called after each
/// model, with how many there are.
///
/// # Errors
/// As [`Lesson::learn`] and [`Model::label`].
pub fn held_out(
    candidate: &Candidate,
    takes: &[AnnotatedTake],
    folds: &[Fold],
    done: &(dyn Fn(usize) + Sync),
) -> Result<Vec<Vec<Judged>>, AnnotateError> {
    let groups = candidate.groups(takes, folds);
    let Candidate { lesson, cuts, calibrated, .. } = candidate;
    // Of one group: the takes by each cut.
    let judge = |(train, test): &(Vec<usize>, Vec<usize>)| {
        let train: Vec<&AnnotatedTake> = train.iter().map(|&take| &takes[take]).collect();
        let learn = if *calibrated { Lesson::learn_calibrated_of } else { Lesson::learn_of };
        let model = learn(lesson, &train)?;
        let of =
            |cut: &Cut| test.iter().map(|&take| judged(&model, cut, &takes[take], take)).collect();
        let own = cuts.iter().map(of).collect::<Result<Vec<Vec<Judged>>, AnnotateError>>();
        done(groups.len());
        own
    };
    let each: Vec<Vec<Vec<Judged>>> =
        groups.par_iter().map(judge).collect::<Result<_, AnnotateError>>()?;
    let mut by_cut = vec![Vec::new(); cuts.len()];
    for group in each {
        by_cut.iter_mut().zip(group).for_each(|(all, own)| all.extend(own));
    }
    by_cut.iter_mut().for_each(|all| all.sort_by_key(|judged| judged.take));
    Ok(by_cut)
}

/// What a model says of a take, the `number`-th, held against its truth.
///
/// # Errors
/// As [`Model::label`].
pub fn judged(
    model: &Model,
    cut: &Cut,
    annotated: &AnnotatedTake,
    number: usize,
) -> Result<Judged, AnnotateError> {
    let AnnotatedTake { take, marked, .. } = annotated;
    let decode = match cut {
        Cut::Found(decoding) => decoding.of(take, &model.shapes)?,
        Cut::True => Decode::Segments(stable(marked)),
    };
    let answer = model.label(take, &decode)?;
    let comparison = Comparison {
        labels: model.labels.len(),
        frames: take.frames(),
        tolerance: (TOLERANCE_S * take.rate_hz).round() as usize,
    };
    let said = |found: &Suggested| Marked {
        frames: found.frames.clone(),
        mark: Mark::Stable(found.label),
    };
    let counts =
        comparison.counts(marked, &answer.segments.iter().map(said).collect::<Vec<_>>())?;
    let truth = by_frame(marked, take.frames());
    let reliability = [Temperature::default(), model.temperature]
        .map(|temperature| reliability(&answer.scores, temperature, &truth));
    let temperature = model.temperature;
    Ok(Judged { take: number, answer, counts, reliability, temperature })
}

/// The stable stretches of an annotator.
fn stable(marked: &[Marked]) -> Vec<Range<usize>> {
    let stable = marked.iter().filter(|marked| matches!(marked.mark, Mark::Stable(_)));
    stable.map(|marked| marked.frames.clone()).collect()
}

fn reliability(scores: &Rows, temperature: Temperature, truth: &[Option<usize>]) -> Reliability {
    let mut counts = Reliability::default();
    let mut shares = vec![0.0; scores.width()];
    for (row, truth) in scores.iter().zip(truth) {
        let Some(truth) = *truth else { continue };
        shares.copy_from_slice(row);
        temperature.apply(&mut shares);
        let answer = highest(&shares);
        counts.count(shares[answer], answer == truth);
    }
    counts
}
