//! Which levels a trial of a block of difference scaling shows, in which order: drawn from seed and participant.

use serde_json::Value;

use super::Draw;

/// The clips of each trial of a block (as projected, JSON), as they stand: sets of ascending levels of a segment, drawn
/// from all of them without one twice before all were shown, each from the lowest level up or the other way round.
pub(super) fn scaling_sets(block: &Value, component: &str, draw: Draw<'_>) -> Vec<Vec<String>> {
    let list = |key: &str| block[key].as_array().map_or(&[][..], Vec::as_slice);
    let levels: Vec<f64> = list("levels").iter().filter_map(Value::as_f64).collect();
    let segments: Vec<&str> = list("shown").iter().filter_map(Value::as_str).collect();
    let number = |key: &str| block[key].as_u64().unwrap_or_default() as usize;
    let places = sets(levels.len(), number("each"));
    let count = places.len() * segments.len();
    if count == 0 {
        return Vec::new();
    }
    let mut stream = draw.stream(&["scaling/", component].concat());
    let mut order: Vec<usize> = Vec::new();
    let mut shown = Vec::new();
    for _ in 0..number("trials") {
        if order.is_empty() {
            order = (0..count).collect();
            stream.shuffle(&mut order);
        }
        let Some(set) = order.pop() else { break };
        let prefix = segments[set % segments.len()];
        let own = &places[set / segments.len()];
        let mut clips: Vec<String> =
            own.iter().map(|&level| [prefix, &levels[level].to_string()].concat()).collect();
        if stream.below(2) == 1 {
            clips.reverse();
        }
        shown.push(clips);
    }
    shown
}

/// All sets of so many of the first `count` places, each ascending.
fn sets(count: usize, size: usize) -> Vec<Vec<usize>> {
    let mut found: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 0..size {
        let longer = |set: &Vec<usize>| {
            let from = set.last().map_or(0, |last| last + 1);
            (from..count).map(|next| [set.as_slice(), &[next]].concat()).collect::<Vec<_>>()
        };
        found = found.iter().flat_map(longer).collect();
    }
    if size == 0 { Vec::new() } else { found }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn block(trials: usize) -> Value {
        json!({
            "levels": [0.0, 0.25, 0.5, 0.75, 1.0], "each": 3, "trials": trials,
            "shown": ["joy.lsts@alpha=", "fear.lsts@alpha="]
        })
    }

    fn draw(participant: u64) -> Draw<'static> {
        Draw { seed: 4, config_hash: "c", participant, condition: None }
    }

    #[test]
    fn all_sets_are_shown_before_one_comes_again() {
        // 10 triads of 5 levels, two segments.
        let shown = scaling_sets(&block(40), "scale", draw(1));
        let ascending = |clips: &Vec<String>| {
            let mut clips = clips.clone();
            clips.sort();
            clips
        };
        for round in shown.chunks(20) {
            let mut sets: Vec<_> = round.iter().map(ascending).collect();
            sets.sort();
            sets.dedup();
            assert_eq!(sets.len(), 20);
        }
        let falling = shown.iter().filter(|clips| clips[0] > clips[1]).count();
        assert!((8..=32).contains(&falling), "both ways: {falling}");
        assert!(shown.iter().all(|clips| (clips[0] > clips[1]) == (clips[1] > clips[2])));
        assert_eq!(shown, scaling_sets(&block(40), "scale", draw(1)));
        assert_ne!(shown, scaling_sets(&block(40), "scale", draw(2)));
        assert_eq!(shown[..5], scaling_sets(&block(5), "scale", draw(1)));
    }

    #[test]
    fn a_block_without_clips_has_no_trials() {
        assert!(scaling_sets(&json!({}), "scale", draw(1)).is_empty());
        assert_eq!(sets(5, 4).len(), 5);
        assert_eq!(sets(4, 3), [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]);
    }
}
