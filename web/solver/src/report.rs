//! What the worker says of a clip besides its weights.

use mimique_stimulus::{FrameStatistics, SolvedTake};

use crate::tree::Tree;

/// `{"shapeNames": [...], "statistics": {...} or null, "warnings": [...]}`.
pub fn report(take: &SolvedTake) -> Tree {
    Tree::Object(vec![
        ("shapeNames".to_owned(), Tree::texts(&take.shape_names)),
        ("statistics".to_owned(), take.statistics.as_ref().map_or(Tree::Null, statistics)),
        ("warnings".to_owned(), Tree::texts(&take.warnings)),
    ])
}

/// The same object as serde writes of them.
fn statistics(of: &FrameStatistics) -> Tree {
    let pair = |pair: Option<(usize, usize)>| {
        pair.map(|(count, first)| {
            Tree::List(vec![Tree::Number(count as f64), Tree::Number(first as f64)])
        })
    };
    let always = [
        ("frames", Tree::Number(of.frames as f64)),
        ("residual_rms_mm", Tree::Number(of.residual_rms_mm)),
        ("residual_worst_mm", Tree::Number(of.residual_worst_mm)),
        ("iterations_mean", Tree::Number(of.iterations_mean)),
        ("iterations_most", Tree::Number(f64::from(of.iterations_most))),
        ("kkt_worst", Tree::Number(of.kkt_worst)),
        ("missing_markers", Tree::Number(of.missing_markers as f64)),
        ("not_converged", pair(of.not_converged).unwrap_or(Tree::Null)),
        ("without_markers", pair(of.without_markers).unwrap_or(Tree::Null)),
        ("smoothed", Tree::Number(of.smoothed as f64)),
    ];
    let sometimes = [
        ("far_from_training", pair(of.far_from_training)),
        ("deviation_worst", of.deviation_worst.map(Tree::Number)),
    ];
    let sometimes = sometimes.into_iter().filter_map(|(key, value)| Some((key, value?)));
    Tree::Object(
        always.into_iter().chain(sometimes).map(|(key, value)| (key.to_owned(), value)).collect(),
    )
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    fn same(tree: &Tree, value: &Value) -> bool {
        match (tree, value) {
            (Tree::Null, Value::Null) => true,
            (Tree::Number(ours), Value::Number(theirs)) => theirs.as_f64() == Some(*ours),
            (Tree::List(ours), Value::Array(theirs)) => {
                ours.len() == theirs.len() && ours.iter().zip(theirs).all(|(a, b)| same(a, b))
            }
            (Tree::Object(ours), Value::Object(theirs)) => {
                ours.len() == theirs.len()
                    && ours.iter().all(|(k, v)| theirs.get(k).is_some_and(|theirs| same(v, theirs)))
            }
            _ => false,
        }
    }

    #[test]
    fn statistics_are_what_serde_writes() {
        let some = FrameStatistics {
            frames: 800,
            residual_rms_mm: 0.25,
            residual_worst_mm: 1.5,
            iterations_mean: 4.25,
            iterations_most: 9,
            kkt_worst: 1e-12,
            missing_markers: 7,
            not_converged: Some((2, 14)),
            without_markers: None,
            smoothed: 3,
            far_from_training: Some((5, 1)),
            deviation_worst: Some(0.125),
        };
        let bare = FrameStatistics {
            not_converged: None,
            without_markers: Some((1, 0)),
            far_from_training: None,
            deviation_worst: None,
            ..some.clone()
        };
        for of in [some, bare] {
            let written = serde_json::to_value(&of).expect("written");
            assert!(same(&statistics(&of), &written), "{:?} {written}", statistics(&of));
        }
    }
}
