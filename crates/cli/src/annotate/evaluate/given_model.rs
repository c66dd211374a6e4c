//! A model that is given, held against takes of which it has learnt nothing.

use anyhow::{anyhow, bail};
use mimique_annotate::evaluate::{Cut, Judged, judged, summary};
use mimique_annotate::{AnnotatedTake, Lesson, Mark, Model};

use super::{Args, Column, ColumnKind, Evaluation, Split};
use crate::annotate::corpus::Corpus;
use crate::annotate::named;

/// What a model says of a corpus.
pub(super) fn evaluated(args: &Args, corpus: Corpus, model: &Model) -> anyhow::Result<Evaluation> {
    let file = corpus.file.display();
    if corpus.labels.iter().any(|label| !model.labels.contains(label)) {
        bail!(
            "{file}: labels {}, the model's are {}; name them with --words",
            corpus.labels.join(", "),
            model.labels.join(", ")
        );
    }
    refuse_learnt(args.split, &corpus, model)?;
    let corpus = relabelled(corpus, model)?;
    let decoding = match args.decode.is_default() {
        true => model.decoding.clone(),
        false => args.decode.of_all(None)?,
    };
    let cut = Cut::Found(decoding.clone());
    let judge = |(number, take): (usize, &AnnotatedTake)| judged(model, &cut, take, number);
    let judged = corpus.takes.iter().enumerate().map(judge).collect::<Result<Vec<Judged>, _>>();
    let judged =
        judged.map_err(|e| named(e, &corpus.labels).context(corpus.file.display().to_string()))?;
    let by_person = args.split == Split::Person;
    let labels = corpus.labels.len();
    let summary = summary(&corpus.takes, &judged, labels, by_person, args.method.seed)?;
    let lesson =
        Lesson { thinned_to_hz: model.thinned_to_hz, decoding, ..corpus.lesson(model.settings) };
    let column = Column {
        kind: ColumnKind::Model,
        lesson,
        own_person: false,
        calibrated: model.learnt_from.held_out > 0,
        judged,
        summary,
    };
    Ok(Evaluation {
        corpus,
        split: args.split,
        columns: vec![column],
        thesis: Vec::new(),
        not_alone: false,
        svm_thinned_to_hz: None,
    })
}

/// Refuses takes, persons or kinds that the model has learnt from.
fn refuse_learnt(split: Split, corpus: &Corpus, model: &Model) -> anyhow::Result<()> {
    let kept = model.columns(&corpus.shapes);
    let kept = kept.map_err(|e| anyhow!("{}: {e}", corpus.file.display()))?;
    for (own, line) in corpus.takes.iter().zip(&corpus.lines) {
        let same = AnnotatedTake { take: own.take.columns(&kept)?, ..own.clone() }.learnt();
        for learnt in &model.learnt_from.takes {
            let (what, value) = match split {
                _ if learnt.weights == same.weights => ("take", &own.name),
                Split::Person if learnt.person == own.person => ("person", &own.person),
                Split::Kind if learnt.kind == own.kind => ("kind", &own.kind),
                _ => continue,
            };
            bail!(
                "{}: line {line}: {what} {value}: the model has learnt from it ({}); leave the line out{}",
                corpus.file.display(),
                learnt.name,
                if what == "take" { "" } else { ", or use --split take" }
            );
        }
    }
    Ok(())
}

/// The takes with the model's columns and labels.
fn relabelled(corpus: Corpus, model: &Model) -> anyhow::Result<Corpus> {
    let place: Vec<usize> = corpus
        .labels
        .iter()
        .filter_map(|label| model.labels.iter().position(|own| own == label))
        .collect();
    let kept = model.columns(&corpus.shapes)?;
    let mut takes = corpus.takes;
    for own in &mut takes {
        own.take = own.take.columns(&kept)?;
        for marked in &mut own.marked {
            marked.mark = match marked.mark {
                Mark::Stable(label) => Mark::Stable(place[label]),
                Mark::Transition(from, to) => Mark::Transition(place[from], place[to]),
            };
        }
    }
    let (labels, shapes) = (model.labels.clone(), model.shapes.clone());
    Ok(Corpus { takes, labels, shapes, ..corpus })
}
