//! An export without one segment or one participant: what the analysis of the rest finds shows how much depends on it.

use std::sync::Arc;

use crate::trials::export::{Answer, ExcludedTrial, Export};

impl Export {
    /// The segments of the trials that are used, in alphabetical order.
    pub(crate) fn segments(&self) -> Vec<Arc<str>> {
        let mut segments: Vec<Arc<str>> =
            self.trials.iter().filter_map(|trial| trial.segment.clone()).collect();
        segments.sort_unstable();
        segments.dedup();
        segments
    }

    /// The participants with an answer in a trial that is used, as places in [`Export::people`], ascending.
    pub(crate) fn answering_people(&self) -> Vec<usize> {
        let mut people: Vec<usize> =
            self.all_answers().flatten().map(|answer| answer.person).collect();
        people.sort_unstable();
        people.dedup();
        people
    }

    /// The same export without the trials of a segment.
    pub(crate) fn without_segment(&self, segment: &str) -> Self {
        let trials: Vec<bool> =
            (self.trials.iter()).map(|trial| trial.segment.as_deref() != Some(segment)).collect();
        self.retained(&trials, |excluded| excluded.trial.segment.as_deref() != Some(segment))
    }

    /// The same export without the trials of a participant, who stays in [`Export::people`].
    pub(crate) fn without_person(&self, person: usize) -> Self {
        let mut trials = vec![true; self.trials.len()];
        for answer in self.all_answers().flatten().filter(|answer| answer.person == person) {
            trials[answer.trial] = false;
        }
        self.retained(&trials, |excluded| excluded.person != person)
    }

    /// The trials that are marked with their answers, and some of the excluded trials.
    fn retained(&self, trials: &[bool], excluded: impl Fn(&ExcludedTrial) -> bool) -> Self {
        let mut next = 0;
        let places: Vec<Option<usize>> = (trials.iter())
            .map(|retained| {
                retained.then(|| {
                    next += 1;
                    next - 1
                })
            })
            .collect();
        let own = |answers: &Vec<Answer>| -> Vec<Answer> {
            let own = answers.iter().filter_map(|answer| {
                Some(Answer { trial: places[answer.trial]?, ..answer.clone() })
            });
            own.collect()
        };
        let answers =
            self.answers.iter().map(|(question, answers)| (question.clone(), own(answers)));
        let trials = self.trials.iter().zip(trials).filter(|(_, retained)| **retained);
        Self {
            people: self.people.clone(),
            trials: trials.map(|(trial, _)| trial.clone()).collect(),
            excluded_trials: (self.excluded_trials.iter())
                .filter(|own| excluded(own))
                .cloned()
                .collect(),
            answers: answers.filter(|(_, answers)| !answers.is_empty()).collect(),
            ..Self::new(self.factors.clone(), self.about.clone())
        }
    }
}
