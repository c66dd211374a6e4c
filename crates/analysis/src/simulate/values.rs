//! What a parameters file names, held against the study: numbers, deviations, shares, factors and levels.

use std::collections::BTreeMap;

use super::parameters::{ByLevel, Interaction};
use super::read::{Levels, ParametersError, problem_at};

pub(super) fn finite(pointer: &str, value: f64) -> Result<(), ParametersError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(problem_at(pointer, format!("{value} is not a number"), "give a number"))
}

pub(super) fn deviation(pointer: &str, value: f64) -> Result<(), ParametersError> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(problem_at(pointer, format!("{value} is no standard deviation"), "give 0 or more"))
}

pub(super) fn known_factor<'l>(
    pointer: &str,
    factor: &str,
    levels: &'l Levels,
) -> Result<&'l [String], ParametersError> {
    levels.get(factor).map(Vec::as_slice).ok_or_else(|| {
        let names: Vec<&str> = levels.keys().map(String::as_str).collect();
        problem_at(
            pointer,
            format!("there is no factor \"{factor}\""),
            format!("the study has {}", names.join(", ")),
        )
    })
}

pub(super) fn known_level(
    pointer: &str,
    level: &str,
    levels: &[String],
) -> Result<(), ParametersError> {
    if levels.iter().any(|known| known == level) {
        return Ok(());
    }
    Err(problem_at(
        pointer,
        format!("there is no level \"{level}\""),
        format!("the levels are {}", levels.join(", ")),
    ))
}

pub(super) fn by_factor(
    pointer: &str,
    by: &ByLevel,
    levels: &Levels,
) -> Result<(), ParametersError> {
    for (factor, sd) in by {
        let pointer = format!("{pointer}/{factor}");
        known_factor(&pointer, factor, levels)?;
        deviation(&pointer, *sd)?;
    }
    Ok(())
}

pub(super) fn effects(
    pointer: &str,
    effects: &BTreeMap<String, ByLevel>,
    levels: &Levels,
) -> Result<(), ParametersError> {
    for (factor, shifts) in effects {
        let pointer = format!("{pointer}/{factor}");
        let known = known_factor(&pointer, factor, levels)?;
        for (level, shift) in shifts {
            let pointer = format!("{pointer}/{level}");
            known_level(&pointer, level, known)?;
            finite(&pointer, *shift)?;
        }
    }
    Ok(())
}

pub(super) fn interactions(
    pointer: &str,
    given: &[Interaction],
    levels: &Levels,
) -> Result<(), ParametersError> {
    for (place, interaction) in given.iter().enumerate() {
        finite(&format!("{pointer}/{place}/shift"), interaction.shift)?;
        for (factor, level) in &interaction.levels {
            let pointer = format!("{pointer}/{place}/levels/{factor}");
            known_level(&pointer, level, known_factor(&pointer, factor, levels)?)?;
        }
    }
    Ok(())
}

pub(super) fn shares(
    pointer: &str,
    row: &ByLevel,
    answers: &[&str],
) -> Result<(), ParametersError> {
    for (answer, share) in row {
        let pointer = format!("{pointer}/{answer}");
        if !answers.contains(&answer.as_str()) {
            let remedy = format!("the options are {}", answers.join(", "));
            return Err(problem_at(&pointer, format!("there is no option \"{answer}\""), remedy));
        }
        if !(share.is_finite() && *share >= 0.0) {
            return Err(problem_at(&pointer, format!("{share} is no share"), "give 0 or more"));
        }
    }
    if row.values().sum::<f64>() <= 0.0 {
        return Err(problem_at(pointer, "the shares add up to 0", "give some answer a share"));
    }
    Ok(())
}
