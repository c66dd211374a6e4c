//! One response fitted: its answers, the columns of its design, and what they tell.

use std::collections::{BTreeMap, HashMap};

use mimique_study::{Clip, Hypothesis, Measure, Study};

use super::components::{Components, Item, components};
use super::ordinal::{self, Cell, OrderedProbit};
use crate::simulate::parameters::ByLevel;
use crate::simulate::scales::{factor_levels, segment_places, traits};
use crate::trials::export::{Answer, Export};

/// Most factors to which people are fitted to take differently: pairs are counted for every subset.
const MOST_FACTORS: usize = 3;

/// The answers and where they stand.
pub(super) struct Data<'e> {
    pub export: &'e Export,
    study: &'e Study,
    pub clips: &'e [Clip],
    places: HashMap<&'e str, usize>,
    segments: Vec<usize>,
    levels: BTreeMap<String, Vec<String>>,
    traits: BTreeMap<String, Vec<String>>,
}

/// One fitted response.
pub(super) struct Fitted {
    pub probit: OrderedProbit,
    pub components: Components,
    /// Factors to which people can take differently.
    by: Vec<String>,
    /// Factor, its levels: the effects stand in this order, the last level of each left out.
    tested: Vec<(String, Vec<String>)>,
}

impl<'e> Data<'e> {
    /// Finds the clips, segments and levels of the study.
    pub(super) fn new(export: &'e Export, study: &'e Study, clips: &'e [Clip]) -> Self {
        let places = clips.iter().enumerate().map(|(i, clip)| (clip.id.as_str(), i)).collect();
        let segments = segment_places(clips);
        let levels = factor_levels(study, clips);
        Self { export, study, clips, places, segments, levels, traits: traits(study) }
    }

    /// The place of the clip that was answered.
    pub(super) fn clip(&self, answer: &Answer) -> Option<usize> {
        self.places.get(&*self.export.trials[answer.trial].stimulus).copied()
    }

    /// Factors that hypotheses of one factor name for this response.
    pub(super) fn tested(&self, response: &str) -> Vec<String> {
        let mut factors: Vec<String> = Vec::new();
        let about = |each: &&Hypothesis| each.response == response && each.measure != Measure::Rt;
        for hypothesis in self.study.hypotheses.iter().filter(about) {
            for factor in &hypothesis.factors {
                if !factors.contains(factor) && self.levels.get(factor).is_some_and(|l| l.len() > 1)
                {
                    factors.push(factor.clone());
                }
            }
        }
        factors
    }

    fn level(&self, answer: &Answer, clip: usize, factor: &str) -> Option<usize> {
        let text = if self.traits.contains_key(factor) {
            let (_, cells) = self.export.about.iter().find(|(name, _)| name == factor)?;
            cells.get(answer.person)?.clone()?
        } else {
            self.clips[clip].factor_text(factor)?
        };
        self.levels.get(factor)?.iter().position(|level| *level == text)
    }

    /// Fits one response: `points` are the chosen points, `rows` factors whose combinations have a mean
    /// of their own that is no effect.
    pub(super) fn fit(
        &self,
        points: &[(usize, &Answer)],
        count: usize,
        tested: &[String],
        rows: &[&str],
    ) -> Option<Fitted> {
        let placed: Vec<(usize, usize, &Answer)> = points
            .iter()
            .filter_map(|(point, answer)| Some((*point, self.clip(answer)?, *answer)))
            .collect();
        let coding = EffectCoding::new(self, self.answered_levels(tested, &placed), rows, &placed);
        let mut cells: BTreeMap<Vec<u64>, Cell> = BTreeMap::new();
        let mut used = Vec::new();
        for (point, clip, answer) in placed {
            let Some(x) = coding.design_row(clip, answer) else { continue };
            let key = x.iter().map(|value| value.to_bits()).collect();
            let cell =
                cells.entry(key).or_insert_with(|| Cell { x: x.clone(), counts: vec![0.0; count] });
            cell.counts[point] += 1.0;
            used.push((point, clip, answer, x));
        }
        let cells: Vec<Cell> = cells.into_values().collect();
        let mut probit = ordinal::fit(&cells, count)?;
        let tested = coding.tested;
        let by = self.taken_differently(&tested);
        let items: Vec<Item> = used
            .iter()
            .map(|(point, clip, answer, x)| {
                let eta: f64 = x.iter().zip(&probit.effects).map(|(x, effect)| x * effect).sum();
                let level = |factor: &String| {
                    self.level(answer, *clip, factor).map_or(u32::MAX, |level| level as u32)
                };
                let levels = by.iter().map(level).collect();
                let place = (answer.person, *clip, self.segments[*clip]);
                Item::new(place, levels, *point, &probit.thresholds, eta)
            })
            .collect();
        let components = components(&items, by.len());
        // Where rows have means of their own, a threshold is that of the first row: none is used.
        let effects = tested.iter().map(|(_, levels)| levels.len() - 1).sum();
        probit.effects.truncate(effects);
        Some(Fitted { probit, components, by, tested })
    }

    /// Only levels that were answered; a factor with one of them has no effect to fit.
    fn answered_levels(
        &self,
        tested: &[String],
        placed: &[(usize, usize, &Answer)],
    ) -> Vec<(String, Vec<String>)> {
        let mut tested: Vec<(String, Vec<String>)> = tested
            .iter()
            .filter_map(|factor| Some((factor.clone(), self.levels.get(factor)?.clone())))
            .collect();
        for (factor, levels) in &mut tested {
            let mut seen = vec![false; levels.len()];
            for (_, clip, answer) in placed {
                if let Some(level) = self.level(answer, *clip, factor) {
                    seen[level] = true;
                }
            }
            *levels =
                levels.iter().zip(seen).filter(|(_, seen)| *seen).map(|(l, _)| l.clone()).collect();
        }
        tested.retain(|(_, levels)| levels.len() > 1);
        tested
    }

    /// Tested factors of clips, and methods.
    fn taken_differently(&self, tested: &[(String, Vec<String>)]) -> Vec<String> {
        let mut by: Vec<String> = tested
            .iter()
            .map(|(factor, _)| factor.clone())
            .filter(|factor| !self.traits.contains_key(factor))
            .collect();
        let several = self.levels.get("method").is_some_and(|levels| levels.len() > 1);
        if several && !by.iter().any(|factor| factor == "method") {
            by.insert(0, "method".to_owned());
        }
        by.truncate(MOST_FACTORS);
        by
    }
}

/// Columns of the design: the tested factors' effects, which add up to nothing over the levels, then one
/// for each combination of the rows' factors but the first.
struct EffectCoding<'d> {
    data: &'d Data<'d>,
    tested: Vec<(String, Vec<String>)>,
    rows: &'d [&'d str],
    combinations: BTreeMap<Vec<Option<usize>>, usize>,
}

impl<'d> EffectCoding<'d> {
    fn new(
        data: &'d Data<'d>,
        tested: Vec<(String, Vec<String>)>,
        rows: &'d [&'d str],
        placed: &[(usize, usize, &Answer)],
    ) -> Self {
        let mut coding = Self { data, tested, rows, combinations: BTreeMap::new() };
        for (_, clip, answer) in placed {
            let key = coding.combination(*clip, answer);
            let next = coding.combinations.len();
            coding.combinations.entry(key).or_insert(next);
        }
        coding
    }

    /// The levels of the rows' factors.
    fn combination(&self, clip: usize, answer: &Answer) -> Vec<Option<usize>> {
        self.rows.iter().map(|row| self.data.level(answer, clip, row)).collect()
    }

    /// The design's row of an answer; none where a level is not among those tested.
    fn design_row(&self, clip: usize, answer: &Answer) -> Option<Vec<f64>> {
        let mut x = Vec::new();
        for (factor, levels) in &self.tested {
            let name = &self.data.levels[factor][self.data.level(answer, clip, factor)?];
            let level = levels.iter().position(|level| level == name)?;
            let last = levels.len() - 1;
            x.extend((0..last).map(|column| match level {
                _ if level == last => -1.0,
                _ if level == column => 1.0,
                _ => 0.0,
            }));
        }
        let row = *self.combinations.get(&self.combination(clip, answer))?;
        let row_columns = self.combinations.len().saturating_sub(1);
        x.extend((0..row_columns).map(|column| f64::from(u8::from(row == column + 1))));
        Some(x)
    }
}

impl Fitted {
    /// Puts the spreads that the answers tell; the others keep what they have.
    pub(super) fn spreads(
        &self,
        sd: impl Fn(f64) -> f64,
        (person, segment, clip): (&mut f64, &mut f64, &mut f64),
        by: &mut ByLevel,
    ) {
        for (place, share) in [
            (person, self.components.person),
            (segment, self.components.segment),
            (clip, self.components.clip),
        ] {
            if let Some(share) = share {
                *place = sd(share);
            }
        }
        for (factor, share) in self.by.iter().zip(&self.components.person_by) {
            if let Some(share) = share {
                by.insert(factor.clone(), sd(*share));
            }
        }
    }

    /// Effects of the tested factors by level, in the given unit of a standard deviation.
    pub(super) fn effects(&self, unit: f64) -> BTreeMap<String, ByLevel> {
        let mut rest = self.probit.effects.as_slice();
        let mut effects = BTreeMap::new();
        for (factor, levels) in &self.tested {
            let (own, others) = rest.split_at(levels.len() - 1);
            rest = others;
            let last = -own.iter().sum::<f64>();
            let shifts = own.iter().copied().chain([last]).map(|shift| unit * shift);
            effects.insert(factor.clone(), levels.iter().cloned().zip(shifts).collect());
        }
        effects
    }
}
