use mimique_adaptive::{Trajectory, TrajectoryDesign};

use super::*;
use crate::numerics::random::Stream;

/// Random courses of people who answer at random, but for what `answer` makes of the courses.
fn study(
    [people, trials, units]: [usize; 3],
    seed: u64,
    answer: impl Fn(&[Trajectory], &mut Stream) -> (usize, Option<f64>),
) -> ReverseTrials {
    let design = TrajectoryDesign::of_units(units);
    let mut stream = Stream::new(seed, 0);
    let mut all = Vec::new();
    for person in 0..people {
        for _ in 0..trials {
            let courses = design.draw(&mut || stream.unit()).unwrap();
            let (answer, intensity) = answer(&courses, &mut stream);
            all.push(ReverseTrial { person, answer, intensity, courses });
        }
    }
    ReverseTrials {
        people: (0..people).map(|k| format!("p{k}")).collect(),
        categories: ["joy", "anger", "other"].map(str::to_owned).to_vec(),
        units: (0..units).map(|k| format!("AU{k:02}")).collect(),
        trials: all,
        dropped: 0,
        answer_column: "answer".to_owned(),
    }
}

fn options(bins: usize, permutations: usize) -> ReverseCorrelationOptions {
    ReverseCorrelationOptions { bins, duration_s: 1.25, permutations, seed: 3 }
}

fn group(found: &ReverseCorrelation, category: usize) -> GroupImage {
    found.categories[category].group.clone().ok().unwrap()
}

/// Joy is unit 2 that is high late, anger unit 5 that is high early; all else is answered at random.
fn planted(courses: &[Trajectory], stream: &mut Stream) -> (usize, Option<f64>) {
    let height = |unit: usize, time: f64| {
        courses
            .iter()
            .filter(|course| course.unit == unit)
            .map(|course| course.at(time))
            .sum::<f64>()
    };
    if stream.unit() < 0.2 {
        return (stream.below(3), Some(1.0 + stream.below(5) as f64));
    }
    let strong = |unit: usize, noise: f64| {
        let amplitude: f64 =
            courses.iter().filter(|course| course.unit == unit).map(|c| c.amplitude).sum();
        Some((1.0 + 4.0 * amplitude + noise).round())
    };
    let noise = stream.unit() - 0.5;
    if height(2, 0.9) > 0.25 {
        (0, strong(2, noise))
    } else if height(5, 0.3) > 0.25 {
        (1, strong(5, noise))
    } else {
        (2, Some(1.0 + stream.below(5) as f64))
    }
}

#[test]
fn planted_units_and_times_are_recovered_and_no_others() {
    let trials = study([12, 240, 10], 1, planted);
    let found = reverse_correlation(&trials, options(25, 299)).unwrap();
    for (category, unit, early) in [(0, 2, false), (1, 5, true)] {
        let group = group(&found, category);
        let faces: Vec<&str> = group.face.iter().map(|course| course.unit.as_str()).collect();
        assert_eq!(faces, [format!("AU{unit:02}")]);
        let image = &group.units[unit];
        let best = (0..25).max_by(|a, b| image.z[*a].total_cmp(&image.z[*b])).unwrap();
        let time = found.times_s[best];
        assert!((time - if early { 0.3 } else { 0.9 }).abs() < 0.1, "{category}: {time}");
        // The face in mind peaks there, too; at the other end of the clip it does not differ.
        let course = &group.face[0].activation;
        let highest = (0..25).max_by(|a, b| course[*a].total_cmp(&course[*b])).unwrap();
        assert!((found.times_s[highest] - time).abs() < 0.15);
        assert!(image.p[best] <= 1.0 / 300.0 + 1e-12);
        assert!(image.p[if early { 24 } else { 0 }] > 0.05);
        assert!(image.difference[best] > 0.1 && image.t[best].unwrap() > 5.0);
        assert!(image.people >= 10 && image.information_bits > 0.05);
        let intensity = image.intensity.unwrap();
        assert!(intensity.p < 0.01 && (0.3..5.0).contains(&intensity.effect), "{intensity:?}");
        // The other category's unit is weaker here, if anything; a third unit is nothing.
        for (other, image) in group.units.iter().enumerate().filter(|(k, _)| *k != unit) {
            assert!(image.z.iter().all(|z| *z < group.critical_z), "{other}");
            assert!(other == 2 || other == 5 || image.p.iter().all(|p| *p > 0.05), "{other}");
        }
    }
}

#[test]
fn without_dependence_one_image_in_twenty_has_a_significant_cell() {
    let rounds = 400;
    let mut wrong = [0; 2];
    for seed in 0..rounds {
        let trials = study([4, 30, 5], 1000 + seed, |_, stream| (stream.below(2), None));
        let found =
            reverse_correlation(&trials, ReverseCorrelationOptions { seed, ..options(6, 99) });
        let group = group(&found.unwrap(), 0);
        wrong[0] += usize::from(group.units.iter().any(|unit| unit.p.iter().any(|p| *p <= 0.05)));
        wrong[1] += usize::from(group.units.iter().any(|unit| unit.presence.p <= 0.05));
    }
    // 20 of 400 are expected, standard deviation 4.4. Presence has few values, so that ties make it stricter.
    assert!((8..=33).contains(&wrong[0]), "{wrong:?}");
    assert!((5..=33).contains(&wrong[1]), "{wrong:?}");
}

#[test]
fn null_intensities_are_not_told_apart() {
    let mut wrong = 0;
    for seed in 0..200 {
        let trials = study([4, 40, 4], 5000 + seed, |_, stream| {
            (stream.below(2), Some(1.0 + stream.below(7) as f64))
        });
        let found =
            reverse_correlation(&trials, ReverseCorrelationOptions { seed, ..options(2, 99) });
        let group = group(&found.unwrap(), 1);
        let low = |unit: &UnitImage| unit.intensity.is_some_and(|test| test.p <= 0.05);
        wrong += usize::from(group.units.iter().any(low));
    }
    // 10 of 200 are expected, standard deviation 3.1.
    assert!((2..=20).contains(&wrong), "{wrong}");
}

#[test]
fn images_do_not_depend_on_the_order_of_trials_and_z_is_the_correlation() {
    let trials = study([3, 60, 6], 9, planted);
    let mut turned = trials.clone();
    turned.trials.reverse();
    let found = reverse_correlation(&trials, options(10, 19)).unwrap();
    let again = reverse_correlation(&turned, options(10, 19)).unwrap();
    for (a, b) in found.categories.iter().zip(&again.categories) {
        assert_eq!((a.answers, a.people), (b.answers, b.people));
        for (a, b) in a.each.iter().zip(&b.each) {
            let pairs = a.z.iter().zip(&b.z).chain(a.difference.iter().zip(&b.difference));
            pairs.for_each(|(a, b)| assert!((a - b).abs() < 1e-10, "{a} {b}"));
        }
    }
    // By hand: the second person's correlation of unit 2 in bin 7 with the answer "joy".
    let own: Vec<&ReverseTrial> = trials.trials.iter().filter(|trial| trial.person == 1).collect();
    let x: Vec<f64> = own
        .iter()
        .map(|trial| {
            let course = trial.courses.iter().find(|course| course.unit == 2);
            course.map_or(0.0, |course| course.at(7.5 * 0.125))
        })
        .collect();
    let y: Vec<f64> = own.iter().map(|trial| f64::from(u8::from(trial.answer == 0))).collect();
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let (mx, my) = (mean(&x), mean(&y));
    let product = |a: &[f64], ma: f64, b: &[f64], mb: f64| {
        a.iter().zip(b).map(|(a, b)| (a - ma) * (b - mb)).sum::<f64>()
    };
    let r = product(&x, mx, &y, my) / (product(&x, mx, &x, mx) * product(&y, my, &y, my)).sqrt();
    let image = &found.categories[0].each[1];
    assert!((image.z[2 * 10 + 7] - r * 59.0_f64.sqrt()).abs() < 1e-10);
    let so: Vec<f64> = x.iter().zip(&y).filter(|(_, y)| **y == 1.0).map(|(x, _)| *x).collect();
    let not: Vec<f64> = x.iter().zip(&y).filter(|(_, y)| **y == 0.0).map(|(x, _)| *x).collect();
    assert!((image.difference[27] - (mean(&so) - mean(&not))).abs() < 1e-12);
}

#[test]
fn who_always_answers_the_same_has_no_image_and_one_category_is_refused() {
    let mut trials = study([3, 20, 4], 2, |_, stream| (stream.below(2), None));
    trials.trials.iter_mut().filter(|trial| trial.person == 0).for_each(|trial| trial.answer = 1);
    let found = reverse_correlation(&trials, options(4, 19)).unwrap();
    assert_eq!(found.categories[0].people, 2);
    assert!(found.categories[0].each.iter().all(|image| image.participant != "p0"));
    assert!(found.categories[2].group.reason().is_some(), "nobody answered \"other\"");
    trials.trials.iter_mut().for_each(|trial| trial.answer = 1);
    let error = reverse_correlation(&trials, options(4, 19)).unwrap_err().to_string();
    assert!(error.contains("column \"answer\": only one level (\"anger\")"), "{error}");
}

#[test]
fn rows_make_trials_and_bad_rows_are_named() {
    let head = "who,trial,said,unit,from,top,to,height,strong\n";
    let good =
        "a,1,joy,AU12,0,0.5,1,0.8,3\na,1,joy,AU06,0.1,0.4,1,0.5,3\na,2,anger,AU04,0,0.2,1,1,5\n";
    let read = |text: &str| {
        let table = crate::Table::parse(text.as_bytes()).unwrap();
        let f = |name: &str| table.factor(name).unwrap();
        let n = |name: &str| table.numbers(name).unwrap();
        ReverseTrials::of(
            [&f("who"), &f("trial"), &f("said"), &f("unit")],
            [&n("from"), &n("top"), &n("to"), &n("height")],
            None,
            Some(&n("strong")),
        )
    };
    let trials = read(&format!("{head}{good}")).unwrap();
    assert_eq!(trials.units, ["AU04", "AU06", "AU12"]);
    assert_eq!((trials.trials.len(), trials.trials[0].courses.len()), (2, 2));
    assert_eq!((trials.trials[1].intensity, trials.latest_offset_s()), (Some(5.0), 1.0));
    let unanswered = read(&format!("{head}{good}a,3,,AU12,0,0.5,1,0.8,\n")).unwrap();
    assert_eq!((unanswered.trials.len(), unanswered.dropped), (2, 1));
    for (row, says) in [
        ("a,2,joy,AU12,0,0.5,1,0.8,5\n", "trial \"2\" of \"a\": its rows differ"),
        ("a,2,anger,AU04,0,0.5,1,0.8,5\n", "\"AU04\" is in two rows"),
        ("a,2,,AU12,0,0.5,1,0.8,5\n", "its rows differ"),
        ("a,3,joy,AU12,0,0.5,1,,3\n", "row 4: no course"),
        ("a,3,joy,,0,0.5,1,0.8,3\n", "row 4: no course"),
        ("a,3,joy,AU12,0.6,0.5,1,0.8,3\n", "row 4: no course"),
        ("a,3,joy,AU12,0.1,0.5,1,1.5,3\n", "row 4: no course"),
    ] {
        let error = read(&format!("{head}{good}{row}")).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
}
