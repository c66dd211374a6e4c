//! Classifiers against scikit-learn and LIBSVM.

use mimique_annotate::{
    ClassWeight, Examples, Forest, ForestOptions, Kernel, Logistic, LogisticOptions, Neighbours,
    Rows, Svm, SvmOptions,
};
use serde_json::Value;

use crate::cases::{json, list, near, number, numbers, relative, table, text, words};

/// The rows of a table and their labels, by name.
struct Named {
    labels: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Named {
    fn read(test: &str, name: &str) -> Option<Self> {
        let (_, rows) = table(&text(test, &format!("classify/{name}"))?);
        let numbers = |row: &Vec<String>| row[1..].iter().map(|c| c.parse().unwrap()).collect();
        let rows_of_numbers = rows.iter().map(numbers).collect();
        Some(Self { labels: rows.iter().map(|r| r[0].clone()).collect(), rows: rows_of_numbers })
    }

    fn examples(&self, names: &[String], kept: impl Fn(&[f64]) -> bool) -> Examples {
        let kept: Vec<usize> = (0..self.rows.len()).filter(|&r| kept(&self.rows[r])).collect();
        let values = kept.iter().flat_map(|&r| self.rows[r].clone()).collect();
        let place = |label: &String| names.iter().position(|n| n == label).unwrap();
        let labels = kept.iter().map(|&r| place(&self.labels[r])).collect();
        let rows = Rows::new(values, self.rows[0].len()).unwrap();
        Examples::new(rows, labels, names.len()).unwrap()
    }

    /// The labels, by code point.
    fn names(&self) -> Vec<String> {
        let mut names = self.labels.clone();
        names.sort();
        names.dedup();
        names
    }
}

fn tables(test: &str) -> Option<(Named, Named)> {
    Some((Named::read(test, "train.csv")?, Named::read(test, "test.csv")?))
}

fn ordinary(row: &[f64]) -> bool {
    row[0] <= 30.0
}

fn class_weight(case: &Value) -> ClassWeight {
    if case["class_weight"].is_null() { ClassWeight::Even } else { ClassWeight::Balanced }
}

fn accuracy(found: &[usize], names: &[String], test: &Named) -> f64 {
    let right = found.iter().zip(&test.labels).filter(|(f, t)| names[**f] == **t).count();
    right as f64 / found.len() as f64
}

fn highest(values: &[f64]) -> usize {
    (1..values.len()).fold(0, |best, i| if values[i] > values[best] { i } else { best })
}

#[test]
fn nearest_neighbours() {
    let Some((train, test)) = tables("nearest_neighbours") else { return };
    let Some(expected) = json("nearest_neighbours", "classify/knn.json") else { return };
    let names = train.names();
    let examples = train.examples(&names, |_| true);
    for k in [1, 3, 5, 15] {
        let case = &expected[format!("k{k}")];
        let neighbours = Neighbours::new(&examples, k).unwrap();
        let votes: Vec<_> = test.rows.iter().map(|row| neighbours.vote(row).unwrap()).collect();
        let found: Vec<&str> = votes.iter().map(|v| names[v.label].as_str()).collect();
        assert_eq!(found, words(&case["labels"]), "{k}");
        let shares: Vec<f64> = votes.iter().map(|v| v.share).collect();
        assert_eq!(shares, numbers(&case["share"]), "{k}");
        for (key, from) in [("first_ten", 0), ("last_three", votes.len() - 3)] {
            for (vote, expected) in votes[from..].iter().zip(list(&case[key])) {
                let found: Vec<f64> = vote.neighbours.iter().map(|&r| r as f64).collect();
                assert_eq!(found, numbers(expected), "{k} {key}");
            }
        }
    }
}

#[test]
fn support_vector_machines() {
    let Some((train, test)) = tables("support_vector_machines") else { return };
    let Some(expected) = json("support_vector_machines", "classify/svm.json") else { return };
    let names = train.names();
    let examples = train.examples(&names, ordinary);
    for (place, case) in list(&expected["cases"]).iter().enumerate() {
        let kernel = match case["kernel"].as_str().unwrap() {
            "linear" => Kernel::Linear,
            _ => Kernel::Rbf { gamma: number(&case["gamma"]) },
        };
        let (c, class_weight) = (number(&case["C"]), class_weight(case));
        let options = SvmOptions { kernel, c, class_weight, ..SvmOptions::default() };
        for (name, weight) in names.iter().zip(class_weight.of(&examples)) {
            near(&[weight], &[number(&case["weights"][name])], 1e-12, name);
        }
        let svm = Svm::fit(&examples, &options).unwrap();
        let objectives: Vec<f64> = svm.pairs().iter().map(|p| p.objective).collect();
        let what = format!("case {place}");
        relative(&objectives, &numbers(&case["objective"]), 1e-4, 0.0, &what);
        let pairs: Vec<Vec<&str>> =
            svm.pairs().iter().map(|p| p.labels.map(|l| names[l].as_str()).to_vec()).collect();
        assert_eq!(pairs, list(&case["pairs"]).iter().map(words).collect::<Vec<_>>());
        let decided = test.rows.iter().zip(list(&case["decision"])).enumerate();
        for (row, (values, expected)) in decided {
            let found = svm.decisions(values).unwrap();
            near(&found, &numbers(expected), 1e-3, &format!("{what}, row {row}"));
            if case["firm"][row].as_bool().unwrap() {
                let label = &names[svm.label(values).unwrap()];
                assert_eq!(label, case["labels"][row].as_str().unwrap(), "{what}, row {row}");
            }
        }
    }
}

#[test]
fn logistic_regressions() {
    let Some((train, test)) = tables("logistic_regressions") else { return };
    let Some(expected) = json("logistic_regressions", "classify/logistic.json") else { return };
    let names = train.names();
    assert_eq!(names, words(&expected["labels"]));
    let examples = train.examples(&names, ordinary);
    for case in list(&expected["cases"]) {
        let options = LogisticOptions { c: number(&case["C"]), class_weight: class_weight(case) };
        let logistic = Logistic::fit(&examples, &options).unwrap();
        let found = logistic.coefficients().values();
        near(found, &numbers(&case["coefficients"]), 1e-4, "coefficients");
        near(&logistic.bias(), &numbers(&case["bias"]), 1e-4, "bias");
        let rows = test.rows.iter().zip(list(&case["probability"])).zip(words(&case["labels"]));
        for ((row, probability), label) in rows {
            let found = logistic.probabilities(row).unwrap();
            near(&found, &numbers(probability), 1e-5, "probability");
            assert_eq!(names[highest(&found)], label);
        }
    }
}

#[test]
fn forests() {
    let Some((train, test)) = tables("forests") else { return };
    let Some(expected) = json("forests", "classify/forest.json") else { return };
    let names = train.names();
    let forest = Forest::fit(&train.examples(&names, ordinary), &ForestOptions::default()).unwrap();
    let own = &test.rows[..test.rows.len() - 1];
    let found: Vec<usize> =
        own.iter().map(|row| highest(&forest.probabilities(row).unwrap())).collect();
    let recall = |name: &String| {
        let shown = || (0..own.len()).filter(|&r| test.labels[r] == *name);
        let right = shown().filter(|&r| names[found[r]] == *name).count();
        right as f64 / shown().count() as f64
    };
    let balanced = names.iter().map(recall).sum::<f64>() / names.len() as f64;
    for (key, value) in [
        ("accuracy", accuracy(&found, &names, &test)),
        ("balanced_accuracy", balanced),
        ("out_of_bag", forest.out_of_bag().unwrap()),
    ] {
        let band = numbers(&expected[key]["accept"]);
        assert!((band[0]..=band[1]).contains(&value), "{key}: {value} outside {band:?}");
    }
}
