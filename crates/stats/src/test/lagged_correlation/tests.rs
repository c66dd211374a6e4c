//! Planted lags, gains, noise and gaps; p without coupling; surrogates that share what people do anyway.

use mimique_test_support::Random;

use super::*;

const RATE_HZ: f64 = 30.0;
const INSTANTS: usize = 150;

fn options(kind: Surrogates, surrogates: usize, seed: u64) -> LaggedCorrelationOptions {
    let window = LagWindow::of_seconds(RATE_HZ, [-0.5, 1.5], 2.0);
    LaggedCorrelationOptions { window, surrogates, kind, seed }
}

/// A course that stays near itself from one instant to the next.
fn smooth(instants: usize, random: &mut Random) -> Vec<f64> {
    let mut state = random.normal();
    let mut step = || {
        state = 0.9 * state + 0.436 * random.normal();
        state
    };
    (0..instants).map(|_| step()).collect()
}

/// Clips of some shapes, and people who see each of them once: `gain` times the clip after `lag` instants, and what they
/// do by themselves.
fn planted(people: usize, clips: usize, lag: usize, gain: f64, random: &mut Random) -> Couplings {
    const SHAPES: usize = 3;
    let clips: Vec<Courses> =
        (0..clips).map(|_| (0..SHAPES).map(|_| smooth(INSTANTS, random)).collect()).collect();
    let mut plays = Vec::new();
    for person in 0..people {
        for (clip, shown) in clips.iter().enumerate() {
            let mut follow = |course: &Vec<f64>| -> Vec<f64> {
                let own = smooth(INSTANTS, random);
                let seen = |at: usize| at.checked_sub(lag).map_or(0.0, |before| course[before]);
                own.iter().enumerate().map(|(at, own)| 0.2 + gain * seen(at) + own).collect()
            };
            let track = shown.iter().map(&mut follow).collect();
            plays.push(CoupledPlay { person, clip, track });
        }
    }
    let people = (0..people).map(|person| format!("p{person}")).collect();
    Couplings { people, clips, plays }
}

fn tested(given: &Couplings, options: LaggedCorrelationOptions) -> LaggedCorrelation {
    lagged_correlation(given, options).unwrap().unwrap()
}

#[test]
fn a_planted_lag_is_found_whatever_the_gain_and_in_spite_of_noise_and_gaps() {
    for (seed, (lag, gain)) in [(12, 0.4), (24, 0.4), (0, 0.4), (18, 0.15)].into_iter().enumerate()
    {
        let mut random = Random::new(seed as u64);
        let mut given = planted(12, 6, lag, gain, &mut random);
        // A fifth of the instants is not measured, whole stretches of it.
        for (number, play) in given.plays.iter_mut().enumerate() {
            let from = (7 * number) % (INSTANTS - 30);
            play.track.iter_mut().for_each(|course| course[from..from + 30].fill(f64::NAN));
        }
        for kind in [Surrogates::OtherClips, Surrogates::Shifted] {
            let found = tested(&given, options(kind, 199, 1));
            assert!(
                (found.lag_s - lag as f64 / RATE_HZ).abs() <= 1.5 / RATE_HZ,
                "{lag}: {}",
                found.lag_s
            );
            assert!(found.p_value <= 0.01 && found.highest_r > found.critical_r, "{found:?}");
            assert_eq!((found.participants, found.n, found.dropped), (12, 72, 0));
            let place = found.lags_s.iter().position(|own| *own == found.lag_s).unwrap();
            let [low, high] = found.interval_95.as_ref().unwrap()[place];
            assert!(low < found.highest_r && found.highest_r < high && low > 0.0);
            assert!(found.surrogates_95[place][1] < found.highest_r);
        }
    }
    // Of a pure echo the correlation is one at its lag and lower elsewhere.
    let mut given = planted(2, 3, 0, 0.0, &mut Random::new(3));
    for play in &mut given.plays {
        play.track = given.clips[play.clip].clone();
        play.track.iter_mut().for_each(|course| course.rotate_right(9));
    }
    let found = tested(&given, options(Surrogates::OtherClips, 19, 1));
    assert_eq!(found.lag_s, 0.3);
    assert!(found.highest_r > 0.999 && found.r[0] < 0.9);
}

#[test]
fn without_coupling_p_is_uniform() {
    for (kind, allowed) in [(Surrogates::OtherClips, 1.36), (Surrogates::Shifted, 1.63)] {
        const SEEDS: usize = 200;
        let p: Vec<f64> = (0..SEEDS as u64)
            .map(|seed| {
                let given = planted(3, 4, 0, 0.0, &mut Random::new(1000 + seed));
                tested(&given, options(kind, 99, seed)).p_value
            })
            .collect();
        // The distance of Kolmogorov and Smirnov from steps of a hundredth.
        let mut sorted = p.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let apart = |(rank, p): (usize, &f64)| {
            let share = (rank + 1) as f64 / SEEDS as f64;
            (share - p).abs().min((rank as f64 / SEEDS as f64 - p).abs())
        };
        let distance = sorted.iter().enumerate().map(apart).fold(0.0, f64::max);
        assert!(distance * (SEEDS as f64).sqrt() < allowed, "{kind:?}: {distance}");
        let positive = p.iter().filter(|p| **p <= 0.05).count();
        assert!((2..=20).contains(&positive), "{kind:?}: {positive} of {SEEDS} at 0.05");
    }
}

#[test]
fn what_people_do_in_every_play_alike_is_no_coupling() {
    // All clips rise and fall alike, and all people smile in the middle of every clip, whichever it is.
    let bump = |height: f64, random: &mut Random| -> Vec<f64> {
        let own = smooth(INSTANTS, random);
        let at = |at: usize| height * (-((at as f64 - 70.0) / 20.0).powi(2)).exp() + 0.3 * own[at];
        (0..INSTANTS).map(at).collect()
    };
    let (mut positive, mut shifted) = (0, 0);
    for seed in 0..20 {
        let random = &mut Random::new(seed);
        let mut given = planted(5, 5, 0, 0.0, random);
        given.clips.iter_mut().flatten().for_each(|course| *course = bump(2.0, random));
        given
            .plays
            .iter_mut()
            .flat_map(|play| &mut play.track)
            .for_each(|course| *course = bump(1.5, random));
        let found = tested(&given, options(Surrogates::OtherClips, 99, seed));
        assert!(found.highest_r > 0.4, "the curves are high all the same");
        positive += usize::from(found.p_value <= 0.05);
        shifted +=
            usize::from(tested(&given, options(Surrogates::Shifted, 99, seed)).p_value <= 0.05);
    }
    assert!(positive <= 4, "{positive} of 20");
    assert_eq!(shifted, 20, "a turned course does not share the moment");
}

#[test]
fn what_has_no_curve_is_counted_and_left_out() {
    let mut given = planted(3, 4, 6, 0.5, &mut Random::new(9));
    let whole = tested(&given, options(Surrogates::OtherClips, 99, 5));
    assert_eq!(
        whole,
        tested(&given, options(Surrogates::OtherClips, 99, 5)),
        "the same bits again"
    );
    // One play without a face, one of a face that never moves, and a person with neither.
    given.plays[0].track.iter_mut().for_each(|course| course.fill(f64::NAN));
    given.plays[1].track.iter_mut().for_each(|course| course.fill(0.25));
    given.people.push("nobody".to_owned());
    let found = tested(&given, options(Surrogates::OtherClips, 99, 5));
    assert_eq!((found.participants, found.n, found.dropped), (3, 10, 2));
    assert_eq!(found.each.iter().map(|own| own.plays).collect::<Vec<_>>(), [2, 4, 4]);
    // One person has no interval; nobody has no curve.
    given.plays.retain(|play| play.person == 1);
    assert_eq!(tested(&given, options(Surrogates::Shifted, 19, 5)).interval_95, None);
    given.plays.clear();
    assert_eq!(lagged_correlation(&given, options(Surrogates::Shifted, 19, 5)).unwrap(), None);
    assert!(lagged_correlation(&given, options(Surrogates::Shifted, 18, 5)).is_err());
}
