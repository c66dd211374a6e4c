//! What the page shows of a question: the controls that there are, each with its texts in one language.

use super::{Choice, Question};
use crate::KindOfQuestion as _;
use crate::study_file::LocalText;
use crate::text::{Words, typeset};

/// A control of the page, with what it shows.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum QuestionKindView {
    /// Answered by keys while the clip plays.
    Keys {
        /// The options.
        options: Vec<ChoiceView>,
        /// The key of each; one may have none.
        keys: Vec<Option<String>>,
    },
    /// Radio buttons.
    SingleChoice {
        /// In the order shown.
        options: Vec<ChoiceView>,
    },
    /// Check boxes.
    MultipleChoice {
        /// In the order shown.
        options: Vec<ChoiceView>,
        /// Most that may be chosen.
        maximum: Option<usize>,
    },
    /// A scale: number and label of each point (the label is empty where the file has none).
    Likert {
        /// From the lowest to the highest.
        points: Vec<(i64, String)>,
        /// What the lowest means.
        left: String,
        /// What the highest means.
        right: String,
    },
    /// A number on a line.
    Slider {
        /// Whether it is moved while the clip plays.
        while_playing: bool,
        /// Lowest value.
        minimum: f64,
        /// Highest value.
        maximum: f64,
        /// Distance of neighbouring values.
        step: f64,
        /// What the lowest means.
        left: String,
        /// What the highest means.
        right: String,
    },
    /// A number typed.
    Number {
        /// Lowest value.
        minimum: Option<f64>,
        /// Highest value.
        maximum: Option<f64>,
        /// Whole numbers only.
        integer: bool,
        /// Unit shown after the field.
        unit: Option<String>,
    },
    /// Text typed.
    Text {
        /// Several lines.
        long: bool,
        /// Most characters.
        max_length: usize,
    },
    /// One choice in each row.
    Matrix {
        /// The rows.
        rows: Vec<ChoiceView>,
        /// The options of each row.
        options: Vec<ChoiceView>,
    },
    /// Options put in order.
    Ranking {
        /// In the order they stand at first.
        options: Vec<ChoiceView>,
    },
    /// A point on a grid.
    ValenceArousal {
        /// Cells across and up.
        num_items: u32,
        /// What the left edge means.
        left: String,
        /// What the right edge means.
        right: String,
        /// What the lower edge means.
        bottom: String,
        /// What the upper edge means.
        top: String,
    },
    /// Two of the options: the best and the worst.
    BestWorst {
        /// What is asked of the best.
        best: String,
        /// What is asked of the worst.
        worst: String,
        /// In the order shown.
        options: Vec<ChoiceView>,
    },
}

impl QuestionKindView {
    /// Whether it is answered while the clip plays.
    pub fn is_meanwhile(&self) -> bool {
        matches!(self, Self::Keys { .. } | Self::Slider { while_playing: true, .. })
    }
}

/// An option.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChoiceView {
    /// What the answer says.
    pub value: String,
    /// What the participant reads.
    pub label: String,
    /// A picture shown with the label.
    pub image: Option<String>,
    /// A sign-language video shown with the label.
    pub video: Option<String>,
}

/// To whom a question is shown: in which language and order.
#[derive(Debug, Clone, Copy)]
pub struct Showing<'a> {
    /// The question.
    pub question: &'a Question,
    /// The participant's language.
    pub language: &'a str,
    /// The page's own texts in it.
    pub words: &'a Words,
    /// The places of the options in the order drawn for the participant, where one was.
    pub order: Option<&'a [usize]>,
}

impl Showing<'_> {
    /// A text in the participant's language.
    pub fn text(&self, text: &LocalText) -> String {
        typeset(self.language, text.in_language(self.language)).into_owned()
    }

    /// The same; nothing where there is no text.
    pub fn text_of(&self, text: &Option<LocalText>) -> String {
        text.as_ref().map_or_else(String::new, |text| self.text(text))
    }

    /// An option.
    pub fn choice(&self, choice: &Choice) -> ChoiceView {
        ChoiceView {
            value: choice.value.clone(),
            label: self.text(&choice.label),
            image: choice.image.clone(),
            video: choice.video.as_ref().map(|path| path.in_language(self.language).to_owned()),
        }
    }

    /// Options in the order of the file.
    pub fn choices(&self, choices: &[Choice]) -> Vec<ChoiceView> {
        choices.iter().map(|choice| self.choice(choice)).collect()
    }

    /// The question's options in the order shown to this participant.
    pub fn options(&self) -> Vec<ChoiceView> {
        let options = self.question.kind.options();
        match self.order {
            None => self.choices(options),
            Some(order) => order
                .iter()
                .filter_map(|&index| options.get(index))
                .map(|choice| self.choice(choice))
                .collect(),
        }
    }
}
