//! The library of `mimique new`: designs of studies and instruments, each a JSON file of `study-config`. To add one is
//! a file and its line in a table here.
//!
//! A design has what makes it one (`questions`, `components`, `sequence`, `methods`, `hypotheses`); the rest of the
//! study is `designs/base.json`. An instrument has its questions as a study file has them, where they are asked, its
//! citation, licence and scoring. What may not be reproduced is named in `instruments/elsewhere.json`.

use std::path::Path;

use anyhow::{Context as _, anyhow, bail};
use serde::Deserialize;
use serde_json::{Map, Value};

/// What every study has besides its design.
const BASE: &str = include_str!("../../../../study-config/designs/base.json");

/// The designs by their names.
const DESIGNS: [(&str, &str); 4] = [
    ("rate-one", include_str!("../../../../study-config/designs/rate-one.json")),
    ("compare-two", include_str!("../../../../study-config/designs/compare-two.json")),
    ("all-pairs", include_str!("../../../../study-config/designs/all-pairs.json")),
    ("identify-emotion", include_str!("../../../../study-config/designs/identify-emotion.json")),
];

/// Studies of the thesis (Reverdy 2019, chapter 6), whole as they stand: name, file, what they are.
const THESIS: [(&str, &str, &str); 3] = [
    (
        "study1",
        include_str!("../../../../study-config/study1.json"),
        "the thesis's study 1: 18 performances by alpha 0.3, 0.5 and 0.7",
    ),
    (
        "study2a",
        include_str!("../../../../study-config/study2a.json"),
        "the thesis's study 2a: LSTS against a baseline, then the performances themselves",
    ),
    (
        "study2b",
        include_str!("../../../../study-config/study2b.json"),
        "the thesis's study 2b: each clip in step beside its performance",
    ),
];

/// The instruments by their names.
const INSTRUMENTS: [(&str, &str); 4] = [
    ("sus", include_str!("../../../../study-config/instruments/sus.json")),
    ("nasa-tlx", include_str!("../../../../study-config/instruments/nasa-tlx.json")),
    ("affect-grid", include_str!("../../../../study-config/instruments/affect-grid.json")),
    ("closeness", include_str!("../../../../study-config/instruments/closeness.json")),
];

/// Instruments whose text is not here.
const ELSEWHERE: &str = include_str!("../../../../study-config/instruments/elsewhere.json");

/// What a study is made from.
#[derive(Debug)]
pub(super) enum Design {
    /// Parts that are put together with base, stimuli and instruments.
    Parts(Box<Parts>),
    /// A study as it stands.
    Whole(Value),
}

/// The parts of a design.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Parts {
    pub about: String,
    pub title: Value,
    pub methods: Map<String, Value>,
    pub questions: Vec<Value>,
    pub components: Map<String, Value>,
    pub sequence: Value,
    pub hypotheses: Vec<Value>,
    #[serde(default)]
    pub comments: Map<String, Value>,
}

/// When an instrument is asked.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Asked {
    /// Of each clip.
    Clip,
    /// On a page of its own, after the clips.
    After,
}

/// An instrument.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Instrument {
    /// Its name in the study: of the page, and of its file.
    #[serde(skip)]
    pub id: String,
    pub name: String,
    pub asked: Asked,
    pub citation: String,
    pub licence: String,
    /// Where the words of other languages than the original's are from, by language.
    #[serde(default)]
    pub translations: Map<String, Value>,
    pub scoring: String,
    #[serde(default)]
    pub title: Option<Value>,
    pub questions: Vec<Value>,
    #[serde(default)]
    pub scales: Map<String, Value>,
    /// Pictures that its questions show, by the names of their files.
    #[serde(default)]
    pub pictures: Map<String, Value>,
}

/// An instrument that is not in the library.
#[derive(Debug, Deserialize)]
pub(super) struct Elsewhere {
    pub id: String,
    pub name: String,
    pub citation: String,
    #[serde(rename = "where")]
    pub place: String,
    pub why: String,
}

/// What every study has.
pub(super) fn base() -> anyhow::Result<Map<String, Value>> {
    serde_json::from_str(BASE).context("study-config/designs/base.json")
}

/// Names of the designs, and what they are.
pub(super) fn designs() -> anyhow::Result<Vec<(&'static str, String)>> {
    let mut all = Vec::new();
    for (name, text) in DESIGNS {
        all.push((name, parts(name, text)?.about));
    }
    all.extend(THESIS.map(|(name, _, about)| (name, about.to_owned())));
    Ok(all)
}

/// The design of that name.
pub(super) fn design(name: &str) -> anyhow::Result<Design> {
    if let Some((_, text)) = DESIGNS.iter().find(|(own, _)| *own == name) {
        return Ok(Design::Parts(Box::new(parts(name, text)?)));
    }
    if let Some((_, text, _)) = THESIS.iter().find(|(own, ..)| *own == name) {
        return Ok(Design::Whole(mimique_study::parse(text)?));
    }
    let known: Vec<&str> =
        DESIGNS.iter().map(|(own, _)| *own).chain(THESIS.map(|(own, ..)| own)).collect();
    bail!("--design: there is no design {name:?}; take one of {}", known.join(", "))
}

fn parts(name: &str, text: &str) -> anyhow::Result<Parts> {
    serde_json::from_str(text).with_context(|| format!("study-config/designs/{name}.json"))
}

/// The instruments of the library.
pub(super) fn instruments() -> anyhow::Result<Vec<Instrument>> {
    INSTRUMENTS.iter().map(|(name, text)| read(name, text)).collect()
}

/// What the library does not have.
pub(super) fn elsewhere() -> anyhow::Result<Vec<Elsewhere>> {
    serde_json::from_str(ELSEWHERE).context("study-config/instruments/elsewhere.json")
}

/// The instrument of that name, or of that file.
pub(super) fn instrument(name: &str) -> anyhow::Result<Instrument> {
    if let Some((_, text)) = INSTRUMENTS.iter().find(|(own, _)| *own == name) {
        return read(name, text);
    }
    let path = Path::new(name);
    if path.extension().is_some_and(|end| end == "json") {
        let text = std::fs::read_to_string(path)
            .map_err(|e| anyhow!("--instrument: {name}: open: {e}; check the path"))?;
        let id = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        return read(&id, &text).with_context(|| {
            format!(
                "--instrument: {name}; write it as study-config/instruments/sus.json is written"
            )
        });
    }
    if let Some(other) = elsewhere()?.into_iter().find(|other| other.id == name) {
        bail!(
            "--instrument: {name}: the text of the {} is not in the library: {}; get it from {}, write it into a file as \
             study-config/instruments/sus.json is written, and give that file: --instrument {name}.json",
            other.name,
            other.why,
            other.place
        );
    }
    let known: Vec<&str> = INSTRUMENTS.iter().map(|(own, _)| *own).collect();
    bail!(
        "--instrument: there is no instrument {name:?}; take one of {}, or a file of your own (my.json)",
        known.join(", ")
    )
}

fn read(id: &str, text: &str) -> anyhow::Result<Instrument> {
    let instrument: Instrument =
        serde_json::from_str(text).with_context(|| format!("instrument {id}"))?;
    Ok(Instrument { id: id.to_owned(), ..instrument })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_in_the_library_can_be_read_and_is_named_once() {
        assert_eq!(designs().unwrap().len(), DESIGNS.len() + THESIS.len());
        for instrument in instruments().unwrap() {
            let Instrument { id, citation, licence, scoring, questions, .. } = instrument;
            let texts = [citation, licence, scoring];
            assert!(!questions.is_empty() && texts.iter().all(|text| text.len() > 20), "{id}");
            for question in questions {
                let prompt = &question["prompt"];
                assert!(prompt["en"].is_string() && prompt["fr"].is_string(), "{id}: {prompt}");
            }
        }
        for other in elsewhere().unwrap() {
            let error = instrument(&other.id).unwrap_err().to_string();
            assert!(error.contains(&other.place) && error.contains(&other.why), "{error}");
        }
    }
}
