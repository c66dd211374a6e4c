//! The sections of a report in their order: in short, participants, hypotheses, measures, timing, notes.

use std::collections::{BTreeMap, BTreeSet};

use mimique_study::Study;
use serde::Serialize;

use super::ReportFile;
use super::comparison::Comparison;
use super::document::{Block, DataTable, Document, Figure, escape, slug};
use super::export::{AskedQuestion, Export, Flow, Person};
use super::flow_chart::flow_chart;
use super::hypothesis::{HypothesisResult, test_hypothesis};
use super::language::Language;
use super::layouts::LayoutCell;
use super::measure::Measure;
use super::naming::Naming;
use super::person_level::PersonLevel;
use super::reading;
use super::replay;
use super::section_course::Course;
use super::tables;
use super::trial_level::TrialLevel;
use crate::adjust::Adjustment;
use crate::confusion::Confusion;
use crate::describe::{Description, describe};
use crate::outcome::{Labelled, Outcome};
use crate::proportion::proportion;

/// Levels beyond which a column is no factor that people compare.
const MOST_LEVELS: usize = 12;

/// What is written: the document, `results.json`, and the readings of the hypotheses.
pub(crate) struct Sections {
    pub document: Document,
    pub results: String,
    pub readings: Vec<(String, String)>,
    pub replay: Vec<ReportFile>,
}

/// Everything that was computed, for `results.json`.
#[derive(Serialize, Default)]
pub(crate) struct Results<'a> {
    pub study: String,
    pub version: String,
    pub language: &'static str,
    pub flow: Option<&'a Flow>,
    pub people: &'a [Person],
    pub about_people: BTreeMap<String, AboutPeople>,
    pub hypotheses: Vec<HypothesisResult>,
    pub confusion: Vec<NamedConfusion>,
    pub comparisons: Vec<Comparison>,
    pub two_way: Vec<TwoWay>,
    pub course: Vec<Course>,
    pub layouts: Vec<LayoutCell>,
    pub late_frames: Vec<LateFrames>,
}

/// Answers about people.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum AboutPeople {
    /// Of a number.
    Numbers(Outcome<Description>),
    /// Of words: people an answer.
    Counts(Labelled<usize>),
}

/// A confusion matrix of some of the trials.
#[derive(Serialize)]
pub(crate) struct NamedConfusion {
    pub response: String,
    /// The factor; none for all trials.
    pub by: Option<String>,
    /// `all`, or a factor's level.
    pub of: String,
    pub result: Confusion,
}

/// Two factors and their interaction.
#[derive(Serialize)]
pub(crate) struct TwoWay {
    pub measure: String,
    pub factors: [String; 2],
    pub as_in_the_thesis: TrialLevel,
    pub recommended: PersonLevel,
}

/// Late frames at a level of the first factor.
#[derive(Serialize)]
pub(crate) struct LateFrames {
    pub level: String,
    pub trials: usize,
    pub frames: f64,
    pub late: f64,
    pub trials_with_late_frames: usize,
    pub longest_ms: Option<f64>,
}

/// Collects blocks and results.
pub(crate) struct Writer<'a> {
    pub naming: Naming<'a>,
    pub export: &'a Export,
    pub study: &'a Study,
    pub blocks: Vec<Block>,
    pub results: Results<'a>,
    /// Factors with several levels in the trials used, `method` first.
    pub factors: Vec<String>,
}

/// Writes all sections.
pub(crate) fn write(export: &Export, study: &Study, language: Language) -> Sections {
    let mut writer = Writer {
        naming: Naming { language, study },
        export,
        study,
        blocks: Vec::new(),
        results: Results {
            study: study.id.clone(),
            version: study.study_metadata.version.clone(),
            language: language.code(),
            flow: Some(&export.flow),
            people: &export.people,
            ..Results::default()
        },
        factors: factors_in_use(export, study),
    };
    let asked = export.questions(study);
    let measures: Vec<(AskedQuestion<'_>, Measure)> = asked
        .into_iter()
        .filter_map(|asked| {
            let measure = Measure::of_question(export, &asked, language)?;
            Some((asked, measure))
        })
        .collect();
    let hypotheses = hypotheses(&writer);
    writer.in_short(&hypotheses);
    writer.participants();
    writer.hypotheses(&hypotheses);
    let readings = hypotheses.iter().map(|h| (h.id.clone(), h.reading.clone())).collect();
    writer.results.hypotheses = hypotheses;
    for (asked, measure) in measures.iter().filter(|(asked, _)| asked.is_recognition()) {
        writer.recognition(asked, measure);
    }
    for (asked, measure) in measures.iter().filter(|(asked, _)| !asked.is_recognition()) {
        writer.rating(asked, measure);
    }
    writer.layouts();
    let mut over_time: Vec<&Measure> = measures.iter().map(|(_, measure)| measure).collect();
    let time =
        measures.first().and_then(|(asked, _)| Measure::response_time(export, asked, language));
    over_time.extend(&time);
    writer.course_of_the_session(&over_time);
    writer.timing();
    writer.notes();

    let title = study.study_metadata.title.in_language(language.code()).to_owned();
    let subtitle = language.pick(
        format!(
            "Results of the study {}, version {}: {} people, {} trials.",
            study.id,
            study.study_metadata.version,
            export.flow.people_used,
            export.flow.trials_used
        ),
        format!(
            "Résultats de l’étude {}, version {} : {} personnes, {} essais.",
            study.id,
            study.study_metadata.version,
            export.flow.people_used,
            export.flow.trials_used
        ),
    );
    let replay = replay::files(&writer);
    let mut results =
        serde_json::to_string_pretty(&writer.results).unwrap_or_else(|error| error.to_string());
    results.push('\n');
    Sections {
        document: Document { title, subtitle, blocks: writer.blocks },
        results,
        readings,
        replay,
    }
}

/// Factors with two levels or more among the trials, those that the methods set first. Of two factors that part the
/// trials alike only the first is kept.
fn factors_in_use(export: &Export, study: &Study) -> Vec<String> {
    // What the methods set is compared; then what was played, in the order that people name it.
    let clips = study.clips();
    let of_methods = |name: &str| {
        let mut by_method: BTreeMap<&str, Option<String>> = BTreeMap::new();
        let alike = clips.iter().all(|clip| {
            let level = clip.factors.get(name).map(ToString::to_string);
            *by_method.entry(&clip.method).or_insert_with(|| level.clone()) == level
        });
        let levels: BTreeSet<&Option<String>> = by_method.values().collect();
        alike && levels.len() > 1
    };
    let rank = |name: &str| match name {
        "method" => 0,
        _ if of_methods(name) => 1,
        "expression" => 2,
        "intensity" => 3,
        _ => 4,
    };
    let mut places: Vec<usize> = (0..export.factors.len()).collect();
    places.sort_by_key(|&place| (rank(&export.factors[place]), place));
    let mut kept: Vec<usize> = Vec::new();
    for place in places {
        let levels: BTreeSet<&str> =
            export.trials.iter().filter_map(|trial| trial.levels[place].as_deref()).collect();
        if !(2..=MOST_LEVELS).contains(&levels.len()) {
            continue;
        }
        let alike = kept.iter().any(|&other| {
            let pairs: BTreeSet<(Option<&str>, Option<&str>)> = export
                .trials
                .iter()
                .map(|trial| (trial.levels[place].as_deref(), trial.levels[other].as_deref()))
                .collect();
            let others: BTreeSet<Option<&str>> =
                export.trials.iter().map(|trial| trial.levels[other].as_deref()).collect();
            pairs.len() == others.len()
        });
        if !alike {
            kept.push(place);
        }
    }
    kept.into_iter().map(|place| export.factors[place].clone()).collect()
}

fn hypotheses(writer: &Writer<'_>) -> Vec<HypothesisResult> {
    let mut results: Vec<HypothesisResult> = writer
        .study
        .hypotheses
        .iter()
        .map(|hypothesis| test_hypothesis(&writer.naming, writer.export, writer.study, hypothesis))
        .collect();
    let p: Vec<Option<f64>> = results.iter().map(|result| result.p).collect();
    let tested = p.iter().flatten().count();
    for (result, corrected) in results.iter_mut().zip(Adjustment::Holm.apply(&p)) {
        result.p_holm_over_hypotheses = corrected;
        if let (Some(p), Some(corrected), true) = (result.p, corrected, tested > 1) {
            let language = writer.naming.language;
            result.reading.push(' ');
            result.reading += &reading::over_hypotheses(language, p, corrected, tested);
        }
    }
    results
}

impl Writer<'_> {
    pub(crate) fn language(&self) -> Language {
        self.naming.language
    }

    pub(crate) fn heading(&mut self, level: u8, english: &str, french: &str) {
        let text = self.language().pick(english, french).to_owned();
        self.blocks.push(Block::Heading(level, text));
    }

    pub(crate) fn paragraph(&mut self, english: &str, french: &str) {
        let text = self.language().pick(english, french).to_owned();
        self.blocks.push(Block::Paragraph(text));
    }

    /// Adds a figure whose own label is its description.
    pub(crate) fn figure(&mut self, mut figure: Figure) {
        figure.svg = figure.svg.replacen(
            &format!("aria-label=\"{}\"", escape(&figure.caption)),
            &format!("aria-label=\"{}\"", escape(&figure.alt)),
            1,
        );
        self.blocks.push(Block::Figure(figure));
    }

    fn in_short(&mut self, hypotheses: &[HypothesisResult]) {
        self.heading(2, "In short", "En bref");
        if hypotheses.is_empty() {
            self.paragraph(
                "The study file states no hypothesis; every comparison below is exploratory.",
                "Le fichier de l’étude n’énonce aucune hypothèse ; toutes les comparaisons ci-dessous sont exploratoires.",
            );
        }
        for result in hypotheses {
            self.blocks.push(Block::Reading(format!("{}. {}", result.id, result.reading)));
        }
        let n = self.export.flow.people_used;
        if n < 6 {
            self.blocks.push(Block::Caution(self.language().pick(
                format!("With {n} people in the analysis no paired test can reach p < 0.05: six are the least, and most effects need many more. Take what follows as a trial run of the analysis."),
                format!("Avec {n} personnes dans l’analyse, aucun test apparié ne peut atteindre p < 0,05 : il en faut au moins six, et la plupart des effets en demandent bien plus. Considérez ce qui suit comme un essai de l’analyse."),
            )));
        }
    }

    fn participants(&mut self) {
        let language = self.language();
        self.heading(2, "Participants", "Participants");
        let flow = flow_chart(language, &self.export.flow);
        self.figure(flow);
        if self.export.flow.rules.is_empty() {
            self.paragraph(
                "The study file sets no rule of exclusion; only withdrawn and pilot sessions are left out.",
                "Le fichier de l’étude ne fixe aucune règle d’exclusion ; seules les sessions retirées et pilotes sont écartées.",
            );
        } else {
            let rules = self.export.flow.rules.join(", ");
            self.blocks.push(Block::Paragraph(language.pick(
                format!("Rules of exclusion, fixed in the study file: {rules}."),
                format!("Règles d’exclusion, fixées dans le fichier de l’étude : {rules}."),
            )));
        }
        let caption = language.pick(
            "Answers of the people in the analysis about themselves",
            "Réponses des personnes de l’analyse sur elles-mêmes",
        );
        let mut table = DataTable::new(
            "about-people",
            caption,
            language.pick(["question", "people", "answers"], ["question", "personnes", "réponses"]),
        );
        for (column, cells) in &self.export.about {
            let used: Vec<&str> = cells
                .iter()
                .zip(&self.export.people)
                .filter(|(_, person)| person.excluded.is_none())
                .filter_map(|(cell, _)| cell.as_deref())
                .collect();
            let question = self
                .study
                .demographics
                .iter()
                .flat_map(|page| &page.questions)
                .find(|question| question.id == *column);
            let label = question.map_or_else(
                || column.clone(),
                |question| question.prompt.in_language(language.code()).to_owned(),
            );
            let (summary, words) = self.about_people(column, &used);
            table.row([label, used.len().to_string(), words]);
            self.results.about_people.insert(column.clone(), summary);
        }
        if !table.rows.is_empty() {
            self.blocks.push(Block::Table(table));
        }
    }

    fn about_people(&self, column: &str, used: &[&str]) -> (AboutPeople, String) {
        let language = self.language();
        let numbers: Option<Vec<f64>> = used.iter().map(|cell| cell.parse().ok()).collect();
        if let Some(numbers) = numbers.filter(|numbers| !numbers.is_empty()) {
            let description = describe(&numbers);
            let words = match &description {
                Outcome::Ok(d) => language.pick(
                    format!(
                        "mean {}, sd {}, median {}, from {} to {}",
                        language.number(d.mean),
                        d.sd.map_or_else(|| "–".to_owned(), |sd| language.number(sd)),
                        language.number(d.median),
                        language.number(d.min),
                        language.number(d.max)
                    ),
                    format!(
                        "moyenne {}, écart type {}, médiane {}, de {} à {}",
                        language.number(d.mean),
                        d.sd.map_or_else(|| "–".to_owned(), |sd| language.number(sd)),
                        language.number(d.median),
                        language.number(d.min),
                        language.number(d.max)
                    ),
                ),
                Outcome::Undefined { reason } => reason.clone(),
            };
            return (AboutPeople::Numbers(description), words);
        }
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for cell in used {
            *counts.entry(cell).or_insert(0) += 1;
        }
        let mut counts: Vec<(String, usize)> =
            counts.into_iter().map(|(cell, count)| (cell.to_owned(), count)).collect();
        counts.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        let words: Vec<String> = counts
            .iter()
            .take(MOST_LEVELS)
            .map(|(cell, count)| format!("{}: {count}", self.naming.level(column, cell)))
            .collect();
        (AboutPeople::Counts(Labelled(counts)), words.join(", "))
    }

    fn hypotheses(&mut self, hypotheses: &[HypothesisResult]) {
        if hypotheses.is_empty() {
            return;
        }
        let language = self.language();
        self.heading(2, "Hypotheses", "Hypothèses");
        self.blocks.push(Block::Caution(reading::trial_level_caution(language).to_owned()));
        for result in hypotheses {
            self.blocks.push(Block::Heading(3, format!("{}. {}", result.id, result.statement)));
            let table = tables::two_columns(
                &self.naming,
                format!("hypothesis-{}", slug(&result.id)),
                language.pick(
                    format!("{}: as in the thesis and recommended", result.id),
                    format!("{} : comme dans la thèse et recommandé", result.id),
                ),
                result.factors.first().map_or("", String::as_str),
                result.kind,
                &result.as_in_the_thesis,
                &result.recommended,
            );
            self.blocks.push(Block::Table(table));
            let pairs = tables::many_pairs(
                &self.naming,
                format!("hypothesis-{}-pairs", slug(&result.id)),
                result.factors.first().map_or("", String::as_str),
                result.kind,
                &result.recommended,
            );
            self.blocks.extend(pairs.map(Block::Table));
            self.blocks.push(Block::Reading(result.reading.clone()));
        }
        if hypotheses.iter().filter(|result| result.p.is_some()).count() > 1 {
            let heading = language.pick(
                ["hypothesis", "p (recommended test)", "p corrected for all hypotheses (Holm)"],
                ["hypothèse", "p (test recommandé)", "p corrigé pour toutes les hypothèses (Holm)"],
            );
            let caption =
                language.pick("All hypotheses together", "Toutes les hypothèses ensemble");
            let mut table = DataTable::new("hypotheses", caption, heading);
            for result in hypotheses {
                let cell = |p: Option<f64>| {
                    p.map_or_else(|| "–".to_owned(), |p| language.p_cell(p, p.ln()))
                };
                table.row([result.id.clone(), cell(result.p), cell(result.p_holm_over_hypotheses)]);
            }
            self.blocks.push(Block::Table(table));
        }
    }

    fn notes(&mut self) {
        let language = self.language();
        self.heading(2, "How this was computed", "Comment cela a été calculé");
        self.paragraph(
            "Recommended: each person’s answers at a level are averaged, so that a person counts once. Several levels: Friedman’s test with Iman and Davenport’s F and Kendall’s W. Pairs: Wilcoxon’s signed rank test, exact and conditional on the observed ranks, zeros by Pratt, Holm’s correction, rank-biserial correlation, Hodges-Lehmann estimate and 95 % interval from the Walsh averages. Interactions: aligned rank transform on person means.",
            "Recommandé : les réponses de chaque personne à un niveau sont moyennées, de sorte qu’une personne compte une fois. Plusieurs niveaux : test de Friedman, F d’Iman et Davenport, W de Kendall. Paires : test des rangs signés de Wilcoxon, exact et conditionnel aux rangs observés, zéros selon Pratt, correction de Holm, corrélation bisériale des rangs, estimation de Hodges-Lehmann et intervalle à 95 % par les moyennes de Walsh. Interactions : transformation des rangs alignés sur les moyennes des personnes.",
        );
        self.paragraph(
            "Effect sizes: r is the matched rank-biserial correlation, W Kendall’s coefficient of concordance, V Cramér’s, ε² is H / (n − 1) of Kruskal-Wallis, η²H the same of Scheirer-Ray-Hare (SRH), ηp² the partial eta squared of the aligned rank transform (ART).",
            "Tailles d’effet : r est la corrélation bisériale des rangs appariés, W le coefficient de concordance de Kendall, V celui de Cramér, ε² est H / (n − 1) de Kruskal-Wallis, η²H le même de Scheirer-Ray-Hare (SRH), ηp² l’êta carré partiel de la transformation des rangs alignés (ART).",
        );
        self.paragraph(
            "As in the thesis: Kruskal-Wallis, Wilcoxon (R of 2019: zeros dropped, exact only below 50 differences without ties and zeros, else normal with continuity correction), Scheirer-Ray-Hare (type I sums of squares, corrected for ties) and chi-square (Yates’s correction for two by two) on single trials.",
            "Comme dans la thèse : Kruskal-Wallis, Wilcoxon (R de 2019 : zéros supprimés, exact seulement sous 50 différences sans ex æquo ni zéros, sinon normal avec correction de continuité), Scheirer-Ray-Hare (sommes de carrés de type I, corrigées des ex æquo) et khi-deux (correction de Yates pour deux par deux) sur les essais pris un à un.",
        );
        if self.one_clip_a_cell() {
            self.blocks.push(Block::Caution(
                language
                    .pick(
                        "Every combination of factors was shown with one clip only: what is found here holds for these clips, and does not generalise to other performances of the same emotions.",
                        "Chaque combinaison de facteurs n’a été montrée qu’avec un seul extrait : ce qui est trouvé ici vaut pour ces extraits et ne se généralise pas à d’autres interprétations des mêmes émotions.",
                    )
                    .to_owned(),
            ));
        }
    }

    /// Whether every combination of factors was shown with one clip only.
    pub(crate) fn one_clip_a_cell(&self) -> bool {
        let mut clips: BTreeMap<Vec<Option<&str>>, BTreeSet<&str>> = BTreeMap::new();
        for trial in &self.export.trials {
            let cell = trial.levels.iter().map(Option::as_deref).collect();
            clips.entry(cell).or_default().insert(&trial.stimulus);
        }
        clips.values().all(|clips| clips.len() == 1)
    }

    /// Shares of right answers by the levels of a factor.
    pub(crate) fn shares_by(
        &self,
        measure: &Measure,
        codes: impl Fn(usize) -> bool,
    ) -> crate::proportion::Proportion {
        let (mut right, mut all) = (0, 0);
        for (i, value) in measure.values.iter().enumerate() {
            if codes(i) {
                all += 1;
                right += u64::from(*value > 0.5);
            }
        }
        proportion(right, all)
    }
}
