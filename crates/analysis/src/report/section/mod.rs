//! The sections of a report in their order: in short, participants, hypotheses, measures, timing, notes.

pub(crate) mod best_worst;
pub(crate) mod choice_reasons;
pub(crate) mod choice_tests;
pub(crate) mod choices;
pub(crate) mod course;
pub(crate) mod decisions;
pub(crate) mod detection;
pub(crate) mod detection_by_factor;
pub(crate) mod equivalence;
pub(crate) mod hypotheses;
pub(crate) mod layout_tests;
pub(crate) mod layouts;
pub(crate) mod measures;
pub(crate) mod notes;
pub(crate) mod other_clips;
pub(crate) mod panels;
pub(crate) mod paper;
pub(crate) mod paper_participants;
pub(crate) mod people;
pub(crate) mod recognition;
pub(crate) mod roc;
pub(crate) mod sensitivity;
pub(crate) mod stimulus_measures;
pub(crate) mod timing;
pub(crate) mod trace_tests;
pub(crate) mod traces;

use std::collections::{BTreeMap, BTreeSet};

use mimique_locale::Language;
use mimique_report::ReportFile;
use mimique_report::document::{Block, DataTable, Document, Figure};
use mimique_stats::{Proportion, proportion};
use mimique_study::{KindOfQuestion as _, Study};
use rayon::iter::{IntoParallelIterator, ParallelIterator};

use crate::hypothesis::HypothesisResult;
use crate::mimicry::tables::FaceTables;
use crate::naming::{Naming, people_counted};
use crate::report::preview::Preview;
use crate::report::replay;
use crate::report::results::Results;
use crate::report::section::hypotheses::tested;
use crate::sensitivity::Sensitivity;
use crate::trials::asked_question::AskedQuestion;
use crate::trials::export::Export;
use crate::trials::measure::Measure;
use crate::trials::stimulus_measures::StimulusMeasures;
use crate::trials::versions::OtherVersion;

/// Levels beyond which a column is no factor that people compare.
pub(crate) const MOST_LEVELS: usize = 12;

/// What is written: the document, `results.json`, and the readings of the hypotheses.
pub(crate) struct Sections {
    pub document: Document,
    pub results: String,
    pub readings: Vec<(String, String)>,
    pub sensitivity: Vec<(String, String)>,
    pub replay: Vec<ReportFile>,
}

/// Writes one part of a report.
type Part<'p, 'a> = Box<dyn FnOnce(&mut Writer<'a>) + Send + 'p>;

/// Collects blocks and results.
pub(crate) struct Writer<'a> {
    pub naming: Naming<'a>,
    pub export: &'a Export,
    pub study: &'a Study,
    pub blocks: Vec<Block>,
    pub results: Results<'a>,
    /// Factors with several levels in the trials used, `method` first.
    pub factors: Vec<String>,
    /// What was measured of the stimuli, where a table of it is given.
    pub stimuli: Option<&'a StimulusMeasures>,
    /// What was measured of participants' faces, where tables of it are given.
    pub faces_measured: Option<&'a FaceTables>,
    /// Versions of the study that were served, other than this file.
    pub other_versions: &'a [OtherVersion],
    /// Where single clips are seen.
    pub preview: Option<Preview<'a>>,
}

/// What is given beside the export.
#[derive(Clone, Copy)]
pub(crate) struct Beside<'a> {
    pub stimuli: Option<&'a StimulusMeasures>,
    pub faces: Option<&'a FaceTables>,
    pub versions: &'a [OtherVersion],
    /// Where it was asked for.
    pub sensitivity: Option<&'a Sensitivity>,
}

/// Writes all sections.
pub(crate) fn write(
    export: &Export,
    study: &Study,
    beside: Beside<'_>,
    preview: Option<Preview<'_>>,
    language: Language,
) -> Sections {
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
            other_versions: beside.versions,
            sensitivity: beside.sensitivity,
            ..Results::default()
        },
        factors: factors_in_use(export, study),
        stimuli: beside.stimuli,
        faces_measured: beside.faces,
        other_versions: beside.versions,
        preview,
    };
    let asked = export.questions(study).into_iter();
    let is_apart = |id: &str| study.is_asked_of_drawn_faces(id) || study.is_asked_of_scales(id);
    let asked = asked.filter(|asked| !is_apart(&asked.id));
    let measures: Vec<(AskedQuestion<'_>, Measure)> = asked
        .filter_map(|asked| {
            let measure = Measure::of_question(export, &asked, language)?;
            Some((asked, measure))
        })
        .collect();
    let hypotheses = tested(&writer);
    writer.in_short(&hypotheses);
    writer.participants();
    writer.hypotheses(&hypotheses);
    let sensitivity = beside.sensitivity.map(|found| writer.sensitivity(found));
    let readings = hypotheses.iter().map(|h| (h.id.clone(), h.reading.clone())).collect();
    let parts = of_measures(&writer, &measures, &hypotheses);
    for part in parts {
        writer.append(part);
    }
    writer.paper(&hypotheses);
    writer.results.hypotheses = hypotheses;
    writer.notes();

    let replay = replay::files(&writer);
    let mut results =
        serde_json::to_string_pretty(&writer.results).unwrap_or_else(|error| error.to_string());
    results.push('\n');
    let (title, subtitle) = heading(export, study, language);
    Sections {
        document: Document { title, subtitle, blocks: writer.blocks },
        results,
        readings,
        sensitivity: sensitivity.unwrap_or_default(),
        replay,
    }
}

/// The sections about the measures and about the study's own tables. Each part is written by itself, at
/// the same time as the others, and takes its place.
fn of_measures<'a>(
    writer: &Writer<'a>,
    measures: &[(AskedQuestion<'a>, Measure)],
    hypotheses: &[HypothesisResult],
) -> Vec<Writer<'a>> {
    let (export, study, language) = (writer.export, writer.study, writer.language());
    let (recognised, rated): (Vec<_>, Vec<_>) =
        measures.iter().partition(|(asked, _)| asked.is_recognition());
    let mut over_time: Vec<&Measure> = measures.iter().map(|(_, measure)| measure).collect();
    let time =
        measures.first().and_then(|(asked, _)| Measure::response_time(export, asked, language));
    over_time.extend(&time);
    let choices: Vec<AskedQuestion<'_>> = export
        .questions(study)
        .into_iter()
        .filter(|asked| asked.question.is_some_and(|question| question.kind.compares_clips()))
        // What was shown followed the answers: counts of them say nothing of the clips.
        .filter(|asked| !study.is_asked_of_no_clip(&asked.id))
        .collect();
    let mut parts: Vec<Part<'_, 'a>> = Vec::new();
    for (asked, measure) in recognised {
        parts.push(Box::new(|part| part.recognition(asked, measure)));
    }
    for (asked, measure) in rated {
        parts.push(Box::new(|part| part.rating(asked, measure)));
    }
    parts.push(Box::new(|part| part.panels(measures)));
    parts.push(Box::new(|part| part.thresholds()));
    parts.push(Box::new(|part| part.scalings()));
    parts.push(Box::new(|part| part.faces()));
    for asked in &choices {
        parts.push(Box::new(|part| part.choices(asked)));
    }
    for question in study.all_questions().filter(|each| each.kind.is_best_worst()) {
        parts.push(Box::new(|part| part.best_worst(question)));
    }
    if !study.tables.is_empty() {
        parts.push(Box::new(|part| part.layouts_heading()));
    }
    for layout in &study.tables {
        parts.push(Box::new(|part| part.layout(layout, hypotheses)));
    }
    parts.push(Box::new(|part| part.agreement(measures)));
    parts.push(Box::new(|part| part.scales()));
    parts.push(Box::new(|part| part.stimulus_measures(measures)));
    parts.push(Box::new(|part| part.mimicry()));
    parts.push(Box::new(|part| part.course_of_the_session(&over_time)));
    parts.push(Box::new(|part| part.timing()));
    parts
        .into_par_iter()
        .map(|write| {
            let mut part = writer.part();
            write(&mut part);
            part
        })
        .collect()
}

/// Title and subtitle of the report.
fn heading(export: &Export, study: &Study, language: Language) -> (String, String) {
    let title = study.study_metadata.title.in_language(language.code()).to_owned();
    let (arrived, used) = (export.flow.people, export.flow.people_used);
    let people = people_counted(language, arrived);
    let people = match arrived == used {
        true => people,
        false => language.pick(
            format!("{people}, {used} in the analysis"),
            format!("{people}, dont {used} dans l’analyse"),
        ),
    };
    let trials =
        language.counted(export.flow.trials_used, ["trial", "trials"], ["essai", "essais"]);
    let subtitle = language.pick(
        format!(
            "Results of the study {}, version {}: {people}, {trials}.",
            study.id, study.study_metadata.version
        ),
        format!(
            "Résultats de l’étude {}, version {} : {people}, {trials}.",
            study.id, study.study_metadata.version
        ),
    );
    (title, subtitle)
}

/// Factors with two levels or more among the trials, those that the methods set first. A factor whose level
/// follows from that of another one before it (as a parameter's from the method's) is left out.
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
    // A trial of each combination tells as much as all of them.
    let combinations = &export.combinations().first;
    let trials = || combinations.iter().map(|&trial| &export.trials[trial]);
    let mut kept: Vec<usize> = Vec::new();
    for place in places {
        let levels: BTreeSet<&str> =
            trials().filter_map(|trial| trial.levels[place].as_deref()).collect();
        if !(2..=MOST_LEVELS).contains(&levels.len()) {
            continue;
        }
        let alike = kept.iter().any(|&other| {
            let pairs: BTreeSet<(Option<&str>, Option<&str>)> = trials()
                .map(|trial| (trial.levels[place].as_deref(), trial.levels[other].as_deref()))
                .collect();
            let others: BTreeSet<Option<&str>> =
                trials().map(|trial| trial.levels[other].as_deref()).collect();
            pairs.len() == others.len()
        });
        if !alike {
            kept.push(place);
        }
    }
    kept.into_iter().map(|place| export.factors[place].clone()).collect()
}

impl<'a> Writer<'a> {
    /// A writer of the same study that has written nothing.
    fn part(&self) -> Self {
        Self {
            naming: self.naming,
            blocks: Vec::new(),
            results: Results::default(),
            factors: self.factors.clone(),
            ..*self
        }
    }

    /// What a part has written, behind what is there.
    fn append(&mut self, part: Self) {
        self.blocks.extend(part.blocks);
        self.results.append(part.results);
    }
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

    /// What `write` writes, behind a heading.
    pub(crate) fn folded(&mut self, heading: String, write: impl FnOnce(&mut Self)) {
        let before = std::mem::take(&mut self.blocks);
        write(self);
        let own = std::mem::replace(&mut self.blocks, before);
        if !own.is_empty() {
            self.blocks.push(Block::Folded(heading, own));
        }
    }

    /// A table behind its caption.
    pub(crate) fn folded_table(&mut self, table: DataTable) {
        self.blocks.push(Block::Folded(table.caption.clone(), vec![Block::Table(table)]));
    }

    /// Adds a figure whose own label is its description.
    pub(crate) fn figure(&mut self, figure: Figure) {
        self.blocks.push(Block::figure(figure));
    }

    /// Shares of right answers by the levels of a factor.
    pub(crate) fn shares_by(&self, measure: &Measure, codes: impl Fn(usize) -> bool) -> Proportion {
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
