//! A study put together: what is wished, the parts of its design, its stimuli and instruments in; the study file as JSON
//! and the comments of its parts out.

use anyhow::bail;
use mimique_study::SCHEMA_ADDRESS;
use serde_json::{Map, Value, json};

use super::Wishes;
use super::library::{Asked, Design, Instrument, Parts, base};
use super::stimuli::Stimuli;

/// A study file and what stands above its parts.
pub(super) struct Composed {
    pub study: Value,
    pub comments: Map<String, Value>,
}

/// Puts a study together.
pub(super) fn compose(
    wishes: &Wishes,
    design: &Design,
    instruments: &[Instrument],
    stimuli: Option<&Stimuli>,
) -> anyhow::Result<Composed> {
    let mut base = base()?;
    let mut comments = comments_of(base.remove("comments"));
    let mut study = match (design, stimuli) {
        (Design::Parts(parts), Some(stimuli)) => {
            comments.extend(parts.comments.clone());
            of_parts(base, parts, stimuli, wishes)?
        }
        (Design::Whole(study), _) => study.as_object().cloned().unwrap_or_default(),
        (Design::Parts(_), None) => bail!("--design: {}: it needs stimuli", wishes.design),
    };
    study.insert("$schema".to_owned(), json!(SCHEMA_ADDRESS));
    study.insert("id".to_owned(), json!(wishes.id));
    if let Some(title) = &wishes.title {
        study["studyMetadata"]["title"] = in_all(title, &wishes.languages);
    }
    add_instruments(&mut study, instruments)?;
    study.insert("languages".to_owned(), json!(wishes.languages));
    let mut study = Value::Object(study);
    only_languages(&mut study, &wishes.languages);
    comments.retain(|pointer, _| pointer.is_empty() || study.pointer(pointer).is_some());
    Ok(Composed { study, comments })
}

fn comments_of(value: Option<Value>) -> Map<String, Value> {
    value.and_then(|value| value.as_object().cloned()).unwrap_or_default()
}

/// The study of a design's parts.
fn of_parts(
    base: Map<String, Value>,
    parts: &Parts,
    own: &Stimuli,
    wishes: &Wishes,
) -> anyhow::Result<Map<String, Value>> {
    let mut study = base;
    let look = study.remove("look").unwrap_or_default();
    study.insert("studyMetadata".to_owned(), json!({ "title": parts.title, "version": "1.0.0" }));
    let methods = methods(parts, wishes);
    study.insert("questions".to_owned(), json!(parts.questions));
    study.insert("components".to_owned(), json!(parts.components));
    study.insert("sequence".to_owned(), parts.sequence.clone());
    study.insert("hypotheses".to_owned(), json!(hypotheses(parts, &methods)));
    let mut stimuli = own.parts.clone();
    stimuli.insert("methods".to_owned(), Value::Object(methods));
    stimuli.insert("look".to_owned(), look);
    study.insert("stimuli".to_owned(), Value::Object(stimuli));
    options_of_truth(&mut study, own);
    if own.expressions.len() < 2 {
        let asks_which = parts.questions.iter().any(|question| question.get("truth").is_some());
        if asks_which {
            bail!(
                "--design: {}: it asks which expression a clip shows, and all of its clips show one: {}; name clips of \
                 others, too",
                wishes.design,
                own.expressions.first().map_or("none", |[word, ..]| word)
            );
        }
        // One segment follows itself.
        study["sequence"].as_object_mut().map(|sequence| sequence.remove("constraints"));
    }
    Ok(study)
}

/// The methods that are compared: those that are named, else the design's.
fn methods(parts: &Parts, wishes: &Wishes) -> Map<String, Value> {
    if wishes.methods.is_empty() {
        return parts.methods.clone();
    }
    wishes.methods.iter().map(|name| (name.clone(), json!({ "method": name }))).collect()
}

/// The hypotheses, each with the test that goes with so many methods; none about methods where there is one.
fn hypotheses(parts: &Parts, methods: &Map<String, Value>) -> Vec<Value> {
    let words: Vec<&Value> = methods.values().map(|method| &method["method"]).collect();
    let of_methods = parts.hypotheses.iter().filter(|_| words.len() > 1).cloned();
    let fitting = of_methods.map(|mut hypothesis| {
        let test = match (hypothesis["test"].as_str(), words.len()) {
            (Some("wilcoxon" | "friedman"), 2) => "wilcoxon",
            (Some("wilcoxon" | "friedman"), _) => "friedman",
            (Some("sign" | "bradley-terry"), 2) => "sign",
            (Some("sign" | "bradley-terry"), _) => "bradley-terry",
            (other, _) => other.unwrap_or_default(),
        }
        .to_owned();
        if test == "wilcoxon" {
            hypothesis["levels"] = json!(words);
        }
        hypothesis["test"] = json!(test);
        hypothesis
    });
    fitting.collect()
}

/// A choice with a right answer has an option for each expression that is shown.
fn options_of_truth(study: &mut Map<String, Value>, own: &Stimuli) {
    let questions = study.get_mut("questions").and_then(Value::as_array_mut);
    for question in questions.into_iter().flatten() {
        if question["truth"] == json!("expression") {
            let options: Vec<Value> = (own.expressions.iter())
                .map(|[word, en, fr]| json!({ "value": word, "label": { "en": en, "fr": fr } }))
                .collect();
            question["options"] = json!(options);
        }
    }
}

/// The questions of instruments: in the trials, or on pages after them.
fn add_instruments(
    study: &mut Map<String, Value>,
    instruments: &[Instrument],
) -> anyhow::Result<()> {
    let mut pages = Vec::new();
    for instrument in instruments {
        match instrument.asked {
            Asked::Clip => ask_of_clips(study, instrument)?,
            Asked::After => {
                let mut page =
                    json!({ "type": "questionnaire", "questions": instrument.questions });
                if let Some(title) = &instrument.title {
                    page["title"] = title.clone();
                }
                study["components"][&instrument.id] = page;
                pages.push(json!(instrument.id));
            }
        }
        if !instrument.scales.is_empty() {
            let scales = study.entry("scales").or_insert_with(|| json!({}));
            for (name, scale) in &instrument.scales {
                scales[name] = scale.clone();
            }
        }
    }
    if !pages.is_empty() {
        let mut main = study["sequence"].take();
        if main.get("id").is_none() {
            main["id"] = json!("main");
        }
        pages.insert(0, main);
        study.insert("sequence".to_owned(), json!({ "order": "fixed", "components": pages }));
    }
    Ok(())
}

/// An instrument's questions, asked in every trial of single clips.
fn ask_of_clips(study: &mut Map<String, Value>, instrument: &Instrument) -> anyhow::Result<()> {
    let mut asks = false;
    let components = study.get_mut("components").and_then(Value::as_object_mut);
    for component in components.into_iter().flat_map(|all| all.values_mut()) {
        if component["type"] == json!("trials")
            && let Some(asked) = component["questions"].as_array_mut()
        {
            asked.extend(instrument.questions.iter().map(|question| question["id"].clone()));
            asks = true;
        }
    }
    if !asks {
        bail!(
            "--instrument: {}: it is asked of one clip, and the design shows clips side by side; take rate-one or \
             identify-emotion",
            instrument.id
        );
    }
    if let Some(questions) = study.get_mut("questions").and_then(Value::as_array_mut) {
        questions.extend(instrument.questions.iter().cloned());
    }
    Ok(())
}

/// One text in all languages.
fn in_all(text: &str, languages: &[String]) -> Value {
    languages.iter().map(|language| (language.clone(), json!(text))).collect::<Map<_, _>>().into()
}

/// Leaves of each text the languages of the study; a text of a language that the library does not have is in English,
/// to be translated.
fn only_languages(value: &mut Value, languages: &[String]) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|item| only_languages(item, languages)),
        Value::Object(map) if is_text(map) => {
            let english = map.get("en").or_else(|| map.values().next()).cloned();
            let text = |language: &String| {
                map.get(language).or(english.as_ref()).cloned().unwrap_or_default()
            };
            *map = languages.iter().map(|language| (language.clone(), text(language))).collect();
        }
        Value::Object(map) => map.values_mut().for_each(|part| only_languages(part, languages)),
        _ => {}
    }
}

/// Whether an object is a text in languages of the library.
fn is_text(map: &Map<String, Value>) -> bool {
    let all =
        |(key, value): (&String, &Value)| ["en", "fr"].contains(&key.as_str()) && value.is_string();
    !map.is_empty() && map.iter().all(all)
}
