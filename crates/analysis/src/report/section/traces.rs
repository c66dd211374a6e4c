//! Ratings that follow the clip: their mean over people at each instant, by the factor that the study compares.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use mimique_report::document::slug;
use mimique_stats::{Factor, t_quantile_upper};
use mimique_study::TRACE_HZ;
use serde::Serialize;

use crate::report::figure;
use crate::report::section::Writer;
use crate::report::section::trace_tests::{PersonCourses, TracePair, compared};
use crate::trials::measure::Measure;

/// The mean course of a rating at each level of a factor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MeanTraces {
    pub response: String,
    pub factor: String,
    /// What is equal within the matched sets of answers whose courses are averaged.
    pub matched_by: Vec<String>,
    /// Every level of the factor: a matched set has an answer at each.
    pub all_levels: Vec<String>,
    /// From one value of a course to the next, seconds.
    pub step_seconds: f64,
    pub levels: Vec<MeanTrace>,
    /// Every two levels.
    pub pairs: Vec<TracePair>,
}

/// The mean course at one level.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MeanTrace {
    pub level: String,
    /// People with a course at this level.
    pub people: usize,
    /// Mean of people's means at each instant.
    pub mean: Vec<f64>,
    /// Its 95 % interval by t at each instant by itself; none of one person.
    pub interval_95: Option<Vec<[f64; 2]>>,
}

impl Writer<'_> {
    /// The mean courses of a rating that followed the clip, by the first factor in use; nothing of other ratings.
    pub(crate) fn traces(&mut self, measure: &Measure, factors: &[String]) {
        let has_course =
            self.export.answers_to(&measure.id).iter().any(|answer| answer.trace.is_some());
        let Some(name) = factors.first().filter(|_| has_course) else { return };
        let mut factor = measure.factor(self.export, name, &[]);
        let matching = measure.matching(self.export, &factor);
        for (code, set) in factor.codes.iter_mut().zip(&matching.set_of_row) {
            if set.is_none() {
                *code = Factor::MISSING;
            }
        }
        let courses: Vec<PersonCourses> =
            (0..factor.levels.len()).map(|level| self.courses(measure, &factor, level)).collect();
        let of_levels = || factor.levels.iter().zip(&courses);
        let levels: Vec<MeanTrace> =
            of_levels().filter_map(|(level, own)| mean_trace(level, own)).collect();
        let pairs = compared(&factor.levels, &courses);
        let language = self.language();
        self.heading(3, "While the clip plays", "Pendant l’extrait");
        self.paragraph(
            "Means over people of each one’s mean course, with 95 % intervals by t at each instant by itself: they are not corrected for the number of instants. The test below is.",
            "Moyennes, sur les personnes, du cours moyen de chacune, avec des intervalles t à 95 % à chaque instant pris à part : ils ne sont pas corrigés du nombre d’instants. Le test ci-dessous l’est.",
        );
        let lines: Vec<(String, &MeanTrace)> =
            levels.iter().map(|own| (self.naming.level(name, &own.level), own)).collect();
        let id = format!("{}-while-playing", slug(&measure.id));
        let shown = self.naming.factor(name);
        let caption = language.pick(
            format!("{} while the clip plays, by {shown}", measure.label),
            format!("{} pendant l’extrait, par {shown}", measure.label),
        );
        let spans = self.significant_spans(name, &pairs, &self.only_clips(measure, &factor));
        let drawing = figure::traces(language, &id, &caption, 1.0 / TRACE_HZ, &lines, &spans);
        self.figure(drawing);
        self.trace_tests(measure, name, &pairs);
        let response = measure.id.clone();
        self.results.traces.push(MeanTraces {
            response,
            factor: factor.name,
            matched_by: matching.by,
            all_levels: factor.levels,
            step_seconds: 1.0 / TRACE_HZ,
            levels,
            pairs,
        });
    }

    /// The clip of each level that has one alone.
    fn only_clips(&self, measure: &Measure, factor: &Factor) -> BTreeMap<String, Arc<str>> {
        let mut clips: BTreeMap<String, BTreeSet<Arc<str>>> = BTreeMap::new();
        for (answer, &code) in self.export.answers_to(&measure.id).iter().zip(&factor.codes) {
            if let Some(level) = factor.levels.get(code as usize) {
                let clip = self.export.trials[answer.trial].stimulus.clone();
                clips.entry(level.clone()).or_default().insert(clip);
            }
        }
        let only = |(level, own): (String, BTreeSet<Arc<str>>)| {
            let one = own.len() == 1;
            own.into_iter().next().filter(|_| one).map(|clip| (level, clip))
        };
        clips.into_iter().filter_map(only).collect()
    }

    /// The mean course of each person at a level: as long as the person's shortest.
    fn courses(&self, measure: &Measure, factor: &Factor, level: usize) -> PersonCourses {
        let answers = self.export.answers_to(&measure.id);
        let mut people: BTreeMap<usize, (Vec<f64>, f64)> = BTreeMap::new();
        for (answer, &code) in answers.iter().zip(&factor.codes) {
            let Some(course) = answer.trace.as_ref().filter(|_| code as usize == level) else {
                continue;
            };
            let new = || (vec![0.0; course.len()], 0.0);
            let (sums, count) = people.entry(answer.person).or_insert_with(new);
            sums.truncate(course.len());
            sums.iter_mut().zip(course.iter()).for_each(|(sum, value)| *sum += f64::from(*value));
            *count += 1.0;
        }
        let mean = |(sums, count): (Vec<f64>, f64)| sums.iter().map(|sum| sum / count).collect();
        people.into_iter().map(|(person, own)| (person, mean(own))).collect()
    }
}

/// The mean course at a level: as long as the shortest.
fn mean_trace(level: &str, people: &PersonCourses) -> Option<MeanTrace> {
    let length = people.values().map(Vec::len).min()?;
    let n = people.len();
    let at = |instant: usize| -> [f64; 2] {
        let values = || people.values().map(|course| course[instant]);
        let mean = values().sum::<f64>() / n as f64;
        let squares: f64 = values().map(|value| (value - mean).powi(2)).sum();
        [mean, (squares / (n as f64 - 1.0) / n as f64).sqrt()]
    };
    let found: Vec<[f64; 2]> = (0..length).map(at).collect();
    let interval_95 = (n > 1).then(|| {
        let t = t_quantile_upper(0.025, n as f64 - 1.0);
        found.iter().map(|[mean, se]| [mean - t * se, mean + t * se]).collect()
    });
    Some(MeanTrace {
        level: level.to_owned(),
        people: n,
        mean: found.iter().map(|[mean, _]| *mean).collect(),
        interval_95,
    })
}
