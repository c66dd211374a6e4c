//! Whether judges agree with themselves and with each other: circular triads, the coefficient of consistence ζ,
//! the coefficient of agreement u (Kendall and Babington Smith 1940, Biometrika 31, 324).
//!
//! A judge who chooses A over B, B over C and C over A makes a circular triad. All three statistics are of
//! complete tournaments: each judge has chosen once of each pair, without ties.

use std::collections::BTreeMap;

use mimique_locale::{format_number, format_p};
use serde::Serialize;

use crate::distributions::tail::{Tail, chi_square_upper};
use crate::outcome::Outcome;
use crate::procedure::arguments::Arguments;
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{Term, TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::{Refusal, Unfit};
use crate::table::Table;
use crate::table::comparisons::{COMPARISON_OPTIONS, Chosen, PairedComparisons};
use crate::undefined::NoEstimate;

/// Items up to which p of a number of circular triads is exact.
const EXACT_UP_TO: usize = 7;

/// A judge's consistency.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JudgeConsistency {
    /// The judge.
    pub participant: String,
    /// Circular triads.
    pub circular_triads: usize,
    /// The most there can be.
    pub most: usize,
    /// 1 - circular triads / most; none with two items.
    pub zeta: Option<f64>,
    /// Probability of so few circular triads or fewer where every choice is tossed; exact to 7 items, else none.
    pub p_exact: Option<f64>,
    /// The same by the chi-square approximation, from 8 items on.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub p_chi_square: Option<f64>,
}

/// Result of [`consistency`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Consistency {
    /// Always `consistency`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// The items.
    pub items: Vec<String>,
    /// Judges.
    pub judges: usize,
    /// Rows left out.
    pub dropped: usize,
    /// Each judge, in the order of their names.
    pub people: Vec<JudgeConsistency>,
    /// Of all tournaments of so many items, how many have 0, 1, 2, ... circular triads; none beyond 7 items.
    pub distribution_of_triads: Option<Vec<u64>>,
    /// Agreement between judges: 1 where all agree.
    pub u: f64,
    /// The least that u can be with so many judges.
    pub u_least: f64,
    /// Chi-square of u; none with two judges.
    pub chi_square: Option<f64>,
    /// Its degrees of freedom, not whole.
    pub df: Option<f64>,
    /// Its upper tail.
    pub p: Option<f64>,
    /// The natural logarithm of that.
    pub ln_p: Option<f64>,
}

/// Consistency of the judges, who are the participants of the comparisons. Refuses what is no complete
/// tournament, naming judge and pair; undefined with one judge.
pub fn consistency(data: &PairedComparisons) -> Result<Outcome<Consistency>, Refusal> {
    let (items, judges) = (data.items.len(), data.participants.len());
    let wins = tournaments(data)?;
    if judges < 2 {
        return Ok(Outcome::undefined(NoEstimate::OneJudge));
    }
    let distribution = (items <= EXACT_UP_TO).then(|| distribution_of_triads(items));
    let people = data.participants.iter().zip(&wins);
    let people =
        people.map(|(judge, wins)| judge_consistency(judge, wins, distribution.as_deref()));
    let agreement = Agreement::of(&wins);
    let (test, df) = agreement.chi_square();
    let tail = test.map(|statistic| chi_square_upper(statistic, df));
    Ok(Outcome::Ok(Consistency {
        test: "consistency",
        variant: "complete tournaments without ties",
        items: data.items.clone(),
        judges,
        dropped: data.dropped,
        people: people.collect(),
        distribution_of_triads: distribution,
        u: agreement.u(),
        u_least: -1.0 / (judges - usize::from(judges % 2 == 0)) as f64,
        chi_square: test,
        df: test.map(|_| df),
        p: tail.map(|tail| tail.p),
        ln_p: tail.map(|tail| tail.ln_p),
    }))
}

/// For each judge, whether the row's item was chosen over the column's.
fn tournaments(data: &PairedComparisons) -> Result<Vec<Vec<Vec<bool>>>, Refusal> {
    let items = data.items.len();
    let mut wins = vec![vec![vec![false; items]; items]; data.participants.len()];
    let mut times = vec![vec![0_usize; items * items]; data.participants.len()];
    let named = |judge: usize, a: usize, b: usize| {
        let (judge, pair) = (&data.participants[judge], [&data.items[a], &data.items[b]]);
        (judge.clone(), pair.map(String::clone))
    };
    for answer in &data.answers {
        let (winner, loser) = match answer.chosen {
            Chosen::Left => (answer.left, answer.right),
            Chosen::Right => (answer.right, answer.left),
            Chosen::Same => {
                let (judge, pair) = named(answer.participant, answer.left, answer.right);
                return Err(Unfit::TiedTournament { judge, pair }.into());
            }
        };
        wins[answer.participant][winner][loser] = true;
        let (a, b) = (winner.min(loser), winner.max(loser));
        times[answer.participant][a * items + b] += 1;
    }
    for (judge, times) in times.iter().enumerate() {
        for (a, b) in mimique_adaptive::all_pairs(items) {
            let times = times[a * items + b];
            if times != 1 {
                let (judge, pair) = named(judge, a, b);
                return Err(Unfit::IncompleteTournament { judge, pair, times }.into());
            }
        }
    }
    Ok(wins)
}

fn choose(n: usize, k: usize) -> usize {
    (0..k).fold(1, |ways, i| ways * (n - i.min(n)) / (i + 1))
}

/// Circular triads of a tournament by its scores: C(n, 3) - Σ C(s, 2).
fn triads(scores: impl Iterator<Item = usize>, items: usize) -> usize {
    choose(items, 3) - scores.map(|score| choose(score, 2)).sum::<usize>()
}

fn judge_consistency(
    judge: &str,
    wins: &[Vec<bool>],
    distribution: Option<&[u64]>,
) -> JudgeConsistency {
    let items = wins.len();
    let scores = wins.iter().map(|row| row.iter().filter(|won| **won).count());
    let found = triads(scores, items);
    let cube = items * items * items;
    let most = if items % 2 == 1 { (cube - items) / 24 } else { (cube - 4 * items) / 24 };
    JudgeConsistency {
        participant: judge.to_owned(),
        circular_triads: found,
        most,
        zeta: (most > 0).then(|| 1.0 - found as f64 / most as f64),
        p_exact: distribution.map(|counts| {
            let all: u64 = counts.iter().sum();
            counts[..=found].iter().sum::<u64>() as f64 / all as f64
        }),
        p_chi_square: distribution.is_none().then(|| chi_square_of_triads(found, items)),
    }
}

/// The approximation for many items: 8 / (n - 4) (C(n, 3) / 4 - d + 1/2) + f is chi-square with
/// f = n (n - 1)(n - 2) / (n - 4)² degrees of freedom where its tail is that of fewer than d; so few or fewer
/// are fewer than d + 1.
fn chi_square_of_triads(found: usize, items: usize) -> f64 {
    let (n, rest) = (items as f64, items as f64 - 4.0);
    let df = n * (n - 1.0) * (n - 2.0) / (rest * rest);
    let statistic = 8.0 / rest * (choose(items, 3) as f64 / 4.0 - found as f64 - 0.5) + df;
    chi_square_upper(statistic, df).p
}

/// How many tournaments have each number of circular triads: items are added one by one, tournaments with the same
/// scores counted together.
fn distribution_of_triads(items: usize) -> Vec<u64> {
    let mut by_scores: BTreeMap<Vec<usize>, u64> = BTreeMap::from([(vec![0], 1)]);
    for present in 1..items {
        let mut next = BTreeMap::new();
        for (scores, ways) in &by_scores {
            for beaten in 0_u32..1 << present {
                let mut scores: Vec<usize> = (0..present)
                    .map(|item| scores[item] + usize::from(beaten >> item & 1 == 0))
                    .collect();
                scores.push(beaten.count_ones() as usize);
                scores.sort_unstable();
                *next.entry(scores).or_insert(0) += ways;
            }
        }
        by_scores = next;
    }
    let mut counts = Vec::new();
    for (scores, ways) in by_scores {
        let found = triads(scores.into_iter(), items);
        counts.resize(counts.len().max(found + 1), 0);
        counts[found] += ways;
    }
    counts
}

/// Agreements of pairs of judges.
struct Agreement {
    /// Σ C(a_ij, 2), with a_ij the judges who chose i over j.
    agreements: f64,
    pairs_of_items: f64,
    judges: f64,
}

impl Agreement {
    fn of(wins: &[Vec<Vec<bool>>]) -> Self {
        let (judges, items) = (wins.len(), wins[0].len());
        let mut agreements = 0;
        for a in 0..items {
            for b in 0..items {
                agreements += choose(wins.iter().filter(|wins| wins[a][b]).count(), 2);
            }
        }
        Self {
            agreements: agreements as f64,
            pairs_of_items: choose(items, 2) as f64,
            judges: judges as f64,
        }
    }

    fn pairs_of_judges(&self) -> f64 {
        self.judges * (self.judges - 1.0) / 2.0
    }

    fn u(&self) -> f64 {
        2.0 * self.agreements / (self.pairs_of_judges() * self.pairs_of_items) - 1.0
    }

    /// 4 / (m - 2) (Σ - C(n, 2) C(m, 2) (m - 3) / (2 (m - 2))) on C(n, 2) m (m - 1) / (m - 2)² degrees of
    /// freedom; none with two judges.
    fn chi_square(&self) -> (Option<f64>, f64) {
        let rest = self.judges - 2.0;
        if rest <= 0.0 {
            return (None, 0.0);
        }
        let expected =
            0.5 * self.pairs_of_items * self.pairs_of_judges() * (self.judges - 3.0) / rest;
        let df = 2.0 * self.pairs_of_items * self.pairs_of_judges() / (rest * rest);
        (Some(4.0 / rest * (self.agreements - expected)), df)
    }
}

/// `mimique test consistency`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "consistency",
    question: "Do judges agree with themselves and each other? Circular triads, zeta, Kendall's u",
    options: &[&COMPARISON_OPTIONS],
    run,
    sample: Sample::Tournaments,
    r: r#"
# Kendall and Babington Smith's coefficient of agreement u of complete tournaments.
agreement_of_judges <- function(participant, left, right, answer) {
  items <- sort(unique(c(left, right)))
  n <- choose(length(items), 2)
  m <- length(unique(participant))
  winner <- ifelse(answer == "left", left, right)
  loser <- ifelse(answer == "left", right, left)
  agreements <- sum(choose(table(factor(winner, items), factor(loser, items)), 2))
  statistic <- 4 / (m - 2) * (agreements - n * choose(m, 2) * (m - 3) / (2 * (m - 2)))
  c(statistic = statistic, p = pchisq(statistic, n * m * (m - 1) / (m - 2)^2, lower.tail = FALSE),
    effect = 2 * agreements / (choose(m, 2) * n) - 1, n = m)
}
"#,
    python: r#"
def agreement_of_judges(participant, left, right, answer):
    """Kendall and Babington Smith's coefficient of agreement u of complete tournaments."""
    items = np.unique(np.concatenate([left, right]))
    n = math.comb(len(items), 2)
    m = len(set(participant))
    winner = np.where(answer == "left", left, right)
    loser = np.where(answer == "left", right, left)
    agreements = sum(
        math.comb(int(((winner == a) & (loser == b)).sum()), 2) for a in items for b in items
    )
    pairs = math.comb(m, 2)
    statistic = 4 / (m - 2) * (agreements - n * pairs * (m - 3) / (2 * (m - 2)))
    p = stats.chi2.sf(statistic, n * m * (m - 1) / (m - 2) ** 2)
    return dict(statistic=statistic, p=p, effect=2 * agreements / (pairs * n) - 1, n=m)
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let outcome = consistency(&PairedComparisons::named(table, arguments)?)?;
    Ok(Answer::of_test(&outcome, words))
}

impl TestResult for Consistency {
    const NAMES: TestNames = TestNames {
        test: "agreement of judges",
        short: "agreement",
        in_words: ["test of agreement between judges", "test de l’accord entre les juges"],
        statistic: "chi-square",
        statistic_symbol: "χ²",
        effect: "Kendall's u",
        effect_symbol: "u",
        function: "agreement_of_judges",
    };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        let (Some(statistic), Some(Tail { p, ln_p })) =
            (self.chi_square, self.p.zip(self.ln_p).map(|(p, ln_p)| Tail { p, ln_p }))
        else {
            return vec![Outcome::undefined(NoEstimate::TwoJudges)];
        };
        vec![Outcome::Ok(TestRow {
            variant: self.variant.to_owned(),
            term: Term::Whole,
            statistic,
            // Its degrees of freedom are not whole: the result has them.
            degrees_of_freedom: Vec::new(),
            p_value: p,
            ln_p,
            effect: Some(self.u),
            n: self.judges,
        })]
    }
}

fn words(result: &Consistency) -> String {
    let mut lines = Lines::default();
    lines.add(format!(
        "Consistency of {} judges who chose between {} items{}",
        result.judges,
        result.items.len(),
        lines::dropped(result.dropped)
    ));
    let test = match (result.chi_square, result.df, result.p, result.ln_p) {
        (Some(chi_square), Some(df), Some(p), Some(ln_p)) => format!(
            ", chi-square = {}, df = {}, p {}",
            format_number(chi_square),
            format_number(df),
            format_p(p, ln_p)
        ),
        _ => String::new(),
    };
    lines.add(format!(
        "agreement: Kendall's u = {} (least {}, most 1){test}",
        format_number(result.u),
        format_number(result.u_least)
    ));
    let mut rows = vec![lines::row(["judge", "circular triads", "most", "zeta", "p of so few"])];
    for judge in &result.people {
        rows.push(vec![
            judge.participant.clone(),
            judge.circular_triads.to_string(),
            judge.most.to_string(),
            lines::optional(judge.zeta),
            lines::p_value(judge.p_exact.or(judge.p_chi_square)),
        ]);
    }
    lines.table(&rows);
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triads_of_few_items_are_counted_one_by_one() {
        for items in 3..=6 {
            let pairs = mimique_adaptive::all_pairs(items);
            let mut expected = vec![0; choose(items, 3) + 1];
            for outcomes in 0_u32..1 << pairs.len() {
                let mut wins = vec![vec![false; items]; items];
                for (place, &(a, b)) in pairs.iter().enumerate() {
                    let first = outcomes >> place & 1 == 1;
                    wins[a][b] = first;
                    wins[b][a] = !first;
                }
                let mut found = 0;
                for a in 0..items {
                    for b in a + 1..items {
                        for c in b + 1..items {
                            let one_way = wins[a][b] && wins[b][c] && wins[c][a];
                            let other_way = wins[b][a] && wins[c][b] && wins[a][c];
                            found += usize::from(one_way || other_way);
                        }
                    }
                }
                expected[found] += 1;
            }
            while expected.last() == Some(&0) {
                expected.pop();
            }
            assert_eq!(distribution_of_triads(items), expected, "{items}");
        }
        assert_eq!(distribution_of_triads(7).iter().sum::<u64>(), 1 << 21);
    }

    #[test]
    fn the_approximation_is_near_the_exact_p_of_seven_items() {
        let exact = distribution_of_triads(7);
        let mut sum = 0;
        for (found, ways) in exact.iter().enumerate() {
            sum += ways;
            let (p, near) = (sum as f64 / f64::from(1 << 21), chi_square_of_triads(found, 7));
            assert!((p - near).abs() < 0.05, "{found}: {p} {near}");
        }
    }

    fn judged(rows: &[(usize, &str, &str, &str)]) -> Result<Outcome<Consistency>, Refusal> {
        let mut text = "p,l,r,a\n".to_owned();
        for (judge, left, right, answer) in rows {
            text += &format!("{judge},{left},{right},{answer}\n");
        }
        let table = Table::parse(text.as_bytes()).unwrap();
        let factor = |name: &str| table.factor(name).unwrap();
        let sides = [&factor("l"), &factor("r")];
        consistency(&PairedComparisons::of(&factor("p"), sides, &factor("a"), &[])?)
    }

    #[test]
    fn who_agrees_in_all_has_u_of_one() {
        let mut rows = Vec::new();
        for judge in 0..4 {
            rows.extend([(judge, "a", "b", "left"), (judge, "c", "a", "right")]);
            rows.push((judge, "b", "c", "left"));
        }
        let found = judged(&rows).unwrap().ok().unwrap();
        assert!((found.u - 1.0).abs() < 1e-15);
        assert!(found.people.iter().all(|judge| judge.zeta == Some(1.0)));
        // Of two judges who disagree in all, u is the least.
        let rows = [
            (0, "a", "b", "left"),
            (0, "b", "c", "left"),
            (0, "c", "a", "left"),
            (1, "a", "b", "right"),
            (1, "b", "c", "right"),
            (1, "c", "a", "right"),
        ];
        let found = judged(&rows).unwrap().ok().unwrap();
        assert_eq!((found.u, found.u_least, found.p), (-1.0, -1.0, None));
        assert_eq!(found.people[0].zeta, Some(0.0));
    }

    #[test]
    fn what_is_no_tournament_is_refused_with_judge_and_pair() {
        let whole = [(1, "a", "b", "left"), (1, "b", "c", "left"), (1, "a", "c", "left")];
        let said = |rows: &[(usize, &str, &str, &str)]| judged(rows).unwrap_err().to_string();
        let missing = said(&[&whole[..], &[(2, "a", "b", "left")]].concat());
        assert!(missing.contains("\"2\" has chosen 0 times between \"a\" and \"c\""), "{missing}");
        let twice = said(&[&whole[..], &[(1, "b", "a", "left")]].concat());
        assert!(twice.contains("\"1\" has chosen 2 times"), "{twice}");
        let tied = said(&[&whole[..2], &[(1, "a", "c", "same")]].concat());
        assert!(tied.contains("\"1\" finds \"a\" and \"c\" the same"), "{tied}");
        assert!(judged(&whole).unwrap().reason().is_some(), "one judge agrees with nobody");
    }
}
