//! One line of a table of tests: what any test gives, with what it was a test of.

use mimique_stats::{
    AlignedRankTransform, Alternative, Blocks, BradleyTerry, ChiSquare, Contingency, EffectSize,
    EquivalenceOfGroups, EquivalenceOfPairs, Factor, Friedman, HodgesLehmann, KruskalWallis,
    MannWhitney, MinFPrime, Numbers, Outcome, Refusal, ScheirerRayHare, Sign, Spearman,
    SumsOfSquares, Term, TestNames, TestResult, TestRow, WORTHS_RATIO, Wilcoxon, WilcoxonOptions,
    aligned_rank_transform, chi_square, cliff_delta, friedman, kruskal_wallis, mann_whitney,
    paired_dominance, scheirer_ray_hare, sign, spearman, standardised_difference, wilcoxon,
};
use serde::{Serialize, Serializer};

use crate::hypothesis::call::{Call, Design};
use crate::hypothesis::undefined::{TestOutcome, Why};

/// What a test counts as one observation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Unit {
    /// Every trial.
    Trials,
    /// One mean per person, between people.
    PersonMeans,
    /// One mean per person and level, within people.
    MeansWithinPeople,
    /// Each person's difference between two levels; the pair as `a - b`.
    DifferencesOfPeople(String),
    /// Each person's own correlation.
    CorrelationsOfPeople,
    /// Each person's choices of one of two levels less those of the other.
    ChoicesOfPeople,
    /// How often each person chose each level.
    WinsOfPeople,
    /// Answers, those of one participant together.
    ClusteredByPerson,
    /// Ratings, people and segments both drawn.
    PeopleAndSegments,
}

impl Unit {
    /// Behind the name of a test, as `results.json` has it.
    fn in_words(&self) -> String {
        match self {
            Self::Trials => "of trials".to_owned(),
            Self::PersonMeans => "of person means".to_owned(),
            Self::MeansWithinPeople => "on person means".to_owned(),
            Self::DifferencesOfPeople(pair) => format!("of person differences {pair}"),
            Self::CorrelationsOfPeople => "of each person's rho".to_owned(),
            Self::ChoicesOfPeople => "of each person's choices".to_owned(),
            Self::WinsOfPeople => "on each person's wins".to_owned(),
            Self::ClusteredByPerson => "clustered by participant".to_owned(),
            Self::PeopleAndSegments => "over people and segments".to_owned(),
        }
    }

    /// As the scripts in R and Python are told it.
    pub(crate) fn in_scripts(&self) -> &'static str {
        match self {
            Self::Trials => "trials",
            _ => "person means",
        }
    }
}

/// One test's numbers, whatever the test.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TestLine {
    /// What the test, its statistic and its effect size are called.
    pub names: TestNames,
    /// What was tested.
    pub unit: Unit,
    /// The numbers.
    pub row: TestRow,
    /// Standardised effect sizes with intervals, of tests on one value per person.
    pub effect_sizes: Vec<EffectSize>,
    /// p after Holm's correction, where several were tested.
    pub p_holm: Option<f64>,
    /// How other programs compute it.
    pub call: Call,
}

impl Serialize for TestLine {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        /// A line as `results.json` has it.
        #[derive(Serialize)]
        struct Written<'l> {
            /// Name and variant.
            test: String,
            #[serde(skip_serializing_if = "Term::is_whole")]
            term: &'l Term,
            statistic_name: &'l str,
            statistic: f64,
            df: String,
            p_value: f64,
            ln_p: f64,
            #[serde(skip_serializing_if = "Option::is_none")]
            p_holm: Option<f64>,
            effect_name: &'l str,
            effect: Option<f64>,
            #[serde(skip_serializing_if = "<[EffectSize]>::is_empty")]
            effect_sizes: &'l [EffectSize],
            n: usize,
        }
        let variant = match self.row.variant.as_str() {
            "" => String::new(),
            variant => format!(", {variant}"),
        };
        Written {
            test: format!("{} {}{variant}", self.names.test, self.unit.in_words()),
            term: &self.row.term,
            statistic_name: self.names.statistic,
            statistic: self.row.statistic,
            df: self.degrees_of_freedom(),
            p_value: self.row.p_value,
            ln_p: self.row.ln_p,
            p_holm: self.p_holm,
            effect_name: self.names.effect,
            effect: self.row.effect,
            effect_sizes: &self.effect_sizes,
            n: self.row.n,
        }
        .serialize(serializer)
    }
}

/// The p of a test that may be undefined.
pub(crate) trait OutcomeP {
    /// p, where there is one.
    fn p(&self) -> Option<f64>;

    /// p after a correction over several tests, where there was one.
    fn p_that_counts(&self) -> Option<f64>;
}

impl OutcomeP for TestOutcome {
    fn p(&self) -> Option<f64> {
        match self {
            Self::Ok(line) => Some(line.row.p_value),
            Self::Undefined { .. } => None,
        }
    }

    fn p_that_counts(&self) -> Option<f64> {
        match self {
            Self::Ok(line) => Some(line.p_that_counts()),
            Self::Undefined { .. } => None,
        }
    }
}

impl TestLine {
    /// `2` or `2, 48`; empty where the statistic has none.
    fn degrees_of_freedom(&self) -> String {
        let degrees = self.row.degrees_of_freedom.iter().map(usize::to_string);
        degrees.collect::<Vec<_>>().join(", ")
    }

    /// The same in brackets.
    pub(crate) fn degrees_in_brackets(&self) -> String {
        match self.degrees_of_freedom() {
            none if none.is_empty() => none,
            degrees => format!("({degrees})"),
        }
    }

    /// p after a correction over several tests, where there was one.
    pub(crate) fn p_that_counts(&self) -> f64 {
        self.p_holm.unwrap_or(self.row.p_value)
    }

    /// The same with another term.
    pub(crate) fn with_term(mut self, term: Term) -> Self {
        self.row.term = term;
        self
    }

    /// The same with effect sizes.
    fn with_effect_sizes(mut self, sizes: impl IntoIterator<Item = EffectSize>) -> Self {
        self.effect_sizes = sizes.into_iter().collect();
        self
    }

    /// Every row of a test's result. A refusal inside a report is a stated impossibility.
    fn all<T: TestResult>(
        result: Result<Outcome<T>, Refusal>,
        unit: &Unit,
        call: impl Fn(usize) -> Call,
    ) -> Vec<TestOutcome> {
        let rows = match result {
            Err(refusal) => vec![Outcome::undefined(refusal)],
            Ok(Outcome::Undefined { reason }) => vec![Outcome::undefined(reason)],
            Ok(Outcome::Ok(result)) => result.rows(),
        };
        let line = |(place, row): (usize, Outcome<TestRow>)| {
            let row = row.map(|row| Self {
                names: T::NAMES,
                unit: unit.clone(),
                row,
                effect_sizes: Vec::new(),
                p_holm: None,
                call: call(place),
            });
            row.map_reason(Why::from)
        };
        rows.into_iter().enumerate().map(line).collect()
    }

    /// The row of a test that has one.
    fn one<T: TestResult>(
        result: Result<Outcome<T>, Refusal>,
        unit: &Unit,
        call: Call,
    ) -> TestOutcome {
        let rows = Self::all(result, unit, |_| call.clone());
        rows.into_iter().next().unwrap_or_else(|| TestOutcome::undefined(Why::NoTest))
    }

    /// A test of independent groups.
    fn groups<T: TestResult>(
        result: Result<Outcome<T>, Refusal>,
        values: &Numbers,
        factor: &Factor,
        unit: &Unit,
    ) -> TestOutcome {
        let call = Call::new(Design::Groups, T::NAMES.function)
            .text(&values.name)
            .text(&factor.name)
            .list(&factor.levels)
            .text(unit.in_scripts());
        Self::one(result, unit, call)
    }

    /// Kruskal-Wallis.
    pub(crate) fn kruskal_wallis(values: &Numbers, factor: &Factor, unit: &Unit) -> TestOutcome {
        Self::groups::<KruskalWallis>(kruskal_wallis(values, factor), values, factor, unit)
    }

    /// Mann-Whitney; of people with Cliff's delta of the first level.
    pub(crate) fn mann_whitney(values: &Numbers, factor: &Factor, unit: &Unit) -> TestOutcome {
        let line = Self::groups::<MannWhitney>(mann_whitney(values, factor), values, factor, unit);
        if *unit == Unit::Trials {
            return line;
        }
        let [first, second] = [0, 1].map(|level: u32| -> Vec<f64> {
            let own = factor.codes.iter().zip(&values.values);
            own.filter(|(code, _)| **code == level).map(|(_, value)| *value).collect()
        });
        line.map(|line| line.with_effect_sizes(cliff_delta(&first, &second)))
    }

    /// Mann-Whitney of two groups, Kruskal-Wallis of more.
    pub(crate) fn of_groups(values: &Numbers, factor: &Factor, unit: &Unit) -> TestOutcome {
        if factor.levels.len() == 2 {
            Self::mann_whitney(values, factor, unit)
        } else {
            Self::kruskal_wallis(values, factor, unit)
        }
    }

    /// Chi-square of a factor and answers, Yates for two by two.
    pub(crate) fn chi_square(rows: &Factor, answers: &Factor) -> TestOutcome {
        let result = Contingency::of(rows, answers).and_then(|table| chi_square(&table));
        let call = Call::new(Design::Groups, ChiSquare::NAMES.function)
            .text(&answers.name)
            .text(&rows.name)
            .list(&rows.levels)
            .text(Unit::Trials.in_scripts());
        Self::one(result.map(Outcome::Ok), &Unit::Trials, call)
    }

    /// Wilcoxon's signed rank test with the Hodges-Lehmann estimate that goes with it; of people's means with effect sizes
    /// of the differences.
    pub(crate) fn wilcoxon(
        differences: &Numbers,
        options: WilcoxonOptions,
        unit: &Unit,
        call: Call,
    ) -> (TestOutcome, Option<HodgesLehmann>) {
        let result = wilcoxon(differences, options);
        let interval = match &result {
            Ok(Outcome::Ok(result)) => Some(result.hodges_lehmann_ci),
            _ => None,
        };
        let line = Self::one::<Wilcoxon>(result, unit, call);
        let sizes = match unit {
            Unit::MeansWithinPeople => {
                let values = &differences.values;
                [paired_dominance(values), standardised_difference(values)]
            }
            _ => [None, None],
        };
        let term = Term::Differences(differences.name.clone());
        let line =
            line.map(|line| line.with_term(term).with_effect_sizes(sizes.into_iter().flatten()));
        (line, interval)
    }

    /// Spearman.
    pub(crate) fn spearman(x: &Numbers, y: &Numbers, unit: &Unit) -> TestOutcome {
        let call = Call::new(Design::Columns, Spearman::NAMES.function)
            .text(&x.name)
            .text(&y.name)
            .text(unit.in_scripts());
        let line = Self::one::<Spearman>(spearman(x, y), unit, call);
        line.map(|line| {
            let rho = line.row.effect.filter(|_| *unit != Unit::Trials);
            let size = rho.map(|rho| EffectSize::spearman(rho, line.row.n));
            line.with_term(Term::Relation([y.name.clone(), x.name.clone()])).with_effect_sizes(size)
        })
    }

    /// Friedman with Iman and Davenport's F.
    pub(crate) fn friedman(blocks: &Blocks, call: Call) -> TestOutcome {
        let line = Self::one::<Friedman>(Ok(friedman(blocks)), &Unit::MeansWithinPeople, call);
        let groups = blocks.groups.len();
        line.map(|line| {
            let size = line.row.effect.map(|w| EffectSize::kendall_w(w, line.row.n, groups));
            line.with_effect_sizes(size)
        })
    }

    /// Friedman on how often each person chose each level.
    pub(crate) fn friedman_on_wins(wins: &Blocks, call: Call) -> TestOutcome {
        Self::one::<Friedman>(Ok(friedman(wins)), &Unit::WinsOfPeople, call)
    }

    /// Clark's min F'.
    pub(crate) fn min_f(result: Result<Outcome<MinFPrime>, Refusal>, call: Call) -> TestOutcome {
        Self::one::<MinFPrime>(result, &Unit::PeopleAndSegments, call)
    }

    /// The sign test.
    pub(crate) fn sign(
        differences: &Numbers,
        alternative: Alternative,
        unit: &Unit,
        call: Call,
    ) -> TestOutcome {
        let line = Self::one::<Sign>(sign(differences, alternative), unit, call);
        line.map(|line| line.with_term(Term::Whole))
    }

    /// Equal worths, clustered by participant.
    pub(crate) fn worths(found: &BradleyTerry, call: Call) -> TestOutcome {
        Self::one(Ok(Outcome::Ok(found.clone())), &Unit::ClusteredByPerson, call)
    }

    /// Equal worths by the likelihood ratio.
    pub(crate) fn worths_ratio(found: &BradleyTerry, call: Call) -> TestOutcome {
        let line = |row| Self::beside(WORTHS_RATIO, row, Unit::Trials, call);
        found.ratio_row().map(line).map_reason(Why::from)
    }

    /// Two one-sided signed rank tests.
    pub(crate) fn equivalence_of_pairs(found: &EquivalenceOfPairs, call: Call) -> TestOutcome {
        Self::one(Ok(Outcome::Ok(found.clone())), &Unit::MeansWithinPeople, call)
    }

    /// Two one-sided rank sum tests.
    pub(crate) fn equivalence_of_groups(
        found: &EquivalenceOfGroups,
        unit: &Unit,
        call: Call,
    ) -> TestOutcome {
        Self::one(Ok(Outcome::Ok(found.clone())), unit, call)
    }

    /// A row that a test has beside its own.
    pub(crate) fn beside(names: TestNames, row: TestRow, unit: Unit, call: Call) -> Self {
        Self { names, unit, row, effect_sizes: Vec::new(), p_holm: None, call }
    }

    /// Scheirer-Ray-Hare with type I sums of squares: both factors and their interaction.
    pub(crate) fn scheirer_ray_hare(
        values: &Numbers,
        factors: [&Factor; 2],
        unit: &Unit,
    ) -> Vec<TestOutcome> {
        let result = scheirer_ray_hare(values, factors, SumsOfSquares::One);
        let call = |effect: usize| {
            two_factors(Design::TwoFactors, ScheirerRayHare::NAMES, values, factors)
                .number(effect + 1)
                .text(unit.in_scripts())
        };
        Self::all::<ScheirerRayHare>(result, unit, call)
    }

    /// Aligned rank transform: both factors and their interaction.
    pub(crate) fn aligned_rank_transform(
        values: &Numbers,
        factors: [&Factor; 2],
        person: &Factor,
        matched_on: &[Vec<String>; 2],
    ) -> Vec<TestOutcome> {
        let result = aligned_rank_transform(values, &factors, person);
        let call = |effect: usize| {
            two_factors(Design::Combinations, AlignedRankTransform::NAMES, values, factors)
                .number(effect + 1)
                .list(&matched_on[0])
                .list(&matched_on[1])
        };
        Self::all::<AlignedRankTransform>(result, &Unit::PersonMeans, call)
    }
}

/// A call of a test of two factors.
fn two_factors(design: Design, names: TestNames, values: &Numbers, factors: [&Factor; 2]) -> Call {
    Call::new(design, names.function)
        .text(&values.name)
        .text(&factors[0].name)
        .list(&factors[0].levels)
        .text(&factors[1].name)
        .list(&factors[1].levels)
}
