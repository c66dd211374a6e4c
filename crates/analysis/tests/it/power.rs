//! Power against what is known: the false positives of tests that take trials for independent, and the
//! power of a test whose distribution is known.

use mimique_analysis::{
    ClipScope, EffectUnit, Parameters, Power, PowerOptions, PrecisionPoint, Preregistration,
    as_predicted, power, power_markdown, power_runs, precision_csv, preregistration,
};
use mimique_locale::Language;
use mimique_study::{Generalise, StraightLining, Study};
use serde_json::Value;

fn study(name: &str) -> (Study, String) {
    let path = format!("{}/../../study-config/{name}", env!("CARGO_MANIFEST_DIR"));
    let value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    (Study::from_value(&value).unwrap(), mimique_study::config_hash(&value))
}

/// The study and the parameters of `study-config/power`.
fn independence() -> (Study, String, Parameters) {
    let (study, hash) = study("power/independence.json");
    let path = format!(
        "{}/../../study-config/power/independence.parameters.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(path).unwrap();
    let parameters = Parameters::read_over(&Parameters::for_study(&study), &text, &study).unwrap();
    (study, hash, parameters)
}

fn options(participants: &[usize], runs: usize) -> PowerOptions {
    PowerOptions {
        participants: participants.to_vec(),
        clips: Vec::new(),
        runs,
        seed: 20_261_121,
        alpha: 0.05,
        false_positives: false,
        mixed: false,
    }
}

/// STATISTICS.md: 27 participants, 54 clips, no effect; the standard deviation of how people take to a
/// method is 0, 0.3, 0.6. Trial-level Kruskal-Wallis finds 2, 19, 48 %, and about 60 % for a trait of the
/// person; the tests of one value a person 4 to 6 %.
#[test]
fn trials_taken_for_independent_find_what_is_not_there() {
    let (study, hash, mut parameters) = independence();
    for (taste, expected) in [(0.0, 0.02), (0.3, 0.19), (0.6, 0.48)] {
        parameters.ratings.get_mut("rating").unwrap().person_by_sd.insert("method".into(), taste);
        let result = power(&study, &hash, &parameters, &options(&[27], 2000), &|| {}).unwrap();
        let point = &result.points[0];
        assert_eq!((point.participants, point.clips, point.people_used), (27, 54, 27.0));
        let [method, group] = point.hypotheses.as_slice() else { panic!("two hypotheses") };
        let share = method.power.as_in_the_thesis.share;
        assert!((share - expected).abs() < 0.03, "method, sd {taste}: {share}");
        let share = method.power.deciding.share;
        assert!((0.04..=0.06).contains(&share), "method, recommended, sd {taste}: {share}");
        let share = group.power.as_in_the_thesis.share;
        assert!((share - 0.6).abs() < 0.05, "group, sd {taste}: {share}");
        let share = group.power.deciding.share;
        assert!((0.035..=0.06).contains(&share), "group, recommended, sd {taste}: {share}");
    }
}

#[test]
fn is_the_same_on_any_number_of_threads() {
    let (study, hash, parameters) = independence();
    let run = |threads: usize| -> Power {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| power(&study, &hash, &parameters, &options(&[8, 12], 20), &|| {})).unwrap()
    };
    assert_eq!(run(1), run(3));
}

/// A difference of 0.5 points with noise 1, no thresholds to speak of and no tastes: the paired test of n
/// people with m trials a level has about the power of a t test with noncentrality
/// 0.5 / sqrt(2 / m) * sqrt(n), times the signed rank test's efficiency 3 / pi.
#[test]
fn power_is_that_of_the_paired_test() {
    let (mut study, hash) = study("demo.json");
    study.hypotheses.iter_mut().for_each(|own| own.generalise = Some(Generalise::TheseClips));
    let mut parameters = Parameters::for_study(&study);
    parameters.dropout =
        mimique_analysis::Dropout { declined: 0.0, per_trial: 0.0, withdrawn: 0.0 };
    parameters.careless.share = 0.0;
    let rating = parameters.ratings.get_mut("believability").unwrap();
    rating.mean = 4.0;
    rating.person_by_sd.clear();
    (rating.person_sd, rating.segment_sd, rating.clip_sd) = (0.5, 0.0, 0.0);
    rating.interactions.clear();
    let shifts = [("lsts30", 0.25), ("box", -0.25)].map(|(level, shift)| (level.to_owned(), shift));
    rating.effects = [("method".to_owned(), shifts.into_iter().collect())].into_iter().collect();
    let result = power(&study, &hash, &parameters, &options(&[12, 20], 1500), &|| {}).unwrap();
    for point in &result.points {
        let h3 = &point.hypotheses[2];
        assert_eq!(h3.id, "H3");
        // Noise of a rating: 1 and rounding's 1/12; 6 trials a method.
        let per_person = (2.0 * (1.0 + 1.0 / 12.0) / 6.0_f64).sqrt();
        let effective = point.participants as f64 * 3.0 / std::f64::consts::PI;
        let noncentrality = 0.5 / per_person * effective.sqrt();
        let degrees = point.participants as f64 - 1.0;
        let critical = mimique_stats::t_quantile_upper(0.025, degrees);
        // Normal approximation of the noncentral t (Johnson and Kotz 1970, 31.3).
        let z = (critical * (1.0 - 1.0 / (4.0 * degrees)) - noncentrality)
            / (1.0 + critical * critical / (2.0 * degrees)).sqrt();
        let expected = mimique_stats::normal_upper(z).p;
        let found = h3.power.deciding.share;
        assert!(
            (found - expected).abs() < 0.05,
            "{} people: {found}, {expected}",
            point.participants
        );
    }
    assert!(
        result.points[1].hypotheses[2].power.deciding.share
            > result.points[0].hypotheses[2].power.deciding.share
    );
}

#[test]
fn the_smallest_difference_is_detected_four_times_in_five() {
    let (mut study, hash) = study("power/verdicts.json");
    study.hypotheses.truncate(1);
    let mut parameters = Parameters::for_study(&study);
    parameters.careless.share = 0.0;
    let rating = parameters.ratings.get_mut("rating").unwrap();
    (rating.mean, rating.noise_sd, rating.clip_sd) = (4.0, 1.0, 0.2);
    rating.interactions.clear();
    rating.effects.clear();
    let options = PowerOptions { clips: vec![24], ..options(&[20], 60) };
    let none = power(&study, &hash, &parameters, &options, &|| {}).unwrap();
    let found = &none.points[0].hypotheses[0];
    assert_eq!(found.scope, ClipScope::Others);
    let smallest = found.smallest_difference.unwrap();
    assert_eq!(smallest.unit, EffectUnit::Points);
    let rating = parameters.ratings.get_mut("rating").unwrap();
    let half = smallest.value / 2.0;
    let shifts = [("lsts30", half), ("box", -half)].map(|(level, own)| (level.to_owned(), own));
    rating.effects = [("method".to_owned(), shifts.into_iter().collect())].into_iter().collect();
    let options = PowerOptions { runs: 500, ..options };
    let with = power(&study, &hash, &parameters, &options, &|| {}).unwrap();
    let share = with.points[0].hypotheses[0].power.deciding.share;
    // Four standard errors of 500 runs and the average of the standard errors.
    assert!((share - 0.8).abs() < 0.09, "{share} at {}", smallest.value);
}

#[test]
fn without_effects_there_is_none_left() {
    let (study, hash) = study("demo.json");
    let mut parameters = Parameters::for_study(&study);
    for rating in parameters.ratings.values_mut() {
        (rating.segment_sd, rating.clip_sd) = (0.0, 0.0);
    }
    let recognition = parameters.recognition.get_mut("emotion").unwrap();
    (recognition.segment_sd, recognition.clip_sd) = (0.0, 0.0);
    let mut options = options(&[30], 800);
    options.false_positives = true;
    let result = power(&study, &hash, &parameters, &options, &|| {}).unwrap();
    for hypothesis in &result.points[0].hypotheses {
        let rate = hypothesis.false_positives.unwrap().deciding;
        // 5 % with a standard error of 0.8 %; the exact tests stay below.
        assert!((0.015..0.08).contains(&rate.share), "{}: {}", hypothesis.id, rate.share);
        // The aligned rank transform of an interaction, and exact tests, stay near what they say.
        assert!(rate.interval[0] < rate.share && rate.share < rate.interval[1]);
    }
    let believability = &result.points[0].hypotheses[2];
    assert!(believability.power.deciding.share > 0.3, "{believability:?}");
}

/// Where the parameters hold no effect (a typed number never has one), the share of positive tests is no
/// power, and nobody is told how many people have enough of it.
#[test]
fn without_an_effect_in_the_parameters_nothing_is_called_power() {
    let path = format!("{}/../../study-config/demo.json", env!("CARGO_MANIFEST_DIR"));
    let mut value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    value["questions"].as_array_mut().unwrap().push(serde_json::json!(
        { "id": "years", "type": "number", "prompt": { "en": "How old?", "fr": "Quel âge\u{a0}?" } }
    ));
    value["components"]["faces"]["questions"].as_array_mut().unwrap().push("years".into());
    let hypotheses = value["hypotheses"].as_array_mut().unwrap();
    let (mut years, mut time) = (hypotheses[1].clone(), hypotheses[1].clone());
    (years["id"], years["response"]) = ("HY".into(), "years".into());
    (time["id"], time["measure"]) = ("HT".into(), "rt".into());
    hypotheses.extend([years, time]);
    let study = Study::from_value(&value).unwrap();
    let hash = mimique_study::config_hash(&value);
    let mut parameters = Parameters::for_study(&study);
    let effects = |parameters: &Parameters| -> Vec<bool> {
        study.hypotheses.iter().map(|each| parameters.has_effect(&study, each)).collect()
    };
    assert_eq!(effects(&parameters), [true, true, true, true, false, true]);
    assert_eq!(effects(&parameters.without_effects(&study)), [false; 6]);
    let believability = parameters.ratings.get_mut("believability").unwrap();
    believability.effects.clear();
    believability.interactions.clear();
    assert_eq!(effects(&parameters), [true, true, false, false, false, true]);

    let result = power(&study, &hash, &parameters, &options(&[10], 2), &|| {}).unwrap();
    let note = "hold no effect of its factors on its response";
    let table = power_markdown(&result, Language::English);
    assert_eq!(table.matches(note).count(), 3);
    assert!(table.contains("**HY**, for other clips\n\nThe parameters hold no effect"), "{table}");
    let curve = mimique_analysis::power_curve(&result, Language::English);
    assert_eq!(curve.matches("no effect in the parameters").count(), 3);
}

#[test]
fn refuses_what_cannot_be() {
    let (study, hash) = study("demo.json");
    let parameters = Parameters::for_study(&study);
    let refused = |options: &PowerOptions| {
        power(&study, &hash, &parameters, options, &|| {}).unwrap_err().to_string()
    };
    assert!(refused(&options(&[1], 10)).starts_with("participants: 1 is not possible; give 2 to"));
    assert!(refused(&options(&[10], 0)).starts_with("runs: 0 is not possible"));
    let mut none = study.clone();
    none.hypotheses.clear();
    let error = power(&none, &hash, &parameters, &options(&[10], 1), &|| {}).unwrap_err();
    assert!(error.to_string().starts_with("/hypotheses: the study has none"));
}

#[test]
fn preregistration_says_what_the_file_says() {
    for (language, words) in [
        (
            "en",
            [
                "## Sampling plan",
                "H4",
                "Holm’s correction over the 4 hypotheses",
                "people who do not finish",
                "in more than 12 trials in a row (counted for each of `emotion`, `perceived_intensity`, `believability`)",
                "aligned rank transform",
            ],
        ),
        (
            "fr",
            [
                "## Échantillon",
                "H4",
                "correction de Holm sur les 4 hypothèses",
                "les personnes qui ne terminent pas",
                "dans plus de 12 essais de suite",
                "rangs alignés",
            ],
        ),
    ] {
        let (mut study, hash) = study("demo.json");
        let rule = StraightLining { longest_run: 12, questions: Vec::new() };
        study.exclusions.get_or_insert_default().straight_lining = Some(rule);
        let parameters = Parameters::for_study(&study);
        let power = power(&study, &hash, &parameters, &options(&[10], 4), &|| {}).unwrap();
        let text = preregistration(&Preregistration {
            study: &study,
            config_hash: &hash,
            power: &power,
            parameters: &parameters,
            language: Language::from_code(language).unwrap(),
            curve: Some("curve.svg"),
        });
        for part in words.into_iter().chain([hash.as_str(), "](curve.svg)"]) {
            assert!(text.contains(part), "{language}: {part}\n{text}");
        }
        for hypothesis in &study.hypotheses {
            assert!(text.contains(hypothesis.statement.in_language(language)));
        }
        assert!(!text.contains("?condition="), "{text}");
        // The parameters can be read again.
        let json = text.split("```json").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
        let read: Value = serde_json::from_str(json).unwrap();
        assert_eq!(read, serde_json::to_value(&parameters).unwrap());
    }
}

#[test]
fn the_questions_of_aspredicted_are_answered_from_the_study_file() {
    let (study, hash) = study("demo.json");
    let parameters = Parameters::for_study(&study);
    let power = power(&study, &hash, &parameters, &options(&[10], 4), &|| {}).unwrap();
    let from = Preregistration {
        study: &study,
        config_hash: &hash,
        power: &power,
        parameters: &parameters,
        language: Language::from_code("fr").unwrap(),
        curve: Some("curve.svg"),
    };
    let text = as_predicted(&from);
    let questions: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("## ")?.split_once(')'))
        .map(|(number, _)| number)
        .collect();
    assert_eq!(questions, ["1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11"]);
    let field = |number: usize| {
        let begin = text.find(&format!("## {number}) ")).unwrap();
        let end = text.find(&format!("## {}) ", number + 1)).unwrap_or(text.len());
        &text[begin..end]
    };
    for hypothesis in &study.hypotheses {
        assert!(field(2).contains(hypothesis.statement.in_language("en")));
        assert!(field(5).contains(&format!("- **{}**", hypothesis.id)));
    }
    for (number, part) in [
        (1, "no data have been collected"),
        (3, "- `believability`: "),
        (4, "Each participant sees 12 trials."),
        (4, "seed"),
        (5, "Holm’s correction over the 4 hypotheses"),
        (6, "people who do not finish"),
        (6, "Nothing is imputed."),
        (7, "Collection stops when"),
        (8, "exploratory"),
        (8, &*hash),
        (9, study.study_metadata.title.in_language("en")),
    ] {
        assert!(field(number).contains(part), "{number}: {part}\n{text}");
    }
    assert!(!text.contains("curve.svg"), "its fields take text alone");
    assert!(!text.contains("Échantillon") && !text.contains("personnes"), "it is English");
    assert!(!text.contains("\n### "), "what stands in a field has no headings");
}

#[test]
fn a_preregistration_says_the_conditions_between_participants() {
    let path = format!("{}/../../study-config/demo.json", env!("CARGO_MANIFEST_DIR"));
    let mut value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    value["sequence"] = serde_json::json!({ "order": "fixed", "components": [
        { "id": "shown", "conditional": true, "order": "random", "components": ["faces"] },
        { "id": "control", "conditional": true, "order": "fixed", "components": [] },
    ] });
    let study = Study::from_value(&value).unwrap();
    let hash = mimique_study::config_hash(&value);
    let parameters = Parameters::for_study(&study);
    let power = power(&study, &hash, &parameters, &options(&[10], 4), &|| {}).unwrap();
    let text = preregistration(&Preregistration {
        study: &study,
        config_hash: &hash,
        power: &power,
        parameters: &parameters,
        language: Language::from_code("en").unwrap(),
        curve: None,
    });
    for part in [
        "Between participants: the condition `shown`, of 12 trials.",
        "Between participants: the condition `control`, of 0 trials.",
        "Each participant sees those of one condition.",
        "- `shown` (only in this condition): `faces` in an order drawn for each participant",
        "- `control` (only in this condition): nothing",
        "(`?condition=`)",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

/// The precision of the one block of a study of `study-config`, with so many people.
fn precision_of(
    name: &str,
    change: impl FnOnce(&mut Value),
    people: &[usize],
    runs: usize,
) -> Vec<PrecisionPoint> {
    let path = format!("{}/../../study-config/{name}", env!("CARGO_MANIFEST_DIR"));
    let mut value = mimique_study::parse(&std::fs::read_to_string(path).unwrap()).unwrap();
    change(&mut value);
    let study = Study::from_value(&value).unwrap();
    let mut parameters = Parameters::for_study(&study);
    (parameters.dropout.declined, parameters.dropout.per_trial) = (0.0, 0.0);
    parameters.careless.share = 0.0;
    let options = PowerOptions {
        participants: people.to_vec(),
        clips: vec![],
        runs,
        seed: 5,
        alpha: 0.05,
        false_positives: false,
        mixed: false,
    };
    let counted = std::sync::atomic::AtomicU64::new(0);
    let count = || {
        counted.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let found = power(&study, "hash", &parameters, &options, &count).unwrap();
    assert_eq!(counted.into_inner(), power_runs(&study, &options), "progress comes to its end");
    for language in [Language::English, Language::French] {
        let table = power_markdown(&found, language);
        assert_eq!(
            table.lines().filter(|line| line.starts_with("| ")).count(),
            1 + 3 * people.len()
        );
    }
    let text = preregistration(&Preregistration {
        study: &study,
        config_hash: "hash",
        power: &found,
        parameters: &parameters,
        language: Language::English,
        curve: None,
    });
    assert!(text.contains("No hypothesis is tested") && text.contains("simulated studies per row"));
    assert!(!text.contains("Each statement says"), "{text}");
    let [block] = &found.precision[..] else { panic!("{:?}", found.precision) };
    assert_eq!(precision_csv(&found).lines().count(), 1 + block.points.len());
    block.points.clone()
}

#[test]
fn intervals_of_thresholds_and_scales_narrow_with_trials_and_people() {
    let trials = |value: &mut Value| {
        value["components"]["limit"]["trials"] = 20.into();
        value["hypotheses"] = serde_json::json!([]);
    };
    let limit = precision_of("jnd-alpha.json", trials, &[5, 18], 5);
    let of = |points: &[PrecisionPoint], trials, participants| {
        let found = points.iter().find(|it| (it.trials, it.participants) == (trials, participants));
        found.unwrap().clone()
    };
    let width = |trials, people| of(&limit, trials, people).width.unwrap();
    assert!(width(20, 18) < 0.75 * width(20, 5), "{limit:?}");
    // Few trials leave everybody near the middle of the levels: the mean is narrow, and of people little is known.
    let error = |trials| of(&limit, trials, 18).error.unwrap();
    assert!(error(40) < 0.8 * error(10), "{limit:?}");
    assert!(
        limit.iter().all(|point| point.found > 0.75 && point.found_falsely.is_none()),
        "{limit:?}"
    );
    let scale = precision_of(
        "scale-alpha.json",
        |value| value["hypotheses"] = serde_json::json!([]),
        &[4, 16],
        12,
    );
    let trials = scale[2].trials;
    let width = |trials, people| of(&scale, trials, people).width.unwrap();
    assert!(width(trials, 16) < 0.75 * width(trials, 4), "{scale:?}");
    assert!(width(2 * trials, 16) < width(trials / 2, 16), "{scale:?}");
}

#[test]
fn faces_in_mind_are_found_by_more_people_and_trials_and_nothing_else_is() {
    let change = |value: &mut Value| {
        let blocks = value["components"].as_object_mut().unwrap().values_mut();
        for block in blocks.filter(|block| block["type"] == "reverseCorrelation") {
            block["trials"] = 60.into();
        }
        value["hypotheses"] = serde_json::json!([]);
    };
    let found = precision_of("reverse-correlation.json", change, &[3, 10], 2);
    let told = |trials: u32, people: usize| {
        found.iter().find(|it| (it.trials, it.participants) == (trials, people)).unwrap().found
    };
    assert!(told(120, 10) > told(30, 3) + 0.2, "{found:?}");
    assert!(told(120, 10) > 0.6, "{found:?}");
    assert!(
        found.iter().all(|point| point.found_falsely.unwrap() < 0.03 && point.width.is_none()),
        "{found:?}"
    );
}
