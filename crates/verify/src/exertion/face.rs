//! `svr/`, `rules/`, `weights/`, `chain/`: the curves, and the face that follows from them.

use mimique_exertion::{
    Accumulated, Breathing, BreathingInput, Clip, Control, Controls, Curves, Expression,
    ExpressionModel, Face, Features, Heart, HeartModel, Part as PlanPart, Person, PersonSpec, Plan,
    Series, ShapeTable, Start, SupportVectors, Window,
};
use serde_json::{Map, Value, json};

use super::{Answers, Asked, Stop, rows};
use crate::VerifyError;
use crate::case::{Tolerance, numbers};
use crate::document::Part;

/// A document of `svr/`.
pub(super) fn support_vectors(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let x = rows(&asked.input.get("x")?)?;
    let model = asked.input.get("model")?;
    // Without vectors nothing but the rows says how many features there are.
    let alone = model.get("vectors")?.list()?.is_empty() && model.find("offset").is_none();
    let features = x.first().filter(|_| alone).map(Vec::len);
    let model = SupportVectors::of_json("", model.value(), features)?;
    let y = x.iter().map(|row| model.predict(row)).collect::<Result<Vec<f64>, _>>()?;
    answers.numbers("y", &y);
    Ok(())
}

/// A document of `rules/`.
pub(super) fn rules(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let level = asked.number("level")?;
    let mut got = Vec::new();
    for entry in asked.input.get("features")?.list()? {
        let [w, p, rcn, epoc] = entry.numbers()?[..] else {
            return Err(entry.wrong("w, p, rcn and EPOC").into());
        };
        let curves = mimique_exertion::rules(&Features { w, p, rcn, epoc }, level);
        got.push(numbers(&curves.to_array()));
    }
    answers.member("curves", &Value::Array(got));
    Ok(())
}

/// Four curves a frame.
fn curves(part: &Part<'_>) -> Result<Vec<Curves>, VerifyError> {
    let of = |entry: &Part<'_>| match entry.numbers()?[..] {
        [open, stretch, eyes, brows] => Ok(Curves::of_array([open, stretch, eyes, brows])),
        _ => Err(entry.wrong("four curves")),
    };
    part.list()?.iter().map(of).collect()
}

/// A document of `weights/`.
pub(super) fn weights(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let input = &asked.input;
    let expressivity = input.find("expressivity").map_or(json!({}), |part| part.value().clone());
    let person = PersonSpec::of_json(&json!({"expressivity": expressivity}))?;
    let person = Person::new(person)?;
    let table = match input.find("shapes").map(|part| part.value()) {
        None | Some(Value::Null) => ShapeTable::default(),
        Some(table) => ShapeTable::of_json(table)?,
    };
    let curves = curves(&input.get("curves")?)?;
    let breath = match input.find("breathing") {
        Some(part) if !part.value().is_null() => Some(breath(&part)?),
        _ => None,
    };
    let breath = breath.as_ref().map(|(breathing, rcn)| (breathing, &rcn[..]));
    let controls = Controls::of(&curves, &person.spec().expressivity, breath);
    answers.member("clipped", &json!(controls.cut_frames));
    let got: Map<String, Value> = Control::ALL
        .iter()
        .map(|(control, name)| ((*name).to_owned(), numbers(controls.of_control(*control))))
        .collect();
    answers.member("controls", &Value::Object(got));
    let frames: Vec<usize> = (0..controls.frames()).collect();
    shapes(answers, table.names(), &table.weights(&controls), &frames);
    Ok(())
}

/// The breath of a case, and rcn of its frames.
fn breath(part: &Part<'_>) -> Result<(Breathing, Vec<f64>), Stop> {
    let rcn = part.get("rcn")?.numbers()?;
    let breathing = Breathing::of(&BreathingInput {
        rate_hz: part.get("rateHz")?.number()?,
        phase0: part.get("phase0")?.number()?,
        breaths: &part.get("breaths")?.numbers()?,
        rcn: &rcn,
        fatigue: &part.get("fatigue")?.numbers()?,
        seed: None,
    })?;
    Ok((breathing, rcn))
}

/// The weights of some frames by shape; shapes that stay 0 are left out on both sides.
fn shapes(answers: &mut Answers<'_>, names: &[String], weights: &[f64], frames: &[usize]) {
    let Some(expected) = answers.expected.find("weights") else { return };
    let mut got = Map::new();
    for (shape, name) in names.iter().enumerate() {
        let own: Vec<f64> = frames.iter().map(|f| weights[f * names.len() + shape]).collect();
        let moves = own.iter().any(|weight| *weight != 0.0);
        if moves && expected.find(name).is_none() {
            answers.case.compare(
                &format!("weights/{name}"),
                &Value::Null,
                &numbers(&own),
                Tolerance::Exact,
            );
        }
        got.insert(name.clone(), numbers(&own));
    }
    answers.member("weights", &Value::Object(got));
}

/// A document of `chain/`.
pub(super) fn chain(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let input = &asked.input;
    let person = asked.person()?;
    let heart = input.get("heart")?;
    let law = HeartModel::by_name(heart.text()?).ok_or_else(|| heart.wrong("thesis or steady"))?;
    let mut parts = Vec::new();
    for phase in input.get("phases")?.list()? {
        let [w, seconds] = phase.numbers()?[..] else {
            return Err(phase.wrong("work of a second and seconds").into());
        };
        parts.push((w, seconds));
    }
    let seconds = parts.iter().map(|(_, seconds)| seconds).sum();
    let work = Accumulated::of_phases(&parts)?;
    let plan = Plan::of(PlanPart { work, seconds, rcn: None })?;
    let start = Start { rcn: asked.number("rcn0")?, epoc: asked.number("epoc0")? };
    let series = Series::of(&person, &plan, Heart::Law(law), start)?;
    answers.numbers("w", &series.w);
    answers.numbers("rcn", &series.rcn);
    answers.numbers("epoc", &series.metabolism.epoc);

    let window = Window {
        seconds: [asked.number("first")?, asked.number("last")?],
        rate_hz: asked.number("rateHz")?,
    };
    let face = Face { expression: expression(asked)?, breathing: true, ..Face::default() };
    let clip = Clip::of(&person, &plan, &series, &window, &face)?;
    let listed = answers.expected.get("frames")?;
    let frames = listed.indices_below(clip.times.len(), "a frame of the window")?;
    answers.member("frames", &json!(frames));
    let p: Vec<f64> = frames.iter().map(|f| clip.features[*f].p).collect();
    answers.numbers("p", &p);
    let curves = frames.iter().map(|f| numbers(&clip.curves[*f].to_array()));
    answers.member("curves", &curves.collect());
    let breathing = clip.breathing.as_ref();
    let phase: Vec<f64> =
        breathing.map(|own| frames.iter().map(|f| own.phase[*f]).collect()).unwrap_or_default();
    answers.numbers("phase", &phase);
    // What shows the body stands behind the shapes of the face, and no case has it.
    shapes(answers, face.shapes.names(), &face.shapes.weights(&clip.controls), &frames);
    Ok(())
}

/// How many folders up a model file may lie.
const ABOVE: usize = 3;

/// The rules, or the model of a file beside the folder of cases.
fn expression(asked: &Asked<'_>) -> Result<Expression, Stop> {
    let part = asked.input.get("expression")?;
    let name = part.text()?;
    if name == "rules" {
        return Ok(Expression::Rules);
    }
    let file =
        asked.folder.ancestors().take(ABOVE).map(|above| above.join(name)).find(|f| f.is_file());
    let file =
        file.ok_or_else(|| part.wrong("rules, or a model file beside the folder of cases"))?;
    let text = crate::document::text(&file)?;
    let model =
        ExpressionModel::of_text(&text).map_err(|error| VerifyError::file(&file, &error))?;
    Ok(Expression::Model(Box::new(model)))
}
