//! The section of a report that holds answers against what was measured of the stimuli.

use std::collections::BTreeMap;

use mimique_stats::{Numbers, Outcome, bonett_wright_interval, spearman};
use mimique_study::Measure as What;
use serde::Serialize;

use crate::language::Language;
use crate::report::document::{Block, DataTable, slug};
use crate::report::section::Writer;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::Measure;

/// Fewest stimuli that a rank correlation is told of.
const FEWEST: usize = 4;

/// How the mean answers about stimuli go with a measure of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MeasureCorrelation {
    /// The question.
    pub response: String,
    /// Column of the table of stimuli.
    pub measure: String,
    /// Over all stimuli.
    pub all: Correlation,
    /// Of the deviations from the mean of each performance (segment and avatar): whether of the clips of one performance
    /// that with more of the measure is rated higher. None where no performance has two clips.
    pub within_performances: Option<Correlation>,
}

/// Spearman's rank correlation over stimuli.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) struct Correlation {
    /// Stimuli.
    pub stimuli: usize,
    /// The correlation.
    pub rho: f64,
    /// Bonett and Wright's interval (Psychometrika 65, 2000), 95 %; within performances with a degree of freedom less for each
    /// performance but one.
    pub ci95: Option<[f64; 2]>,
}

impl Writer<'_> {
    /// Answers against measures; nothing where no table of stimuli is given.
    pub(crate) fn stimulus_measures(&mut self, measures: &[(AskedQuestion<'_>, Measure)]) {
        let Some(table) = self.stimuli.filter(|table| !table.measures.is_empty()) else { return };
        let language = self.language();
        self.heading(2, "Answers and measures of the stimuli", "Réponses et mesures des stimuli");
        self.paragraph(
            "Each stimulus’s mean answer is held against what was measured of it: Spearman’s rank correlation over stimuli, with Bonett and Wright’s 95 % interval. Within performances both are taken as deviations from the mean of the performance, so that a performance that everybody rates higher tells nothing. These are descriptions of these stimuli; no hypothesis is decided by them.",
            "La réponse moyenne de chaque stimulus est comparée à ce qui en a été mesuré : corrélation des rangs de Spearman sur les stimuli, avec l’intervalle à 95 % de Bonett et Wright. Au sein des performances, les deux sont pris comme écarts à la moyenne de la performance : une performance que tous notent plus haut ne dit rien. Ce sont des descriptions de ces stimuli ; aucune hypothèse n’en dépend.",
        );
        if !table.ambiguous.is_empty() {
            let names: Vec<&str> = table.ambiguous.iter().map(String::as_str).collect();
            let names = names.join(", ");
            self.blocks.push(Block::Caution(language.pick(
                format!("Left out, since they were prepared anew between versions of the study: {names}."),
                format!("Laissés de côté, car préparés de nouveau entre des versions de l’étude : {names}."),
            )));
        }
        let mut found = Vec::new();
        for (asked, measure) in measures {
            if self.of_pair(asked, What::Answer, "method").is_none() {
                found.extend(self.correlations(measure));
            }
        }
        if found.is_empty() {
            self.paragraph(
                "No question has mean answers of four stimuli that were measured and differ.",
                "Aucune question n’a de réponses moyennes pour quatre stimuli mesurés et différents.",
            );
        }
        for (_, measure) in measures {
            let own: Vec<&MeasureCorrelation> =
                found.iter().filter(|each| each.response == measure.id).collect();
            if !own.is_empty() {
                self.blocks.push(Block::Table(correlation_table(language, measure, &own)));
            }
        }
        self.results.stimulus_measures = found;
    }

    /// The correlations of a question's answers with each measure.
    fn correlations(&self, measure: &Measure) -> Vec<MeasureCorrelation> {
        let Some(table) = self.stimuli else { return Vec::new() };
        let mut sums: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
        for (&value, &trial) in measure.values.iter().zip(&measure.trial) {
            let sum = sums.entry(&self.export.trials[trial].stimulus).or_default();
            sum.0 += value;
            sum.1 += 1.0;
        }
        let clips = self.study.clips();
        let performance_of: BTreeMap<&str, [&str; 2]> =
            clips.iter().map(|clip| (&*clip.id, [&*clip.segment, &*clip.avatar])).collect();
        let of_measure = |(name, values): &(String, BTreeMap<String, f64>)| {
            let points: Vec<StimulusPoint<'_>> = (sums.iter())
                .filter_map(|(&stimulus, (sum, count))| {
                    Some((*performance_of.get(stimulus)?, *values.get(stimulus)?, sum / count))
                })
                .collect();
            Some(MeasureCorrelation {
                response: measure.id.clone(),
                measure: name.clone(),
                all: correlation(&points, 0)?,
                within_performances: within_performances(&points),
            })
        };
        table.measures.iter().filter_map(of_measure).collect()
    }
}

/// A stimulus: its performance, what was measured, its mean answer.
type StimulusPoint<'a> = ([&'a str; 2], f64, f64);

/// Spearman's correlation of some points that `lost` degrees of freedom were taken from; none of too few, or of a constant.
fn correlation(points: &[StimulusPoint<'_>], lost: usize) -> Option<Correlation> {
    if points.len() < FEWEST + lost {
        return None;
    }
    let numbers = |name: &str, of: fn(&StimulusPoint<'_>) -> f64| Numbers {
        name: name.to_owned(),
        values: points.iter().map(of).collect(),
    };
    let (x, y) = (numbers("measure", |point| point.1), numbers("answer", |point| point.2));
    let Ok(Outcome::Ok(found)) = spearman(&x, &y) else { return None };
    let ci95 = bonett_wright_interval(found.rho, points.len() - lost);
    Some(Correlation { stimuli: points.len(), rho: found.rho, ci95 })
}

/// The same of deviations from the means of performances with several clips.
fn within_performances(points: &[StimulusPoint<'_>]) -> Option<Correlation> {
    let mut performances: BTreeMap<[&str; 2], Vec<(f64, f64)>> = BTreeMap::new();
    for (performance, x, y) in points {
        performances.entry(*performance).or_default().push((*x, *y));
    }
    performances.retain(|_, own| own.len() > 1);
    let mut deviations = Vec::new();
    for (performance, own) in &performances {
        let mean = |of: fn(&(f64, f64)) -> f64| own.iter().map(of).sum::<f64>() / own.len() as f64;
        let (x, y) = (mean(|point| point.0), mean(|point| point.1));
        deviations.extend(own.iter().map(|point| (*performance, point.0 - x, point.1 - y)));
    }
    correlation(&deviations, performances.len().saturating_sub(1))
}

/// A row per measure.
fn correlation_table(
    language: Language,
    measure: &Measure,
    correlations: &[&MeasureCorrelation],
) -> DataTable {
    let caption = language.pick(
        format!(
            "{} and measures of the stimuli: Spearman’s correlation [95 % interval]",
            measure.label
        ),
        format!(
            "{} et mesures des stimuli : corrélation de Spearman [intervalle à 95 %]",
            measure.label
        ),
    );
    let columns = match language {
        Language::English => ["Measure", "Stimuli", "Over all stimuli", "Within performances"],
        Language::French => {
            ["Mesure", "Stimuli", "Sur tous les stimuli", "Au sein des performances"]
        }
    };
    let mut table =
        DataTable::new(format!("{}-and-stimulus-measures", slug(&measure.id)), caption, columns);
    let cell = |correlation: Option<Correlation>| match correlation {
        None => String::new(),
        Some(Correlation { rho, ci95: None, .. }) => language.fixed(rho, 2),
        Some(Correlation { rho, ci95: Some(ends), .. }) => {
            let [low, high] = ends.map(|end| language.fixed(end, 2));
            format!("{} [{low}; {high}]", language.fixed(rho, 2))
        }
    };
    for each in correlations {
        table.row([
            words_of(language, &each.measure),
            each.all.stimuli.to_string(),
            cell(Some(each.all)),
            cell(each.within_performances),
        ]);
    }
    table
}

/// A measure's name in words; a laboratory's own measures are named by their columns.
fn words_of(language: Language, name: &str) -> String {
    let parts = [
        ("forehead", "forehead", "front"),
        ("brow", "brows", "sourcils"),
        ("eye", "eyes", "yeux"),
        ("nose", "nose", "nez"),
        ("cheek", "cheeks", "joues"),
        ("mouth", "mouth", "bouche"),
        ("chin", "chin", "menton"),
        ("jaw", "jaw", "mâchoire"),
        ("face", "face", "visage"),
    ];
    let range = name.strip_prefix("range_mm_");
    if let Some((_, english, french)) = parts.iter().find(|(part, ..)| range == Some(part)) {
        return language
            .pick(format!("Range, {english} (mm)"), format!("Amplitude, {french} (mm)"));
    }
    let (english, french) = match name {
        "jerk_m_per_s3" => ("Jerk (m/s³)", "Secousse (m/s³)"),
        "widest_mouth_mm" => {
            ("Widest opening of the lips (mm)", "Plus grande ouverture des lèvres (mm)")
        }
        "residual_mm" => ("Residual at the markers (mm)", "Résidu aux marqueurs (mm)"),
        "marker_correlation" => ("Correlation with the markers", "Corrélation avec les marqueurs"),
        "recorded_rms_mm" => (
            "Distance from the recorded face (mm, rms)",
            "Distance au visage enregistré (mm, efficace)",
        ),
        "recorded_largest_mm" => (
            "Largest distance from the recorded face (mm)",
            "Plus grande distance au visage enregistré (mm)",
        ),
        "recorded_lip_vertex_error_mm" => {
            ("Lip vertex error (mm)", "Erreur des sommets des lèvres (mm)")
        }
        "recorded_lip_closure_misses" => {
            ("Missed closures of the lips (share)", "Fermetures des lèvres manquées (part)")
        }
        other => (other, other),
    };
    language.pick(english, french).to_owned()
}
