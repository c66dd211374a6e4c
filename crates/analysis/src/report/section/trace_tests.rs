//! Ratings that follow the clip, compared between every two levels within people: cluster-based permutation tests over
//! time.

use std::collections::BTreeMap;
use std::sync::Arc;

use mimique_report::document::{DataTable, slug};
use mimique_stats::{ClusterPermutation, ClusterPermutationOptions, Outcome, cluster_permutation};
use mimique_study::TRACE_HZ;
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;

use crate::hypothesis::reading::LEVEL;
use crate::hypothesis::undefined::Why;
use crate::report::figure::TraceSpans;
use crate::report::section::Writer;
use crate::trials::measure::Measure;

/// Draws of each test.
pub(crate) const PERMUTATIONS: usize = 5000;
/// With their seed: the same answers give the same p.
const OPTIONS: ClusterPermutationOptions =
    ClusterPermutationOptions { permutations: PERMUTATIONS, seed: 1 };

/// A mean course of each person, by the person's place in the export.
pub(crate) type PersonCourses = BTreeMap<usize, Vec<f64>>;

/// Two levels compared within people.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct TracePair {
    pub a: String,
    pub b: String,
    /// Of a - b, over the instants that everybody has.
    pub test: Outcome<ClusterPermutation, Why>,
    /// Its clusters, in seconds.
    pub spans: Vec<TraceSpan>,
}

/// A cluster in seconds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct TraceSpan {
    pub from_s: f64,
    pub to_s: f64,
    /// Sum of t, above 0 where the first level is higher.
    pub mass: f64,
    /// Corrected over instants.
    pub p: f64,
    /// The same corrected over pairs too (Holm).
    pub p_corrected: f64,
}

/// Every two levels.
pub(crate) fn compared(levels: &[String], courses: &[PersonCourses]) -> Vec<TracePair> {
    let places = 0..levels.len();
    let places: Vec<[usize; 2]> =
        places.clone().flat_map(|a| (a + 1..places.end).map(move |b| [a, b])).collect();
    let pair = |[a, b]: [usize; 2]| {
        let both = courses[a].iter().filter_map(|(who, own)| Some((own, courses[b].get(who)?)));
        let difference = |(a, b): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| a - b).collect()
        };
        let differences: Vec<Vec<f64>> = both.map(difference).collect();
        let test = match cluster_permutation(&differences, OPTIONS) {
            Err(refusal) => Outcome::undefined(refusal),
            Ok(outcome) => outcome.map_reason(Why::from),
        };
        let spans = match &test {
            Outcome::Undefined { .. } => Vec::new(),
            Outcome::Ok(found) => found
                .clusters
                .iter()
                .map(|own| TraceSpan {
                    from_s: own.first as f64 / TRACE_HZ,
                    to_s: own.last as f64 / TRACE_HZ,
                    mass: own.mass,
                    p: own.p,
                    p_corrected: own.p,
                })
                .collect(),
        };
        TracePair { a: levels[a].clone(), b: levels[b].clone(), test, spans }
    };
    let mut pairs: Vec<TracePair> = places.into_par_iter().map(pair).collect();
    correct(&mut pairs);
    pairs
}

/// Holm's correction over pairs: p of a pair is its smallest; its other clusters are corrected by the same number of
/// pairs.
fn correct(pairs: &mut [TracePair]) {
    let smallest =
        |pair: &TracePair| pair.spans.iter().map(|span| span.p).fold(f64::INFINITY, f64::min);
    let mut order: Vec<&mut TracePair> = pairs.iter_mut().collect();
    order.sort_by(|a, b| smallest(a).total_cmp(&smallest(b)));
    let (all, mut least) = (order.len(), 0.0_f64);
    for (place, pair) in order.into_iter().enumerate() {
        let left = (all - place) as f64;
        for span in &mut pair.spans {
            span.p_corrected = (span.p * left).max(least).min(1.0);
        }
        least = least.max(smallest(pair) * left);
    }
}

impl Writer<'_> {
    /// The pairs with their significant spans, seconds; pairs without one are left out. A span of two levels of which
    /// each has one clip leads to both of them; `clip_of` says the clip of such a level.
    pub(crate) fn significant_spans(
        &self,
        factor: &str,
        pairs: &[TracePair],
        clip_of: &BTreeMap<String, Arc<str>>,
    ) -> Vec<TraceSpans> {
        let of_pair = |pair: &TracePair| {
            let clips = clip_of.get(&pair.a).zip(clip_of.get(&pair.b));
            let link = |seconds: f64| {
                let (preview, (a, b)) = self.preview.zip(clips)?;
                Some(preview.of_pair(self.language(), [a, b], seconds))
            };
            let significant = pair.spans.iter().filter(|span| span.p_corrected < LEVEL);
            let spans =
                significant.map(|span| ([span.from_s, span.to_s], link(span.from_s))).collect();
            TraceSpans { pair: self.naming.pair(factor, &pair.a, &pair.b), spans }
        };
        pairs.iter().map(of_pair).filter(|own| !own.spans.is_empty()).collect()
    }

    /// How it was tested, and every cluster.
    pub(crate) fn trace_tests(&mut self, measure: &Measure, factor: &str, pairs: &[TracePair]) {
        if pairs.is_empty() {
            return;
        }
        let language = self.language();
        let ClusterPermutationOptions { permutations, seed } = OPTIONS;
        self.paragraph(
            &format!("Every two levels are compared within people by a cluster-based permutation test over time (Maris and Oostenveld 2007): clusters of instants at which the paired t is beyond its two-sided 5 % quantile, by the sum of their t; signs of people’s differences drawn {permutations} times with seed {seed}; p corrected over all instants, and over pairs by Holm. A bar below the lines marks a cluster with p < 0.05. It says that the courses differ; its ends are not tested."),
            &format!("Chaque paire de niveaux est comparée au sein des personnes par un test de permutation par amas au fil du temps (Maris et Oostenveld 2007) : amas d’instants où le t apparié dépasse son quantile bilatéral à 5 %, selon la somme de leurs t ; signes des différences des personnes tirés {permutations} fois avec la graine {seed} ; p corrigé sur tous les instants, et sur les paires selon Holm. Une barre sous les courbes marque un amas avec p < 0,05. Elle dit que les cours diffèrent ; ses bornes ne sont pas testées."),
        );
        let heading = language.pick(
            ["pair", "people", "from (s)", "to (s)", "sum of t", "p", "p (Holm)"],
            ["paire", "personnes", "de (s)", "à (s)", "somme des t", "p", "p (Holm)"],
        );
        let shown = self.naming.factor(factor);
        let caption = language.pick(
            format!("Clusters in which two courses differ, by {shown}"),
            format!("Amas où deux cours diffèrent, par {shown}"),
        );
        let id = format!("{}-while-playing-clusters", slug(&measure.id));
        let mut table = DataTable::new(id, caption, heading);
        for pair in pairs {
            let label = self.naming.pair(factor, &pair.a, &pair.b);
            let people = match &pair.test {
                Outcome::Ok(found) => found.participants.to_string(),
                Outcome::Undefined { reason } => {
                    let words = language.pick("undefined: ", "non défini : ");
                    let words = format!("{words}{}", reason.words(language));
                    let blank = || String::new();
                    table.row([label, words, blank(), blank(), blank(), blank(), blank()]);
                    continue;
                }
            };
            if pair.spans.is_empty() {
                let none = || "–".to_owned();
                table.row([label, people, none(), none(), none(), none(), none()]);
                continue;
            }
            for span in &pair.spans {
                table.row([
                    label.clone(),
                    people.clone(),
                    language.fixed(span.from_s, 2),
                    language.fixed(span.to_s, 2),
                    language.fixed(span.mass, 1),
                    language.p_cell(span.p, span.p.ln()),
                    language.p_cell(span.p_corrected, span.p_corrected.ln()),
                ]);
            }
        }
        self.folded_table(table);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_corrected_by_those_that_are_left() {
        let pair = |p: &[f64]| TracePair {
            a: String::new(),
            b: String::new(),
            test: Outcome::undefined(Why::NoTest),
            spans: p
                .iter()
                .map(|p| TraceSpan { from_s: 0.0, to_s: 1.0, mass: 1.0, p: *p, p_corrected: *p })
                .collect(),
        };
        let mut pairs = [pair(&[0.03, 0.4]), pair(&[]), pair(&[0.01, 0.02]), pair(&[0.015])];
        correct(&mut pairs);
        let found: Vec<f64> =
            pairs.iter().flat_map(|pair| &pair.spans).map(|span| span.p_corrected).collect();
        let expected = [0.06, 0.8, 0.04, 0.08, 0.045];
        for (own, expected) in found.iter().zip(expected) {
            assert!((own - expected).abs() < 1e-12, "{found:?}");
        }
    }
}
