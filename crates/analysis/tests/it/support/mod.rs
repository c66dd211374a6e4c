//! A study's export with simulated raters, written as `mimique export --format csv` writes it.

pub mod confident;
pub mod equivalence;
pub mod followed;
pub mod planted;
pub mod preregistered;
pub mod rerun;
pub mod results;
pub mod simulated;

use mimique_study::columns::{ASSIGNED_CONDITION, FIXED_COLUMNS};
use mimique_study::{Question, QuestionKind, Study};
use mimique_test_support::Random;
use serde_json::{Value, json};

/// What the raters are like.
pub struct Raters {
    pub people: usize,
    /// Added to ratings of the first method.
    pub effect: f64,
    pub seed: u64,
}

/// One row a participant, trial and response; the last person stops half-way.
pub fn export(study: &Study, raters: &Raters) -> String {
    let factors = study.factor_names();
    let asked: Vec<&str> = study
        .demographics
        .iter()
        .flat_map(|page| &page.questions)
        .map(|question| question.id.as_str())
        .collect();
    let mut names: Vec<&str> = Vec::new();
    for (name, ..) in FIXED_COLUMNS {
        names.push(name);
        if name == "condition" && !study.conditions().is_empty() {
            names.push(ASSIGNED_CONDITION);
        }
        if name == "stimulus" {
            names.extend(factors.iter().map(String::as_str));
        }
    }
    names.extend(&asked);
    let mut text = names.join(",") + "\n";
    let mut random = Random::new(raters.seed);
    let clips = study.clips();
    let emotions = ["anger", "disgust", "fear", "joy", "sadness", "surprise"];
    for person in 0..raters.people {
        let (level, liking) = (0.6 * random.normal(), 0.3 * random.normal());
        let status = if person + 1 == raters.people { "active" } else { "completed" };
        let trials = if status == "active" { clips.len() / 2 } else { clips.len() };
        let about: Vec<(&str, String)> = study
            .demographics
            .iter()
            .flat_map(|page| &page.questions)
            .map(|question| (question.id.as_str(), trait_answer(question, &mut random)))
            .collect();
        for (order, clip) in clips.iter().take(trials).enumerate() {
            let lsts = clip.method == "lsts30";
            let expression = clip.factors["expression"].to_string();
            let place = emotions.iter().position(|e| *e == expression).unwrap_or(0);
            let right = 0.45 + 0.08 * place as f64 + if lsts { 0.08 * raters.effect } else { 0.0 };
            let answer = if random.uniform() < right {
                expression.clone()
            } else {
                emotions[(place + 1 + (random.uniform() * 4.99) as usize) % 6].to_owned()
            };
            let mut rating = |shift: f64| {
                let method = if lsts { raters.effect + liking } else { 0.0 };
                let value = 4.0 + shift + level + method + random.normal();
                value.round().clamp(1.0, 7.0).to_string()
            };
            let mut answers: Vec<(&str, String)> = Vec::new();
            for question in &study.questions {
                match &question.kind {
                    QuestionKind::SingleChoice(_) => answers.push((&question.id, answer.clone())),
                    QuestionKind::Likert(_) if question.id == "perceived_intensity" => {
                        let strength = clip.factors.get("intensity").map(ToString::to_string);
                        let strength = strength.and_then(|text| text.parse().ok()).unwrap_or(2.0);
                        let shift = 0.3 * (place as f64 - 2.5) + 0.8 * (strength - 2.0);
                        answers.push((&question.id, rating(shift)));
                    }
                    _ => answers.push((&question.id, rating(0.0))),
                }
            }
            let frames = 90 + (random.uniform() * 30.0) as u32;
            let late =
                if random.uniform() < 0.06 { frames / 3 } else { (random.uniform() * 3.0) as u32 };
            for (question, answer) in answers {
                let rt = 1500.0 + 2500.0 * (0.6 * random.normal()).exp();
                let cells: Vec<String> = names
                    .iter()
                    .map(|name| match *name {
                        "participant_id" => format!("p{:04}", person + 1),
                        "participant" => (person + 1).to_string(),
                        "trial_id" => format!("faces/{}", clip.id),
                        "trial_index" | "trial_order" => (order + 1).to_string(),
                        "trial_type" => "trial".to_owned(),
                        "condition" => "faces".to_owned(),
                        "stage" => "live".to_owned(),
                        ASSIGNED_CONDITION => condition_of(study, person).to_owned(),
                        "status" => status.to_owned(),
                        "stimulus" => clip.id.clone(),
                        "response_id" => question.to_owned(),
                        "answer" | "response" => answer.clone(),
                        "truth" if question == "emotion" => expression.clone(),
                        "correct" if question == "emotion" => (answer == expression).to_string(),
                        "rt" => format!("{rt:.3}"),
                        "frames" => frames.to_string(),
                        "frames_late" => late.to_string(),
                        "frame_longest_ms" => format!("{:.1}", 17.0 + 3.0 * f64::from(late)),
                        "refresh_hz" => "60".to_owned(),
                        other => match about.iter().find(|(id, _)| *id == other) {
                            Some((_, answer)) => answer.clone(),
                            None => {
                                let level = clip.factors.get(other).map(ToString::to_string);
                                level.unwrap_or_default()
                            }
                        },
                    })
                    .collect();
                text.push_str(&cells.join(","));
                text.push('\n');
            }
        }
    }
    text
}

/// The condition of a person, numbered from 0: they go round.
pub fn condition_of(study: &Study, person: usize) -> &str {
    let conditions = study.conditions();
    conditions[person % conditions.len()]
}

fn trait_answer(question: &Question, random: &mut Random) -> String {
    match &question.kind {
        QuestionKind::Likert(likert) => {
            let points = (likert.end() - likert.start + 1) as f64;
            (likert.start + (random.uniform() * points) as i64).to_string()
        }
        QuestionKind::SingleChoice(choice) => {
            let place = (random.uniform() * choice.options.len() as f64) as usize;
            choice.options[place].value.clone()
        }
        _ => (19 + (random.uniform() * 40.0) as u32).to_string(),
    }
}

/// A study of one method with three values of its parameter, 18 clips each, that lays out its tables.
pub fn parameter_study() -> Study {
    Study::from_text(include_str!("../../fixtures/parameter-study.json")).unwrap()
}

/// The demonstration in three conditions, which its hypotheses and tables compare.
pub fn study_in_conditions() -> Study {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/demo.json");
    let mut file = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    let condition = |id: &str, order: &str| json!({ "id": id, "conditional": true, "order": order, "components": ["faces"] });
    let conditions =
        [condition("rested", "fixed"), condition("at-once", "random"), condition("10", "random")];
    file["sequence"] = json!({ "order": "fixed", "components": conditions });
    let hypothesis = |id: &str, test: &str, response: &str, more: Value| {
        let mut hypothesis = json!({ "id": id, "statement": { "en": "No effect.", "fr": "Sans effet." },
            "test": test, "response": response, "factors": ["assigned_condition"] });
        hypothesis.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        hypothesis
    };
    file["hypotheses"] = json!([
        hypothesis("C1", "kruskal-wallis", "believability", json!({})),
        hypothesis(
            "C2",
            "mann-whitney",
            "believability",
            json!({ "levels": ["rested", "at-once"] })
        ),
        hypothesis("C3", "chi-square", "emotion", json!({ "measure": "correct" })),
        hypothesis(
            "C4",
            "mann-whitney",
            "emotion",
            json!({ "measure": "rt", "levels": ["at-once", "10"] })
        ),
        hypothesis(
            "C5",
            "scheirer-ray-hare",
            "believability",
            json!({ "factors": ["assigned_condition", "method"] })
        ),
    ]);
    let table = |layout: &str, more: Value| {
        let mut table = json!({ "id": layout, "layout": layout, "responses": ["believability", "emotion"],
            "caption": { "en": "Conditions", "fr": "Conditions" } });
        table.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        table
    };
    file["tables"] = json!([
        table("means", json!({ "factors": ["assigned_condition", "method"] })),
        table("influences", json!({ "factors": ["assigned_condition"] })),
        table("interactions", json!({ "crossings": [["assigned_condition", "method"]] })),
        table("confusion", json!({ "responses": ["emotion"], "factors": ["assigned_condition"] })),
    ]);
    let report = mimique_study::check(&file.to_string(), &|_| Ok(()));
    assert!(report.study.is_some(), "{:?}", report.issues);
    Study::from_value(&file).unwrap()
}

/// The built-in demonstration study, with a rule on late frames such as a real study has.
pub fn demo_study() -> Study {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../study-config/demo.json");
    let mut study = Study::from_text(&std::fs::read_to_string(path).unwrap()).unwrap();
    let exclusions = study.exclusions.as_mut().expect("the demonstration has exclusions");
    exclusions.late_frame_share = Some(0.2);
    study
}
