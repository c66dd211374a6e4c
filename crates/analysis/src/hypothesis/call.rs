//! How a number was computed, as a call that scripts in R and Python can make too.

/// One argument.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Argument {
    /// A number as it is: of a model, of the study file.
    Given(f64),
    Text(String),
    List(Vec<String>),
    Number(usize),
}

/// What is taken from the trials for a test: a function of `analysis.R` and `analysis.py`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Design {
    /// Independent groups: of trials, or of one mean per person.
    Groups,
    /// Differences between two levels within people, by something about the people.
    DifferencesByTrait,
    /// Differences between two levels, one per person.
    People,
    /// Differences between two levels, one per matched pair of trials.
    MatchedTrials,
    /// One mean per person and level.
    Blocks,
    /// Two columns of trials or of people.
    Columns,
    /// Each person's own correlation of two columns.
    Correlations,
    /// Two factors of trials or of people.
    TwoFactors,
    /// One mean per person and combination of two factors.
    Combinations,
    /// The trials of one level.
    Level,
    /// The mean of the people's means at one level.
    PersonMean,
    /// What was shown and what was answered.
    Answers,
    /// Choices between levels: participant, left, right, answer.
    Choices,
    /// Choices of one of two levels less those of the other, by trial or by person.
    NetChoices,
    /// How often each person chose each level.
    Wins,
    /// Which of every two levels was rated higher on a page.
    PageOrder,
    /// Ratings by levels, people and segments.
    PeopleAndSegments,
    /// Differences between two levels, one per person, and the smallest that matters.
    EquivalenceOfPeople,
    /// Two independent groups, and the smallest difference that matters.
    EquivalenceOfGroups,
    /// Mean ratings, a row per clip that everybody rated, a column per person.
    ClipsByPeople,
    /// First answers, a row per clip, a column per person, gaps allowed.
    FirstAnswers,
    /// What each person was shown and answered, perhaps at some levels of a factor, and a category.
    Detection,
    /// A category's d' or criterion of each person and level.
    DetectionBlocks,
    /// Differences of these between two levels, one per person.
    DetectionPeople,
    /// What each person was shown and answered, how surely, and a category.
    Confidence,
    /// Where a rating that follows the clip stands at an instant: one mean per person, of a level.
    Course,
    /// Differences of people's mean courses between two levels.
    Courses,
    /// Items of a scale, a row per person.
    Items,
    /// Right answers of a person by level, of an adaptive block.
    AnswersByLevel,
    /// Thresholds that were computed above, those within the levels.
    Found,
    /// Judgements of a block of difference scaling.
    Judgements,
    /// Faces of a block of reverse correlation: heights of units, and who answered with a category.
    Faces,
    /// A p that a model gives, which only the script in R fits, and only nearly.
    Given,
}

impl Design {
    /// Its function in both scripts.
    pub(crate) fn function(self) -> &'static str {
        match self {
            Self::Groups => "of_groups",
            Self::DifferencesByTrait => "of_differences_by_trait",
            Self::People => "of_people",
            Self::MatchedTrials => "of_matched_trials",
            Self::Blocks => "of_blocks",
            Self::Columns => "of_columns",
            Self::Correlations => "of_correlations",
            Self::TwoFactors => "of_two_factors",
            Self::Combinations => "of_combinations",
            Self::Level => "of_level",
            Self::PersonMean => "of_person_means",
            Self::Answers => "of_answers",
            Self::Choices => "of_choices",
            Self::NetChoices => "of_net_choices",
            Self::Wins => "of_wins",
            Self::PageOrder => "of_page_order",
            Self::PeopleAndSegments => "of_people_and_segments",
            Self::EquivalenceOfPeople => "of_people_within",
            Self::EquivalenceOfGroups => "of_groups_within",
            Self::ClipsByPeople => "of_clips_by_people",
            Self::FirstAnswers => "of_first_answers",
            Self::Detection => "of_detection",
            Self::DetectionBlocks => "of_detection_blocks",
            Self::DetectionPeople => "of_detection_people",
            Self::Confidence => "of_confidence",
            Self::Course => "of_course",
            Self::Courses => "of_courses",
            Self::Items => "of_items",
            Self::AnswersByLevel => "of_answers_by_level",
            Self::Found => "of_found",
            Self::Judgements => "of_judgements",
            Self::Faces => "of_faces",
            Self::Given => "given",
        }
    }
}

/// What is taken from the trials, the test of it, and which columns and levels.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Call {
    pub design: Design,
    /// The test's function in both scripts.
    pub test: &'static str,
    pub arguments: Vec<Argument>,
}

impl Call {
    pub(crate) fn new(design: Design, test: &'static str) -> Self {
        Self { design, test, arguments: Vec::new() }
    }

    pub(crate) fn text(mut self, text: &str) -> Self {
        self.arguments.push(Argument::Text(text.to_owned()));
        self
    }

    pub(crate) fn list(mut self, items: &[String]) -> Self {
        self.arguments.push(Argument::List(items.to_vec()));
        self
    }

    /// A number that a script does not compute, to twelve digits: where a maximum is searched the last ones differ between
    /// the program and a browser's module.
    pub(crate) fn given(mut self, number: f64) -> Self {
        let number = format!("{number:.11e}").parse().unwrap_or(number);
        self.arguments.push(Argument::Given(number));
        self
    }

    pub(crate) fn number(mut self, number: usize) -> Self {
        self.arguments.push(Argument::Number(number));
        self
    }
}
