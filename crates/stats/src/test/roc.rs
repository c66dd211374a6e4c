//! Receiver operating characteristic of a forced choice with a rating of confidence: one category against all others.
//!
//! Each answer is placed on a line of evidence for the category: at the top the surest answers "this category", at the
//! bottom the surest answers "another one" (Macmillan and Creelman 2005, chapter 3). The curve goes through the share of
//! signals and of noise at or above each place, from (0, 0) to (1, 1). The area below it, by trapezoids, is the probability
//! that a signal stands above a noise, ties counted half: Mann and Whitney's U over signals x noise (Bamber 1975).
//! Where answers tell nothing of what was shown it is one half.

use mimique_locale::format_number;
use serde::Serialize;

use crate::outcome::Outcome;
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::summary::describe::{Description, describe};
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::table::{Numbers, Table};
use crate::test::detection::FEW_SIGNALS;
use crate::undefined::NoEstimate;

/// A curve and the area below it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RocCurve {
    /// Rate of false alarms and rate of hits, from (0, 0) to (1, 1): one point more than places on the line of evidence.
    pub points: Vec<[f64; 2]>,
    /// The area below, 0 to 1.
    pub area: f64,
}

/// A person's area.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PersonArea {
    /// The person.
    pub participant: String,
    /// Signals.
    pub signals: usize,
    /// None where the person was shown no signal or no noise.
    pub area: Option<f64>,
}

/// A category against all others.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CategoryRoc {
    /// The category.
    pub category: String,
    /// Signals of all people together.
    pub signals: usize,
    /// Noise.
    pub noise: usize,
    /// The answers of all people together.
    pub pooled: Outcome<RocCurve>,
    /// Each person.
    pub people: Vec<PersonArea>,
    /// Whether somebody was shown fewer than 5 signals: then the pooled area is the one to read.
    pub few_signals: bool,
    /// Of people's areas, with the t interval of their mean.
    pub areas: Outcome<Description>,
}

/// Result of [`roc`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Roc {
    /// Always `roc`.
    pub test: &'static str,
    /// People.
    pub participants: usize,
    /// Answers.
    pub n: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// Each category that was shown.
    pub categories: Vec<CategoryRoc>,
}

/// Curves of each category that was shown; `confidence` is higher where an answer is surer. Refuses fewer than two
/// categories.
pub fn roc(
    participant: &Factor,
    truth: &Factor,
    answer: &Factor,
    confidence: &Numbers,
) -> Result<Roc, Refusal> {
    let complete = complete_rows(&[confidence], &[participant, truth, answer])?;
    let (rows, dropped) = (complete.to_vec(), complete.dropped());
    let [participant, truth, answer] = [participant, truth, answer].map(|f| f.rows(&rows));
    truth.require_levels(2)?;
    let sure: Vec<f64> = rows.iter().map(|row| confidence.values[*row]).collect();
    let least = sure.iter().copied().fold(f64::INFINITY, f64::min);
    let categories = truth.levels.iter().enumerate().map(|(shown, name)| {
        let said = answer.levels.iter().position(|level| level == name);
        let mut people = vec![Evidence::default(); participant.levels.len()];
        for (row, sure) in sure.iter().enumerate() {
            // Above 0 for this category, below for another one.
            let reach = sure - least + 1.0;
            let is_said = said == Some(answer.codes[row] as usize);
            let value = if is_said { reach } else { -reach };
            let own = &mut people[participant.codes[row] as usize];
            let kind =
                if truth.codes[row] as usize == shown { &mut own.signals } else { &mut own.noise };
            kind.push(value);
        }
        category(name, &participant.levels, &people)
    });
    Ok(Roc {
        test: "roc",
        participants: participant.levels.len(),
        n: rows.len(),
        dropped,
        categories: categories.collect(),
    })
}

/// Where answers stand on the line of evidence.
#[derive(Debug, Clone, Default)]
struct Evidence {
    signals: Vec<f64>,
    noise: Vec<f64>,
}

impl Evidence {
    /// None without signals or without noise.
    fn curve(&self) -> Option<RocCurve> {
        if self.signals.is_empty() || self.noise.is_empty() {
            return None;
        }
        let mut places: Vec<f64> = self.signals.iter().chain(&self.noise).copied().collect();
        places.sort_by(|one, other| other.total_cmp(one));
        places.dedup();
        let share = |values: &[f64], place: f64| {
            values.iter().filter(|value| **value >= place).count() as f64 / values.len() as f64
        };
        let reached =
            places.iter().map(|place| [share(&self.noise, *place), share(&self.signals, *place)]);
        let points: Vec<[f64; 2]> = std::iter::once([0.0; 2]).chain(reached).collect();
        let trapezoid = |pair: &[[f64; 2]]| {
            let [[from, low], [to, high]] = [pair[0], pair[1]];
            (to - from) * (low + high) / 2.0
        };
        Some(RocCurve { area: points.windows(2).map(trapezoid).sum(), points })
    }
}

fn category(name: &str, names: &[String], people: &[Evidence]) -> CategoryRoc {
    let all = |of: fn(&Evidence) -> &Vec<f64>| people.iter().flat_map(of).copied().collect();
    let all = Evidence { signals: all(|own| &own.signals), noise: all(|own| &own.noise) };
    let own = |(participant, evidence): (&String, &Evidence)| PersonArea {
        participant: participant.clone(),
        signals: evidence.signals.len(),
        area: evidence.curve().map(|curve| curve.area),
    };
    let each: Vec<PersonArea> = names.iter().zip(people).map(own).collect();
    let areas: Vec<f64> = each.iter().filter_map(|person| person.area).collect();
    CategoryRoc {
        category: name.to_owned(),
        signals: all.signals.len(),
        noise: all.noise.len(),
        pooled: all
            .curve()
            .map_or_else(|| Outcome::undefined(NoEstimate::OnlySignalsOrNoise), Outcome::Ok),
        few_signals: people.iter().any(|own| (own.signals.len() as u64) < FEW_SIGNALS),
        people: each,
        areas: describe(&areas),
    }
}

/// `mimique test roc`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "roc",
    question: "How well is each category told, at every confidence? ROC curves and the areas below",
    options: &[&[
        ProcedureOption::text("participant", "Column of the people").required(),
        ProcedureOption::text("truth", "Column of what was shown").required(),
        ProcedureOption::text("answer", "Column of what was answered").required(),
        ProcedureOption::text("confidence", "Column of how sure the answer is, higher is surer")
            .required(),
    ]],
    run,
    sample: Sample::Other,
    r: r#"
# Areas below the ROC curves of one category against all others, of each person: Mann-Whitney, ties half; NA of who was
# shown no signal or no noise.
evidence <- function(answer, confidence, category) {
  ifelse(answer == category, 1, -1) * (confidence - min(confidence) + 1)
}
area_below <- function(signal, evidence) {
  if (all(signal) || !any(signal)) return(NA)
  above <- outer(evidence[signal], evidence[!signal], function(a, b) (a > b) + (a == b) / 2)
  mean(above)
}
roc <- function(participant, truth, answer, confidence, category) {
  places <- evidence(answer, confidence, category)
  areas <- vapply(split(seq_along(truth), participant), function(own) area_below(truth[own] == category, places[own]), 0)
  mean_and_interval(areas[!is.na(areas)])
}
# The points and the area of all answers together.
roc_of_all <- function(participant, truth, answer, confidence, category) {
  places <- evidence(answer, confidence, category)
  signal <- truth == category
  borders <- sort(unique(places), decreasing = TRUE)
  share <- function(values) vapply(borders, function(border) mean(values >= border), 0)
  c(area = area_below(signal, places), numbered("false_alarms", c(0, share(places[!signal]))),
    numbered("hits", c(0, share(places[signal]))))
}
"#,
    python: r#"
def evidence(answer, confidence, category):
    return np.where(answer == category, 1, -1) * (confidence - confidence.min() + 1)


def area_below(signal, evidence):
    """The area below a ROC curve: Mann-Whitney, ties half; nan without signals or without noise."""
    if signal.all() or not signal.any():
        return math.nan
    u = stats.mannwhitneyu(evidence[signal], evidence[~signal]).statistic
    return u / (signal.sum() * (~signal).sum())


def roc(participant, truth, answer, confidence, category):
    """The mean area over people of one category against all others, with its t interval."""
    places, signal = evidence(answer, confidence, category), truth == category
    areas = [area_below(signal[participant == who], places[participant == who]) for who in np.unique(participant)]
    return mean_and_interval([area for area in areas if not math.isnan(area)])


def roc_of_all(participant, truth, answer, confidence, category):
    """The points and the area of all answers together."""
    places, signal = evidence(answer, confidence, category), truth == category
    borders = np.unique(places)[::-1]
    shares = [[0.0, *((values >= border).mean() for border in borders)] for values in (places[~signal], places[signal])]
    return dict(area=area_below(signal, places), **numbered("false_alarms", shares[0]), **numbered("hits", shares[1]))
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factor = |option: &str| arguments.factor(table, option);
    let confidence = arguments.numbers(table, "confidence")?;
    let result = roc(&factor("participant")?, &factor("truth")?, &factor("answer")?, &confidence)?;
    Ok(Answer::of(&Outcome::Ok(result), words))
}

fn words(result: &Roc) -> String {
    let mut lines = Lines::default();
    lines.add("ROC curves, one category against all others");
    lines.add(format!(
        "{} answers of {} people{}",
        result.n,
        result.participants,
        lines::dropped(result.dropped)
    ));
    let heads =
        ["category", "signals", "noise", "area of all", "people", "mean area", "95 % interval"];
    let mut rows = vec![lines::row(heads)];
    for found in &result.categories {
        let pooled = found.pooled.clone().ok().map(|curve| curve.area);
        let areas = found.areas.clone().ok();
        let interval = areas.as_ref().and_then(|own| own.mean_ci_t);
        rows.push(vec![
            found.category.clone(),
            found.signals.to_string(),
            found.noise.to_string(),
            lines::optional(pooled),
            areas.as_ref().map_or(0, |own| own.n).to_string(),
            lines::optional(areas.as_ref().map(|own| own.mean)),
            interval.map_or_else(String::new, |[low, high]| {
                format!("{} to {}", format_number(low), format_number(high))
            }),
        ]);
    }
    lines.table(&rows);
    if result.categories.iter().any(|found| found.few_signals) {
        lines.add(format!(
            "note: somebody was shown a category fewer than {FEW_SIGNALS} times: read the area of all answers together"
        ));
    }
    lines.into_text()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(csv: &str) -> Roc {
        let table = Table::parse(csv.as_bytes().to_vec()).unwrap();
        let factor = |name: &str| table.factor(name).unwrap();
        roc(&factor("p"), &factor("t"), &factor("a"), &table.numbers("c").unwrap()).unwrap()
    }

    /// Signals at 3, 2, 2 and -1, noise at 2, -1 and -3: of 12 pairs 8 have the signal above and 3 are ties, as
    /// `scipy.stats.mannwhitneyu([3, 2, 2, -1], [2, -1, -3]).statistic` (9.5) of SciPy 1.17.1 has it.
    #[test]
    fn points_and_area_are_those_counted_by_hand() {
        let csv = "p,t,a,c\n1,x,x,3\n1,x,x,2\n1,x,x,2\n1,x,y,1\n1,y,x,2\n1,y,y,1\n1,y,y,3\n";
        let result = found(csv);
        let x = &result.categories[0];
        let curve = x.pooled.clone().ok().unwrap();
        assert!((curve.area - 9.5 / 12.0).abs() < 1e-15, "{}", curve.area);
        let third = 1.0 / 3.0;
        let points = [[0.0, 0.0], [0.0, 0.25], [third, 0.75], [2.0 * third, 1.0], [1.0, 1.0]];
        assert_eq!(curve.points, points);
        assert!(x.few_signals);
        // Of two categories one is told as well as the other.
        let y = result.categories[1].pooled.clone().ok().unwrap();
        assert!((y.area - curve.area).abs() < 1e-15);
        // Where confidence is all the same, the curve is the one point of hits and false alarms.
        let plain = found(&csv.replace(",3\n", ",2\n").replace(",1\n", ",2\n"));
        let plain = plain.categories[0].pooled.clone().ok().unwrap();
        assert_eq!(plain.points, [[0.0, 0.0], [third, 0.75], [1.0, 1.0]]);
    }

    #[test]
    fn who_was_shown_no_noise_has_no_area_and_is_in_no_mean() {
        let csv = "p,t,a,c\n1,x,x,2\n1,y,y,2\n2,x,x,1\n2,y,x,2\n3,x,x,1\n";
        let x = &found(csv).categories[0];
        let areas: Vec<Option<f64>> = x.people.iter().map(|own| own.area).collect();
        assert_eq!(areas, [Some(1.0), Some(0.0), None]);
        let mean = x.areas.clone().ok().unwrap();
        assert_eq!((mean.n, mean.mean), (2, 0.5));
        let table = Table::parse(b"p,t,a,c\n1,x,x,2\n1,x,y,2\n".to_vec()).unwrap();
        let factor = |name: &str| table.factor(name).unwrap();
        let one = roc(&factor("p"), &factor("t"), &factor("a"), &table.numbers("c").unwrap());
        assert!(one.is_err(), "one category alone");
    }
}
