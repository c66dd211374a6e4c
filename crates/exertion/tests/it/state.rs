//! Heart, metabolism, breath, plan: laws, and the figures that the design expects of them.

use mimique_exertion::{
    Accumulated, Breathing, BreathingInput, Clip, ExertionError, Expression, Face, Heart, HeartLaw,
    HeartModel, Metabolism, Part, Person, PersonSpec, Plan, RecordedHeart, Series, Start, Window,
    fatigue, heart, heart_with,
};
use proptest::prelude::*;

fn person(level: f64) -> Person {
    Person::new(PersonSpec { level, ..PersonSpec::default() }).unwrap()
}

/// rcn after minutes of constant work.
fn after(level: f64, model: HeartModel, w: f64, minutes: f64) -> f64 {
    let work = vec![w; (60.0 * minutes) as usize + 1];
    *heart(&person(level), model, &work, 0.1).unwrap().last().unwrap()
}

fn near(got: f64, want: f64, by: f64) {
    assert!((got - want).abs() <= by, "{got}, not {want}");
}

#[test]
fn the_law_of_the_thesis_has_no_steady_state() {
    let w = HeartLaw::of_level(5.0).threshold + 5.0;
    for (minutes, want) in [(1.0, 0.54), (5.0, 0.84), (10.0, 0.91), (40.0, 0.98)] {
        near(after(5.0, HeartModel::Thesis, w, minutes), want, 0.011);
    }
    // 1 - rcn = g / (1 + k t g), the solution of the law in continuous time.
    let small = HeartLaw::of_level(5.0).threshold + 0.2;
    let k = HeartLaw::of_level(5.0).rise * 0.2;
    near(1.0 - after(5.0, HeartModel::Thesis, small, 20.0), 0.9 / (1.0 + k * 1200.0 * 0.9), 2e-4);
}

#[test]
fn work_at_the_threshold_changes_nothing() {
    let law = HeartLaw::of_level(3.0);
    let rcn = heart(&person(3.0), HeartModel::Thesis, &[law.threshold; 60], 0.37).unwrap();
    assert!(rcn.iter().all(|share| *share == 0.37));
}

#[test]
fn the_steady_heart_settles() {
    let person = person(5.0);
    for (w, want) in [(4.2, 95.0), (15.5, 165.0)] {
        near(person.heart_rate(after(5.0, HeartModel::Steady, w, 15.0)), want, 1.0);
    }
    // The first minute of recovery by the thesis, in beats: 20, 47, 71 at levels 0, 5, 10.
    for (level, want) in [(0.0, 20.0), (5.0, 47.0), (10.0, 71.0)] {
        let own = self::person(level);
        let rcn = heart(&own, HeartModel::Thesis, &[0.0; 61], 0.8).unwrap();
        near(own.heart_rate(0.8) - own.heart_rate(rcn[60]), want, 1.0);
    }
}

#[test]
fn epoc_gathers_and_goes() {
    let person = person(5.0);
    let at = |share: f64, minutes: usize| {
        // The share of VO2max by way of the heart.
        let rcn = (share * person.vo2_max() - 3.5) / (person.vo2_max() - 3.5);
        *Metabolism::of(&person, &vec![rcn; 60 * minutes + 1], 0.0).unwrap().epoc.last().unwrap()
    };
    for (share, ten, twenty) in [(0.5, 5.0, 8.0), (0.7, 20.0, 32.0), (1.0, 62.0, 99.0)] {
        near(at(share, 10), ten, 0.6);
        near(at(share, 20), twenty, 0.6);
    }
    let rest = Metabolism::of(&person, &[0.0; 60 * 14 + 1], 40.0).unwrap();
    near(rest.epoc[60 * 14], 20.0, 0.2);
    near(fatigue(30.0), 1.0 - 1.0 / std::f64::consts::E, 1e-12);
}

fn run(level: f64) -> (Person, Plan, Series) {
    let person = person(level);
    let work = Accumulated::of_phases(&[(15.5, 300.0)]).unwrap();
    let plan = Plan::of(Part { work, seconds: 300.0, rcn: None }).unwrap();
    let series = Series::of(&person, &plan, Heart::default(), Start::default()).unwrap();
    (person, plan, series)
}

/// Figure 3.8 of the thesis: five minutes of a run at levels 0, 5 and 10.
#[test]
fn five_minutes_of_a_run() {
    for (level, rcn, epoc, open, stretch) in [
        (0.0, 0.93, 22.0, 71.0, 64.0),
        (5.0, 0.87, 15.0, 63.0, 50.0),
        (10.0, 0.63, 4.0, 20.0, 32.0),
    ] {
        let (person, plan, series) = run(level);
        near(series.rcn[300], rcn, 0.006);
        near(series.metabolism.epoc[300], epoc, 0.6);
        let window = Window { seconds: [290.0, 300.0], rate_hz: 30.0 };
        let clip = Clip::of(&person, &plan, &series, &window, &Face::default()).unwrap();
        near(clip.curves[300].mouth_open, open, 2.0);
        near(clip.curves[300].mouth_stretch, stretch, 1.0);
        assert_eq!(series.near_maximum.is_some(), rcn > 0.9);
    }
}

#[test]
fn a_window_is_the_same_part_of_a_longer_one_but_for_the_breath() {
    let (person, plan, series) = run(5.0);
    let clip = |first: f64, last: f64| {
        let window = Window { seconds: [first, last], rate_hz: 60.0 };
        Clip::of(&person, &plan, &series, &window, &Face::default()).unwrap()
    };
    let (long, short) = (clip(100.0, 130.0), clip(110.0, 120.0));
    assert_eq!(short.times.len(), 601);
    for (long, short) in long.curves[600..].iter().zip(&short.curves) {
        let pairs = long.to_array().into_iter().zip(short.to_array());
        pairs.for_each(|(a, b)| near(a, b, 1e-9));
    }
    assert_eq!((short.table().frames[0], short.table().times[60]), (6600, 1.0));
    for window in [[-1.0, 5.0], [5.0, 5.0], [290.0, 300.5], [f64::NAN, 3.0]] {
        let window = Window { seconds: window, rate_hz: 60.0 };
        let refused = Clip::of(&person, &plan, &series, &window, &Face::default()).unwrap_err();
        assert_eq!(refused.place(), "window");
    }
}

#[test]
fn linear_curves_are_the_heart() {
    let (person, plan, series) = run(5.0);
    let window = Window { seconds: [100.0, 101.0], rate_hz: 10.0 };
    let face = Face { expression: Expression::Linear, ..Face::default() };
    let clip = Clip::of(&person, &plan, &series, &window, &face).unwrap();
    for (curves, features) in clip.curves.iter().zip(&clip.features) {
        assert_eq!(curves.to_array(), [100.0 * features.rcn; 4]);
    }
}

#[test]
fn a_plan_joins_its_parts() {
    let phases = |phases: &[(f64, f64)]| Accumulated::of_phases(phases).unwrap();
    let repeated = phases(&[(4.0, 1.5)]).repeated(true);
    let plan = Plan::new(vec![
        Part::rest(10.0),
        Part { work: repeated, seconds: 20.0, rcn: None },
        Part { work: phases(&[(30.0, 2.0)]), seconds: 5.5, rcn: Some(vec![0.2, 0.6, 0.7]) },
        Part { work: phases(&[(9.0, 100.0)]), seconds: 2.0, rcn: None },
    ])
    .unwrap();
    assert_eq!(plan.span_s(), 37.5);
    near(plan.at(10.0), 0.0, 1e-12);
    near(plan.at(30.0), 80.0, 1e-12);
    near(plan.at(31.0), 110.0, 1e-12);
    near(plan.at(35.5), 140.0, 1e-12);
    near(plan.at(37.5), 158.0, 1e-12);
    near(plan.at(1e9), 158.0, 1e-12);
    near(plan.w(30.5), 0.5 * 4.0 + 0.5 * 30.0, 1e-12);
    near(plan.p(10.0), 2.0, 1e-12);
    assert_eq!(plan.recorded_rcn(30.0), None, "a border belongs to what ends there");
    assert_eq!(plan.recorded_rcn(30.5), Some(0.4));
    assert_eq!(plan.recorded_rcn(35.0), Some(0.7));
    assert_eq!(plan.recorded_rcn(36.0), None);

    let person = person(5.0);
    let all = Series::of(&person, &plan, Heart::default(), Start::default()).unwrap();
    assert_eq!((all.seconds(), all.rcn[31], all.rcn[32]), (38, 0.6, 0.7));
    assert!(all.rcn[36] != 0.7, "the law goes on from the last recorded");
    let law = Heart::Law(HeartModel::Thesis);
    let modelled = Series::of(&person, &plan, law, Start::default()).unwrap();
    assert!(modelled.rcn[31] < 0.2);
    let refused = Series::of(&person, &plan, Heart::Recorded, Start::default()).unwrap_err();
    assert_eq!(
        refused,
        ExertionError::NoHeartRate { place: "heart".to_owned(), first: 0.0, last: 30.0 }
    );
}

#[test]
fn plans_that_are_none_are_refused() {
    let place = |parts: Vec<Part>| Plan::new(parts).unwrap_err().place().to_owned();
    assert_eq!(place(Vec::new()), "parts");
    assert_eq!(place(vec![Part::rest(5.0), Part::rest(0.0)]), "parts/1");
    assert_eq!(place(vec![Part::rest(f64::NAN)]), "parts/0");
    assert_eq!(place(vec![Part::rest(90_000.0)]), "parts");
    let heart = Part { rcn: Some(vec![0.5, 1.5]), ..Part::rest(2.0) };
    assert_eq!(place(vec![heart]), "parts/0/rcn");
}

/// Work that is negative by its convention cannot move the heart.
#[test]
fn negative_work_is_refused_where_it_is() {
    let work = Accumulated::of_knots(vec![0.0, 5.0, 8.0], vec![0.0, 20.0, 17.0]).unwrap();
    let plan = Plan::of(Part { work, seconds: 8.0, rcn: None }).unwrap();
    let refused = Series::of(&person(5.0), &plan, Heart::default(), Start::default()).unwrap_err();
    assert_eq!(refused.place(), "w/6");
}

fn constant(rcn: f64, fatigue: f64, seconds: usize, seed: Option<u64>) -> Breathing {
    let frames = 20 * seconds;
    let breaths = vec![12.0 + 43.0 * rcn; frames];
    Breathing::of(&BreathingInput {
        rate_hz: 20.0,
        phase0: 0.0,
        breaths: &breaths,
        rcn: &vec![rcn; frames],
        fatigue: &vec![fatigue; frames],
        seed,
    })
    .unwrap()
}

#[test]
fn strong_exhalations_and_swallows_come_as_often_as_they_should() {
    // 100 s of 55 breaths a minute: 91 breaths.
    let tired = constant(1.0, 0.8, 100, None);
    assert!((35..=37).contains(&tired.deep_starts.len()), "{}", tired.deep_starts.len());
    let swallows = tired.swallow_starts.len();
    assert!((7..=8).contains(&swallows), "{swallows}");
    for frame in &tired.swallow_starts {
        assert!(!tired.deep_starts.contains(frame), "nobody swallows while blowing");
    }
    let fresh = constant(1.0, 0.0, 100, None);
    assert!(fresh.deep_starts.is_empty() && fresh.exhale.iter().all(|e| *e == 0.0));
}

#[test]
fn irregular_breaths_hang_on_the_seed_alone_and_keep_their_number() {
    let [one, again, other, regular] =
        [Some(7), Some(7), Some(8), None].map(|seed| constant(0.5, 0.3, 600, seed));
    assert_eq!(one, again);
    assert_ne!(one.phase, other.phase);
    let ends = [&one, &other, &regular].map(|b| *b.phase.last().unwrap());
    for end in ends {
        near(end / ends[2], 1.0, 0.05);
    }
    // How long breaths take, from one whole number to the next.
    let lengths = |b: &Breathing| -> Vec<f64> {
        let whole: Vec<usize> =
            (1..b.phase.len()).filter(|&i| b.phase[i].floor() > b.phase[i - 1].floor()).collect();
        whole.windows(2).map(|w| (w[1] - w[0]) as f64).collect()
    };
    let spread = |all: &[f64]| {
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        (all.iter().map(|l| (l - mean) * (l - mean)).sum::<f64>() / all.len() as f64).sqrt() / mean
    };
    near(spread(&lengths(&one)), 0.15, 0.03);
    assert!(spread(&lengths(&regular)) < 0.03);
}

#[test]
fn breathing_that_is_none_is_refused_with_its_place() {
    let input = BreathingInput {
        rate_hz: 20.0,
        phase0: 0.0,
        breaths: &[12.0, 12.0],
        rcn: &[0.0, 0.0],
        fatigue: &[0.0, 0.0],
        seed: None,
    };
    let place = |input: BreathingInput<'_>| Breathing::of(&input).unwrap_err().place().to_owned();
    assert_eq!(place(BreathingInput { rate_hz: 0.0, ..input }), "rateHz");
    assert_eq!(place(BreathingInput { phase0: -0.5, ..input }), "phase0");
    assert_eq!(place(BreathingInput { breaths: &[12.0, -1.0], ..input }), "breaths/1");
    assert_eq!(place(BreathingInput { rcn: &[0.0], ..input }), "rcn");
    assert_eq!(place(BreathingInput { rcn: &[0.0, 1.1], ..input }), "rcn/1");
    assert_eq!(place(BreathingInput { fatigue: &[f64::NAN, 0.0], ..input }), "fatigue/0");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_heart_stays_within_its_reserve(
        level in 0.0..=10.0f64,
        rcn0 in 0.0..=1.0f64,
        w in prop::collection::vec(0.0..500.0f64, 1..200),
    ) {
        for model in [HeartModel::Thesis, HeartModel::Steady] {
            let rcn = heart(&person(level), model, &w, rcn0).unwrap();
            prop_assert!(rcn.iter().all(|share| (0.0..=1.0).contains(share)));
            prop_assert_eq!(rcn[0], rcn0);
            // Work is done now, the heart follows: a prefix of work has a prefix of hearts.
            let half = w.len().div_ceil(2);
            prop_assert_eq!(&heart(&person(level), model, &w[..half], rcn0).unwrap()[..], &rcn[..half]);
        }
    }

    #[test]
    fn more_work_never_slows_the_heart(
        w in prop::collection::vec(0.0..60.0f64, 1..60),
        more in 0.0..20.0f64,
    ) {
        for model in [HeartModel::Thesis, HeartModel::Steady] {
            let less = heart(&person(4.0), model, &w, 0.3).unwrap();
            let harder: Vec<f64> = w.iter().map(|own| own + more).collect();
            let own = heart(&person(4.0), model, &harder, 0.3).unwrap();
            prop_assert!(less.iter().zip(&own).all(|(a, b)| b >= a));
        }
    }

    #[test]
    fn breath_is_continuous_and_within_its_ends(
        rcn in prop::collection::vec(0.0..=1.0f64, 2..400),
        fatigue in 0.0..=1.0f64,
        seed in prop::option::of(any::<u64>()),
    ) {
        let breaths: Vec<f64> = rcn.iter().map(|share| 12.0 + 43.0 * share).collect();
        let b = Breathing::of(&BreathingInput {
            rate_hz: 60.0, phase0: 0.3, breaths: &breaths, rcn: &rcn,
            fatigue: &vec![fatigue; rcn.len()], seed,
        }).unwrap();
        let unit = |values: &[f64]| values.iter().all(|v| (0.0..=1.0).contains(v));
        prop_assert!(unit(&b.volume) && unit(&b.exhale) && unit(&b.swallow));
        prop_assert!(b.flow.iter().all(|v| (-1.0..=1.0).contains(v)));
        prop_assert!(b.phase.is_sorted());
    }

    #[test]
    fn a_recorded_heart_is_taken_where_it_was_recorded(
        w in prop::collection::vec(0.0..60.0f64, 20),
        recorded in prop::collection::vec(prop::option::of(0.0..=1.0f64), 20),
    ) {
        let own = heart_with(&person(5.0), HeartModel::Thesis, &w, 0.1, &recorded).unwrap();
        for (got, recorded) in own.iter().zip(&recorded) {
            prop_assert!(recorded.is_none_or(|recorded| recorded == *got));
        }
    }
}

#[test]
fn a_recorded_heart_is_brought_to_seconds() {
    let person = person(5.0);
    let found = RecordedHeart::of(&person, &[3.0, 3.5, 6.0], &[70.0, 100.0, 250.0]).unwrap();
    assert_eq!(found.heart_rate, [70.0, 130.0, 190.0, 250.0]);
    assert_eq!(found.rcn, [0.0, 0.5, 1.0, 1.0]);
}
