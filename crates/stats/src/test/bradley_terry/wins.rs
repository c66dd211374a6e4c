//! Friedman's test on the wins of each participant: what is left to test where participants are few.

use serde::Serialize;

use crate::table::blocks::Blocks;
use crate::table::comparisons::{Chosen, PairedComparisons};
use crate::test::friedman::{ImanDavenport, friedman};

/// Friedman's test, participants as blocks, wins (a tie is half a win) as responses.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct WinsTest {
    /// Friedman's chi-square, corrected for ties.
    pub statistic: f64,
    /// Items less one.
    pub df: usize,
    /// Upper chi-square tail.
    pub p: f64,
    /// Iman and Davenport's F; none where all participants agree perfectly.
    pub iman_davenport: Option<ImanDavenport>,
}

/// None where participants did not all compare each item equally often, or where all wins are alike.
pub(super) fn test(data: &PairedComparisons) -> Option<WinsTest> {
    let found = friedman(&blocks(data)?).ok()?;
    Some(WinsTest {
        statistic: found.statistic,
        df: found.df,
        p: found.p_value,
        iman_davenport: found.iman_davenport,
    })
}

/// Wins of each item by participant; none where they did not all compare each item equally often.
fn blocks(data: &PairedComparisons) -> Option<Blocks> {
    let items = data.items.len();
    let mut wins = vec![vec![0.0; items]; data.participants.len()];
    let mut shown = vec![vec![0_usize; items]; data.participants.len()];
    for answer in &data.answers {
        let (own, count) = (&mut wins[answer.participant], &mut shown[answer.participant]);
        count[answer.left] += 1;
        count[answer.right] += 1;
        match answer.chosen {
            Chosen::Left => own[answer.left] += 1.0,
            Chosen::Right => own[answer.right] += 1.0,
            Chosen::Same => {
                own[answer.left] += 0.5;
                own[answer.right] += 0.5;
            }
        }
    }
    if shown.iter().any(|own| own.iter().any(|count| *count != own[0])) {
        return None;
    }
    Some(Blocks {
        groups: data.items.clone(),
        blocks: data.participants.clone(),
        responses: wins,
        incomplete: 0,
        dropped: 0,
    })
}

impl PairedComparisons {
    /// Wins of each item (a tie is half a win), a block per participant; none where participants did not all compare
    /// each item equally often.
    pub fn wins(&self) -> Option<Blocks> {
        blocks(self)
    }
}
