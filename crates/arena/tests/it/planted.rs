//! Worths are planted and found again: order where intervals separate, ties where they do not, whatever the order of the
//! files.

use mimique_arena::{
    ArenaClip, ArenaStimuli, LeftOut, NotRanked, RankOptions, Ranking, Vote, pool, rank,
    read_export, read_votes, votes_csv,
};
use mimique_stats::Chosen;
use mimique_test_support::Random;

const OPTIONS: RankOptions = RankOptions { rounds: 200, permutations: 199, seed: 1 };

/// The head's hash in a clip of a method.
fn hash(method: &str, take: &str) -> String {
    format!("hash of {take} by {method}")
}

/// Votes of people in a laboratory: methods with worths (log scale), chosen by Bradley and Terry's model with ties.
fn votes(laboratory: &str, people: usize, worths: &[(&str, f64)], seed: u64) -> Vec<Vote> {
    let mut random = Random::new(seed);
    let mut all = Vec::new();
    for person in 0..people {
        for place in 0..20 {
            let a = (random.uniform() * worths.len() as f64) as usize;
            let b =
                (a + 1 + (random.uniform() * (worths.len() - 1) as f64) as usize) % worths.len();
            let take = ["joy", "fear", "anger"][place % 3];
            let [left, right] = [worths[a], worths[b]];
            let shares = [left.1.exp(), 0.3 * ((left.1 + right.1) / 2.0).exp(), right.1.exp()];
            let mut draw = random.uniform() * shares.iter().sum::<f64>();
            let chosen = Chosen::ALL.into_iter().zip(shares).find(|(_, share)| {
                draw -= share;
                draw <= 0.0
            });
            all.push(Vote {
                laboratory: laboratory.to_owned(),
                session: format!("{laboratory}-{person}"),
                place: place as u32,
                take: take.to_owned(),
                left: left.0.to_owned(),
                right: right.0.to_owned(),
                chosen: chosen.map_or(Chosen::Right, |(chosen, _)| chosen),
                left_hash: hash(left.0, take),
                right_hash: hash(right.0, take),
                day: "2026-11-27".to_owned(),
                rt_ms: Some(1500.0),
                batch: None,
            });
        }
    }
    all
}

const WORTHS: [(&str, f64); 4] =
    [("best", 2.2), ("equal-a", 0.8), ("equal-b", 0.8), ("worst", -0.8)];

fn methods(worths: &[(&str, f64)]) -> Vec<String> {
    worths.iter().map(|(name, _)| (*name).to_owned()).collect()
}

fn bands(ranking: &Ranking) -> Vec<Vec<String>> {
    ranking.bands.iter().map(|band| band.methods.clone()).collect()
}

#[test]
fn the_planted_order_is_found_and_equal_methods_share_a_band() {
    let mut all = votes("here", 60, &WORTHS, 1);
    all.extend(votes("there", 60, &WORTHS, 2));
    let ranking = rank(&all, &methods(&WORTHS), &OPTIONS);
    assert_eq!(ranking.not_ranked, None);
    assert_eq!(bands(&ranking), [vec!["best"], vec!["equal-a", "equal-b"], vec!["worst"]]);
    let ranks: Vec<[usize; 2]> = ranking.placed.iter().map(|own| own.ranks).collect();
    assert_eq!(ranks, [[1, 1], [2, 3], [2, 3], [4, 4]]);
    // The planted differences lie in their intervals, which hold together.
    let planted = |name: &str| WORTHS.iter().find(|own| own.0 == name).unwrap().1;
    for own in &ranking.differences {
        let wanted = (planted(&own.a) - planted(&own.b)) / 3.0f64.ln();
        assert!(own.interval[0] <= wanted && wanted <= own.interval[1], "{own:?}: {wanted}");
    }
    assert!(ranking.heterogeneity.unwrap().p > 0.05);
    assert_eq!(ranking.laboratories.len(), 2);
    assert!(ranking.agreement.unwrap().alpha > 0.0);
    assert!(ranking.left_bias.unwrap()[0].abs() < 0.3);
}

#[test]
fn the_order_of_votes_methods_and_laboratories_does_not_matter() {
    let mut all = votes("here", 20, &WORTHS, 1);
    all.extend(votes("there", 20, &WORTHS, 2));
    let ranking = rank(&all, &methods(&WORTHS), &OPTIONS);
    let mut random = Random::new(7);
    for _ in 0..3 {
        for place in (1..all.len()).rev() {
            all.swap(place, (random.uniform() * (place + 1) as f64) as usize);
        }
        let mut names = methods(&WORTHS);
        names.reverse();
        assert_eq!(rank(&all, &names, &OPTIONS), ranking);
    }
}

#[test]
fn equal_methods_are_ranked_as_seldom_as_the_level_says() {
    let equal = [("a", 0.0), ("b", 0.0), ("c", 0.0), ("d", 0.0)];
    let options = RankOptions { rounds: 0, permutations: 0, seed: 1 };
    let ranked = (0..200).filter(|seed| {
        let found = rank(&votes("here", 25, &equal, 100 + seed), &methods(&equal), &options);
        found.bands.len() > 1 || found.differences.iter().any(|own| own.separated)
    });
    // With 95 % nothing is told apart: 20 of 200 or more would be p < 0.002.
    let count = ranked.count();
    assert!(count < 20, "{count} of 200");
}

#[test]
fn laboratories_that_differ_are_told() {
    let mut all = votes("here", 40, &[("a", 1.0), ("b", 0.0), ("c", -1.0)], 1);
    all.extend(votes("there", 40, &[("a", -1.0), ("b", 0.0), ("c", 1.0)], 2));
    let ranking = rank(&all, &["a", "b", "c"].map(str::to_owned), &OPTIONS);
    assert!(ranking.heterogeneity.unwrap().p <= 0.005);
    let [here, there] = &ranking.laboratories[..] else { panic!("two laboratories") };
    assert!(here.worths["a"].0 > 0.5 && there.worths["a"].0 < -0.5);
}

#[test]
fn a_method_with_few_votes_waits_and_blurs_nobody() {
    let mut all = votes("here", 60, &WORTHS, 1);
    let newcomer = [("best", 0.0), ("newcomer", -9.0)];
    all.extend(votes("there", 1, &newcomer, 3));
    let mut names = methods(&WORTHS);
    names.extend(["newcomer", "unseen"].map(str::to_owned));
    let ranking = rank(&all, &names, &OPTIONS);
    assert_eq!(bands(&ranking).len(), 3);
    let waiting: Vec<(&str, usize)> =
        ranking.waiting.iter().map(|own| (own.method.as_str(), own.votes)).collect();
    assert_eq!(waiting, [("newcomer", 20), ("unseen", 0)]);
}

#[test]
fn what_cannot_be_ranked_is_said_and_not_ranked() {
    let few = rank(&votes("here", 1, &WORTHS, 1), &methods(&WORTHS), &OPTIONS);
    assert_eq!(few.not_ranked, Some(NotRanked::TooFewVotes));
    assert!(few.placed.is_empty() && few.bands.is_empty() && few.waiting.len() == 4);
    assert_eq!(rank(&[], &[], &OPTIONS).not_ranked, Some(NotRanked::TooFewVotes));

    let mut parts = votes("here", 20, &[("a", 0.5), ("b", 0.0)], 1);
    parts.extend(votes("there", 20, &[("c", 0.5), ("d", 0.0)], 2));
    let parts = rank(&parts, &["a", "b", "c", "d"].map(str::to_owned), &OPTIONS);
    let told = NotRanked::Disconnected {
        parts: vec![vec!["a".to_owned(), "b".to_owned()], vec!["c".to_owned(), "d".to_owned()]],
    };
    assert_eq!(parts.not_ranked, Some(told));

    let sure = votes("here", 20, &[("a", 90.0), ("b", 0.0), ("c", 0.5)], 1);
    let sure = rank(&sure, &["a", "b", "c"].map(str::to_owned), &OPTIONS);
    let Some(NotRanked::Separated { undefeated, .. }) = &sure.not_ranked else {
        panic!("{:?}", sure.not_ranked)
    };
    assert_eq!(undefeated, &["a"]);

    let five = votes("here", 5, &WORTHS, 4);
    let five = rank(&five, &methods(&WORTHS), &OPTIONS);
    assert_eq!(five.not_ranked, Some(NotRanked::TooFewPeople { people: 5, wanted: 7 }));
}

#[test]
fn votes_are_read_as_they_were_written() {
    let all = votes("here", 3, &WORTHS, 1);
    let bytes = votes_csv(&all).unwrap();
    assert_eq!(read_votes(&bytes).unwrap(), all);
    let text = String::from_utf8(bytes).unwrap();
    let (names, rows) = text.split_once('\n').unwrap();
    let damaged = format!("{names}\n{}", rows.replacen(",left,", ",lft,", 1));
    let refused = read_votes(damaged.as_bytes()).unwrap_err().to_string();
    assert!(refused.contains("\"lft\"; there are left, same and right"), "{refused}");
}

/// The columns of a tidy export that votes are made of.
const HEADER: &str = "participant_id,config_hash,stage,status,response_id,answer,item_left,item_right,take,provenance,beside_provenance,beside_side,start_time,trial_index,attention_passed,rt,excluded,exclusion_reason,renderer";

/// An export of votes: a row each; `change` may change its cells.
fn export(votes: &[Vote], change: impl Fn(usize, &mut Vec<String>)) -> Vec<u8> {
    let mut text = format!("{HEADER}\n");
    for (row, vote) in votes.iter().enumerate() {
        let mut cells: Vec<String> = [
            vote.session.as_str(),
            "config",
            "live",
            "completed",
            "better",
            vote.chosen.word(),
            &vote.left,
            &vote.right,
            &vote.take,
            &vote.left_hash,
            &vote.right_hash,
            "right",
            "2026-11-27T10:00:00.000Z",
        ]
        .map(str::to_owned)
        .to_vec();
        cells.extend([
            vote.place.to_string(),
            String::new(),
            "1500".to_owned(),
            "false".to_owned(),
        ]);
        cells.extend([String::new(), "stage".to_owned()]);
        change(row, &mut cells);
        text += &(cells.join(",") + "\n");
    }
    text.into_bytes()
}

fn stimuli() -> ArenaStimuli {
    let clips = WORTHS.iter().flat_map(|(method, _)| {
        ["joy", "fear", "anger"].into_iter().map(|take| ArenaClip {
            method: (*method).to_owned(),
            take: take.to_owned(),
            provenance: hash(method, take),
            weights_hash: String::new(),
            duration_ms: 1000.0,
        })
    });
    ArenaStimuli::from_clips(clips)
}

#[test]
fn votes_on_other_stimuli_are_named_with_both_hashes_and_left_out() {
    let own = votes("here", 4, &WORTHS, 1);
    let tampered = export(&own, |_, cells| {
        for cell in &mut cells[9..11] {
            if cell.ends_with("by best") {
                *cell = "another head".to_owned();
            }
        }
    });
    let read = read_export("here", tampered, &stimuli()).unwrap();
    let with_best = own.iter().filter(|vote| vote.left == "best" || vote.right == "best").count();
    assert_eq!(read.votes.len(), own.len() - with_best);
    assert_eq!(read.left_out.values().sum::<usize>(), with_best);
    for reason in read.left_out.keys() {
        let LeftOut::Stimulus { method, take, found, expected } = reason else {
            panic!("{reason}")
        };
        assert_eq!((method.as_str(), found.as_str()), ("best", "another head"));
        assert_eq!(expected.as_deref(), Some(hash("best", take).as_str()));
    }
}

#[test]
fn pilots_the_excluded_the_unfinished_and_the_inattentive_are_left_out_each_with_its_reason() {
    let own = votes("here", 6, &WORTHS, 1);
    let read = read_export(
        "here",
        export(&own, |row, cells| match row / 20 {
            0 => cells[2] = "pilot".to_owned(),
            1 => cells[3] = "active".to_owned(),
            2 => (cells[16], cells[17]) = ("true".to_owned(), "fell asleep".to_owned()),
            3 if row % 20 == 7 => cells[14] = "false".to_owned(),
            4 if row % 20 == 7 => cells[15] = "120".to_owned(),
            4 if row % 20 == 8 => cells[10] = String::new(),
            _ => (),
        }),
        &stimuli(),
    )
    .unwrap();
    let count = |reason: &LeftOut| read.left_out.get(reason).copied();
    assert_eq!(count(&LeftOut::Pilot), Some(20));
    assert_eq!(count(&LeftOut::Unfinished { status: "active".to_owned() }), Some(20));
    assert_eq!(count(&LeftOut::Excluded { why: "fell asleep".to_owned() }), Some(20));
    assert_eq!(count(&LeftOut::FailedCheck), Some(20));
    assert_eq!(count(&LeftOut::TooFast), Some(1));
    assert_eq!(count(&LeftOut::NoHash), Some(1));
    assert_eq!(read.votes.len(), 20 + 18);
}

#[test]
fn sides_follow_the_clip_that_stands_on_the_left() {
    let own = votes("here", 1, &WORTHS, 1);
    let mirrored = export(&own, |_, cells| {
        cells.swap(9, 10);
        cells[11] = "left".to_owned();
    });
    let read = read_export("here", mirrored, &stimuli()).unwrap();
    assert_eq!(read.votes.len(), 20);
}

#[test]
fn a_session_counts_once_wherever_it_is_and_the_order_of_exports_does_not_matter() {
    let stimuli = stimuli();
    let own = votes("here", 3, &WORTHS, 1);
    let other = votes("there", 2, &WORTHS, 2);
    let read =
        |name: &str, votes: &[Vote]| read_export(name, export(votes, |_, _| ()), &stimuli).unwrap();
    // An earlier export, in which the last person had not come far; the same by another laboratory; another's own.
    let exports =
        [read("here", &own[..45]), read("here", &own), read("copy", &own), read("there", &other)];
    let pooled = pool(&exports);
    assert_eq!(pooled.votes.len(), own.len() + other.len());
    let mut turned = exports.clone();
    turned.reverse();
    assert_eq!(pool(&turned), pooled);
    // Among equals the name that comes first; the reason says where they are counted.
    let names: Vec<(&str, usize)> =
        pooled.laboratories.iter().map(|own| (own.name.as_str(), own.votes)).collect();
    assert_eq!(names, [("copy", 60), ("here", 0), ("there", 40)]);
    let here = &pooled.laboratories[1].left_out;
    assert_eq!(here.iter().map(|left| left.votes).sum::<usize>(), 105);
    assert_eq!(here[0].reason, LeftOut::Duplicate { counted: "copy".to_owned() });
}

#[test]
fn what_is_no_export_of_an_arena_is_refused_with_the_column() {
    let refused = |bytes: &str| read_export("x", bytes.into(), &stimuli()).unwrap_err().to_string();
    assert!(refused("a,b\n1,2\n").contains("participant_id"), "{}", refused("a,b\n1,2\n"));
    let none = refused(&format!("{HEADER}\nperson{}\n", ",".repeat(18)));
    assert!(none.starts_with("no row answers \"better\""), "{none}");
}
