//! Several clips on one scale, with a hidden reference and an anchor (MUSHRA): whom ITU-R BS.1534-3 leaves out
//! (section 4.1.2), and whether the conditions differ among those who are kept.
//!
//! A person is left out who rates the hidden reference below 90, or the anchor above 90, in more than 15 % of the
//! segments. Segments whose anchor more than 25 % of people put above 90 do not count for the second rule. The
//! comparison is Friedman's on the person means of those who are kept.

use mimique_locale::format_number;
use serde::Serialize;

use crate::outcome::{Labelled, Outcome};
use crate::procedure::arguments::{Arguments, ProcedureOption};
use crate::procedure::lines::{self, Lines};
use crate::procedure::row::{TestNames, TestResult, TestRow};
use crate::procedure::{Answer, Procedure, Sample};
use crate::refusal::Refusal;
use crate::summary::describe::median;
use crate::table::blocks::Blocks;
use crate::table::factor::Factor;
use crate::table::sample::complete_rows;
use crate::table::{Numbers, Table};
use crate::test::friedman::{Friedman, friedman};

/// Ratings of several conditions of each segment by each person.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelRatings {
    /// People.
    pub participants: Vec<String>,
    /// Segments.
    pub segments: Vec<String>,
    /// Conditions.
    pub conditions: Vec<String>,
    /// Rating by person, then segment, then condition; NaN where missing.
    ratings: Vec<f64>,
    /// Rows left out because of missing values.
    pub dropped: usize,
}

/// The rule of BS.1534-3 and what it is applied to.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelOptions {
    /// The condition that is the hidden reference.
    pub reference: String,
    /// The condition that is the anchor; none: its rule does not apply.
    pub anchor: Option<String>,
    /// The score that the reference should reach and the anchor should not.
    pub score: f64,
    /// The share of segments in which a person may miss that.
    pub share: f64,
    /// The share of people above the score from which on a segment's anchor does not count.
    pub segment_share: f64,
    /// The conditions that are compared; empty: all but reference and anchor, or all if there is only one more.
    pub compared: Vec<String>,
}

impl PanelOptions {
    /// With the numbers of BS.1534-3.
    pub fn new(reference: impl Into<String>, anchor: Option<String>) -> Self {
        Self {
            reference: reference.into(),
            anchor,
            score: 90.0,
            share: 0.15,
            segment_share: 0.25,
            compared: Vec::new(),
        }
    }
}

/// How a person meets the rule.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScreenedPerson {
    /// The person.
    pub participant: String,
    /// Share of the segments that the person rated in which the reference is below the score; none without any.
    pub share_reference_below_90: Option<f64>,
    /// Share of the segments that count in which the anchor is above the score; none without an anchor or
    /// without such a segment.
    pub share_anchor_above_90: Option<f64>,
    /// Whether the rule leaves the person out.
    pub excluded: bool,
}

/// Result of [`panel`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Panel {
    /// Always `panel`.
    pub test: &'static str,
    /// What was computed.
    pub variant: &'static str,
    /// Each person.
    pub people: Vec<ScreenedPerson>,
    /// Segments whose anchor does not count.
    pub segments_without_anchor_rule: Vec<String>,
    /// People who are kept.
    pub kept: usize,
    /// Rows left out because of missing values.
    pub dropped: usize,
    /// Mean of the person means of those who are kept, a condition each; none where nobody rated it.
    pub means: Labelled<Option<f64>>,
    /// Median of these person means.
    pub medians: Labelled<Option<f64>>,
    /// Whether the compared conditions differ, on the person means of those who are kept.
    pub friedman: Outcome<Friedman>,
}

impl PanelRatings {
    /// From columns. Refuses two ratings of one condition of a segment by one person.
    pub fn of(
        rating: &Numbers,
        [participant, segment, condition]: [&Factor; 3],
    ) -> Result<Self, Refusal> {
        let complete = complete_rows(&[rating], &[participant, segment, condition])?;
        let rows = complete.to_vec();
        let dropped = complete.dropped();
        let [participant, segment, condition] =
            [participant, segment, condition].map(|factor| factor.rows(&rows));
        condition.require_levels(2)?;
        let (segments, conditions) = (segment.levels.len(), condition.levels.len());
        let mut ratings = vec![f64::NAN; participant.levels.len() * segments * conditions];
        for (at, &row) in rows.iter().enumerate() {
            let [person, place, level] =
                [&participant, &segment, &condition].map(|factor| factor.codes[at] as usize);
            let own = &mut ratings[(person * segments + place) * conditions + level];
            if !own.is_nan() {
                let names = [&participant.levels[person], &segment.levels[place]];
                return Err(Refusal::RepeatedInBlock {
                    column: format!("{},{}", participant.name, segment.name),
                    block: names.map(String::as_str).join(" / "),
                    group: condition.name.clone(),
                    level: condition.levels[level].clone(),
                });
            }
            *own = rating.values[row];
        }
        Ok(Self {
            participants: participant.levels,
            segments: segment.levels,
            conditions: condition.levels,
            ratings,
            dropped,
        })
    }

    /// The rating of a condition of a segment by a person, all by their places; none where it is missing.
    pub fn rating(&self, person: usize, segment: usize, condition: usize) -> Option<f64> {
        let place = (person * self.segments.len() + segment) * self.conditions.len() + condition;
        Some(self.ratings[place]).filter(|rating| !rating.is_nan())
    }

    /// A person's mean rating of a condition; none without any.
    fn mean(&self, person: usize, condition: usize) -> Option<f64> {
        let ratings = (0..self.segments.len()).filter_map(|s| self.rating(person, s, condition));
        mean(ratings)
    }

    fn condition(&self, name: &str) -> Result<usize, Refusal> {
        self.conditions.iter().position(|own| own == name).ok_or_else(|| Refusal::NoLevel {
            column: "condition".to_owned(),
            level: name.to_owned(),
            levels: self.conditions.clone(),
        })
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0);
    for value in values {
        sum += value;
        count += 1;
    }
    (count > 0).then(|| sum / f64::from(count))
}

/// The share of ratings that a test holds of; none without any.
fn share(ratings: impl Iterator<Item = f64>, holds: impl Fn(f64) -> bool) -> Option<f64> {
    mean(ratings.map(|rating| f64::from(u8::from(holds(rating)))))
}

/// Screens people and compares conditions. Refuses a reference, an anchor or a condition that nobody rated.
pub fn panel(ratings: &PanelRatings, options: &PanelOptions) -> Result<Panel, Refusal> {
    let reference = ratings.condition(&options.reference)?;
    let anchor = options.anchor.as_ref().map(|anchor| ratings.condition(anchor)).transpose()?;
    let persons = 0..ratings.participants.len();
    let segments = 0..ratings.segments.len();
    let above = |rating: f64| rating > options.score;
    let uncounted: Vec<usize> = anchor.map_or_else(Vec::new, |anchor| {
        let high = |segment: &usize| {
            let all = persons.clone().filter_map(|person| ratings.rating(person, *segment, anchor));
            share(all, above).is_some_and(|share| share > options.segment_share)
        };
        segments.clone().filter(high).collect()
    });
    let person = |person: usize| {
        let references = segments.clone().filter_map(|s| ratings.rating(person, s, reference));
        let missed = share(references, |rating| rating < options.score);
        let anchors = anchor.and_then(|anchor| {
            let counted = segments.clone().filter(|segment| !uncounted.contains(segment));
            share(counted.filter_map(|segment| ratings.rating(person, segment, anchor)), above)
        });
        let beyond = |share: Option<f64>| share.is_some_and(|share| share > options.share);
        ScreenedPerson {
            participant: ratings.participants[person].clone(),
            share_reference_below_90: missed,
            share_anchor_above_90: anchors,
            excluded: beyond(missed) || beyond(anchors),
        }
    };
    let people: Vec<ScreenedPerson> = persons.clone().map(person).collect();
    let kept: Vec<usize> = persons.filter(|person| !people[*person].excluded).collect();
    let person_means = |condition: usize| -> Vec<f64> {
        kept.iter().filter_map(|person| ratings.mean(*person, condition)).collect()
    };
    let conditions = 0..ratings.conditions.len();
    let of_each = |statistic: &dyn Fn(Vec<f64>) -> Option<f64>| {
        let values = conditions.clone().map(|condition| statistic(person_means(condition)));
        Labelled::zip(&ratings.conditions, values)
    };
    let compared = compared(ratings, options, [Some(reference), anchor])?;
    Ok(Panel {
        test: "panel",
        variant: "screening by ITU-R BS.1534-3; Friedman on the person means of those kept",
        segments_without_anchor_rule: uncounted
            .iter()
            .map(|segment| ratings.segments[*segment].clone())
            .collect(),
        kept: kept.len(),
        dropped: ratings.dropped,
        means: of_each(&|means| mean(means.into_iter())),
        medians: of_each(&|mut means| (!means.is_empty()).then(|| median(&mut means))),
        friedman: friedman(&blocks(ratings, &kept, &compared)),
        people,
    })
}

/// The places of the conditions that are compared.
fn compared(
    ratings: &PanelRatings,
    options: &PanelOptions,
    controls: [Option<usize>; 2],
) -> Result<Vec<usize>, Refusal> {
    if !options.compared.is_empty() {
        return options.compared.iter().map(|name| ratings.condition(name)).collect();
    }
    let all = 0..ratings.conditions.len();
    let own: Vec<usize> =
        all.clone().filter(|condition| !controls.contains(&Some(*condition))).collect();
    Ok(if own.len() < 2 { all.collect() } else { own })
}

/// Person means of the compared conditions.
fn blocks(ratings: &PanelRatings, kept: &[usize], compared: &[usize]) -> Blocks {
    let means = |person: &usize| -> Option<(String, Vec<f64>)> {
        let means: Option<Vec<f64>> =
            compared.iter().map(|condition| ratings.mean(*person, *condition)).collect();
        Some((ratings.participants[*person].clone(), means?))
    };
    let (blocks, responses): (Vec<_>, Vec<_>) = kept.iter().filter_map(means).unzip();
    Blocks {
        groups: compared.iter().map(|place| ratings.conditions[*place].clone()).collect(),
        incomplete: kept.len() - blocks.len(),
        blocks,
        responses,
        dropped: ratings.dropped,
    }
}

/// `mimique test panel`.
pub(crate) const PROCEDURE: Procedure = Procedure {
    name: "panel",
    question: "Several clips on one scale (MUSHRA): who is left out by BS.1534, and do conditions differ?",
    options: &[&[
        ProcedureOption::text("rating", "Column of ratings from 0 to 100").required(),
        ProcedureOption::text("participant", "Column of the people").required(),
        ProcedureOption::text("segment", "Column of the segments").required(),
        ProcedureOption::text("condition", "Column of the conditions").required(),
        ProcedureOption::text("reference", "The condition that is the hidden reference").required(),
        ProcedureOption::text("anchor", "The condition that is the anchor"),
        ProcedureOption::list(
            "compared",
            "Conditions to compare [default: all but reference and anchor]",
        ),
    ]],
    run,
    sample: Sample::Panel,
    r: r#"
# Screening by ITU-R BS.1534-3, then Friedman's test on the person means of those who are kept.
panel <- function(participant, segment, condition, rating, reference, anchor) {
  of <- function(name) {
    own <- condition == name
    tapply(rating[own], list(participant[own], segment[own]), mean)
  }
  high <- of(anchor) > 90
  counted <- colMeans(high, na.rm = TRUE) <= 0.25
  above <- rowMeans(high[, counted, drop = FALSE], na.rm = TRUE)
  out <- rowMeans(of(reference) < 90, na.rm = TRUE) > 0.15 | (!is.nan(above) & above > 0.15)
  means <- tapply(rating, list(participant, condition), mean)
  means <- means[!out[rownames(means)], setdiff(colnames(means), c(reference, anchor))]
  friedman(means[complete.cases(means), ])
}
"#,
    python: r#"
def panel(participant, segment, condition, rating, reference, anchor):
    """Screening by ITU-R BS.1534-3, then Friedman's test on the person means of those who are kept."""
    people, segments = np.unique(participant), np.unique(segment)

    def of(name):
        own = condition == name
        return np.array(
            [[rating[own & (participant == p) & (segment == s)].mean() for s in segments] for p in people]
        )

    high = of(anchor) > 90
    counted = high.mean(axis=0) <= 0.25
    above = high[:, counted].mean(axis=1) if counted.any() else np.zeros(len(people))
    out = ((of(reference) < 90).mean(axis=1) > 0.15) | (above > 0.15)
    names = [name for name in np.unique(condition) if name not in (reference, anchor)]
    return friedman(np.column_stack([of(name)[~out].mean(axis=1) for name in names]))
"#,
    golden_cases: "",
};

fn run(table: &Table, arguments: &Arguments) -> Result<Answer, Refusal> {
    let factor = |option: &str| arguments.factor(table, option);
    let factors = [&factor("participant")?, &factor("segment")?, &factor("condition")?];
    let ratings = PanelRatings::of(&arguments.numbers(table, "rating")?, factors)?;
    let anchor = arguments.text("anchor").map(str::to_owned);
    let options = PanelOptions {
        compared: arguments.list("compared").to_vec(),
        ..PanelOptions::new(arguments.needed("reference")?, anchor)
    };
    let result = panel(&ratings, &options)?;
    Ok(Answer::of_test(&Outcome::Ok(result), words))
}

impl TestResult for Panel {
    const NAMES: TestNames = TestNames { function: "panel", ..Friedman::NAMES };

    fn rows(&self) -> Vec<Outcome<TestRow>> {
        match &self.friedman {
            Outcome::Ok(found) => found.rows(),
            Outcome::Undefined { reason } => vec![Outcome::undefined(reason.clone())],
        }
    }
}

fn words(result: &Panel) -> String {
    let mut lines = Lines::default();
    lines.add(format!(
        "Ratings of several conditions: {} of {} people are kept by ITU-R BS.1534-3{}",
        result.kept,
        result.people.len(),
        lines::dropped(result.dropped)
    ));
    let out: Vec<&ScreenedPerson> = result.people.iter().filter(|person| person.excluded).collect();
    if !out.is_empty() {
        let mut rows = vec![lines::row(["left out", "reference below 90", "anchor above 90"])];
        let percent = |share: Option<f64>| {
            share.map_or_else(
                || "-".to_owned(),
                |share| format!("{} %", format_number(100.0 * share)),
            )
        };
        for person in out {
            rows.push(vec![
                person.participant.clone(),
                percent(person.share_reference_below_90),
                percent(person.share_anchor_above_90),
            ]);
        }
        lines.table(&rows);
    }
    if !result.segments_without_anchor_rule.is_empty() {
        let segments = result.segments_without_anchor_rule.join(", ");
        lines.add(format!("anchor not counted in {segments}: over 25 % of people put it above 90"));
    }
    let mut rows = vec![lines::row(["condition", "mean", "median"])];
    for (condition, mean) in result.means.iter() {
        let median = result.medians.get(condition).copied().flatten();
        rows.push(vec![condition.to_owned(), lines::optional(*mean), lines::optional(median)]);
    }
    lines.table(&rows);
    let mut text = lines.into_text();
    text += &match &result.friedman {
        Outcome::Ok(found) => crate::test::friedman::words(found),
        Outcome::Undefined { reason } => format!("undefined: {reason}\n"),
    };
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three people, ten segments; each closure gives reference, anchor and two methods.
    fn rated(rate: impl Fn(usize, usize) -> [f64; 4]) -> PanelRatings {
        let mut text = "p,s,c,y\n".to_owned();
        for person in 0..4 {
            for segment in 0..10 {
                for (condition, rating) in
                    ["ref", "anchor", "a", "b"].iter().zip(rate(person, segment))
                {
                    text += &format!("{person},{segment},{condition},{rating}\n");
                }
            }
        }
        let table = Table::parse(text.as_bytes()).unwrap();
        let factor = |name: &str| table.factor(name).unwrap();
        PanelRatings::of(&table.numbers("y").unwrap(), [&factor("p"), &factor("s"), &factor("c")])
            .unwrap()
    }

    fn options() -> PanelOptions {
        PanelOptions::new("ref", Some("anchor".to_owned()))
    }

    #[test]
    fn ninety_is_neither_below_nor_above_and_fifteen_percent_is_not_more() {
        // Nine of ten right at 90: a tenth below is allowed, two tenths are not.
        let ratings = rated(|person, segment| {
            let missed = segment < [1, 2, 0, 0][person];
            [if missed { 89.0 } else { 90.0 }, 90.0, 50.0, 60.0]
        });
        let found = panel(&ratings, &options()).unwrap();
        let out: Vec<bool> = found.people.iter().map(|person| person.excluded).collect();
        assert_eq!(out, [false, true, false, false]);
        assert_eq!(found.people[1].share_reference_below_90, Some(0.2));
        assert_eq!((found.kept, found.people[0].share_anchor_above_90), (3, Some(0.0)));
    }

    #[test]
    fn a_segment_whose_anchor_is_good_does_not_count() {
        // Segments 0 and 1: everybody finds the anchor good. Person 3 finds it good in 2 and 3, too.
        let ratings = rated(|person, segment| {
            let good = segment < 2 || (person == 3 && segment < 4);
            [100.0, if good { 95.0 } else { 10.0 }, 50.0, 60.0 + person as f64]
        });
        let found = panel(&ratings, &options()).unwrap();
        assert_eq!(found.segments_without_anchor_rule, ["0", "1"]);
        let shares: Vec<_> = found.people.iter().map(|p| p.share_anchor_above_90).collect();
        assert_eq!(shares, [Some(0.0), Some(0.0), Some(0.0), Some(0.25)]);
        assert!(found.people[3].excluded && found.kept == 3);
        // A quarter of the people is not more than 25 %: segments 2 and 3 count.
        assert_eq!(found.friedman.ok().unwrap().k, 2, "reference and anchor are not compared");
    }

    #[test]
    fn without_an_anchor_only_the_reference_counts_and_unknown_names_are_refused() {
        let ratings = rated(|_, segment| [100.0, 99.0, segment as f64, 3.0]);
        let found = panel(&ratings, &PanelOptions::new("ref", None)).unwrap();
        assert!(found.people.iter().all(|p| !p.excluded && p.share_anchor_above_90.is_none()));
        let unknown = panel(&ratings, &PanelOptions::new("nothing", None)).unwrap_err();
        assert!(unknown.to_string().contains("\"nothing\""), "{unknown}");
    }
}
