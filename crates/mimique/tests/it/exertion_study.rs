//! `mimique exertion study`: the study that the repository has, designs of other factors, refusals.

use mimique_stimulus::{Places, prepare};
use mimique_study::{Study, TestName};
use mimique_test_support::repository;

use crate::support::{self, ok, refused, text};

#[test]
fn the_study_of_the_repository_is_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("exertion.json");
    ok(&["exertion", "study", "--out", &text(&out)]);
    let kept = repository().join("study-config/exertion.json");
    let written = std::fs::read_to_string(&out).unwrap();
    if std::env::var_os("MIMIQUE_UPDATE_GOLDEN").is_some() {
        std::fs::write(&kept, &written).unwrap();
    }
    assert!(
        std::fs::read_to_string(&kept).unwrap_or_default() == written,
        "{} is not current; write it anew with MIMIQUE_UPDATE_GOLDEN=1",
        kept.display()
    );
    // Walk, run, sprint x three levels x two expressivities.
    let study = Study::from_text(&written).unwrap();
    assert_eq!(study.clips().len(), 18);
    let tests: Vec<TestName> = study.hypotheses.iter().map(|own| own.test).collect();
    let expected = [
        TestName::AlignedRankTransform,
        TestName::Friedman,
        TestName::Friedman,
        TestName::Wilcoxon,
        TestName::Spearman,
    ];
    assert_eq!(tests, expected);
    let borg = |id: &str| {
        let segment = study.stimuli.segments.iter().find(|own| own.id == id).unwrap();
        segment.factors["borg"].to_string().parse::<f64>().unwrap()
    };
    // A run is harder than a walk, and for the untrained harder than for the trained.
    assert!(borg("run-level5-reserved") > borg("walk-level5-reserved") + 3.0);
    assert!(borg("run-level0-reserved") > borg("run-level10-reserved") + 1.0);
    assert_eq!(borg("run-level5-reserved"), borg("run-level5-expressive"));
}

#[test]
fn the_study_is_prepared_simulated_and_analysed() {
    let folder = tempfile::tempdir().unwrap();
    let file = repository().join("study-config/exertion.json");
    let study = Study::from_text(&std::fs::read_to_string(&file).unwrap()).unwrap();
    let places = Places::of(&file, folder.path().join("packs"));
    let prepared = prepare(&study, &places, &mut |_| ()).unwrap();
    assert_eq!(prepared.clips.len(), 18);
    assert!(prepared.clips.values().all(|clip| (clip.duration_ms - 6000.0).abs() < 1e-6));
    let mut weights: Vec<&String> = prepared.clips.values().map(|c| &c.weights_hash).collect();
    weights.sort();
    weights.dedup();
    assert_eq!(weights.len(), 18, "two clips are the same");

    let simulated = text(&folder.path().join("simulated"));
    let config = text(&file);
    ok(&["simulate", &config, "--participants", "12", "--seed", "1", "--out", &simulated]);
    let answers = format!("{simulated}/exertion_responses.csv");
    let report = text(&folder.path().join("report"));
    let said = ok(&["analyze", &answers, "--study", &config, "--out", &report]);
    for id in ["H1", "H2", "H3", "H4", "H5"] {
        assert!(said.contains(id), "{id}: {said}");
    }
    let power = ok(&["power", &config, "--participants", "10", "--runs", "5"]);
    assert!(power.contains("H5"), "{power}");
}

#[test]
fn designs_of_other_factors_have_their_hypotheses() {
    let folder = tempfile::tempdir().unwrap();
    let design = |words: &[&str]| {
        let out = folder.path().join("study.json");
        let out = text(&out);
        let mut all = vec!["exertion", "study", "--for", "60", "--clip", "2", "--out", &out];
        all.extend(words);
        ok(&all);
        Study::from_text(&std::fs::read_to_string(&out).unwrap()).unwrap()
    };
    // Both work alike: nothing is to be seen of the exertion.
    let alike = design(&["--activities", "run", "--levels", "5"]);
    assert_eq!((alike.clips().len(), alike.hypotheses.len()), (2, 1));
    assert_eq!(alike.hypotheses[0].test, TestName::Wilcoxon);
    let factors = &alike.stimuli.segments[0].factors;
    assert_eq!(factors.keys().collect::<Vec<_>>(), ["expressivity"]);
    let faces = design(&[
        "--activities",
        "run",
        "--levels",
        "2.5,8",
        "--expressivities",
        "plain=1",
        "--models",
        "rules,linear",
        "--breaths",
        "with,without",
    ]);
    assert_eq!(faces.clips().len(), 8);
    let factors: Vec<&str> = faces.hypotheses.iter().map(|own| own.factors[0].as_str()).collect();
    assert_eq!(factors, ["level", "model", "breath", "borg"]);
    let of_thesis =
        design(&["--activities", "run", "--levels", "5", "--expressivities", "a,c,e", "--skin"]);
    let own = |id: &str| of_thesis.stimuli.captures[id].exertion.clone().unwrap();
    let calm = own("run-level5-a").person.expressivity.unwrap();
    assert_eq!((calm.mouth_open, calm.brows), (Some(0.86), Some(0.73)));
    assert_eq!(own("run-level5-e").person.expressivity.unwrap().eyes, Some(1.15));
    assert!(own("run-level5-c").skin);
    let still = &faces.stimuli.captures["run-level2_5-plain-model2-without"];
    let own = still.exertion.as_ref().unwrap();
    assert_eq!((own.model.as_str(), own.breath, own.seconds), ("linear", false, Some(60.0)));
    assert_eq!(
        (faces.stimuli.segments[0].first, faces.stimuli.segments[0].end),
        (Some(3480), Some(3600))
    );
}

#[test]
fn designs_that_cannot_be_are_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("study.json");
    let person = folder.path().join("p.json");
    std::fs::write(&person, "{\"weight\": 70}").unwrap();
    let person = text(&person);
    for (words, expected) in [
        (&["--levels", "0,11"][..], "--levels: level: 11; give 0 to 10"),
        (&["--levels", "5,5"], "--levels: 5 is given twice"),
        (&["--activities", "run,run"], "--activities: run is given twice"),
        (&["--models", "rules,rules"], "--models: rules is given twice"),
        (&["--breaths", "with,with"], "--breaths: with is given twice"),
        (&["--expressivities", "a=1,a=2"], "--expressivities: a is given twice"),
        (&["--expressivities", "a=-1"], "--expressivities: expressivity/mouthOpen: -1 is below 0"),
        (&["--expressivities", "a b=1"], "cannot be part of a clip's identifier"),
        (
            &["--activities", "run", "--levels", "5", "--expressivities", "a=1"],
            "--levels: one clip alone, which nothing compares",
        ),
        (&["--clip", "90", "--for", "60"], "--clip: 90 s of 60 s of walk; shorten it"),
        (&["--person", &person], "p.json: unknown field `weight`"),
    ] {
        let text_of_out = text(&out);
        let mut all = vec!["exertion", "study", "--out", &text_of_out];
        all.extend(words);
        let said = refused(&all);
        assert!(said.contains(expected), "{words:?}: {said}");
        assert!(!out.exists(), "{words:?} wrote something");
    }
    let all = ["exertion", "study", "--activities", "swim", "--out", &text(&out)];
    let said = support::mimique(&all);
    assert_eq!(said.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&said.stderr).contains("use walk, run or sprint"));
}
