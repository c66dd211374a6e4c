//! A model file from a lesson: the best pair of every curve, its regression on all rows, and how well it
//! foretells blocks and people that it has not seen.

use mimique_exertion::{Curves, SupportVectorParts, model_json};
use serde_json::{Map, Value, json};

use crate::TrainingError;
use crate::cross_validation::{cross_validate, hold_out, learn};
use crate::lesson::Lesson;
use crate::regression::EpsilonSvr;
use crate::search::{Best, Grid};

/// Rows that a search of the grid uses at most: its time grows with their square.
const SEARCH_ROWS: usize = 300;
/// The tolerance of the regressions that are kept, per cent.
const TOLERANCE: f64 = 1e-3;

/// A curve that was learnt.
#[derive(Debug, Clone, PartialEq)]
pub struct LearntCurve {
    /// Its name.
    pub name: &'static str,
    /// The pair of the grid.
    pub best: Best,
    /// Vectors of the regression.
    pub vectors: usize,
    /// By how much the optimality conditions are missed, per cent.
    pub violation: f64,
    /// Root of the mean squared error of contiguous blocks that were held out, per cent.
    pub rmse: f64,
    /// The same of every person, foretold from all others; empty for one person.
    pub rmse_of_people: Vec<f64>,
}

/// What was learnt.
#[derive(Debug, Clone, PartialEq)]
pub struct Trained {
    /// The curves in the order of [`Curves::NAMES`].
    pub curves: Vec<LearntCurve>,
    /// The model file.
    pub file: Value,
}

/// Learns all curves of a lesson; `each` hears of every curve when it is learnt.
///
/// # Errors
/// [`TrainingError`].
pub fn train(
    lesson: &Lesson,
    grid: &Grid,
    each: &mut dyn FnMut(&LearntCurve),
) -> Result<Trained, TrainingError> {
    let mut curves = Vec::new();
    let mut parts = Vec::new();
    for (place, name) in Curves::NAMES.into_iter().enumerate() {
        let (learnt, own) = curve(lesson, grid, place, name)?;
        each(&learnt);
        curves.push(learnt);
        parts.push(own);
    }
    let about = about(lesson, grid, &curves);
    let parts: [SupportVectorParts; 4] = parts.try_into().map_err(|_| TrainingError::Count {
        what: "curves",
        found: curves.len(),
        expected: Curves::NAMES.len(),
    })?;
    let file = model_json(&lesson.features, &parts, about);
    Ok(Trained { curves, file })
}

fn curve(
    lesson: &Lesson,
    grid: &Grid,
    place: usize,
    name: &'static str,
) -> Result<(LearntCurve, SupportVectorParts), TrainingError> {
    let few = lesson.thinned(SEARCH_ROWS);
    let few_rows: Vec<&[f64]> = few.rows.iter().map(Vec::as_slice).collect();
    let best = grid.search(&few_rows, &few.targets[place], name)?;
    let svr = EpsilonSvr {
        c: 10f64.powf(best.c),
        gamma: 10f64.powf(best.gamma),
        epsilon: grid.epsilon,
        tolerance: TOLERANCE,
    };
    let rows: Vec<&[f64]> = lesson.rows.iter().map(Vec::as_slice).collect();
    let targets = &lesson.targets[place];
    let learnt = learn(&svr, &rows, targets, true)?;
    let rmse = cross_validate(&svr, &rows, targets, grid.folds, true)?;
    let mut rmse_of_people = Vec::new();
    if lesson.people.len() > 1 {
        for person in 0..lesson.people.len() {
            let held = |row: usize| lesson.of_person[row] == person;
            let out = hold_out(&svr, &rows, targets, held, true)?;
            rmse_of_people.push((out.squares / out.rows.max(1) as f64).sqrt());
        }
    }
    let (vectors, violation) = (learnt.model.vectors(), learnt.fitted.violation);
    Ok((LearntCurve { name, best, vectors, violation, rmse, rmse_of_people }, learnt.parts))
}

/// What a model file says of where it is from.
fn about(lesson: &Lesson, grid: &Grid, curves: &[LearntCurve]) -> Map<String, Value> {
    let people: Vec<Value> = lesson
        .people
        .iter()
        .map(|pupil| {
            let own = Curves::NAMES.iter().zip(pupil.expressivity);
            let expressivity: Map<String, Value> =
                own.map(|(name, most)| ((*name).to_owned(), json!(most))).collect();
            json!({"who": pupil.who, "rows": pupil.rows, "expressivity": expressivity})
        })
        .collect();
    let learnt: Map<String, Value> = curves
        .iter()
        .map(|own| {
            let of_people: Map<String, Value> = lesson
                .people
                .iter()
                .zip(&own.rmse_of_people)
                .map(|(pupil, rmse)| (pupil.who.clone(), json!(rmse)))
                .collect();
            let value = json!({
                "cExponent": own.best.c, "gammaExponent": own.best.gamma, "vectors": own.vectors,
                "violation": own.violation, "rmse": own.rmse, "rmseOfPeople": of_people,
            });
            (own.name.to_owned(), value)
        })
        .collect();
    let training = json!({
        "rows": lesson.rows.len(), "standardise": true, "epsilon": grid.epsilon, "folds": grid.folds,
        "people": people, "curves": learnt,
    });
    Map::from_iter([("training".to_owned(), training)])
}
