//! The section of a report that holds answers against what was measured of the stimuli.

use std::collections::BTreeMap;

use mimique_locale::Language;
use mimique_report::document::{Block, DataTable, Figure, slug};
use mimique_stats::{Numbers, Outcome, resampled_interval, spearman};
use mimique_study::Measure as What;
use serde::Serialize;

use crate::report::figure::{ScatterPanel, scatter};
use crate::report::preview::Preview;
use crate::report::section::Writer;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::measure::Measure;

/// Fewest stimuli that a rank correlation is told of.
const FEWEST: usize = 6;
/// Fewest performances that are drawn again for an interval: of fewer the ends are those of single performances.
const FEWEST_PERFORMANCES: usize = 4;
/// Draws of performances for an interval.
const ROUNDS: usize = 2000;
/// Seed of these draws.
const SEED: u64 = 1;
/// How the names of the ranges of the parts of a face begin.
const RANGE: &str = "obj_range_mm_";

/// How the mean answers about stimuli go with a measure of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct MeasureCorrelation {
    /// The question.
    pub response: String,
    /// Column of the table of stimuli.
    pub measure: String,
    /// What is held against each other, a stimulus each.
    #[serde(skip)]
    points: Vec<NamedPoint>,
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
    /// Performances (segment and avatar) that they belong to.
    pub performances: usize,
    /// The correlation.
    pub rho: f64,
    /// The percentile interval at 95 % of performances drawn with replacement; none of fewer than four performances.
    pub ci95: Option<[f64; 2]>,
}

/// A stimulus by name, what was measured of it, its mean answer.
type NamedPoint = (String, f64, f64);

impl Writer<'_> {
    /// Answers against measures; nothing where no table of stimuli is given.
    pub(crate) fn stimulus_measures(&mut self, measures: &[(AskedQuestion<'_>, Measure)]) {
        let Some(table) = self.stimuli.filter(|table| !table.measures.is_empty()) else { return };
        let language = self.language();
        self.heading(2, "Answers and measures of the stimuli", "Réponses et mesures des stimuli");
        self.paragraph(
            "Each stimulus’s mean answer is held against what was measured of it: Spearman’s rank correlation over stimuli, with the 95 % percentile interval of 2000 draws of performances (of few performances it lies a little farther from 0 than the correlation, since those that are drawn twice tie their ranks). Within performances both are taken as deviations from the mean of the performance, so that a performance that everybody rates higher tells nothing. These are descriptions of these stimuli; no hypothesis is decided by them.",
            "La réponse moyenne de chaque stimulus est comparée à ce qui en a été mesuré : corrélation des rangs de Spearman sur les stimuli, avec l’intervalle à 95 % (percentiles) de 2000 tirages de performances (avec peu de performances, il est un peu plus loin de 0 que la corrélation, car celles tirées deux fois lient leurs rangs). Au sein des performances, les deux sont pris comme écarts à la moyenne de la performance : une performance que tous notent plus haut ne dit rien. Ce sont des descriptions de ces stimuli ; aucune hypothèse n’en dépend.",
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
                "No question has mean answers of six stimuli that were measured and differ.",
                "Aucune question n’a de réponses moyennes pour six stimuli mesurés et différents.",
            );
        }
        for (_, measure) in measures {
            let own: Vec<&MeasureCorrelation> =
                found.iter().filter(|each| each.response == measure.id).collect();
            if !own.is_empty() {
                self.figure(scattered(language, measure, &own, self.preview));
                self.folded_table(correlation_table(language, measure, &own));
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
            let mut points: Vec<StimulusPoint<'_>> = Vec::new();
            let mut named = Vec::new();
            for (&stimulus, (sum, count)) in &sums {
                let (Some(&performance), Some(&value)) =
                    (performance_of.get(stimulus), values.get(stimulus))
                else {
                    continue;
                };
                points.push((performance, value, sum / count));
                named.push((stimulus.to_owned(), value, sum / count));
            }
            Some(MeasureCorrelation {
                response: measure.id.clone(),
                measure: name.clone(),
                points: named,
                all: correlation(&points)?,
                within_performances: within_performances(&points),
            })
        };
        table.measures.iter().filter_map(of_measure).collect()
    }
}

/// A stimulus: its performance, what was measured, its mean answer.
type StimulusPoint<'a> = ([&'a str; 2], f64, f64);

/// Spearman's correlation of some points; none of too few, or of a constant.
fn correlation(points: &[StimulusPoint<'_>]) -> Option<Correlation> {
    if points.len() < FEWEST {
        return None;
    }
    let rho = rank_correlation(points)?;
    let mut performances: BTreeMap<[&str; 2], Vec<StimulusPoint<'_>>> = BTreeMap::new();
    for point in points {
        performances.entry(point.0).or_default().push(*point);
    }
    let groups: Vec<Vec<StimulusPoint<'_>>> = performances.into_values().collect();
    let of_drawn = |drawn: &[usize]| {
        let points: Vec<StimulusPoint<'_>> =
            drawn.iter().flat_map(|&group| groups[group].iter().copied()).collect();
        rank_correlation(&points)
    };
    let ci95 = (groups.len() >= FEWEST_PERFORMANCES)
        .then(|| resampled_interval(groups.len(), ROUNDS, SEED, of_drawn))
        .flatten();
    Some(Correlation { stimuli: points.len(), performances: groups.len(), rho, ci95 })
}

/// Spearman's correlation of measures and answers; none of a constant.
fn rank_correlation(points: &[StimulusPoint<'_>]) -> Option<f64> {
    let numbers = |name: &str, of: fn(&StimulusPoint<'_>) -> f64| Numbers {
        name: name.to_owned(),
        values: points.iter().map(of).collect(),
    };
    let (x, y) = (numbers("measure", |point| point.1), numbers("answer", |point| point.2));
    match spearman(&x, &y) {
        Ok(Outcome::Ok(found)) => Some(found.rho),
        _ => None,
    }
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
    correlation(&deviations)
}

/// A panel per measure: all but the ranges of single parts of the face, which the table has.
fn scattered(
    language: Language,
    measure: &Measure,
    correlations: &[&MeasureCorrelation],
    preview: Option<Preview<'_>>,
) -> Figure {
    let whole = |each: &&&MeasureCorrelation| {
        !each.measure.starts_with(RANGE) || each.measure == "obj_range_mm_face"
    };
    let panels: Vec<ScatterPanel<'_>> = (correlations.iter().filter(whole))
        .map(|each| ScatterPanel { title: words_of(language, &each.measure), points: &each.points })
        .collect();
    let caption = language.pick(
        format!("{}: mean answer against measures of the stimuli", measure.label),
        format!("{} : réponse moyenne selon les mesures des stimuli", measure.label),
    );
    let id = format!("{}-against-measures", slug(&measure.id));
    scatter(language, &id, &caption, &measure.label, &panels, preview)
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
    let range = name.strip_prefix(RANGE);
    if let Some((_, english, french)) = parts.iter().find(|(part, ..)| range == Some(part)) {
        return language
            .pick(format!("Range, {english} (mm)"), format!("Amplitude, {french} (mm)"));
    }
    let (english, french) = match name {
        "obj_jerk_m_per_s3" => ("Jerk (m/s³)", "Secousse (m/s³)"),
        "obj_widest_mouth_mm" => {
            ("Widest opening of the lips (mm)", "Plus grande ouverture des lèvres (mm)")
        }
        "obj_residual_mm" => ("Residual at the markers (mm)", "Résidu aux marqueurs (mm)"),
        "obj_marker_correlation" => {
            ("Correlation with the markers", "Corrélation avec les marqueurs")
        }
        "obj_recorded_rmse_mm" => {
            ("RMSE from the recorded face (mm)", "Écart efficace au visage enregistré (mm)")
        }
        "obj_recorded_largest_mm" => (
            "Largest distance from the recorded face (mm)",
            "Plus grande distance au visage enregistré (mm)",
        ),
        "obj_recorded_lip_vertex_error_mm" => {
            ("Lip vertex error (mm)", "Erreur des sommets des lèvres (mm)")
        }
        "obj_recorded_lip_vertex_error_mm2" => {
            ("Lip vertex error, squared (mm²)", "Erreur des sommets des lèvres, au carré (mm²)")
        }
        "obj_recorded_upper_face_deviation_mm2" => {
            ("Upper-face dynamics deviation (mm²)", "Écart de dynamique du haut du visage (mm²)")
        }
        "obj_recorded_lip_gap_error_mm" => {
            ("Error of the lips’ gap (mm)", "Erreur de l’écart des lèvres (mm)")
        }
        "obj_recorded_lip_closures_kept" => {
            ("Closures of the lips kept (share)", "Fermetures des lèvres conservées (part)")
        }
        other => (other, other),
    };
    language.pick(english, french).to_owned()
}
