//! Cumulative link mixed models.

use mimique_stats::{Factor, MixedModel, MixedModelOptions, Table, mixed_model};
use serde_json::{Map, Value, json};

use super::{Given, Stop, defined};
use crate::document::Part;

/// A model as R writes it: `rating ~ method * training + (1 | participant) + (1 | clip)`.
struct Formula {
    response: String,
    factors: Vec<String>,
    interactions: bool,
    groupings: Vec<String>,
}

impl Formula {
    fn read(part: &Part<'_>) -> Result<Self, Stop> {
        let wrong = || Stop::from(part.wrong("rating ~ factors + (1 | grouping)"));
        let (response, rest) = part.text()?.split_once('~').ok_or_else(wrong)?;
        let mut own = Self {
            response: response.trim().to_owned(),
            factors: Vec::new(),
            interactions: false,
            groupings: Vec::new(),
        };
        for term in rest.split('+').map(str::trim) {
            match term.strip_prefix("(1 | ").and_then(|term| term.strip_suffix(')')) {
                Some(grouping) => own.groupings.push(grouping.to_owned()),
                None if term.starts_with('(') => return Err(wrong()),
                None => {
                    let factors: Vec<&str> = term.split('*').map(str::trim).collect();
                    own.interactions |= factors.len() > 1;
                    own.factors.extend(factors.into_iter().map(str::to_owned));
                }
            }
        }
        Ok(own)
    }

    fn fit(&self, table: &Table) -> Result<MixedModel, Stop> {
        let factors =
            self.factors.iter().map(|name| table.factor(name)).collect::<Result<Vec<_>, _>>()?;
        let grouping = |name: &String| -> Result<Factor, Stop> {
            Ok(match name.split_once(':') {
                Some((a, b)) => table.factor(a)?.crossed(&table.factor(b)?),
                None => table.factor(name)?,
            })
        };
        let groupings = self.groupings.iter().map(grouping).collect::<Result<Vec<_>, _>>()?;
        let options = MixedModelOptions { interactions: self.interactions, ratio_of_last: true };
        let (factors, groupings): (Vec<&Factor>, Vec<&Factor>) =
            (factors.iter().collect(), groupings.iter().collect());
        let rating = table.numbers(&self.response)?;
        defined(mixed_model(&rating, &factors, &groupings, options)?)
    }
}

/// The model of the formula, and the one beside it where the case has one.
pub(super) fn clmm(given: &Given<'_>) -> Result<Value, Stop> {
    let table = given.table(0)?;
    let found = Formula::read(&given.options.get("formula")?)?.fit(&table)?;
    let mut told = json!(found);
    for (grouping, sd) in found.sd.iter() {
        told[format!("sd_{grouping}")] = json!(sd);
    }
    if let Some(last) = &found.lr_last {
        told[format!("lr_{}", last.grouping)] = json!(last);
    }
    if let Some(beside) = given.expected.find("intercepts_only") {
        let formula = beside.get("formula")?;
        let found = Formula::read(&formula)?.fit(&table)?;
        let of = |value: fn(&mimique_stats::MixedCoefficient) -> f64| {
            found.coefficients.iter().map(|(_, own)| value(own)).collect::<Vec<_>>()
        };
        let mut own = Map::new();
        own.insert("formula".to_owned(), formula.value().clone());
        own.insert("loglik".to_owned(), json!(found.loglik));
        own.insert("estimate".to_owned(), json!(of(|own| own.estimate)));
        own.insert("se".to_owned(), json!(of(|own| own.se)));
        told["intercepts_only"] = Value::Object(own);
    }
    Ok(told)
}
