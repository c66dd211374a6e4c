//! The report of an evaluation: a document of the components that studies' reports have, `results.json`,
//! and what is printed.

mod confusion;
mod reliability;
mod scores;
mod timeline;
mod words;

use std::io::Write as _;
use std::path::Path;

use mimique_annotate::evaluate::{Judged, Score, Summary};
use mimique_locale::Language;
use mimique_report::document::{Block, Document};
use mimique_report::{ReportFile, document_files};
use serde_json::{Value, json};

use super::evaluate::{Column, Evaluation};

/// The files of a report.
pub fn files(of: &Evaluation, language: Language) -> Vec<ReportFile> {
    let mut files = document_files(&document(of, language), language);
    let text = serde_json::to_string_pretty(&results(of)).unwrap_or_default() + "\n";
    files.push(ReportFile { path: "results.json".to_owned(), text });
    files
}

/// The document.
fn document(of: &Evaluation, language: Language) -> Document {
    let (takes, channel) = (of.corpus.takes.len(), &of.corpus.channel);
    let persons = of.columns[0].summary.persons.len();
    let title = language.pick(
        format!("Suggested labels held against annotators: {channel}"),
        format!("Étiquettes suggérées face aux annotateurs : {channel}"),
    );
    let split = words::split(language, of.split);
    let subtitle = language.pick(
        format!("{takes} takes of {persons} people, {} labels; {split}.", of.corpus.labels.len()),
        format!(
            "{takes} prises de {persons} personnes, {} étiquettes ; {split}.",
            of.corpus.labels.len()
        ),
    );
    let mut writer = Writer { of, language, blocks: Vec::new() };
    writer.in_short();
    writer.confusions();
    writer.people_and_labels();
    writer.calibration();
    writer.timelines();
    writer.notes();
    Document { title, subtitle, blocks: writer.blocks }
}

/// Collects the blocks of a document.
struct Writer<'a> {
    of: &'a Evaluation,
    language: Language,
    blocks: Vec<Block>,
}

impl Writer<'_> {
    fn heading(&mut self, english: &str, french: &str) {
        let text = self.language.pick(english, french).to_owned();
        self.blocks.push(Block::Heading(2, text));
    }

    fn paragraph(&mut self, text: impl Into<String>) {
        self.blocks.push(Block::Paragraph(text.into()));
    }

    fn caution(&mut self, text: impl Into<String>) {
        self.blocks.push(Block::Caution(text.into()));
    }

    fn in_short(&mut self) {
        let (of, language) = (self.of, self.language);
        self.heading("In short", "En bref");
        for line in &of.corpus.description {
            self.caution(line.clone());
        }
        if let Some(last) = of.columns.last() {
            self.blocks.push(Block::Reading(reading(language, of, last)));
        }
        self.blocks.push(Block::Table(scores::scores(language, of)));
        if of.columns[0].summary.intervals.is_none() {
            self.paragraph(words::no_intervals(language, of.split));
        }
        for column in &of.columns {
            self.paragraph(words::sentence(language, column));
        }
        self.caution(words::split_caution(language, of.split));
        if !of.thesis.is_empty() {
            self.blocks.push(Block::Table(scores::figure_4_4(language, of)));
        }
    }

    fn confusions(&mut self) {
        self.heading("Which labels are taken for which", "Quelles étiquettes sont confondues");
        for column in &self.of.columns {
            self.blocks.push(Block::figure(confusion::confusion(self.language, self.of, column)));
        }
    }

    fn people_and_labels(&mut self) {
        self.heading("Labels and people", "Étiquettes et personnes");
        self.blocks.push(Block::Table(scores::by_label(self.language, self.of)));
        if self.of.columns[0].summary.persons.len() > 1 {
            self.blocks.push(Block::Table(scores::by_person(self.language, self.of)));
        }
    }

    fn calibration(&mut self) {
        let (of, language) = (self.of, self.language);
        if of.columns.iter().all(|column| !column.calibrated) {
            return;
        }
        self.heading("How far probabilities hold", "Ce que valent les probabilités");
        self.paragraph(language.pick(
            "The scores of a classifier are divided by a temperature, found on takes held out of those that are learnt \
             from, before they become probabilities.",
            "Les scores d’un classifieur sont divisés par une température, trouvée sur des prises mises à part de \
             l’apprentissage, avant de devenir des probabilités.",
        ));
        self.blocks.push(Block::Table(scores::calibration(language, of)));
        for column in of.columns.iter().filter(|column| column.calibrated) {
            self.blocks.push(Block::figure(reliability::reliability(language, column)));
        }
    }

    fn timelines(&mut self) {
        self.heading("Take by take", "Prise par prise");
        for take in 0..self.of.corpus.takes.len() {
            self.blocks.push(Block::figure(timeline::timeline(self.language, self.of, take)));
        }
    }

    fn notes(&mut self) {
        let (of, language) = (self.of, self.language);
        self.heading("Notes", "Notes");
        self.paragraph(words::scores_explained(language));
        self.paragraph(language.pick(
            "Intervals: percentiles of 2,000 resamples of whole takes, or of whole people where people are held out. No \
             frame of a take that is tested, and of nothing held out with it, was learnt from.",
            "Intervalles : percentiles de 2 000 rééchantillonnages de prises entières, ou de personnes entières quand des \
             personnes sont mises à part. Aucune image d’une prise testée, ni de ce qui est mis à part avec elle, n’a été \
             apprise.",
        ));
        if of.not_alone {
            self.paragraph(language.pick(
                "The thesis and the short paper learn each person alone; here that could not be done, and others were \
                 learnt from, too.",
                "La thèse et l’article court apprennent chaque personne seule ; ici cela n’était pas possible, et d’autres ont \
                 été apprises aussi.",
            ));
        }
        if let Some(rate) = of.svm_thinned_to_hz {
            let rate = language.number(rate);
            self.paragraph(language.pick(
                format!("Support vector machines learnt {rate} frames per second: all would be more than 20,000."),
                format!("Les SVM ont appris {rate} images par seconde : toutes seraient plus de 20 000."),
            ));
        }
        self.caution(language.pick(
            "These figures are of these takes. They are no claim about faces at large, nor that one method is best.",
            "Ces chiffres valent pour ces prises. Ils ne disent rien des visages en général, ni qu’une méthode est la meilleure.",
        ));
        for note in &of.corpus.notes {
            self.paragraph(note.clone());
        }
    }
}

/// The finding in a sentence or two.
fn reading(language: Language, of: &Evaluation, column: &Column) -> String {
    let Summary { scores, majority, .. } = &column.summary;
    let share = |value: Option<f64>| value.map_or("–".to_owned(), |v| language.percent(v));
    let right = share(scores.frames.accuracy);
    let ratio = scores::value(language, scores.segments.ratio);
    let f1 = scores::value(language, scores.segments.f1[2]);
    let (label, always) = match majority {
        Some((label, scores)) => (of.corpus.labels[*label].as_str(), share(scores.frames.accuracy)),
        None => ("–", "–".to_owned()),
    };
    let name = words::column(language, column.kind);
    language.pick(
        format!(
            "{name}: {right} of the frames are labelled rightly, where always answering {label} would be right in {always}. \
             There are {ratio} segments per true one, and F1@50 is {f1}: frames alone do not tell whether segments are \
             right."
        ),
        format!(
            "{name} : {right} des images sont justes, alors que répondre toujours {label} le serait pour {always}. Il y a \
             {ratio} segments par segment vrai, et F1@50 vaut {f1} : les images seules ne disent pas si les segments sont \
             justes."
        ),
    )
}

/// Everything that was computed.
fn results(of: &Evaluation) -> Value {
    let columns = of.columns.iter().map(|column| {
        json!({
            "as": words::column(Language::English, column.kind),
            "method": column.lesson.method,
            "decoding": column.lesson.decoding,
            "trainingFramesPerSecond": column.lesson.thinned_to_hz,
            "eachPersonAlone": column.own_person,
            "calibrated": column.calibrated,
            "summary": summary(of, &column.summary),
            "takes": column.judged.iter().map(|own| judged(of, own)).collect::<Vec<_>>(),
        })
    });
    let thesis = of.thesis.iter().map(|row| {
        json!({
            "method": row.method,
            "manual": row.of_true.scores.labelled,
            "automatic": row.of_found.scores.labelled,
        })
    });
    json!({
        "channel": of.corpus.channel,
        "labels": of.corpus.labels,
        "shapes": of.corpus.shapes,
        "heldOut": words::split(Language::English, of.split),
        "description": of.corpus.description,
        "candidates": columns.collect::<Vec<_>>(),
        "figure44": thesis.collect::<Vec<_>>(),
        "notes": of.corpus.notes,
    })
}

fn summary(of: &Evaluation, own: &Summary) -> Value {
    let error = own.reliability.each_ref().map(|own| own.expected_error());
    let brier = own.reliability.each_ref().map(|own| own.brier());
    json!({
        "confusion": own.counts.confusion.rows().collect::<Vec<_>>(),
        "framesWithoutAnswer": own.counts.frames_without_answer,
        "scores": own.scores,
        "intervals": own.intervals,
        "majority": own.majority.as_ref().map(|(label, scores)| {
            json!({"label": of.corpus.labels[*label], "scores": scores})
        }),
        "persons": own.persons.iter().map(|(person, counts)| {
            json!({"person": person, "scores": counts.scores()})
        }).collect::<Vec<_>>(),
        "labels": own.counts.confusion.label_scores(),
        "calibration": {
            "raw": {"error": error[0], "brier": brier[0]},
            "tempered": {"error": error[1], "brier": brier[1]},
        },
    })
}

fn judged(of: &Evaluation, own: &Judged) -> Value {
    let take = &of.corpus.takes[own.take];
    let segments = own.answer.segments.iter().map(|found| {
        json!({
            "label": of.corpus.labels[found.label],
            "first_frame": found.frames.start,
            "end_frame": found.frames.end,
            "probability": found.probability,
        })
    });
    json!({
        "take": take.name,
        "person": take.person,
        "kind": take.kind,
        "temperature": own.temperature,
        "scores": own.counts.scores(),
        "segments": segments.collect::<Vec<_>>(),
    })
}

/// What is printed: every score, the majority's beside it.
pub fn print(of: &Evaluation, folder: Option<&Path>, json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let page = folder.map(|folder| folder.join("report.html"));
    if json {
        let mut told = results(of);
        told["report"] = json!(page);
        writeln!(out, "{}", serde_json::to_string_pretty(&told)?)?;
        return Ok(());
    }
    let language = Language::English;
    writeln!(
        out,
        "{}: {} takes of {} people, {} labels, {}",
        of.corpus.file.display(),
        of.corpus.takes.len(),
        of.columns[0].summary.persons.len(),
        of.corpus.labels.len(),
        words::split(language, of.split)
    )?;
    of.corpus.description.iter().try_for_each(|line| writeln!(out, "{line}"))?;
    let majority = of.columns[0].summary.majority.as_ref();
    write!(out, "{:<24}", "")?;
    for column in &of.columns {
        write!(out, "{:<24}", words::column(language, column.kind).to_lowercase())?;
    }
    let always = majority.map(|(label, _)| format!("always {}", of.corpus.labels[*label]));
    writeln!(out, "{}", always.unwrap_or_default())?;
    for score in Score::ALL {
        let mut line = format!("{:<24}", words::score(language, score));
        for column in &of.columns {
            let value = scores::value(language, score.of(&column.summary.scores));
            let interval = scores::interval(language, &column.summary, score);
            let both = if interval.is_empty() { value } else { format!("{value} [{interval}]") };
            line += &format!("{both:<24}");
        }
        line += &scores::majority(language, of, score);
        writeln!(out, "{}", line.trim_end())?;
    }
    for column in of.columns.iter().filter(|column| column.calibrated) {
        let [raw, tempered] = column
            .summary
            .reliability
            .each_ref()
            .map(|own| scores::value(language, own.expected_error()));
        writeln!(
            out,
            "{}: calibration error {raw} without temperature, {tempered} with it",
            words::column(language, column.kind).to_lowercase()
        )?;
    }
    if of.columns[0].summary.intervals.is_none() {
        writeln!(out, "{}", words::no_intervals(language, of.split))?;
    }
    if let Some(page) = page {
        writeln!(out, "report: {}", page.display())?;
    }
    Ok(())
}
