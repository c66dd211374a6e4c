//! The same study without the effects that its hypotheses look for: what false positives are counted in.

use std::collections::BTreeMap;

use mimique_study::{Hypothesis, KindOfQuestion as _, Measure, Study};

use super::parameters::{ByLevel, Interaction, Parameters, Recognition};

impl Parameters {
    /// Without the effects of every hypothesis's factors on its response, and without interactions of
    /// them. What is random stays: clips still differ from one another.
    pub fn without_effects(&self, study: &Study) -> Self {
        let mut null = self.clone();
        study.hypotheses.iter().for_each(|hypothesis| null.drop_effects_of(study, hypothesis));
        null
    }

    /// Whether there is an effect of this hypothesis's factors on its response. Typed numbers and choices
    /// without a right answer never have one.
    pub fn has_effect(&self, study: &Study, hypothesis: &Hypothesis) -> bool {
        let mut null = self.clone();
        null.drop_effects_of(study, hypothesis);
        null != *self
    }

    fn drop_effects_of(&mut self, study: &Study, hypothesis: &Hypothesis) {
        let tested = |factor: &str| hypothesis.factors.iter().any(|each| each == factor);
        if hypothesis.measure == Measure::Rt {
            self.times.effects.retain(|factor, _| !tested(factor));
            return;
        }
        if let Some(rating) = self.ratings.get_mut(&hypothesis.response) {
            drop_effects(&mut rating.effects, &mut rating.interactions, tested);
        }
        if let Some(compared) = self.comparisons.get_mut(&hypothesis.response)
            && tested(&compared.factor)
        {
            compared.worth.values_mut().for_each(|worth| *worth = 0.0);
        }
        if let Some(recognition) = self.recognition.get_mut(&hypothesis.response) {
            drop_effects(&mut recognition.effects, &mut recognition.interactions, tested);
            let asked = study.all_questions().find(|each| each.id == hypothesis.response);
            let truth = asked.and_then(|asked| asked.kind.truth()).unwrap_or_default();
            if tested(truth) || tested(&recognition.by) {
                level_hits(recognition);
            }
        }
    }
}

fn drop_effects(
    effects: &mut BTreeMap<String, ByLevel>,
    interactions: &mut Vec<Interaction>,
    tested: impl Fn(&str) -> bool,
) {
    effects.retain(|factor, _| !tested(factor));
    interactions.retain(|interaction| !interaction.levels.keys().any(|factor| tested(factor)));
}

/// Gives every row the mean share of right answers; how wrong ones are spread stays.
fn level_hits(recognition: &mut Recognition) {
    let hit = |right: &str, row: &ByLevel| {
        row.get(right).copied().unwrap_or(0.0) / row.values().sum::<f64>().max(1e-12)
    };
    let hits: Vec<f64> = recognition
        .confusion
        .iter()
        .flat_map(|(right, rows)| rows.values().map(|row| hit(right, row)))
        .collect();
    let mean = hits.iter().sum::<f64>() / hits.len().max(1) as f64;
    for (right, rows) in &mut recognition.confusion {
        for row in rows.values_mut() {
            let old = hit(right, row);
            let sum: f64 = row.values().sum();
            let scale = if old < 1.0 { (1.0 - mean) / (1.0 - old) / sum } else { 0.0 };
            row.values_mut().for_each(|share| *share *= scale);
            row.insert(right.clone(), mean);
        }
    }
}
