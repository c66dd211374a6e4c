//! What `mimique exertion` refuses: with place, value and remedy, and without leaving anything behind.

use std::path::{Path, PathBuf};

use mimique_test_support::repository;

use crate::support::{self, exertion_args, ok, refused, sample};

#[test]
fn a_refusal_leaves_nothing_behind() {
    let folder = sample();
    let out = folder.path().join("w.csv");
    let run = folder.path().join("run.bvh");
    let paths: [(&str, &Path); 2] = [("", &run), ("--out", &out)];
    for (words, expected) in [
        (
            &["--for", "60", "--window", "50:90"][..],
            "--window: window: 50 to 90 s of 60 s; give a window",
        ),
        (
            &["--for", "60", "--heart", "other"],
            "--heart: \"other\"; use thesis, steady or recorded",
        ),
        (&["--for", "60", "--heart", "recorded"], "--heart: recorded, and seconds 0 to 60 have no"),
        (
            &["--for", "60", "--convention", "odd"],
            "--convention odd: not known; use one of segments",
        ),
        (&["--for", "60", "--convention", "signed"], "--convention signed: w/"),
        (&["--lowpass", "30"], "--lowpass: lowpassHz: 30; give a number above 0 and below 30 Hz"),
        (&["--rate", "8"], "rateHz: 8; give 10 to 100000 frames per second"),
        (&["--up", "w"], "--up: \"w\"; use x, y or z"),
        (&["--unit", "inch"], "--unit: \"inch\"; use m, cm or mm"),
        (&["--loads", "head=3"], "--loads: head: not known; use one of leftHand, rightHand, back"),
        (&["--loads", "back=-3"], "--loads: loads/back: -3 is below 0"),
        (&["--loads", "back=3,back=4"], "--loads: back is given twice"),
        (&["--expressivity", "nose=1"], "--expressivity: nose: not known; use one of mouthOpen"),
        (&["--level", "-1"], "--level: level: -1; give 0 to 10"),
        (&["--model", "nowhere.json"], "nowhere.json: open: "),
        (&["--person", "nowhere.json"], "nowhere.json: open: "),
        (&["--out-rate", "0"], "rateHz: 0; give 1 to 1000 frames per second"),
    ] {
        let said = refused(&exertion_args(words, &paths));
        assert!(said.contains(expected), "{words:?}: {said}");
        assert!(!out.exists(), "{words:?} wrote something");
    }
    for (words, expected) in [
        (&["--for", "soon"][..], "give a duration above 0"),
        (&["--window", "5"], "give two times, the first smaller"),
        (&["--lowpass", "0"], "give hertz above 0, or none"),
        (&["--loads", "back"], "give NAME=NUMBER"),
        (&["--plan", "rest 60"], "cannot be used with"),
    ] {
        let said = refused_by_clap(&exertion_args(words, &paths));
        assert!(said.contains(expected), "{words:?}: {said}");
    }
    let said = refused(&exertion_args(&["--plan", "rest 60, work x 5"], &[("--out", &out)]));
    assert!(said.contains("--plan: part 2: \"work x 5\" is none; write"), "{said}");
}

/// What clap refuses has exit code 2, too.
fn refused_by_clap(all: &[String]) -> String {
    let out = support::mimique(all);
    assert_eq!(out.status.code(), Some(2));
    String::from_utf8_lossy(&out.stderr).into_owned()
}

#[test]
fn files_that_are_none_are_refused_with_place_and_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| -> PathBuf {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path
    };
    for (name, text, expected) in [
        (
            "a.txt",
            "hello\n",
            "byte 0: neither a motion nor an activity, it starts with \"hello\\n\"",
        ),
        (
            "b.csv",
            "time,power_w\n0,100\n9,100\n",
            "time/1: nothing for 9.0 s before 9 s, at most 5 s",
        ),
        ("c.csv", "time,power_w\n0,100\n", "time: 1, at least 2 are needed"),
        (
            "d.csv",
            "time,heart_rate\n0,100\n1,999\n",
            "line 3, column 2 (heart_rate): 999, where people",
        ),
        ("e.csv", "time,work\n0,1\n0.5,1\n", "less than a second was recorded"),
    ] {
        let path = file(name, text);
        let said = refused(&exertion_args(&[], &[("", &path)]));
        assert!(said.contains(&format!("{}: {expected}", path.display())), "{said}");
    }
    let path = file("f.csv", "time,work\n0,9\n1,9\n2,9\n");
    let said = refused(&exertion_args(&["--for", "1min"], &[("", &path)]));
    assert!(said.contains("2 s were recorded, 60 are asked for"), "{said}");
    let person = file("p.json", "{\"age\": 30, \"weight\": 70}");
    let said = refused(&exertion_args(&[], &[("", &path), ("--person", &person)]));
    assert!(said.contains("p.json: weight: not known; use one of age, heightM"), "{said}");
    let model = file("m.json", "{\"version\": 9}");
    let said = refused(&exertion_args(&[], &[("", &path), ("--model", &model)]));
    assert!(said.contains("m.json: version: 9; versions up to 1 are read"), "{said}");
    let shapes = file("t.json", "{\"eyes\": {\"squint\": \"much\"}}");
    let said = refused(&exertion_args(&[], &[("", &path), ("--shapes", &shapes)]));
    assert!(said.contains("t.json: eyes/squint: no number"), "{said}");
}

#[test]
fn training_refuses_what_does_not_fit_together() {
    let folder = sample();
    let at = |name: &str| folder.path().join(name);
    let ride = repository().join("docs/guide/data/exertion/ride.csv");
    let (face, out) = (at("face.csv"), at("model.json"));
    ok(&exertion_args(&["--no-breath"], &[("", &ride), ("--out", &face)]));
    let train = |words: &[&str], paths: &[(&str, &Path)]| {
        let mut all = vec!["train"];
        all.extend(words);
        refused(&exertion_args(&all, paths))
    };
    let whole: [(&str, &Path); 4] =
        [("--take", &ride), ("--heart-rate", &ride), ("--weights", &face), ("--out", &out)];
    let mut two = whole.to_vec();
    two.push(("--take", &ride));
    for (words, paths, expected) in [
        (&[][..], &two[..], "--heart-rate: 1 files for 2 takes; give one for each"),
        (&["--features", "w,v"], &whole, "--features/v: not known; use one of w, p, rcn, epoc"),
        (&["--features", "w,w"], &whole, "--features: w is given twice"),
        (&["--every", "400"], &whole, "rows: 0; give 2 to 6000"),
        (&["--folds", "1", "--every", "20"], &whole, "folds 1: give a number of 2 or more"),
        (&["--epsilon", "-1", "--every", "20"], &whole, "epsilon -1: give a number from 0 on"),
    ] {
        let said = train(words, paths);
        assert!(said.contains(expected), "{words:?}: {said}");
    }
    // A face that never moves teaches nothing.
    let still = at("still.csv");
    let rows: String = (0..300).map(|i| format!("{i},{i},0,0\n")).collect();
    std::fs::write(&still, format!("frame,time,jawOpen,browInnerUp\n{rows}")).unwrap();
    let mut paths = whole.to_vec();
    paths[2] = ("--weights", &still);
    let said = train(&["--every", "5"], &paths);
    assert!(said.contains("somebody: mouthOpen never moves in the weights"), "{said}");
    let mut paths = whole.to_vec();
    let walk = at("walk.bvh");
    paths[1] = ("--heart-rate", &walk);
    let said = train(&[], &paths);
    assert!(said.contains("walk.bvh: byte 0: no activity in a known format"), "{said}");
    assert!(!out.exists());
}
