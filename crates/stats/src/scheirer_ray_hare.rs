//! Scheirer-Ray-Hare test: a two-way analysis of variance of midranks, read as chi-square.
//!
//! Scheirer, Ray and Hare 1976: H = SS_effect / MS_total, MS_total = SS_total / (n - 1), which is the
//! tie correction. The sums of squares need cell counts and cell rank sums only.

use serde::{Serialize, Serializer};

use crate::factor::Factor;
use crate::grouped::equal_values;
use crate::outcome::{Outcome, Refusal};
use crate::ranks::Ranks;
use crate::sample::complete_rows;
use crate::table::Numbers;
use crate::tail::chi_square_upper;
use crate::two_way::{Cells, TwoWaySums};

/// Type of the sums of squares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SumsOfSquares {
    /// In the order given: the second factor adjusted for the first.
    One,
    /// Each main effect adjusted for the other.
    #[default]
    Two,
    /// Each effect adjusted for all others: equal weight to each cell.
    Three,
}

impl SumsOfSquares {
    /// 1, 2 or 3.
    pub fn number(self) -> u8 {
        match self {
            Self::One => 1,
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

impl Serialize for SumsOfSquares {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(self.number())
    }
}

/// Result of [`scheirer_ray_hare`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScheirerRayHare {
    /// Always `scheirer-ray-hare`.
    pub test: &'static str,
    /// What was computed.
    pub variant: String,
    /// The type asked for.
    pub ss_type: SumsOfSquares,
    /// Names of factor 1, factor 2, interaction, residual: the order of all arrays.
    pub effects: [String; 4],
    /// Observations used.
    pub n: usize,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// Cells without an observation.
    pub empty_cells: usize,
    /// Type I: factor 1, then factor 2, then interaction.
    pub type1: SrhTable,
    /// Type II.
    pub type2: SrhTable,
    /// Type III; none where a cell is empty.
    pub type3: Option<SrhTable>,
    /// What to mind.
    pub warnings: Vec<String>,
}

impl ScheirerRayHare {
    /// The table of the type asked for.
    pub fn chosen(&self) -> Option<&SrhTable> {
        match self.ss_type {
            SumsOfSquares::One => Some(&self.type1),
            SumsOfSquares::Two => Some(&self.type2),
            SumsOfSquares::Three => self.type3.as_ref(),
        }
    }
}

/// One analysis of variance of ranks. Arrays of four: factor 1, factor 2, interaction, residual; of
/// three: without the residual. An effect without degrees of freedom has no statistic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct SrhTable {
    /// Observations.
    pub n: usize,
    /// Total mean square of the midranks.
    pub ms_total: f64,
    /// Degrees of freedom.
    pub df: [usize; 4],
    /// Sums of squares.
    pub ss: [f64; 4],
    /// SS / MS_total.
    pub H: [Option<f64>; 3],
    /// Upper chi-square tail.
    pub p: [Option<f64>; 3],
    /// Its natural logarithm.
    pub ln_p: [Option<f64>; 3],
    /// H / (n - 1).
    pub eta_squared_H: [Option<f64>; 3],
}

/// Do two factors, and their combination, shift the response?
///
/// Refuses a factor with one level; undefined if all responses are equal.
pub fn scheirer_ray_hare(
    response: &Numbers,
    factors: [&Factor; 2],
    ss_type: SumsOfSquares,
) -> Result<Outcome<ScheirerRayHare>, Refusal> {
    let rows = complete_rows(&[response], &factors)?;
    let dropped = rows.dropped();
    let [first, second] = factors.map(|factor| rows.factor(factor));
    first.require_levels(2)?;
    second.require_levels(2)?;
    let values = rows.numbers(response);
    let ranks = Ranks::of(&values);
    let n = values.len();
    if ranks.values.len() == 1 {
        return Ok(Outcome::undefined(equal_values(&response.name, n, ranks.values[0])));
    }
    let (a, b) = (first.levels.len(), second.levels.len());
    let cells: Vec<u32> = first
        .codes
        .iter()
        .zip(&second.codes)
        .map(|(&row, &column)| row * b as u32 + column)
        .collect();
    let mut counts = vec![0u64; a * b];
    cells.iter().for_each(|&cell| counts[cell as usize] += 1);
    let doubled = ranks.doubled_sums(&cells, a * b);
    let centre = (n as f64 + 1.0) / 2.0;
    let sums = doubled
        .iter()
        .zip(&counts)
        .map(|(&sum, &count)| sum as f64 / 2.0 - count as f64 * centre)
        .collect();
    let cells = Cells { rows: a, columns: b, counts, sums };
    let two_way = TwoWaySums::of(&cells, ranks.sum_of_squares());
    let table = |ss: [f64; 3]| srh_table(n, &two_way, ss);
    let type3 = two_way.type3().map(&table);

    let mut warnings = Vec::new();
    let empty_cells = cells.empty();
    if empty_cells > 0 {
        warnings.push(format!(
            "{empty_cells} of {} combinations of {} and {} have no observation: the interaction loses as many degrees of freedom, type III is not defined",
            a * b,
            first.name,
            second.name
        ));
        if ss_type == SumsOfSquares::Three {
            return Ok(Outcome::undefined(format!(
                "type III sums of squares need every combination of \"{}\" and \"{}\"; {empty_cells} have no observation",
                first.name, second.name
            )));
        }
    }
    Ok(Outcome::Ok(ScheirerRayHare {
        test: "scheirer-ray-hare",
        variant: format!(
            "midranks, corrected for ties, type {} sums of squares",
            ["I", "II", "III"][usize::from(ss_type.number()) - 1]
        ),
        ss_type,
        effects: [
            first.name.clone(),
            second.name.clone(),
            format!("{}:{}", first.name, second.name),
            "residual".to_owned(),
        ],
        n,
        dropped,
        empty_cells,
        type1: table(two_way.type1()),
        type2: table(two_way.type2()),
        type3,
        warnings,
    }))
}

fn srh_table(n: usize, two_way: &TwoWaySums, ss: [f64; 3]) -> SrhTable {
    let ms_total = two_way.total / (n - 1) as f64;
    let df = two_way.df(n);
    let h: [Option<f64>; 3] =
        std::array::from_fn(|effect| (df[effect] > 0).then(|| ss[effect] / ms_total));
    let tails: [_; 3] =
        std::array::from_fn(|effect| h[effect].map(|h| chi_square_upper(h, df[effect] as f64)));
    SrhTable {
        n,
        ms_total,
        df,
        ss: [ss[0], ss[1], ss[2], two_way.residual()],
        H: h,
        p: tails.map(|tail| tail.map(|tail| tail.p)),
        ln_p: tails.map(|tail| tail.map(|tail| tail.ln_p)),
        eta_squared_H: h.map(|h| h.map(|h| h / (n - 1) as f64)),
    }
}
