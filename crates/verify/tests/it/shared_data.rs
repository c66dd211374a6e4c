//! Every case of the shared data is right, and nothing of them is passed over.

use std::collections::BTreeSet;

use mimique_test_support::real_file;
use mimique_verify::{Case, verify};

/// The cases of a folder; a wrong one fails the test with its wrong values.
fn all_right(test: &str, folder: &str) -> Option<Vec<Case>> {
    let folder = real_file(test, folder)?;
    let mut cases = Vec::new();
    let count = verify(&folder, &mut |case| cases.push(case)).unwrap();
    assert_eq!(count, cases.len());
    let mut wrong = Vec::new();
    for case in cases.iter().filter(|case| !case.right) {
        wrong.extend(case.wrong().take(5).map(|value| {
            let (got, expected, by) = (&value.got, &value.expected, value.tolerance);
            format!("{} {}: {got} instead of {expected} within {by:e}", case.case, value.field)
        }));
    }
    assert!(wrong.is_empty(), "{} problems:\n{}", wrong.len(), wrong.join("\n"));
    let names: BTreeSet<&str> = cases.iter().map(|case| case.case.as_str()).collect();
    assert_eq!(names.len(), cases.len(), "two cases have one name");
    Some(cases)
}

fn values(cases: &[Case]) -> usize {
    cases.iter().map(|case| case.values.len()).sum()
}

fn of<'a>(cases: &'a [Case], begin: &str) -> Vec<&'a Case> {
    cases.iter().filter(|case| case.case.starts_with(begin)).collect()
}

#[test]
fn statistics() {
    let Some(cases) = all_right("statistics", "stats") else { return };
    let tails = of(&cases, "distribution_tails/").len();
    assert!(tails >= 33, "{tails} tails");
    assert!(cases.len() - tails >= 25, "{} cases", cases.len() - tails);
    assert!(values(&cases) > 800, "only {} values were compared", values(&cases));
}

#[test]
fn solver() {
    let Some(cases) = all_right("solver", "lsts") else { return };
    let folder = real_file("solver", "lsts/frames").unwrap();
    // Every stored file but the displacements is a variant.
    let variants = std::fs::read_dir(folder).unwrap().count() - 1;
    assert_eq!(of(&cases, "frames/").len(), variants);
    assert_eq!(of(&cases, "take_n01.csv/").len(), variants);
    assert_eq!(of(&cases, "take_n01.c3d/").len(), variants - 2);
    assert_eq!(of(&cases, "toy").len(), 1);
    assert_eq!(of(&cases, "operators/").len(), 4);
    assert_eq!(of(&cases, "constants").len(), 1);
    for case in of(&cases, "frames/") {
        // Ten frames of 53 shapes, in their order and each alone.
        assert!(case.values.len() >= 2 * 530, "{}: {}", case.case, case.values.len());
    }
    assert!(of(&cases, "toy")[0].values.iter().any(|v| v.field == "solutions/F4_box/c/2"));
}

#[test]
fn annotation() {
    let Some(cases) = all_right("annotation", "annotation") else { return };
    for (begin, least) in [
        ("open/segmentation/", 16),
        ("open/features/", 4),
        ("open/classify/knn/", 4),
        ("open/classify/svm/", 4),
        ("open/classify/logistic/", 2),
        ("open/classify/forest", 1),
        ("open/hmm/given/", 8),
        ("open/hmm/baum_welch/", 9),
        ("open/hmm/composite/", 2),
        ("open/hmm/label_path/", 4),
        ("open/evaluate/expected/take", 5),
        ("open/evaluate/expected/all", 1),
        ("open/evaluate/expected/bootstrap", 1),
        ("open/evaluate/expected/calibration", 1),
        ("open/evaluate/small/", 7),
        ("open/elan/expected/read/", 2),
        ("open/elan/expected/unknown", 1),
        ("open/elan/expected/write", 1),
    ] {
        let found = of(&cases, begin).len();
        assert!(found >= least, "{begin}: {found} cases");
    }
    assert!(values(&cases) > 20_000, "only {} values were compared", values(&cases));
}

#[test]
fn layouts() {
    let Some(cases) = all_right("layouts", "layouts") else { return };
    for (begin, least) in [
        ("open/kmeans_plane", 1),
        ("open/kmeans_face", 1),
        ("open/kmeans_symmetric", 1),
        ("open/sogp_small", 1),
        ("open/sogp_face", 1),
        ("open/gp_face", 1),
        ("open/curve_face/", 4),
        ("open/greedy_face/", 5),
        ("open/slip_face", 1),
        ("open/qr_face", 1),
        ("open/head_face", 1),
        ("open/avatar_kmeans", 1),
        ("open/avatar_greedy/", 2),
        ("open/avatar_curve/", 4),
    ] {
        let found = of(&cases, begin).len();
        assert!(found >= least, "{begin}: {found} cases");
    }
    assert!(values(&cases) > 7_000, "only {} values were compared", values(&cases));
}

#[test]
fn exertion() {
    let Some(cases) = all_right("exertion", "exertion") else { return };
    let folder = real_file("exertion", "exertion/open").unwrap();
    for (name, least) in [
        ("work", 16),
        ("heart", 15),
        ("metabolism", 12),
        ("activity", 3),
        ("breathing", 13),
        ("svr", 12),
        ("train", 11),
        ("rules", 3),
        ("weights", 13),
        ("chain", 4),
    ] {
        let found = of(&cases, &format!("open/{name}/")).len();
        let files = std::fs::read_dir(folder.join(name)).unwrap().filter(|file| {
            file.as_ref().unwrap().path().extension().is_some_and(|ending| ending == "json")
        });
        assert_eq!(found, files.count(), "{name}");
        assert!(found >= least, "{name}: {found} cases");
    }
    let refusals = of(&cases, "open/errors/errors/").len();
    assert!(refusals >= 25, "{refusals} refusals");
    assert!(values(&cases) > 25_000, "only {} values were compared", values(&cases));
}

#[test]
fn psychophysics() {
    let Some(cases) = all_right("psychophysics", "psychophysics") else { return };
    let folder = real_file("psychophysics", "psychophysics/open").unwrap();
    let files = std::fs::read_dir(folder).unwrap().map(|file| file.unwrap().file_name());
    let expected = files.filter(|name| name.to_string_lossy().ends_with(".expected.json")).count();
    assert_eq!(cases.len(), expected);
    assert!(values(&cases) > 1400, "only {} values were compared", values(&cases));
}
