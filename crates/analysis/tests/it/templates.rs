//! Simulated people with templates: dynamic reverse correlation recovers them.

use mimique_adaptive::{Trajectory, TrajectoryDesign};
use mimique_analysis::{Template, TemplatePart, TemplatePeople};
use mimique_stats::{ReverseCorrelationOptions, ReverseTrial, ReverseTrials, Stream};

#[test]
fn templates_of_simulated_people_are_recovered_by_the_analysis() {
    let design = TrajectoryDesign::of_units(23);
    let mut stream = Stream::new(8, 0);
    // Trials of their own for everybody: in shared ones units that come together by chance would do so for all.
    let mut drawn = || -> Vec<Vec<Trajectory>> {
        (0..300).map(|_| design.draw(&mut || stream.unit()).unwrap()).collect()
    };
    let part = |unit, at_s| TemplatePart { unit, at_s };
    let template = |category: &str, parts: Vec<TemplatePart>| Template {
        category: category.to_owned(),
        parts,
    };
    let people = TemplatePeople {
        templates: vec![
            template("joy", vec![part(4, None), part(9, None)]),
            template("surprise", vec![part(0, Some(0.35)), part(17, Some(0.35))]),
        ],
        noise: 0.1,
        criterion: 0.2,
        otherwise: Some("other".to_owned()),
        seed: 5,
    };
    let categories = ["joy", "surprise", "other"];
    let mut all = Vec::new();
    for person in 0..16 {
        let trials = drawn();
        let answers = people.answers(person + 1, &trials);
        assert_eq!(answers, people.answers(person + 1, &trials));
        all.extend(trials.iter().zip(answers).map(|(courses, (category, intensity))| {
            ReverseTrial {
                person: person as usize,
                answer: categories.iter().position(|known| *known == category).unwrap(),
                intensity: Some(1.0 + 4.0 * intensity),
                courses: courses.clone(),
            }
        }));
    }
    let trials = ReverseTrials {
        people: (1..=16).map(|person| person.to_string()).collect(),
        categories: categories.map(str::to_owned).to_vec(),
        units: (0..23).map(|unit| unit.to_string()).collect(),
        trials: all,
        dropped: 0,
        answer_column: "answer".to_owned(),
    };
    let options = ReverseCorrelationOptions {
        bins: 25,
        duration_s: design.duration_s,
        permutations: 199,
        seed: 1,
    };
    let found = mimique_stats::reverse_correlation(&trials, options).unwrap();
    for (category, planted) in [(0, ["4", "9"]), (1, ["0", "17"])] {
        let group = found.categories[category].group.clone().ok().unwrap();
        let face: Vec<&str> = group.face.iter().map(|course| course.unit.as_str()).collect();
        assert_eq!(face, planted, "{}", categories[category]);
        for unit in group.units.iter().filter(|unit| planted.contains(&unit.unit.as_str())) {
            assert!(unit.intensity.is_some_and(|test| test.effect > 0.5 && test.p < 0.05));
        }
    }
    // Surprise was decided early: its units differ most there.
    let group = found.categories[1].group.clone().ok().unwrap();
    for unit in [0, 17] {
        let z = &group.units[unit].z;
        let best = (0..25).max_by(|a, b| z[*a].total_cmp(&z[*b])).unwrap();
        assert!((found.times_s[best] - 0.35).abs() <= 0.1, "{}", found.times_s[best]);
    }
}
