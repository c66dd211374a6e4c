//! Aligned rank transform of a balanced design with two or three factors within blocks.
//!
//! Wobbrock, Findlater, Gergle and Higgins 2011: for each effect, what the other effects explain is
//! taken away (the residual of the full model of cell means plus the effect's own estimate), the result
//! is ranked, and the effect's F comes from the analysis of variance of those ranks with the block as a
//! random intercept (on balanced data: the residual after blocks and all cells).

use std::collections::HashMap;

use serde::Serialize;

use crate::distributions::tail::f_upper;
use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption, RESPONSE};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::ranks::Ranks;
use crate::refusal::Refusal;
use crate::table::Numbers;
use crate::table::Table;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::undefined::Undefined;

/// One effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[allow(non_snake_case)]
pub struct ArtEffect {
    /// The factor, or those that interact.
    pub term: Term,
    /// F; none where the ranks leave no residual.
    pub F: Option<f64>,
    /// Degrees of freedom of the effect.
    pub df1: usize,
    /// Degrees of freedom of the residual.
    pub df2: usize,
    /// Upper F tail.
    pub p_value: Option<f64>,
    /// Its natural logarithm.
    pub ln_p: Option<f64>,
}

/// Result of [`aligned_rank_transform`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AlignedRankTransform {
    /// Always `aligned-rank-transform`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// Observations used.
    pub n: usize,
    /// Rows dropped because of missing values.
    pub dropped: usize,
    /// Blocks used.
    pub n_blocks: usize,
    /// Blocks left out because a cell is missing in them.
    pub incomplete_blocks: usize,
    /// Every effect, main effects first.
    pub effects: Vec<ArtEffect>,
    /// What to mind.
    pub warnings: Vec<String>,
}

/// Main effects and interactions of two or three factors. Each block must have the same number of
/// responses in each cell; blocks with an empty cell are left out.
pub fn aligned_rank_transform(
    response: &Numbers,
    factors: &[&Factor],
    block: &Factor,
) -> Result<Outcome<AlignedRankTransform>, Refusal> {
    if !(2..=3).contains(&factors.len()) {
        return Err(Refusal::NumberOfFactors { named: factors.len(), least: 2, most: 3 });
    }
    let columns: Vec<&Factor> = factors.iter().copied().chain([block]).collect();
    let complete = complete_rows(&[response], &columns)?;
    let (rows, dropped) = (complete.to_vec(), complete.dropped());
    let used: Vec<Factor> = factors.iter().map(|factor| factor.rows(&rows)).collect();
    for factor in &used {
        factor.require_levels(2)?;
    }
    let layout = match Layout::balanced(&used, &block.rows(&rows)) {
        Outcome::Undefined { reason } => return Ok(Outcome::Undefined { reason }),
        Outcome::Ok(layout) => layout,
    };
    let values: Vec<f64> = layout.rows.iter().map(|&i| response.values[rows[i]]).collect();
    if values.iter().all(|&value| value == values[0]) {
        return Ok(Outcome::undefined(Undefined::EqualValues {
            column: response.name.clone(),
            n: values.len(),
            value: values[0],
        }));
    }
    Ok(Outcome::Ok(AlignedRankTransform {
        test: "aligned-rank-transform",
        variant: "aligned, midranks, analysis of variance with the block as random intercept",
        n: values.len(),
        dropped,
        n_blocks: layout.used_blocks,
        incomplete_blocks: layout.n_blocks - layout.used_blocks,
        effects: layout.effects(&values, factors),
        warnings: vec![
            "not reliable on ordinal answers with few steps: fit a cumulative link mixed model before relying on an interaction".to_owned(),
        ],
    }))
}

/// A balanced layout: cell and block of each observation.
struct Layout {
    /// The observations: rows of complete blocks.
    rows: Vec<usize>,
    sizes: Vec<usize>,
    cells: Vec<usize>,
    blocks: Vec<usize>,
    n_blocks: usize,
    used_blocks: usize,
}

impl Layout {
    /// The complete blocks. Undefined if there are fewer than two, or if their cells differ in size.
    fn balanced(factors: &[Factor], block: &Factor) -> Outcome<Self> {
        let sizes: Vec<usize> = factors.iter().map(|factor| factor.levels.len()).collect();
        let cells: usize = sizes.iter().product();
        let cell_of = |i: usize| {
            factors
                .iter()
                .fold(0, |cell, factor| cell * factor.levels.len() + factor.codes[i] as usize)
        };
        let mut found: HashMap<(u32, usize), usize> = HashMap::new();
        for (i, &code) in block.codes.iter().enumerate() {
            *found.entry((code, cell_of(i))).or_insert(0) += 1;
        }
        let complete: Vec<bool> = (0..block.levels.len() as u32)
            .map(|block| (0..cells).all(|cell| found.contains_key(&(block, cell))))
            .collect();
        let rows: Vec<usize> =
            (0..block.codes.len()).filter(|&i| complete[block.codes[i] as usize]).collect();
        let used_blocks = complete.iter().filter(|complete| **complete).count();
        if used_blocks < 2 {
            return Outcome::undefined(Undefined::TooFewCompleteBlocks {
                complete: used_blocks,
                blocks: block.levels.len(),
                combinations: cells,
            });
        }
        let per_cell = rows.len() / (used_blocks * cells);
        let uneven = found
            .iter()
            .filter(|((block, _), _)| complete[*block as usize])
            .any(|(_, &count)| count != per_cell);
        if uneven {
            return Outcome::undefined(Undefined::Unbalanced);
        }
        Outcome::Ok(Self {
            sizes,
            cells: rows.iter().map(|&i| cell_of(i)).collect(),
            blocks: rows.iter().map(|&i| block.codes[i] as usize).collect(),
            rows,
            n_blocks: block.levels.len(),
            used_blocks,
        })
    }

    /// Every effect, main effects first.
    fn effects(&self, values: &[f64], factors: &[&Factor]) -> Vec<ArtEffect> {
        let mut terms: Vec<usize> = (1..1 << factors.len()).collect();
        terms.sort_by_key(|term: &usize| (term.count_ones(), *term));
        terms
            .into_iter()
            .map(|term| {
                let names = (0..factors.len())
                    .filter(|factor| term >> factor & 1 == 1)
                    .map(|factor| factors[factor].name.clone());
                self.effect(values, term, Term::Effect(names.collect()))
            })
            .collect()
    }

    fn effect(&self, values: &[f64], term: usize, name: Term) -> ArtEffect {
        let all = (1 << self.sizes.len()) - 1;
        let cell_means = self.means(values, all);
        let estimate = self.estimate(values, term);
        let aligned: Vec<f64> = (0..values.len())
            .map(|i| values[i] - cell_means[i] + estimate[i])
            // What should be equal differs by rounding.
            .map(|value| (value * 1e8).round() / 1e8)
            .collect();
        let ranks = Ranks::of(&aligned);
        let responses = ranks.to_vec();
        let effect_squares = squares(&self.estimate(&responses, term));
        let total_mean = self.means(&responses, 0);
        let total: f64 = (0..responses.len()).map(|i| (responses[i] - total_mean[i]).powi(2)).sum();
        let rank_cells = self.means(&responses, all);
        let between_cells: f64 =
            (0..responses.len()).map(|i| (rank_cells[i] - total_mean[i]).powi(2)).sum();
        let between_blocks = self.between_blocks(&responses, total_mean[0]);
        let df1: usize = (0..self.sizes.len())
            .filter(|factor| term >> factor & 1 == 1)
            .map(|factor| self.sizes[factor] - 1)
            .product();
        let cells: usize = self.sizes.iter().product();
        let df2 = values.len() - cells - (self.used_blocks - 1);
        let residual = total - between_cells - between_blocks;
        let tail = (df2 > 0 && residual > total * 1e-12).then(|| {
            let f = (effect_squares / df1 as f64) / (residual / df2 as f64);
            (f, f_upper(f, df1 as f64, df2 as f64))
        });
        ArtEffect {
            term: name,
            F: tail.map(|(f, _)| f),
            df1,
            df2,
            p_value: tail.map(|(_, tail)| tail.p),
            ln_p: tail.map(|(_, tail)| tail.ln_p),
        }
    }

    /// Mean of the observations that share the levels of the factors in `subset`, at each observation.
    fn means(&self, values: &[f64], subset: usize) -> Vec<f64> {
        let key = |mut cell: usize| {
            let mut key = 0;
            for factor in (0..self.sizes.len()).rev() {
                let level = cell % self.sizes[factor];
                cell /= self.sizes[factor];
                if subset >> factor & 1 == 1 {
                    key = key * self.sizes[factor] + level;
                }
            }
            key
        };
        let length = self.sizes.iter().product();
        let (mut sums, mut counts) = (vec![0.0; length], vec![0.0; length]);
        for (i, &value) in values.iter().enumerate() {
            sums[key(self.cells[i])] += value;
            counts[key(self.cells[i])] += 1.0;
        }
        self.cells.iter().map(|&cell| sums[key(cell)] / counts[key(cell)]).collect()
    }

    /// Estimated effect at each observation: marginal means with alternating signs over the subsets.
    fn estimate(&self, values: &[f64], term: usize) -> Vec<f64> {
        let mut estimate = vec![0.0; values.len()];
        for subset in (0..=term).filter(|subset| subset & term == *subset) {
            let odd = (term.count_ones() - subset.count_ones()) % 2 == 1;
            for (sum, mean) in estimate.iter_mut().zip(self.means(values, subset)) {
                *sum += if odd { -mean } else { mean };
            }
        }
        estimate
    }

    fn between_blocks(&self, values: &[f64], grand_mean: f64) -> f64 {
        let (mut sums, mut counts) = (vec![0.0; self.n_blocks], vec![0.0f64; self.n_blocks]);
        for (i, &value) in values.iter().enumerate() {
            sums[self.blocks[i]] += value - grand_mean;
            counts[self.blocks[i]] += 1.0;
        }
        sums.iter().zip(&counts).filter(|(_, n)| **n > 0.0).map(|(sum, n)| sum * sum / n).sum()
    }
}

fn squares(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum()
}

/// `mimique test aligned-rank-transform`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "aligned-rank-transform",
    question: "Effects and interactions of two or three factors within blocks, on aligned ranks",
    options: &[&[
        RESPONSE,
        ProcedureOption::list("factors", "Two or three columns").required(),
        ProcedureOption::text("block", "Column of the blocks (participants)").required(),
    ]],
    run,
    sample: Sample::TwoFactorsInBlocks,
    r: r#"
# Of one response per person and combination; `effect` is 1 or 2 for the factors, 3 for both.
aligned_rank_transform <- function(y, a, b, person, effect) {
  a <- factor(a)
  b <- factor(b)
  grand <- mean(y)
  of_a <- ave(y, a) - grand
  of_b <- ave(y, b) - grand
  of_cell <- ave(y, a, b)
  own <- list(of_a, of_b, of_cell - grand - of_a - of_b)[[effect]]
  r <- rank(round(y - of_cell + own, 8))
  table <- anova(lm(r ~ factor(person) + a * b))
  row <- effect + 1
  df <- table[["Df"]][c(row, 5)]
  f <- table[["F value"]][row]
  c(statistic = f, p = pf(f, df[1], df[2], lower.tail = FALSE),
    effect = f * df[1] / (f * df[1] + df[2]), n = length(unique(person)))
}
"#,
    python: r#"
def aligned_rank_transform(y, a, b, person, effect):
    """Of one response per person and combination; effect is 1 or 2 for the factors, 3 for both."""
    places = [np.unique(labels, return_inverse=True)[1] for labels in (person, a, b)]
    n, *sizes = (place.max() + 1 for place in places)
    cube = np.empty((n, *sizes))
    cube[tuple(places)] = y

    def estimates(cube):
        grand = cube.mean()
        of_a = cube.mean(axis=(0, 2), keepdims=True) - grand
        of_b = cube.mean(axis=(0, 1), keepdims=True) - grand
        both = cube.mean(axis=0, keepdims=True) - grand - of_a - of_b
        return [estimate + np.zeros_like(cube) for estimate in (of_a, of_b, both)]

    aligned = np.round(cube - cube.mean(axis=0, keepdims=True) + estimates(cube)[effect - 1], 8)
    r = stats.rankdata(aligned).reshape(cube.shape)
    squares = (estimates(r)[effect - 1] ** 2).sum()
    between_people = ((r.mean(axis=(1, 2)) - r.mean()) ** 2).sum() * sizes[0] * sizes[1]
    between_cells = ((r.mean(axis=0) - r.mean()) ** 2).sum() * n
    residual = ((r - r.mean()) ** 2).sum() - between_people - between_cells
    df1 = [sizes[0] - 1, sizes[1] - 1, (sizes[0] - 1) * (sizes[1] - 1)][effect - 1]
    df2 = (sizes[0] * sizes[1] - 1) * (n - 1)
    f = squares / df1 / (residual / df2)
    return dict(statistic=f, p=stats.f.sf(f, df1, df2), effect=f * df1 / (f * df1 + df2), n=n)
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factors = arguments.factors(table)?;
    let factors: Vec<&Factor> = factors.iter().collect();
    let block = table.combined_factor(arguments.needed("block")?)?;
    let response = arguments.numbers(table, "response")?;
    Ok(Answer::of_test(&aligned_rank_transform(&response, &factors, &block)?, words))
}

impl TestResult for AlignedRankTransform {
    const NAMES: TestNames = TestNames {
        test: "aligned rank transform",
        short: "ART",
        in_words: ["aligned rank transform", "transformation des rangs alignés"],
        statistic: "F",
        statistic_symbol: "F",
        effect: "partial eta squared",
        effect_symbol: "ηp²",
        function: "aligned_rank_transform",
    };

    /// Every effect, main effects first.
    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let row = |effect: &ArtEffect| {
            let (Some(f), Some(p_value), Some(ln_p)) = (effect.F, effect.p_value, effect.ln_p)
            else {
                return Outcome::undefined(Undefined::NoResidual { term: effect.term.clone() });
            };
            let explained = f * effect.df1 as f64;
            Outcome::Ok(TestRow {
                variant: String::new(),
                term: effect.term.clone(),
                statistic: f,
                degrees_of_freedom: vec![effect.df1, effect.df2],
                p_value,
                ln_p,
                effect: Some(explained / (explained + effect.df2 as f64)),
                n: self.n_blocks,
            })
        };
        self.effects.iter().map(row).collect()
    }
}

fn words(result: &AlignedRankTransform) -> String {
    let mut lines = Lines::default();
    lines.add(format!("Aligned rank transform ({})", result.variant));
    lines.add(format!(
        "{} observations, {} blocks{}",
        result.n,
        result.n_blocks,
        lines::dropped(result.dropped)
    ));
    let mut rows = vec![lines::row(["effect", "F", "df1", "df2", "p"])];
    for effect in &result.effects {
        rows.push(vec![
            effect.term.to_string(),
            lines::optional(effect.F),
            effect.df1.to_string(),
            effect.df2.to_string(),
            lines::p_value(effect.p_value),
        ]);
    }
    lines.table(&rows);
    lines.warnings(&result.warnings);
    lines.into_text()
}
