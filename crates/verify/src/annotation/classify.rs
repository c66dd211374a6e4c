//! `classify/`: nearest neighbours, support vector machines, logistic regressions and forests.

use mimique_annotate::{
    ClassWeight, Examples, Forest, ForestOptions, Kernel, Logistic, LogisticOptions, Neighbours,
    Rows, Svm, SvmOptions,
};
use serde_json::{Value, json};

use super::{Checking, Source, Stop, shown};
use crate::case::{Tolerance, number, numbers};
use crate::document::{Part, Table};
use crate::{Case, VerifyError};

/// First weights above it mark planted rows, which only the neighbours learn from.
const PLANTED: f64 = 30.0;

/// Rows and their labels, by name.
struct Named {
    labels: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Named {
    fn read(source: &Source<'_>, name: &str) -> Result<Self, VerifyError> {
        let table = Table::read(&source.folder.join("classify").join(name))?;
        let rows = (0..table.rows.len()).map(|row| table.numbers(row, 1)).collect::<Result<_, _>>();
        Ok(Self { labels: table.rows.iter().map(|row| row[0].clone()).collect(), rows: rows? })
    }

    /// The rows that are kept, with the place of their labels.
    fn examples(&self, names: &[String], kept: impl Fn(&[f64]) -> bool) -> Result<Examples, Stop> {
        let kept: Vec<usize> = (0..self.rows.len()).filter(|&r| kept(&self.rows[r])).collect();
        let values = kept.iter().flat_map(|&r| self.rows[r].iter().copied()).collect();
        let place = |label: &String| names.iter().position(|n| n == label).unwrap_or(names.len());
        let labels = kept.iter().map(|&r| place(&self.labels[r])).collect();
        let width = self.rows.first().map_or(0, Vec::len);
        Ok(Examples::new(Rows::new(values, width)?, labels, names.len())?)
    }

    /// The labels, by code point.
    fn names(&self) -> Vec<String> {
        let mut names = self.labels.clone();
        names.sort();
        names.dedup();
        names
    }

    /// The share of rows whose label is found; `found` may be of fewer rows.
    fn accuracy(&self, found: &[&str]) -> Value {
        let right = found.iter().zip(&self.labels).filter(|(found, own)| *found == own).count();
        number(right as f64 / found.len() as f64)
    }
}

/// What classifiers learn from and are asked.
struct Tables {
    train: Named,
    test: Named,
    names: Vec<String>,
}

impl Tables {
    fn read(source: &Source<'_>) -> Result<Self, VerifyError> {
        let train = Named::read(source, "train.csv")?;
        let names = train.names();
        Ok(Self { train, test: Named::read(source, "test.csv")?, names })
    }

    /// What all but the neighbours learn from.
    fn ordinary(&self) -> Result<Examples, Stop> {
        self.train.examples(&self.names, |row| row.first().is_some_and(|w| *w <= PLANTED))
    }

    /// What all but the neighbours are asked: all rows but the last.
    fn asked(&self) -> &[Vec<f64>] {
        self.test.rows.split_last().map_or(&[], |(_, others)| others)
    }

    fn name(&self, label: usize) -> &str {
        &self.names[label]
    }
}

fn class_weight(case: &Part<'_>) -> Result<ClassWeight, VerifyError> {
    let weight = case.get("class_weight")?;
    match weight.value() {
        Value::Null => Ok(ClassWeight::Even),
        Value::String(word) if word == "balanced" => Ok(ClassWeight::Balanced),
        _ => Err(weight.wrong("null or \"balanced\"")),
    }
}

fn highest(values: &[f64]) -> usize {
    (1..values.len()).fold(0, |best, i| if values[i] > values[best] { i } else { best })
}

/// Nearest neighbours, a case for each number of them.
pub(super) fn neighbours(
    source: &Source<'_>,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    let tables = Tables::read(source)?;
    let root = source.document.root();
    for (name, expected) in root.members()? {
        let Some(k) = expected.find("k") else { continue };
        let accuracy = root.find("accuracy").and_then(|all| all.find(name));
        let mut checking = Checking { case: source.case(name), expected };
        let computed = (|| {
            let examples = tables.train.examples(&tables.names, |_| true)?;
            let found = Neighbours::new(&examples, k.index()?)?;
            let votes = tables.test.rows.iter().map(|row| found.vote(row));
            let votes = votes.collect::<Result<Vec<_>, _>>()?;
            let labels: Vec<&str> = votes.iter().map(|vote| tables.name(vote.label)).collect();
            let near = |from: usize, to: usize| -> Value {
                votes[from..to].iter().map(|vote| json!(vote.neighbours)).collect()
            };
            let (all, exact) = (votes.len(), Tolerance::Exact);
            checking.member("labels", exact, json!(labels));
            checking.member("share", exact, votes.iter().map(|v| number(v.share)).collect());
            checking.member("first_ten", exact, near(0, all.min(10)));
            checking.member("last_three", exact, near(all.saturating_sub(3), all));
            if let Some(expected) = accuracy {
                let got = tables.test.accuracy(&labels);
                checking.case.compare(
                    "accuracy",
                    expected.value(),
                    &got,
                    Tolerance::Absolute(1e-12),
                );
            }
            Ok(())
        })();
        each(checking.done(computed)?);
    }
    Ok(())
}

/// Support vector machines.
pub(super) fn support_vectors(
    source: &Source<'_>,
    each: &mut dyn FnMut(Case),
) -> Result<(), VerifyError> {
    let tables = Tables::read(source)?;
    for (place, expected) in source.document.root().get("cases")?.list()?.into_iter().enumerate() {
        let kernel = expected.get("kernel")?.text()?;
        let mut checking =
            Checking { case: source.case(format_args!("{place}/{kernel}")), expected };
        let computed = support_vector_machine(&tables, &mut checking);
        each(checking.done(computed)?);
    }
    Ok(())
}

fn support_vector_machine(tables: &Tables, checking: &mut Checking<'_>) -> Result<(), Stop> {
    let case = checking.expected.clone();
    let kernel = match case.get("kernel")?.text()? {
        "linear" => Kernel::Linear,
        "rbf" => Kernel::Rbf { gamma: case.get("gamma")?.number()? },
        _ => return Err(case.get("kernel")?.wrong("\"linear\" or \"rbf\"").into()),
    };
    let (c, class_weight) = (case.get("C")?.number()?, class_weight(&case)?);
    let examples = tables.ordinary()?;
    let weights = class_weight.of(&examples);
    let weights: Value =
        tables.names.iter().zip(&weights).map(|(n, w)| (n.clone(), number(*w))).collect();
    checking.member("weights", Tolerance::Absolute(1e-12), weights);

    let svm =
        Svm::fit(&examples, &SvmOptions { kernel, c, class_weight, ..SvmOptions::default() })?;
    let pairs = svm.pairs();
    let names = pairs.iter().map(|p| json!(p.labels.map(|label| tables.name(label)))).collect();
    checking.member("pairs", Tolerance::Exact, names);
    let objectives: Vec<f64> = pairs.iter().map(|pair| pair.objective).collect();
    let relative = Tolerance::Relative { share: 1e-4, floor: 0.0 };
    checking.member("objective", relative, numbers(&objectives));
    let asked = tables.asked();
    let decisions = asked.iter().map(|row| svm.decisions(row)).collect::<Result<Vec<_>, _>>()?;
    checking.member("decision", Tolerance::Absolute(1e-3), decisions.iter().map(numbers).collect());

    // Labels are held only where all tools agree on them.
    let firm = case.get("firm")?.list()?;
    for (row, label) in case.get("labels")?.list()?.into_iter().enumerate() {
        if firm.get(row).is_some_and(|firm| firm.value() == true) {
            let field = format!("labels/{row}");
            let found = asked.get(row).map(|row| svm.label(row)).transpose()?;
            let got = json!(found.map(|label| tables.name(label)));
            checking.case.compare(&field, label.value(), &got, Tolerance::Exact);
        }
    }
    Ok(())
}

/// Logistic regressions.
pub(super) fn logistic(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let tables = Tables::read(source)?;
    let root = source.document.root();
    for (place, expected) in root.get("cases")?.list()?.into_iter().enumerate() {
        let case = expected.clone();
        let mut checking = Checking { case: source.case(place), expected };
        let labels = root.get("labels")?;
        checking.case.compare("names", labels.value(), &json!(tables.names), Tolerance::Exact);
        let computed = (|| {
            let options =
                LogisticOptions { c: case.get("C")?.number()?, class_weight: class_weight(&case)? };
            let fitted = Logistic::fit(&tables.ordinary()?, &options)?;
            let by = Tolerance::Absolute(1e-4);
            checking.member("coefficients", by, shown(fitted.coefficients()));
            checking.member("bias", by, numbers(&fitted.bias()));
            let asked = tables.asked().iter().map(|row| fitted.probabilities(row));
            let asked = asked.collect::<Result<Vec<_>, _>>()?;
            let probabilities = asked.iter().map(numbers).collect();
            checking.member("probability", Tolerance::Absolute(1e-5), probabilities);
            let found: Vec<&str> = asked.iter().map(|p| tables.name(highest(p))).collect();
            checking.member("labels", Tolerance::Exact, json!(found));
            let accuracy = tables.test.accuracy(&found);
            checking.member("accuracy", Tolerance::Absolute(1e-12), accuracy);
            Ok(())
        })();
        each(checking.done(computed)?);
    }
    Ok(())
}

/// A forest: its scores lie where those of scikit-learn's seeds do.
pub(super) fn forest(source: &Source<'_>, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
    let tables = Tables::read(source)?;
    let expected = source.document.root();
    let mut checking = Checking { case: Case::new(source.name), expected: expected.clone() };
    let computed = (|| {
        let options =
            ForestOptions { trees: expected.get("trees")?.index()?, ..ForestOptions::default() };
        let forest = Forest::fit(&tables.ordinary()?, &options)?;
        let asked = tables.asked().iter().map(|row| forest.probabilities(row));
        let asked = asked.collect::<Result<Vec<_>, _>>()?;
        let found: Vec<&str> = asked.iter().map(|p| tables.name(highest(p))).collect();
        for (key, got) in [
            ("accuracy", tables.test.accuracy(&found)),
            ("balanced_accuracy", number(balanced_accuracy(&tables, &found))),
            ("out_of_bag", forest.out_of_bag().map_or(Value::Null, number)),
        ] {
            let accept = expected.get(key)?.get("accept")?;
            let [low, high] = accept.numbers()?[..] else {
                return Err(accept.wrong("two numbers").into());
            };
            // The middle of the band, and half its width.
            let by = Tolerance::Absolute((high - low) / 2.0);
            checking.case.compare(key, &number((low + high) / 2.0), &got, by);
        }
        Ok(())
    })();
    each(checking.done(computed)?);
    Ok(())
}

/// The mean over the labels of the share of their rows that are found.
fn balanced_accuracy(tables: &Tables, found: &[&str]) -> f64 {
    let recalls = tables.names.iter().filter_map(|name| {
        let own: Vec<&&str> = (found.iter().zip(&tables.test.labels))
            .filter(|(_, label)| *label == name)
            .map(|(found, _)| found)
            .collect();
        let right = own.iter().filter(|found| **found == name).count();
        (!own.is_empty()).then(|| right as f64 / own.len() as f64)
    });
    let recalls: Vec<f64> = recalls.collect();
    recalls.iter().sum::<f64>() / recalls.len() as f64
}
