//! How well each shown category is told from all others: d' and criterion, person by person.

use mimique_report::document::{DataTable, slug};
use mimique_stats::{
    DetectedCategory, Detection, Factor, MeanTest, Outcome, Sensitivity, SignalCounts, detection,
};
use serde::Serialize;

use crate::naming::people_counted;
use crate::report::figure::{DetectionPanel, DetectionPoints, detection_planes};
use crate::report::section::Writer;
use crate::report::section::detection_by_factor::DetectionByFactor;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::export::Answer;

/// Detection of the categories of a forced choice.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct QuestionDetection {
    pub response: String,
    pub people: usize,
    pub answers: usize,
    pub categories: Vec<CategoryDetection>,
    /// At each level of the factors of the clips.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub by: Vec<DetectionByFactor>,
}

/// A category against all others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct CategoryDetection {
    pub category: String,
    /// Answers of all people together.
    #[serde(flatten)]
    pub counts: SignalCounts,
    /// Of all people together, log-linear rates.
    pub pooled: Outcome<Sensitivity>,
    /// Of the people, each of whom was shown five signals or more; none where somebody was shown fewer.
    pub of_people: Option<PeopleDetection>,
}

/// Means over people.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct PeopleDetection {
    /// People with a d'.
    pub people: usize,
    pub d_prime_mean: f64,
    /// By t.
    pub d_prime_interval_95: Option<[f64; 2]>,
    pub criterion_mean: f64,
    /// d' against 0; none where it does not vary.
    pub t: Option<MeanTest>,
}

impl Writer<'_> {
    /// d' and criterion of each category, of all answers and by factors; nothing where fewer than two were shown.
    pub(crate) fn detection(&mut self, asked: &AskedQuestion<'_>, truth: &str, factors: &[String]) {
        let Some(found) = self.detected(asked, |_| true) else { return };
        let mut result = QuestionDetection {
            response: asked.id.clone(),
            people: found.participants,
            answers: found.n,
            categories: found.categories.iter().map(CategoryDetection::of).collect(),
            by: Vec::new(),
        };
        self.heading(3, "Detection: d′ and criterion", "Détection : d′ et critère");
        self.paragraph(
            "Each category against all others: d′ = z(hits) − z(false alarms) says how well it is told from them, 0 where it is not; c above 0 that it is named rarely, below 0 that it is named often. Rates are log-linear (Hautus 1995). Means are over people with t intervals; where somebody was shown fewer than five of a category, only the answers of all people together are told.",
            "Chaque catégorie contre toutes les autres : d′ = z(détections) − z(fausses alarmes) dit combien elle en est distinguée, 0 si elle ne l’est pas ; c au-dessus de 0 qu’elle est rarement nommée, au-dessous qu’elle l’est souvent. Les taux sont log-linéaires (Hautus 1995). Les moyennes sont sur les personnes, avec des intervalles t ; si quelqu’un a vu moins de cinq extraits d’une catégorie, seules les réponses de toutes les personnes ensemble sont données.",
        );
        self.detection_figure(asked, truth, &found);
        let table = self.detection_table(&result, truth);
        self.folded_table(table);
        self.roc(asked, truth);
        result.by = self.detection_by_factors(asked, truth, factors);
        self.results.detection.push(result);
    }

    /// Detection among some of the answers, told by their places.
    pub(crate) fn detected(
        &self,
        asked: &AskedQuestion<'_>,
        is_counted: impl Fn(usize) -> bool,
    ) -> Option<Detection> {
        let answers = self.export.answers_to(&asked.id).iter().enumerate();
        let counted = answers.filter(|(place, _)| is_counted(*place));
        let answers: Vec<&Answer> = counted.map(|(_, answer)| answer).collect();
        let [people, shown, given] = self.told(&answers);
        detection(&people, &shown, &given).ok()
    }

    /// Of each answer: who gave it, what was there, what was said.
    pub(super) fn told(&self, answers: &[&Answer]) -> [Factor; 3] {
        let people = answers.iter().map(|own| Some(self.export.people[own.person].id.as_str()));
        let people = Factor::from_cells("participant", people, |_| None);
        let shown = answers.iter().map(|own| own.truth.as_deref());
        let shown = Factor::from_cells("truth", shown, |_| None);
        let given = answers.iter().map(|own| Some(&*own.text));
        [people, shown, Factor::from_cells("answer", given, |_| None)]
    }

    fn detection_table(&self, result: &QuestionDetection, truth: &str) -> DataTable {
        let caption = self.language().pick(
            format!(
                "Detection of each category among all others ({})",
                people_counted(self.language(), result.people)
            ),
            format!(
                "Détection de chaque catégorie parmi les autres ({})",
                people_counted(self.language(), result.people)
            ),
        );
        let id = format!("{}-detection", slug(&result.response));
        let rows = result.categories.iter();
        let rows = rows.map(|own| (self.naming.level(truth, &own.category), own));
        self.detection_rows(id, caption, rows)
    }

    /// A row for each category, or category and level.
    pub(crate) fn detection_rows<'d>(
        &self,
        id: String,
        caption: String,
        rows: impl Iterator<Item = (String, &'d CategoryDetection)>,
    ) -> DataTable {
        let language = self.language();
        let heading = language.pick(
            [
                "",
                "hits",
                "false alarms",
                "d′, mean over people [95 %]",
                "c, mean",
                "p of d′ = 0",
                "d′, all together",
                "c, all together",
            ],
            [
                "",
                "détections",
                "fausses alarmes",
                "d′, moyenne des personnes [95 %]",
                "c, moyenne",
                "p de d′ = 0",
                "d′, ensemble",
                "c, ensemble",
            ],
        );
        let mut table = DataTable::new(id, caption, heading);
        let number = |value: f64| language.fixed(value, 2);
        let none = || "–".to_owned();
        for (label, own) in rows {
            let SignalCounts { hits, signals, false_alarms, noise } = own.counts;
            let people = own.of_people.as_ref();
            let mean = people.map(|found| {
                let mean = number(found.d_prime_mean);
                match found.d_prime_interval_95.map(|ends| ends.map(number)) {
                    Some([low, high]) => format!("{mean} [{low}; {high}]"),
                    None => mean,
                }
            });
            let p = people.and_then(|found| found.t).map(|t| language.p_cell(t.p, t.ln_p));
            let pooled = own.pooled.clone().ok();
            table.row([
                label,
                format!("{hits}/{signals}"),
                format!("{false_alarms}/{noise}"),
                mean.unwrap_or_else(none),
                people.map_or_else(none, |found| number(found.criterion_mean)),
                p.unwrap_or_else(none),
                pooled.map_or_else(none, |found| number(found.d_prime)),
                pooled.map_or_else(none, |found| number(found.criterion)),
            ]);
        }
        table
    }

    fn detection_figure(&mut self, asked: &AskedQuestion<'_>, truth: &str, found: &Detection) {
        let language = self.language();
        let categories = self.detection_points(truth, found);
        if categories.is_empty() {
            return;
        }
        let caption = language.pick("d′ against the criterion c", "d′ selon le critère c");
        let id = format!("{}-d-prime", slug(&asked.id));
        let panels = [DetectionPanel { title: String::new(), categories }];
        self.figure(detection_planes(language, &id, caption, &panels));
    }

    /// Categories as they are drawn: people where each of them was shown enough, else all answers together.
    pub(crate) fn detection_points(&self, truth: &str, found: &Detection) -> Vec<DetectionPoints> {
        let point = |own: &DetectedCategory| {
            let name = self.naming.level(truth, &own.category);
            let Some(people) = of_people(own) else {
                let pooled = own.pooled_loglinear.clone().ok()?;
                let mean = [pooled.criterion, pooled.d_prime];
                return Some(DetectionPoints { name, mean, people: Vec::new() });
            };
            let mean = [people.criterion_mean, people.d_prime_mean];
            let people = own.people.iter().filter_map(|person| person.sensitivity);
            let people = people.map(|own| [own.criterion, own.d_prime]).collect();
            Some(DetectionPoints { name, mean, people })
        };
        found.categories.iter().filter_map(point).collect()
    }
}

impl CategoryDetection {
    pub(crate) fn of(found: &DetectedCategory) -> Self {
        Self {
            category: found.category.clone(),
            counts: found.counts,
            pooled: found.pooled_loglinear.clone(),
            of_people: of_people(found),
        }
    }
}

/// Means over people; none where somebody was shown fewer than five signals.
fn of_people(found: &DetectedCategory) -> Option<PeopleDetection> {
    if found.few_signals {
        return None;
    }
    Some(PeopleDetection {
        people: found.people.iter().filter(|person| person.sensitivity.is_some()).count(),
        d_prime_mean: found.d_prime_mean?,
        d_prime_interval_95: found.d_prime_interval_95,
        criterion_mean: found.criterion_mean?,
        t: found.t,
    })
}
