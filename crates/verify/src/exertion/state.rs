//! `heart/`, `metabolism/`, `activity/`, `breathing/`: what a body's state follows from.

use mimique_exertion::{
    Breathing, BreathingInput, HeartLaw, HeartModel, Metabolism, RecordedHeart, at_whole_seconds,
    vo2_cycling, vo2_on_foot, w_of_vo2,
};
use serde_json::json;

use super::{Answers, Asked, Stop};

/// A document of `heart/`.
pub(super) fn heart(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let person = asked.person()?;
    answers.number("hrRest", person.hr_rest());
    answers.number("hrMax", person.hr_max());
    answers.number("vo2Max", person.vo2_max());
    let law = HeartLaw::of_level(person.spec().level);
    answers.number("threshold", law.threshold);
    answers.number("rise", law.rise);
    answers.number("fall", law.fall);
    let model = asked.input.get("model")?;
    if model.text()? == "recorded" {
        let (time, rate) = (asked.numbers("time")?, asked.numbers("heartRate")?);
        let recorded = RecordedHeart::of(&person, &time, &rate)?;
        answers.numbers("heartRateAtSeconds", &recorded.heart_rate);
        answers.numbers("rcn", &recorded.rcn);
        return Ok(());
    }
    let law = HeartModel::by_name(model.text()?);
    let law = law.ok_or_else(|| model.wrong("thesis, steady or recorded"))?;
    let (w, rcn0) = (asked.numbers("w")?, asked.number("rcn0")?);
    let rcn = mimique_exertion::heart(&person, law, &w, rcn0)?;
    let rates: Vec<f64> = rcn.iter().map(|share| person.heart_rate(*share)).collect();
    answers.numbers("rcn", &rcn);
    answers.numbers("heartRate", &rates);
    Ok(())
}

/// A document of `metabolism/`.
pub(super) fn metabolism(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let person = asked.person()?;
    answers.number("vo2Max", person.vo2_max());
    answers.number("restingKcalDay", person.resting_kcal_day());
    let found = Metabolism::of(&person, &asked.numbers("rcn")?, asked.number("epoc0")?)?;
    for (key, got) in [
        ("borg", &found.borg),
        ("vo2", &found.vo2),
        ("vo2Share", &found.vo2_share),
        ("breaths", &found.breaths),
        ("kcalMin", &found.kcal_min),
        ("epoc", &found.epoc),
        ("fatigue", &found.fatigue),
        ("flush", &found.flush),
        ("sweat", &found.sweat),
    ] {
        answers.numbers(key, got);
    }
    Ok(())
}

/// A document of `activity/`: samples at uneven times, or the formulas alone.
pub(super) fn activity(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let input = &asked.input;
    let of = |key: &str| input.find(key).map(|part| part.numbers()).transpose();
    let mass_kg = input.find("massKg").map_or(Ok(70.0), |part| part.number())?;
    let time = of("time")?;
    let sampled = |key: &str| -> Result<Option<Vec<f64>>, Stop> {
        let Some(values) = of(key)? else { return Ok(None) };
        let values = match &time {
            Some(time) => at_whole_seconds(time, &values, key)?,
            None => values,
        };
        Ok(Some(values))
    };
    let (power, speed, grade) = (sampled("powerW")?, sampled("speed")?, sampled("grade")?);
    let cycling = power.as_ref().map(|power| -> Vec<f64> {
        power.iter().map(|power| vo2_cycling(*power, mass_kg)).collect()
    });
    let on_foot = speed.as_ref().map(|speed| -> Vec<f64> {
        let level = |second: usize| grade.as_ref().map_or(0.0, |grade| grade[second]);
        speed.iter().enumerate().map(|(i, speed)| vo2_on_foot(*speed, level(i))).collect()
    });
    for (key, got) in [("powerW", &power), ("speed", &speed), ("grade", &grade)] {
        if let Some(got) = got {
            answers.numbers(key, got);
        }
    }
    for (key, got) in [("vo2Cycling", &cycling), ("vo2OnFoot", &on_foot)] {
        if let Some(got) = got {
            answers.numbers(key, got);
        }
    }
    if let Some(vo2) = cycling.or(on_foot) {
        answers.numbers("vo2", &vo2);
        let w: Vec<f64> = vo2.iter().map(|vo2| w_of_vo2(*vo2)).collect();
        answers.numbers("w", &w);
    }
    Ok(())
}

/// A document of `breathing/`.
pub(super) fn breathing(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let found = Breathing::of(&BreathingInput {
        rate_hz: asked.number("rateHz")?,
        phase0: asked.number("phase0")?,
        breaths: &asked.numbers("breaths")?,
        rcn: &asked.numbers("rcn")?,
        fatigue: &asked.numbers("fatigue")?,
        seed: None,
    })?;
    for (key, got) in [
        ("phase", &found.phase),
        ("volume", &found.volume),
        ("flow", &found.flow),
        ("exhale", &found.exhale),
        ("swallow", &found.swallow),
    ] {
        answers.numbers(key, got);
    }
    answers.member("deepStarts", &json!(found.deep_starts));
    answers.member("swallowStarts", &json!(found.swallow_starts));
    Ok(())
}
