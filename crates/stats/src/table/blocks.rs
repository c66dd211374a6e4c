//! Repeated measures: one response per block (a participant) and group.

use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;

/// A complete block design: one response a block and group.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    /// Groups.
    pub groups: Vec<String>,
    /// Names of the complete blocks.
    pub blocks: Vec<String>,
    /// Responses of each complete block, in the order of the groups.
    pub responses: Vec<Vec<f64>>,
    /// Blocks left out.
    pub incomplete: usize,
    /// Rows dropped.
    pub dropped: usize,
}

impl Blocks {
    /// Arranges rows by block and group. Refuses two responses in one place, naming it.
    pub fn of(response: &Numbers, group: &Factor, block: &Factor) -> Result<Self, Refusal> {
        let complete = complete_rows(&[response], &[group, block])?;
        let (rows, dropped) = (complete.to_vec(), complete.dropped());
        // A block whose every response is missing is still an incomplete block.
        let with_group: Vec<usize> =
            (0..block.codes.len()).filter(|&r| block.codes[r] != Factor::MISSING).collect();
        let all_blocks = block.rows(&with_group).levels.len();
        let (group, block) = (group.rows(&rows), block.rows(&rows));
        group.require_levels(2)?;
        let k = group.levels.len();
        let mut table = vec![vec![f64::NAN; k]; block.levels.len()];
        for (i, &row) in rows.iter().enumerate() {
            let place = &mut table[block.codes[i] as usize][group.codes[i] as usize];
            if !place.is_nan() {
                return Err(Refusal::RepeatedInBlock {
                    column: block.name.clone(),
                    block: block.levels[block.codes[i] as usize].clone(),
                    group: group.name.clone(),
                    level: group.levels[group.codes[i] as usize].clone(),
                });
            }
            *place = response.values[row];
        }
        let mut complete = (Vec::new(), Vec::new());
        for (name, responses) in block.levels.iter().zip(table) {
            if responses.iter().all(|value| value.is_finite()) {
                complete.0.push(name.clone());
                complete.1.push(responses);
            }
        }
        Ok(Self {
            groups: group.levels,
            incomplete: all_blocks - complete.0.len(),
            blocks: complete.0,
            responses: complete.1,
            dropped,
        })
    }

    /// Differences of two groups, block by block.
    pub fn differences(&self, a: usize, b: usize) -> Numbers {
        Numbers {
            name: format!("{} | {}", self.groups[a], self.groups[b]),
            values: self.responses.iter().map(|block| block[a] - block[b]).collect(),
        }
    }

    /// All pairs of groups, in order.
    pub fn pairs(&self) -> Vec<(usize, usize)> {
        (0..self.groups.len())
            .flat_map(|a| (a + 1..self.groups.len()).map(move |b| (a, b)))
            .collect()
    }
}
