//! `hmm/`: hidden Markov models, given, learnt and joined; label paths.

use mimique_annotate::{
    AnnotateError, BaumWelch, Composite, Hmm, LabelPath, Mixture, Posterior, Rows, runs,
};
use serde_json::{Value, json};

use super::{Checking, Source, Stop, rows, shown};
use crate::case::{self, Tolerance, number, numbers};
use crate::document::Part;
use crate::{Case, VerifyError};

/// Log probabilities: relative, absolute below 1.
const RELATIVE: Tolerance = Tolerance::Relative { share: 1e-9, floor: 1.0 };
/// Posteriors.
const NEAR: Tolerance = Tolerance::Absolute(1e-9);
/// What is learnt.
const LEARNT: Tolerance = Tolerance::Absolute(1e-6);
/// What needs no sum of many numbers.
const CLOSE: Tolerance = Tolerance::Absolute(1e-12);

/// A model of a case.
fn model(part: &Part<'_>) -> Result<Hmm, Stop> {
    let start = part.get("start")?.numbers()?;
    let [weights, means, variances] = ["weight", "mean", "variance"].map(|key| part.get(key));
    let (weights, means, variances) = (weights?.list()?, means?.list()?, variances?.list()?);
    let mut mixtures = Vec::new();
    for ((weight, mean), variance) in weights.iter().zip(&means).zip(&variances) {
        mixtures.push(Mixture::new(weight.numbers()?, rows(mean)?, rows(variance)?)?);
    }
    Ok(Hmm::new(start, rows(&part.get("transition")?)?, mixtures)?)
}

/// A model as cases write it.
fn model_shown(hmm: &Hmm) -> Value {
    let of = |shown: fn(&Mixture) -> Value| hmm.states().iter().map(shown).collect::<Value>();
    json!({
        "start": numbers(hmm.start()),
        "transition": shown(hmm.transition()),
        "weight": of(|m| numbers(m.weight())),
        "mean": of(|m| shown(m.mean())),
        "variance": of(|m| shown(m.variance())),
    })
}

/// Frames of a sequence that a case names.
fn frames(case: &Part<'_>, sequence: &Rows) -> Result<Vec<usize>, VerifyError> {
    case.get("frames")?.indices_below(sequence.len(), "a frame of the sequence")
}

/// Likelihood, path, emissions and posteriors of given models.
pub(super) fn given(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    for expected in source.document.root().list()? {
        let case = expected.clone();
        let mut checking = Checking { case: source.case(case.get("name")?.text()?), expected };
        let computed = (|| {
            let (hmm, sequence) = (model(&case.get("model")?)?, rows(&case.get("sequence")?)?);
            checking.outcome("log_likelihood", RELATIVE, hmm.log_likelihood(&sequence), number);
            let path = hmm.best_path(&sequence);
            checking.outcome("path", Tolerance::Exact, path.clone(), |path| json!(path.states));
            // What no path gives has the probability 0.
            let probability = path.map(|path| path.log_probability).or_else(|why| match why {
                AnnotateError::Impossible { .. } => Ok(f64::NEG_INFINITY),
                other => Err(other),
            });
            checking.outcome("path_log_probability", RELATIVE, probability, number);
            let at = frames(&case, &sequence)?;
            let all = case::rows(&hmm.emissions(&sequence)?, hmm.start().len());
            checking.member("emission", RELATIVE, at.iter().map(|&f| all[f].clone()).collect());
            let posterior = hmm.posterior(&sequence);
            let states = |found: Posterior| shown(&found.states.select(at));
            checking.outcome("posterior", NEAR, posterior, states);
            Ok(())
        })();
        each(checking.done(computed)?);
    }
    Ok(())
}

/// Baum-Welch after so many steps.
pub(super) fn learnt(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    for case in source.document.root().list()? {
        let name = case.get("name")?.text()?;
        for expected in case.get("after")?.list()? {
            let steps = expected.get("iterations")?.index()?;
            let own = source.case(format_args!("{name}/{steps}"));
            let mut checking = Checking { case: own, expected };
            let computed = (|| {
                let begin = model(&case.get("start")?)?;
                let sequences = case.get("sequences")?.list()?;
                let sequences = sequences.iter().map(rows).collect::<Result<Vec<_>, _>>()?;
                let options = BaumWelch {
                    steps,
                    variance_floor: case.get("variance_floor")?.number()?,
                    least_frames: case.get("least_frames")?.number()?,
                    tolerance: 0.0,
                };
                let learnt = options.learn(&begin, &sequences)?;
                checking.member("model", LEARNT, model_shown(&learnt.hmm));
                checking.member("log_likelihood", LEARNT, numbers(&learnt.log_likelihood));
                Ok(())
            })();
            each(checking.done(computed)?);
        }
    }
    Ok(())
}

/// Models of labels joined into one (short paper, eq. 6 to 8).
pub(super) fn joined(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    for (place, expected) in source.document.root().list()?.into_iter().enumerate() {
        let mut checking = Checking { case: source.case(place), expected };
        let computed = join(&mut checking);
        each(checking.done(computed)?);
    }
    Ok(())
}

fn join(checking: &mut Checking<'_>) -> Result<(), Stop> {
    let case = checking.expected.clone();
    let mut models = Vec::new();
    for part in case.get("models")?.list()? {
        models.push(model(&part)?);
    }
    let joined = Composite::join(&models, case.get("p_out")?.number()?)?;
    checking.member("start", CLOSE, numbers(joined.hmm().start()));
    checking.member("transition", CLOSE, shown(joined.hmm().transition()));
    checking.member("class_of_state", Tolerance::Exact, json!(joined.class_of_state()));
    let sequence = rows(&case.get("sequence")?)?;
    let path = joined.hmm().best_path(&sequence)?;
    checking.member("path", Tolerance::Exact, json!(path.states));
    checking.member("path_log_probability", RELATIVE, number(path.log_probability));
    let likelihood = joined.hmm().log_likelihood(&sequence)?;
    checking.member("log_likelihood", RELATIVE, number(likelihood));
    let names = case.get("labels")?.texts()?;
    let labels = joined.path(&sequence)?;
    let labels: Vec<Option<&&str>> = labels.into_iter().map(|label| names.get(label)).collect();
    checking.member("path_labels", Tolerance::Exact, json!(labels));
    let posterior = joined.posterior(&sequence)?.select(frames(&case, &sequence)?);
    checking.member("class_posterior", NEAR, shown(&posterior));
    Ok(())
}

/// The most probable labels when labels stay.
pub(super) fn label_path(
    source: &Source<'_>,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    let root = source.document.root();
    let names = root.get("labels")?.texts()?;
    let scores = root.get("log_scores")?.numbers()?;
    for (place, expected) in root.get("cases")?.list()?.into_iter().enumerate() {
        let case = expected.clone();
        let path = LabelPath {
            mean_stay_s: case.get("mean_stay_s")?.number()?,
            temper: case.get("temper")?.number()?,
        };
        let rate_hz = case.get("rate_hz")?.number()?;
        let mut checking = Checking { case: source.case(place), expected };
        checking.member("stay", CLOSE, number(path.stay(rate_hz)));
        let found = path.labels(&scores, names.len(), rate_hz);
        checking.outcome("path", Tolerance::Exact, found.clone(), |path| json!(path));
        checking.outcome("runs", Tolerance::Exact, found, |path| {
            let run =
                |r: mimique_annotate::Run| json!([r.frames.start, r.frames.end, names[r.label]]);
            runs(&path).into_iter().map(run).collect()
        });
        each(checking.case);
    }
    Ok(())
}
