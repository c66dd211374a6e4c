//! Intervals of worths by Bradley and Terry's model: how often they hold what was planted.

use mimique_stats::{
    BradleyTerryOptions, Chosen, Compared, Outcome, PairedComparisons, WorthEstimates,
    bradley_terry,
};
use mimique_test_support::Random;

const WORTHS: [f64; 4] = [0.6, 0.2, -0.2, -0.6];
/// How much participants differ in the worths.
const PERSON_SD: f64 = 0.7;

/// Every pair in both orders, twice, of participants who differ.
fn answers(participants: usize, random: &mut Random) -> PairedComparisons {
    let mut answers = Vec::new();
    for participant in 0..participants {
        let worths = WORTHS.map(|worth| worth + PERSON_SD * random.normal());
        for _ in 0..2 {
            for left in 0..4 {
                for right in (0..4).filter(|right| *right != left) {
                    let is_left =
                        random.uniform() < 1.0 / (1.0 + (worths[right] - worths[left]).exp());
                    let chosen = if is_left { Chosen::Left } else { Chosen::Right };
                    answers.push(Compared { participant, left, right, chosen });
                }
            }
        }
    }
    PairedComparisons {
        items: ["a", "b", "c", "d"].map(str::to_owned).into(),
        participants: (0..participants).map(|own| own.to_string()).collect(),
        answers,
        dropped: 0,
    }
}

fn estimates(data: &PairedComparisons) -> WorthEstimates {
    let options =
        BradleyTerryOptions { side: Some(false), fit_rounds: 0, ..BradleyTerryOptions::default() };
    match bradley_terry(data, &options).unwrap().estimates {
        Outcome::Ok(found) => found,
        Outcome::Undefined { reason } => panic!("{reason}"),
    }
}

/// The share of intervals of worths and of differences that hold the value of the population, with the participants of a
/// small study. Percentile intervals of resampled participants held 90 to 93 % of them.
#[test]
fn intervals_hold_the_value_of_the_population_in_95_of_100_studies() {
    let mut random = Random::new(11);
    // What the model says of everybody: differences between people draw its worths towards 0.
    let population = estimates(&answers(20_000, &mut random)).worth;
    for participants in [15, 40] {
        let studies = 500;
        let (mut worths, mut differences, mut agree) = (0, 0, true);
        for _ in 0..studies {
            let found = estimates(&answers(participants, &mut random));
            let intervals = found.worth_interval.as_ref().unwrap();
            worths += usize::from((intervals[0][0]..=intervals[0][1]).contains(&population[0]));
            // The third contrast is that of the first and the last item.
            let contrast = &found.contrasts[2];
            let truth = 1.0 / (1.0 + (population[3] - population[0]).exp());
            let [low, high] = contrast.preferred_interval.unwrap();
            differences += usize::from((low..=high).contains(&truth));
            for contrast in &found.contrasts {
                let [low, high] = contrast.preferred_interval.unwrap();
                agree &= (contrast.p.unwrap() < 0.05) != (low..=high).contains(&0.5);
            }
        }
        assert!(agree, "an interval leaves out one half where p < .05, and only there");
        for (of, held) in [("worths", worths), ("differences", differences)] {
            let share = held as f64 / f64::from(studies);
            eprintln!("{participants} participants: {:.1} % of {of}", 100.0 * share);
            assert!((0.925..0.975).contains(&share), "{participants} participants, {of}: {share}");
        }
    }
}
