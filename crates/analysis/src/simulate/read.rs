//! The parameters file: read over a study's own parameters, and checked against the study.

use std::collections::BTreeMap;

use mimique_study::{KindOfQuestion as _, Question, Scale, Study};
use serde_json::Value;

use super::parameters::{Compared, Parameters, Rating, Recognition};
use super::scales::{all_scales, factor_levels};
use super::values::{
    by_factor, deviation, effects, finite, interactions, known_factor, known_level, shares,
};

/// A parameters file that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{pointer}: {problem}; {remedy}")]
pub struct ParametersError {
    /// JSON pointer of the key.
    pub pointer: String,
    /// What is wrong, with the value.
    pub problem: String,
    /// What to do.
    pub remedy: String,
}

/// Factor -> its levels.
pub(super) type Levels = BTreeMap<String, Vec<String>>;

/// Keys whose maps are replaced whole: their own keys are levels, options or places.
const WHOLE: [&str; 7] =
    ["effects", "confusion", "personBySd", "thresholds", "interactions", "worth", "categories"];

impl Parameters {
    /// Reads a parameters file (JSON, comments allowed): what it does not name stays as `base` has it.
    /// Refuses what does not fit the study, naming the key.
    pub fn read_over(base: &Self, text: &str, study: &Study) -> Result<Self, ParametersError> {
        let given = mimique_study::parse(text).map_err(|error| {
            problem_at("/", format!("{}: {}", error.place, error.what), error.remedy)
        })?;
        let mut value = serde_json::to_value(base).map_err(|error| {
            problem_at("/", error.to_string(), "report this mistake of Mimique's")
        })?;
        for part in [
            "ratings",
            "recognition",
            "comparisons",
            "panels",
            "discrimination",
            "scaling",
            "templates",
            "choices",
            "numbers",
        ] {
            refuse_unknown(&value, &given, part)?;
        }
        merge(&mut value, given, 0);
        let parameters: Self = serde_path_to_error::deserialize(value).map_err(|error| {
            let path = error.path().to_string().replace(['.', '['], "/").replace(']', "");
            let pointer = if path == "/" { path } else { format!("/{path}") };
            problem_at(&pointer, error.inner().to_string(), "look up the key's name and kind")
        })?;
        parameters.check(study)?;
        Ok(parameters)
    }

    /// Checks every number, factor and level against the study; the first mistake is the error.
    pub fn check(&self, study: &Study) -> Result<(), ParametersError> {
        let clips = study.clips();
        let levels = factor_levels(study, &clips);
        let scales: BTreeMap<String, _> = all_scales(study).into_iter().collect();
        for (response, rating) in &self.ratings {
            if let Some(scale) = scales.get(response) {
                check_rating(&format!("/ratings/{response}"), rating, scale, &levels)?;
            }
        }
        for (question, recognition) in &self.recognition {
            let place = format!("/recognition/{question}");
            check_recognition(&place, recognition, &levels)?;
            if let Some(asked) = study.all_questions().find(|each| each.id == *question) {
                check_confusion(&place, recognition, asked, &levels)?;
            }
        }
        for (question, compared) in &self.comparisons {
            check_compared(&format!("/comparisons/{question}"), compared, &levels)?;
        }
        for (block, given) in &self.panels {
            deviation(&format!("/panels/{block}/pageSd"), given.page_sd)?;
            if !(0.0..=1.0).contains(&given.misses_reference) {
                let problem = format!("{} is no share", given.misses_reference);
                let place = format!("/panels/{block}/missesReference");
                return Err(problem_at(&place, problem, "give 0 to 1"));
            }
        }
        for (block, given) in &self.discrimination {
            let at = |key: &str| format!("/discrimination/{block}/{key}");
            finite(&at("threshold"), given.threshold)?;
            deviation(&at("personSd"), given.person_sd)?;
            if !(given.spread > 0.0 && given.spread.is_finite()) {
                let problem = format!("{} is no spread", given.spread);
                return Err(problem_at(&at("spread"), problem, "give a number above 0"));
            }
            if !(0.0..=0.5).contains(&given.lapse) {
                let problem = format!("{} is no share of lapses", given.lapse);
                return Err(problem_at(&at("lapse"), problem, "give 0 to 0.5"));
            }
            if !(0.0..0.5).contains(&given.false_alarm) {
                let problem = format!("{} is no share of false alarms", given.false_alarm);
                return Err(problem_at(&at("falseAlarm"), problem, "give 0 to below 0.5"));
            }
        }
        for (name, given) in &self.scaling {
            if let Some((key, problem, remedy)) = given.fault() {
                return Err(problem_at(&format!("/scaling/{name}/{key}"), problem, remedy));
            }
        }
        for (name, block) in study.reverse_correlations() {
            let asked = study.questions.iter().find(|each| each.id == block.question);
            let (Some(given), Some(asked)) = (self.templates.get(name), asked) else { continue };
            let options = asked.kind.options();
            let options: Vec<&str> = options.iter().map(|option| option.value.as_str()).collect();
            if let Some((key, problem, remedy)) = given.fault(&block, &options) {
                return Err(problem_at(&format!("/templates/{name}/{key}"), problem, remedy));
            }
        }
        for (question, shares_given) in &self.choices {
            let Some(asked) = study.all_questions().find(|each| each.id == *question) else {
                continue;
            };
            let answers: Vec<&str> =
                asked.kind.options().iter().map(|option| option.value.as_str()).collect();
            shares(&format!("/choices/{question}"), shares_given, &answers)?;
        }
        for (question, number) in &self.numbers {
            finite(&format!("/numbers/{question}/mean"), number.mean)?;
            deviation(&format!("/numbers/{question}/sd"), number.sd)?;
        }
        self.check_times(&levels)?;
        self.check_conduct()
    }

    fn check_times(&self, levels: &Levels) -> Result<(), ParametersError> {
        effects("/times/effects", &self.times.effects, levels)?;
        for (key, value) in [("medianMs", self.times.median_ms), ("clipMs", self.times.clip_ms)] {
            if !(value.is_finite() && value > 0.0 && value < 3.6e6) {
                let problem = format!("{value} is no time between 0 and an hour");
                return Err(problem_at(&format!("/times/{key}"), problem, "give milliseconds"));
            }
        }
        for (key, value) in [("sigma", self.times.sigma), ("personSigma", self.times.person_sigma)]
        {
            deviation(&format!("/times/{key}"), value)?;
        }
        Ok(())
    }

    /// Displays, carelessness, attention and dropout.
    fn check_conduct(&self) -> Result<(), ParametersError> {
        let rate = self.display.refresh_hz;
        if !(10.0..=1000.0).contains(&rate) {
            let problem = format!("{rate} is no rate of a display");
            return Err(problem_at("/display/refreshHz", problem, "give 10 to 1000 Hz"));
        }
        if !(self.careless.time_share > 0.0 && self.careless.time_share <= 10.0) {
            let problem = format!("{} is no share of a time", self.careless.time_share);
            return Err(problem_at(
                "/careless/timeShare",
                problem,
                "give a number above 0, up to 10",
            ));
        }
        for (pointer, share) in [
            ("/attentionPass", self.attention_pass),
            ("/careless/share", self.careless.share),
            ("/careless/attentionPass", self.careless.attention_pass),
            ("/dropout/declined", self.dropout.declined),
            ("/dropout/perTrial", self.dropout.per_trial),
            ("/dropout/withdrawn", self.dropout.withdrawn),
            ("/display/lateShare", self.display.late_share),
            ("/display/slowPeople", self.display.slow_people),
            ("/display/slowLateShare", self.display.slow_late_share),
            ("/display/webgl2", self.display.webgl2),
            ("/display/replay", self.display.replay),
            ("/display/cutShort", self.display.cut_short),
            ("/display/focusLoss", self.display.focus_loss),
            ("/display/reload", self.display.reload),
        ] {
            if !(0.0..=1.0).contains(&share) {
                return Err(problem_at(pointer, format!("{share} is no share"), "give 0 to 1"));
            }
        }
        Ok(())
    }
}

fn check_rating(
    place: &str,
    rating: &Rating,
    scale: &Scale,
    levels: &Levels,
) -> Result<(), ParametersError> {
    let at = |key: &str| format!("{place}/{key}");
    finite(&at("mean"), rating.mean)?;
    finite(&at("perTrial"), rating.per_trial)?;
    for (key, sd) in [
        ("noiseSd", rating.noise_sd),
        ("personSd", rating.person_sd),
        ("segmentSd", rating.segment_sd),
        ("clipSd", rating.clip_sd),
    ] {
        deviation(&at(key), sd)?;
    }
    by_factor(&at("personBySd"), &rating.person_by_sd, levels)?;
    effects(&at("effects"), &rating.effects, levels)?;
    interactions(&at("interactions"), &rating.interactions, levels)?;
    check_thresholds(&at("thresholds"), &rating.thresholds, scale)
}

fn check_thresholds(pointer: &str, borders: &[f64], scale: &Scale) -> Result<(), ParametersError> {
    if borders.is_empty() {
        return Ok(());
    }
    let expected = scale.points.saturating_sub(1);
    if borders.len() != expected {
        let problem =
            format!("{} thresholds for a scale of {} points", borders.len(), scale.points);
        return Err(problem_at(pointer, problem, format!("give {expected}, or none")));
    }
    if !borders.iter().all(|b| b.is_finite()) || borders.windows(2).any(|w| w[0] > w[1]) {
        let problem = format!("{borders:?} does not ascend");
        return Err(problem_at(pointer, problem, "order them from low to high"));
    }
    Ok(())
}

fn check_recognition(
    place: &str,
    recognition: &Recognition,
    levels: &Levels,
) -> Result<(), ParametersError> {
    let at = |key: &str| format!("{place}/{key}");
    for (key, sd) in [
        ("personSd", recognition.person_sd),
        ("segmentSd", recognition.segment_sd),
        ("clipSd", recognition.clip_sd),
        ("confidence", recognition.confidence),
    ] {
        deviation(&at(key), sd)?;
    }
    by_factor(&at("personBySd"), &recognition.person_by_sd, levels)?;
    effects(&at("effects"), &recognition.effects, levels)?;
    interactions(&at("interactions"), &recognition.interactions, levels)?;
    if !recognition.by.is_empty() {
        known_factor(&at("by"), &recognition.by, levels)?;
    }
    Ok(())
}

fn check_compared(
    place: &str,
    compared: &Compared,
    levels: &Levels,
) -> Result<(), ParametersError> {
    let at = |key: &str| format!("{place}/{key}");
    let known = known_factor(&at("factor"), &compared.factor, levels)?;
    for (level, worth) in &compared.worth {
        let pointer = format!("{}/{level}", at("worth"));
        known_level(&pointer, level, known)?;
        finite(&pointer, *worth)?;
    }
    deviation(&at("personSd"), compared.person_sd)?;
    deviation(&at("segmentSd"), compared.segment_sd)?;
    finite(&at("side"), compared.side)?;
    finite(&at("tie"), compared.tie)?;
    if !(0.0..=1.0).contains(&compared.lapse) {
        let problem = format!("{} is no share", compared.lapse);
        return Err(problem_at(&at("lapse"), problem, "give 0 to 1"));
    }
    Ok(())
}

fn check_confusion(
    place: &str,
    recognition: &Recognition,
    asked: &Question,
    levels: &Levels,
) -> Result<(), ParametersError> {
    let at = |key: &str| format!("{place}/{key}");
    let answers: Vec<&str> =
        asked.kind.options().iter().map(|option| option.value.as_str()).collect();
    let truth = asked.kind.truth().unwrap_or_default();
    let none = Vec::new();
    let shown = levels.get(truth).unwrap_or(&none);
    for (right, rows) in &recognition.confusion {
        let pointer = format!("{}/{right}", at("confusion"));
        if !shown.contains(right) {
            let known = shown.join(", ");
            return Err(problem_at(
                &pointer,
                format!("no clip has the {truth} \"{right}\""),
                format!("the clips have {known}"),
            ));
        }
        for (level, row) in rows {
            shares(&format!("{pointer}/{level}"), row, &answers)?;
        }
    }
    let missing = shown.iter().find(|each| {
        answers.contains(&each.as_str()) && !recognition.confusion.contains_key(*each)
    });
    if let Some(missing) = missing {
        return Err(problem_at(
            &at("confusion"),
            format!("there is no row of \"{missing}\""),
            "give a row for every right answer",
        ));
    }
    Ok(())
}

pub(super) fn problem_at(
    pointer: &str,
    problem: impl Into<String>,
    remedy: impl Into<String>,
) -> ParametersError {
    ParametersError { pointer: pointer.to_owned(), problem: problem.into(), remedy: remedy.into() }
}

fn refuse_unknown(base: &Value, given: &Value, part: &str) -> Result<(), ParametersError> {
    let (Some(Value::Object(known)), Some(Value::Object(named))) =
        (base.get(part), given.get(part))
    else {
        return Ok(());
    };
    match named.keys().find(|key| !known.contains_key(*key)) {
        None => Ok(()),
        Some(key) => {
            let names: Vec<&str> = known.keys().map(String::as_str).collect();
            let remedy = if names.is_empty() {
                "leave this part out".to_owned()
            } else {
                format!("the study has {}", names.join(", "))
            };
            Err(problem_at(
                &format!("/{part}/{key}"),
                "the study has no such question here",
                remedy,
            ))
        }
    }
}

fn merge(base: &mut Value, given: Value, depth: usize) {
    match (base, given) {
        (Value::Object(base), Value::Object(given)) => {
            for (key, value) in given {
                // `choices` is a map of maps of shares.
                let whole = WHOLE.contains(&key.as_str());
                match base.get_mut(&key) {
                    Some(known) if !whole && key == "choices" && depth == 0 => {
                        if let (Value::Object(known), Value::Object(shares)) = (known, value) {
                            known.extend(shares);
                        }
                    }
                    Some(known) if !whole => merge(known, value, depth + 1),
                    _ => {
                        base.insert(key, value);
                    }
                }
            }
        }
        (base, given) => *base = given,
    }
}
