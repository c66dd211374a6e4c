//! A column as a factor: its levels in a stated order and a code a row.

use std::cmp::Ordering;

use crate::refusal::Refusal;
use crate::table::coded::Coded;

/// A column as a factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Factor {
    /// Name of the column.
    pub name: String,
    /// Levels: numeric order if all are numbers, else alphabetical, unless restricted.
    pub levels: Vec<String>,
    /// Level of each row; [`Factor::MISSING`] where the cell is missing or its level not wanted.
    pub codes: Vec<u32>,
}

impl Factor {
    /// Code of a missing cell.
    pub const MISSING: u32 = u32::MAX;

    /// From cells; `number` says whether a level is a number (levels of equal number are one level).
    pub fn from_cells<'a>(
        name: &str,
        cells: impl Iterator<Item = Option<&'a str>>,
        number: impl Fn(&str) -> Option<f64>,
    ) -> Self {
        let coded = Coded::of(cells.map(|cell| cell.map(str::as_bytes)));
        let labels = coded.labels(|bytes| std::str::from_utf8(bytes).unwrap_or_default());
        Self::of_coded(name, &labels, coded.codes, number)
    }

    /// From labels in the order of their first row, and the label of each row.
    pub(crate) fn of_coded(
        name: &str,
        labels: &[&str],
        mut codes: Vec<u32>,
        number: impl Fn(&str) -> Option<f64>,
    ) -> Self {
        // -0 and 0 are one level.
        let numbers: Option<Vec<f64>> =
            labels.iter().map(|label| number(label).map(|value| value + 0.0)).collect();
        let mut order: Vec<usize> = (0..labels.len()).collect();
        match &numbers {
            Some(numbers) => order.sort_by(|&a, &b| numbers[a].total_cmp(&numbers[b])),
            None => order.sort_by_cached_key(|&label| (lower(labels[label]), labels[label])),
        }
        let mut levels: Vec<String> = Vec::new();
        let mut new_code = vec![0; labels.len()];
        for (position, &old) in order.iter().enumerate() {
            let repeats =
                position > 0 && numbers.as_ref().is_some_and(|n| n[order[position - 1]] == n[old]);
            if !repeats {
                levels.push(labels[old].to_owned());
            }
            new_code[old] = levels.len() as u32 - 1;
        }
        for code in &mut codes {
            *code = new_code.get(*code as usize).copied().unwrap_or(Self::MISSING);
        }
        Self { name: name.to_owned(), levels, codes }
    }

    /// The combinations with another factor that occur, `a:b`; a level `x:y` each, the first factor's order first.
    pub fn crossed(&self, other: &Self) -> Self {
        let width = other.levels.len();
        let code = |(one, two): (&u32, &u32)| match (*one, *two) {
            (Self::MISSING, _) | (_, Self::MISSING) => Self::MISSING,
            (one, two) => one * width as u32 + two,
        };
        let levels = self.levels.iter();
        let levels = levels.flat_map(|a| other.levels.iter().map(move |b| format!("{a}:{b}")));
        Self {
            name: format!("{}:{}", self.name, other.name),
            levels: levels.collect(),
            codes: self.codes.iter().zip(&other.codes).map(code).collect(),
        }
        .used()
    }

    /// Only these levels, in this order; rows of other levels become missing.
    pub fn restricted(&self, wanted: &[String]) -> Result<Self, Refusal> {
        let mut new_code = vec![Self::MISSING; self.levels.len()];
        let mut levels = Vec::new();
        for label in wanted {
            let label = label.trim();
            let as_number = label.parse::<f64>().ok();
            let old = self
                .levels
                .iter()
                .position(|level| level == label)
                .or_else(|| {
                    self.levels.iter().position(|level| {
                        as_number.is_some() && level.parse::<f64>().ok() == as_number
                    })
                })
                .ok_or_else(|| {
                    let (column, levels) = (self.name.clone(), self.levels.clone());
                    Refusal::NoLevel { column, level: label.to_owned(), levels }
                })?;
            if new_code[old] != Self::MISSING {
                let (column, level) = (self.name.clone(), label.to_owned());
                return Err(Refusal::RepeatedLevel { column, level });
            }
            new_code[old] = levels.len() as u32;
            levels.push(self.levels[old].clone());
        }
        let codes = self
            .codes
            .iter()
            .map(|&code| if code == Self::MISSING { code } else { new_code[code as usize] })
            .collect();
        Ok(Self { name: self.name.clone(), levels, codes })
    }

    /// The rows in `keep` only, without the levels that none of them has.
    pub fn rows(&self, keep: &[usize]) -> Self {
        let mut used = vec![false; self.levels.len()];
        for &row in keep {
            if let Some(used) = used.get_mut(self.codes[row] as usize) {
                *used = true;
            }
        }
        let mut new_code = vec![Self::MISSING; self.levels.len()];
        let mut levels = Vec::new();
        for (old, level) in self.levels.iter().enumerate().filter(|(old, _)| used[*old]) {
            new_code[old] = levels.len() as u32;
            levels.push(level.clone());
        }
        let codes = keep
            .iter()
            .map(|&row| new_code.get(self.codes[row] as usize).copied().unwrap_or(Self::MISSING))
            .collect();
        Self { name: self.name.clone(), levels, codes }
    }

    /// Without the levels that no row has.
    pub fn used(self) -> Self {
        if self.uses_all_levels() {
            return self;
        }
        let all: Vec<usize> = (0..self.codes.len()).collect();
        self.rows(&all)
    }

    /// Whether each level occurs.
    pub(crate) fn uses_all_levels(&self) -> bool {
        let mut used = vec![false; self.levels.len()];
        let mut left = used.len();
        for &code in &self.codes {
            if let Some(used) = used.get_mut(code as usize)
                && !*used
            {
                *used = true;
                left -= 1;
                if left == 0 {
                    return true;
                }
            }
        }
        left == 0
    }

    /// Level of a row.
    pub fn level(&self, row: usize) -> Option<&str> {
        self.levels.get(self.codes[row] as usize).map(String::as_str)
    }

    /// Refuses fewer than `needed` levels, naming the column.
    pub fn require_levels(&self, needed: usize) -> Result<(), Refusal> {
        if self.levels.len() >= needed {
            return Ok(());
        }
        Err(Refusal::TooFewLevels {
            column: self.name.clone(),
            levels: self.levels.clone(),
            rows: self.codes.len(),
            needed,
        })
    }
}

/// Alphabetical order: without regard to case first, then with.
pub(crate) fn alphabetical(a: &str, b: &str) -> Ordering {
    lower(a).cmp(&lower(b)).then_with(|| a.cmp(b))
}

fn lower(text: &str) -> String {
    text.chars().flat_map(char::to_lowercase).collect()
}
