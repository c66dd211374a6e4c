//! `train/`: support vector regressions learnt here.

use mimique_exertion_training::EpsilonSvr;
use mimique_exertion_training::cross_validation::{contiguous_blocks, cross_validate, learn};
use serde_json::{Value, json};

use super::{Answers, Asked, Stop, rows};

/// By how much the solver may miss the optimality conditions, per cent.
const TOLERANCE: f64 = 1e-6;

/// A document of `train/`: a regression and its predictions, or its cross-validation.
pub(super) fn train(asked: &Asked<'_>, answers: &mut Answers<'_>) -> Result<(), Stop> {
    let x = rows(&asked.input.get("x")?)?;
    let x: Vec<&[f64]> = x.iter().map(Vec::as_slice).collect();
    let y = asked.numbers("y")?;
    let svr = EpsilonSvr {
        c: asked.number("c")?,
        gamma: asked.number("gamma")?,
        epsilon: asked.number("epsilon")?,
        tolerance: TOLERANCE,
    };
    if let Some(folds) = asked.input.find("folds") {
        let folds = folds.index()?;
        let blocks: Value =
            contiguous_blocks(x.len(), folds).iter().map(|b| json!([b.start, b.end])).collect();
        answers.member("blocks", &blocks);
        answers.number("rmse", cross_validate(&svr, &x, &y, folds, false)?);
        return Ok(());
    }
    let learnt = learn(&svr, &x, &y, false)?;
    answers.number("objective", learnt.fitted.objective);
    let at = rows(&asked.input.get("at")?)?;
    let found = at.iter().map(|row| learnt.model.predict(row)).collect::<Result<Vec<f64>, _>>()?;
    answers.numbers("y", &found);
    Ok(())
}
