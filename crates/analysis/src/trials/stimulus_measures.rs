//! What was measured of the stimuli themselves: the table that `mimique export --stimuli` writes, or one with a laboratory's own
//! measures in further columns.

use std::collections::{BTreeMap, BTreeSet};

use mimique_stats::Table;
use mimique_study::Study;
use mimique_study::columns::STIMULI_COLUMNS;

use crate::trials::error::StimuliError;

/// Measures of stimuli.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StimulusMeasures {
    /// Of each measure its name, and the value of each stimulus that has one.
    pub measures: Vec<(String, BTreeMap<String, f64>)>,
    /// Stimuli that stand in the table with different values: they were prepared anew between versions of the study, and nobody
    /// knows which of them an answer is about.
    pub ambiguous: BTreeSet<String>,
}

impl StimulusMeasures {
    /// Reads the table.
    pub(crate) fn read(table: &Table, study: &Study) -> Result<Self, StimuliError> {
        let Ok(place) = table.position("stimulus") else { return Err(StimuliError::NoStimulus) };
        let factors = study.factor_names();
        let is_measure =
            |name: &String| !STIMULI_COLUMNS.contains(&name.as_str()) && !factors.contains(name);
        let mut found = Self { measures: Vec::new(), ambiguous: BTreeSet::new() };
        for name in table.names().iter().filter(|name| is_measure(name)) {
            let cells: Vec<Option<&str>> = table.column(name).into_iter().flatten().collect();
            let numbers =
                || cells.iter().flatten().filter(|cell| cell.trim().parse::<f64>().is_ok());
            if numbers().next().is_none() {
                continue;
            }
            let numbers = table.numbers(name).map_err(|_| {
                let row = (0..table.rows()).find(|&row| {
                    cells[row].is_some_and(|cell| cell.trim().parse::<f64>().is_err())
                });
                let row = row.unwrap_or_default();
                StimuliError::NotANumber {
                    column: name.clone(),
                    line: table.line(row),
                    cell: cells[row].unwrap_or_default().to_owned(),
                }
            })?;
            let mut values: BTreeMap<String, f64> = BTreeMap::new();
            for (row, value) in numbers.values.into_iter().enumerate() {
                let Some(stimulus) = table.cell(row, place).filter(|_| value.is_finite()) else {
                    continue;
                };
                let known = values.insert(stimulus.to_owned(), value);
                if known.is_some_and(|known| known != value) {
                    found.ambiguous.insert(stimulus.to_owned());
                }
            }
            found.measures.push((name.clone(), values));
        }
        for (_, values) in &mut found.measures {
            values.retain(|stimulus, _| !found.ambiguous.contains(stimulus));
        }
        Ok(found)
    }
}
