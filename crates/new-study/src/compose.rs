//! A study put together: what is wished, the parts of its design, its stimuli and instruments in; the study file as JSON
//! and the comments of its parts out.

use mimique_study::{SCHEMA_ADDRESS, SEGMENTS_FOR_OTHER_CLIPS, TestName, json_schema};
use serde::Deserialize as _;
use serde_json::{Map, Value, json};

use crate::library::{Asked, Design, Instrument, LibraryError, Parts, base};
use crate::readme::readme;
use crate::written::written;

/// What is wished of a study, besides its design and its stimuli.
#[derive(Debug, Clone, Default)]
pub struct Wishes {
    /// Its identifier.
    pub id: String,
    /// What participants see above it; the design's title where none is given.
    pub title: Option<String>,
    /// Codes of the languages, the first being the default.
    pub languages: Vec<String>,
    /// The methods that are compared, as a study file has them; the design's where none is given.
    pub methods: Map<String, Value>,
}

/// What a study shows.
#[derive(Debug, Clone, Default)]
pub struct Stimuli {
    /// `avatars`, `captures` and `segments` of the study file.
    pub parts: Map<String, Value>,
    /// The levels of the factor `expression`, with what they are called in English and French.
    pub expressions: Vec<[String; 3]>,
}

/// A study file and what stands above its parts.
#[derive(Debug, Clone)]
pub struct Composed {
    /// The study.
    pub study: Value,
    /// What stands above its parts, by JSON pointers.
    pub comments: Map<String, Value>,
}

impl Composed {
    /// The file: JSON with comments, its keys in the order in which people read them.
    pub fn text(&self) -> String {
        written(&self.study, &self.comments)
    }

    /// The files of its folder, names and texts: the study file, its schema, a README, pictures of instruments. `by` is
    /// what wrote it, `notes` what should be looked at.
    pub fn files(
        &self,
        by: &str,
        design: &str,
        wishes: &Wishes,
        instruments: &[Instrument],
        notes: &[String],
    ) -> Vec<(String, String)> {
        let schema = json_schema();
        let mut files = vec![
            ("study.json".to_owned(), self.text()),
            ("README.md".to_owned(), readme(by, design, wishes, instruments, notes)),
            ("schema/study.schema.json".to_owned(), format!("{schema:#}")),
        ];
        for instrument in instruments {
            files.extend(instrument.pictures.iter().map(|(name, picture)| {
                (format!("pictures/{name}"), picture.as_str().unwrap_or_default().to_owned())
            }));
        }
        files
    }
}

/// The identifier that a name gives a study: lower-case letters and digits, anything else one `-`; none without a
/// letter or digit of the alphabet's first 26.
pub fn study_id(name: &str) -> Option<String> {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let id: String = name.chars().map(plain).collect();
    let id = id.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-");
    (!id.is_empty()).then_some(id)
}

/// Why a study cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum NotComposed {
    /// The design needs stimuli.
    #[error("it needs stimuli")]
    NoStimuli,
    /// The design asks which expression is shown, and all clips show the same one.
    #[error(
        "it asks which expression a clip shows, and all of its clips show one: {expression}; name clips of others, too"
    )]
    OneExpression {
        /// The one.
        expression: String,
    },
    /// An instrument is asked of one clip, and the design has no such trials.
    #[error(
        "it is asked of one clip, and the design shows clips side by side; take rate-one or identify-emotion"
    )]
    NoSingleClips {
        /// The instrument.
        instrument: String,
    },
    /// The library is not as it should be.
    #[error(transparent)]
    Library(#[from] LibraryError),
}

/// Puts a study together.
///
/// # Errors
/// [`NotComposed`]: design, stimuli and instruments do not fit.
pub fn compose(
    wishes: &Wishes,
    design: &Design,
    instruments: &[Instrument],
    stimuli: Option<&Stimuli>,
) -> Result<Composed, NotComposed> {
    let mut base = base()?;
    let mut comments = comments_of(base.remove("comments"));
    let mut study = match (design, stimuli) {
        (Design::Parts(parts), Some(stimuli)) => {
            comments.extend(parts.comments.clone());
            of_parts(base, parts, stimuli, wishes)?
        }
        (Design::Whole(study), _) => study.as_object().cloned().unwrap_or_default(),
        (Design::Parts(_), None) => return Err(NotComposed::NoStimuli),
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
) -> Result<Map<String, Value>, NotComposed> {
    let mut study = base;
    let look = study.remove("look").unwrap_or_default();
    study.insert("studyMetadata".to_owned(), json!({ "title": parts.title, "version": "1.0.0" }));
    let methods = methods(parts, wishes);
    study.insert("questions".to_owned(), json!(parts.questions));
    study.insert("components".to_owned(), json!(parts.components));
    study.insert("sequence".to_owned(), parts.sequence.clone());
    let segments = own.parts.get("segments").and_then(Value::as_array).map_or(0, Vec::len);
    study.insert("hypotheses".to_owned(), json!(hypotheses(parts, &methods, segments)));
    let mut stimuli = own.parts.clone();
    stimuli.insert("methods".to_owned(), Value::Object(methods));
    stimuli.insert("look".to_owned(), look);
    study.insert("stimuli".to_owned(), Value::Object(stimuli));
    options_of_truth(&mut study, own);
    if own.expressions.len() < 2 {
        let asks_which = parts.questions.iter().any(|question| question.get("truth").is_some());
        if asks_which {
            let expression = own.expressions.first().map_or("none", |[word, ..]| word).to_owned();
            return Err(NotComposed::OneExpression { expression });
        }
        // One segment follows itself.
        study["sequence"].as_object_mut().map(|sequence| sequence.remove("constraints"));
    }
    Ok(study)
}

/// The methods that are compared: those that are named, else the design's.
fn methods(parts: &Parts, wishes: &Wishes) -> Map<String, Value> {
    if wishes.methods.is_empty() { parts.methods.clone() } else { wishes.methods.clone() }
}

/// The hypotheses, each with the test that goes with so many methods; none about methods where there is one. With few
/// segments they are about these clips.
fn hypotheses(parts: &Parts, methods: &Map<String, Value>, segments: usize) -> Vec<Value> {
    // What the analysis calls a method: the name among its factors, else its name in the study file.
    let word = |(name, method): (&String, &Value)| {
        method.pointer("/factors/method").cloned().unwrap_or_else(|| json!(name))
    };
    let words: Vec<Value> = methods.iter().map(word).collect();
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
        let other_clips = TestName::deserialize(&hypothesis["test"]);
        if segments < SEGMENTS_FOR_OTHER_CLIPS
            && other_clips.is_ok_and(TestName::holds_for_other_clips)
        {
            hypothesis["generalise"] = json!("these clips");
        }
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
) -> Result<(), NotComposed> {
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
fn ask_of_clips(
    study: &mut Map<String, Value>,
    instrument: &Instrument,
) -> Result<(), NotComposed> {
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
        return Err(NotComposed::NoSingleClips { instrument: instrument.id.clone() });
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
