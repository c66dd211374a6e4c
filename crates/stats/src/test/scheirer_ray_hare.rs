//! Scheirer-Ray-Hare test: a two-way analysis of variance of midranks, read as chi-square.
//!
//! Scheirer, Ray and Hare 1976: H = SS_effect / MS_total, MS_total = SS_total / (n - 1), which is the
//! tie correction. The sums of squares need cell counts and cell rank sums only.

use mimique_locale::{format_number, format_p};
use serde::{Serialize, Serializer};

use crate::distributions::tail::chi_square_upper;
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, Choice, ProcedureOption, RESPONSE};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::ranks::Ranks;
use crate::ranks::two_way::{Cells, TwoWaySums};
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::Table;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::undefined::Undefined;

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
    /// From `1`, `2` or `3`; type II of anything else.
    fn from_name(name: &str) -> Self {
        match name {
            "1" => Self::One,
            "3" => Self::Three,
            _ => Self::Two,
        }
    }

    /// I, II or III.
    pub fn roman(self) -> &'static str {
        match self {
            Self::One => "I",
            Self::Two => "II",
            Self::Three => "III",
        }
    }

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
    pub effects: [Term; 4],
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
        return Ok(Outcome::undefined(Undefined::EqualValues {
            column: response.name.clone(),
            n,
            value: ranks.values[0],
        }));
    }
    let cells = rank_sums(&ranks, &first, &second);
    let two_way = TwoWaySums::of(&cells, ranks.sum_of_squares());
    let table = |ss: [f64; 3]| srh_table(n, &two_way, ss);
    let type3 = two_way.type3().map(&table);

    let mut warnings = Vec::new();
    let empty_cells = cells.empty();
    if empty_cells > 0 {
        warnings.push(format!(
            "{empty_cells} of {} combinations of {} and {} have no observation: the interaction loses as many degrees of freedom, type III is not defined",
            cells.rows * cells.columns,
            first.name,
            second.name
        ));
        if ss_type == SumsOfSquares::Three {
            let factors = [first.name.clone(), second.name.clone()];
            return Ok(Outcome::undefined(Undefined::EmptyCells { factors, empty: empty_cells }));
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
            Term::factor(&first.name),
            Term::factor(&second.name),
            Term::interaction(&first.name, &second.name),
            Term::factor("residual"),
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

/// Sums of the midranks about their mean, by the combination of two factors.
fn rank_sums(ranks: &Ranks, first: &Factor, second: &Factor) -> Cells {
    let (rows, columns) = (first.levels.len(), second.levels.len());
    let cells: Vec<u32> = first
        .codes
        .iter()
        .zip(&second.codes)
        .map(|(&row, &column)| row * columns as u32 + column)
        .collect();
    let mut counts = vec![0u64; rows * columns];
    cells.iter().for_each(|&cell| counts[cell as usize] += 1);
    let doubled = ranks.doubled_sums(&cells, rows * columns);
    let centre = (cells.len() as f64 + 1.0) / 2.0;
    let sums = doubled
        .iter()
        .zip(&counts)
        .map(|(&sum, &count)| sum as f64 / 2.0 - count as f64 * centre)
        .collect();
    Cells { rows, columns, counts, sums }
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

/// `mimique test scheirer-ray-hare`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "scheirer-ray-hare",
    question: "Do two factors, or their combination, matter? Two-way analysis of ranks",
    options: &[&[RESPONSE, ProcedureOption::list("factors", "Two columns").required(), SS]],
    run,
    sample: Sample::TwoFactors,
    r: r#"
# An analysis of variance of ranks (type I), read as chi-square.
scheirer_ray_hare <- function(y, a, b, effect) {
  r <- rank(y)
  table <- anova(lm(r ~ factor(a) * factor(b)))
  h <- table[["Sum Sq"]][effect] / var(r)
  c(statistic = h, p = pchisq(h, table[["Df"]][effect], lower.tail = FALSE),
    effect = h / (length(r) - 1), n = length(r))
}
"#,
    python: r#"
def dummies(labels):
    return np.array([[float(label == level) for level in sorted(set(labels))[1:]] for label in labels])


def residual_squares(design, values):
    fitted = design @ np.linalg.lstsq(design, values, rcond=None)[0]
    return ((values - fitted) ** 2).sum()


def scheirer_ray_hare(y, a, b, effect):
    """An analysis of variance of ranks (type I), read as chi-square."""
    r = stats.rankdata(y)
    of_a, of_b = dummies(a), dummies(b)
    of_both = (of_a[:, :, None] * of_b[:, None, :]).reshape(len(r), -1)
    parts = [np.ones((len(r), 1)), of_a, of_b, of_both]
    before = residual_squares(np.hstack(parts[:effect]), r)
    after = residual_squares(np.hstack(parts[: effect + 1]), r)
    rank = lambda many: np.linalg.matrix_rank(np.hstack(many))
    df = rank(parts[: effect + 1]) - rank(parts[:effect])
    h = (before - after) / r.var(ddof=1)
    return dict(statistic=h, p=stats.chi2.sf(h, df), effect=h / (len(r) - 1), n=len(r))
"#,
    golden_cases: "scheirer_ray_hare",
};

const SS: ProcedureOption = ProcedureOption::one_of(
    "ss",
    "Type of the sums of squares",
    &[
        Choice::new("1", "In the order given").or(&["I"]),
        Choice::new("2", "Each main effect adjusted for the other").or(&["II"]),
        Choice::new("3", "Each effect adjusted for all others").or(&["III"]),
    ],
    Some("2"),
);

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factors = arguments.factors(table)?;
    let [first, second] = factors.as_slice() else {
        return Err(Refusal::NumberOfFactors { named: factors.len(), least: 2, most: 2 });
    };
    let response = arguments.numbers(table, "response")?;
    let ss = arguments.chosen(&SS)?.map(SumsOfSquares::from_name).unwrap_or_default();
    Ok(Answer::of_test(&scheirer_ray_hare(&response, [first, second], ss)?, words))
}

impl TestResult for ScheirerRayHare {
    const NAMES: TestNames = TestNames {
        test: "Scheirer-Ray-Hare",
        short: "SRH",
        in_words: ["Scheirer-Ray-Hare test", "test de Scheirer-Ray-Hare"],
        statistic: "H",
        statistic_symbol: "H",
        effect: "eta squared H",
        effect_symbol: "η²H",
        function: "scheirer_ray_hare",
    };

    /// Both factors and their interaction, of the type of sums of squares asked for.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let row = |effect: usize| {
            let name = &self.effects[effect];
            let known = self.chosen().and_then(|table| {
                Some((table, table.H[effect]?, table.p[effect]?, table.ln_p[effect]?))
            });
            let Some((table, statistic, p_value, ln_p)) = known else {
                return Outcome::undefined(Undefined::NoDegreesOfFreedom { term: name.clone() });
            };
            Outcome::Ok(TestRow {
                variant: format!("type {}", self.ss_type.roman()),
                term: name.clone(),
                statistic,
                degrees_of_freedom: vec![table.df[effect]],
                p_value,
                ln_p,
                effect: table.eta_squared_H[effect],
                n: self.n,
            })
        };
        (0..3).map(row).collect()
    }
}

fn words(result: &ScheirerRayHare) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Scheirer-Ray-Hare test ({})", result.variant));
    lines.add(format!("{} observations{}", result.n, lines::dropped(result.dropped)));
    if let Some(table) = result.chosen() {
        let mut rows =
            vec![lines::row(["effect", "df", "sum of squares", "H", "p", "eta squared H"])];
        for effect in 0..4 {
            let mut cells = vec![
                result.effects[effect].to_string(),
                table.df[effect].to_string(),
                format_number(table.ss[effect]),
            ];
            if effect < 3 {
                cells.extend([
                    lines::optional(table.H[effect]),
                    match (table.p[effect], table.ln_p[effect]) {
                        // The column's name is the other side of the equation.
                        (Some(p), Some(ln_p)) => format_p(p, ln_p).replace("= ", ""),
                        _ => "undefined".to_owned(),
                    },
                    lines::optional(table.eta_squared_H[effect]),
                ]);
            }
            rows.push(cells);
        }
        lines.table(&rows);
    }
    lines.warnings(&result.warnings);
    lines.into_text()
}
