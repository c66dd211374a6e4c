//! Small designs, decided by trying every order: what the check lets pass has an order for everybody,
//! and what it refuses has none.

use std::collections::BTreeMap;

use mimique_study::check;
use serde_json::{Value, json};

use crate::support::small::{Limits, Numbers, clips, has_an_order, keeps_to, small_file};

/// What a drawn design looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Family {
    Flat,
    Repeated,
    Nested,
    BesideSquare,
    Sampled,
}

const FAMILIES: [Family; 5] =
    [Family::Flat, Family::Repeated, Family::Nested, Family::BesideSquare, Family::Sampled];

struct Design {
    file: Value,
    /// Clips that the constraints order, each list by itself; of a sample, those it is drawn from.
    groups: Vec<Vec<String>>,
    samples: Option<usize>,
    limits: [Limits; 2],
}

impl Design {
    fn new(family: Family, seed: u64) -> Self {
        let mut numbers = Numbers(seed);
        let mut segments: Vec<(&str, u8)> = ["joy", "fear", "anger"]
            .iter()
            .flat_map(|&kind| [1, 2, 3].map(|n| (kind, n)))
            .collect();
        let methods = 1 + numbers.below(2);
        let most = if family == Family::Repeated { 4 } else { 7 } / methods;
        let count = 2 + numbers.below(most as u64 - 1);
        while segments.len() > count {
            segments.remove(numbers.below(segments.len() as u64));
        }
        let limits = [
            Limits { at_most_alike: 1 + numbers.below(3), minimum_distance: 1 + numbers.below(3) },
            Limits {
                at_most_alike: if methods == 1 { 7 } else { 1 + numbers.below(3) },
                minimum_distance: 1,
            },
        ];
        let constraint = |factor: &str, limits: Limits| {
            json!({ "factor": factor, "atMostAlike": limits.at_most_alike,
                "minimumDistance": limits.minimum_distance })
        };
        let constraints =
            json!([constraint("expression", limits[0]), constraint("method", limits[1])]);
        let random = |block: &str| {
            let constraints = constraints.clone();
            json!({ "order": "random", "components": [block], "constraints": constraints })
        };
        let samples =
            (family == Family::Sampled).then(|| 1 + numbers.below((count * methods) as u64));
        let sequence = match family {
            Family::Flat | Family::Repeated => random("faces"),
            Family::Nested => {
                let order = ["fixed", "random", "latinSquare"][numbers.below(3)];
                json!({ "order": order, "components": [random("first"), random("second")] })
            }
            Family::BesideSquare => json!({ "order": "latinSquare", "components": [
                { "order": "latinSquare", "components": ["first"] }, random("second") ] }),
            Family::Sampled => {
                let mut sequence = random("faces");
                sequence["numSamples"] = samples.into();
                sequence
            }
        };
        let mut file = small_file(seed, &segments, methods, sequence);
        if family == Family::Repeated {
            file["components"]["faces"]["repetitions"] = 2.into();
        }
        let of = |block: &str| -> Vec<String> {
            let ids = &file["components"][block]["clips"]["ids"];
            ids.as_array().unwrap().iter().map(|id| id.as_str().unwrap().to_owned()).collect()
        };
        let groups = match family {
            Family::Flat | Family::Sampled => vec![of("faces")],
            Family::Repeated => vec![[of("faces"), of("faces")].concat()],
            Family::Nested => vec![of("first"), of("second")],
            Family::BesideSquare => vec![of("second")],
        };
        Self { file, groups, samples, limits }
    }

    /// Whether it must pass; of samples, whether it may be refused.
    fn expected(&self) -> bool {
        match self.samples {
            None => self.groups.iter().all(|group| has_an_order(&values(group), &self.limits)),
            Some(samples) => {
                let all = values(&self.groups[0]);
                (0_u32..1 << all.len()).filter(|set| set.count_ones() as usize == samples).all(
                    |set| {
                        let chosen =
                            all.iter().enumerate().filter(|(index, _)| set >> index & 1 == 1);
                        let chosen: Vec<Vec<String>> =
                            chosen.map(|(_, part)| part.clone()).collect();
                        has_an_order(&chosen, &self.limits)
                    },
                )
            }
        }
    }
}

/// Expression and method of `joy2.m0`.
fn values(clips: &[String]) -> Vec<Vec<String>> {
    let of = |clip: &String| {
        let (segment, method) = clip.split_once('.').unwrap();
        vec![segment[..segment.len() - 1].to_owned(), method.to_owned()]
    };
    clips.iter().map(of).collect()
}

#[test]
fn passes_if_and_only_if_there_is_an_order() {
    let mut counts: BTreeMap<(Family, bool), usize> = BTreeMap::new();
    for family in FAMILIES {
        for seed in 0..120 {
            let design = Design::new(family, seed);
            let here = format!("{family:?}, seed {seed}: {}", design.file["sequence"]);
            let report = check(&design.file.to_string(), &|_| Ok(()));
            *counts.entry((family, report.study.is_some())).or_default() += 1;
            let Some(checked) = report.study else {
                let mut errors = report.issues.iter().filter(|issue| issue.code() != "unused");
                assert!(errors.all(|issue| issue.message().contains("meets them")), "{here}");
                assert!(!design.expected(), "an order exists: {here}");
                continue;
            };
            assert!(design.samples.is_some() || design.expected(), "no order exists: {here}");
            for participant in 0..40 {
                let order = clips(checked.study(), checked.config_hash(), participant);
                for group in &design.groups {
                    let mine: Vec<String> =
                        order.iter().filter(|clip| group.contains(clip)).cloned().collect();
                    assert_eq!(mine.len(), design.samples.unwrap_or(group.len()), "{here}");
                    assert!(keeps_to(&values(&mine), &design.limits), "{here}: {mine:?}");
                }
            }
        }
    }
    eprintln!("(family, passed) -> designs: {counts:?}");
    for family in FAMILIES {
        let of = |passed| counts.get(&(family, passed)).copied().unwrap_or(0);
        assert!(of(true) >= 20 && of(false) >= 20, "{counts:?}");
    }
}
