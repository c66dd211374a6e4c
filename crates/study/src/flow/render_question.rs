//! From state to screen: questions, their options, what of them is signed.

use super::allowed::shown_questions;
use super::plan::Step;
use super::render::Screen;
use super::view_question::{ChoiceView, QuestionKindView, QuestionView};
use crate::answer::{LONG_TEXT, SHORT_TEXT};
use crate::study_file::{Choice, LocalText, Question, QuestionKind};

impl Screen<'_> {
    pub(super) fn questions(&self, step: &Step) -> Vec<QuestionView> {
        shown_questions(step, self.state).map(|question| self.question(question)).collect()
    }

    fn question(&self, question: &Question) -> QuestionView {
        let value = self.state.record.draft(&question.id).cloned();
        let problem = question.accept(value.as_ref()).err();
        let problem = problem.filter(|_| self.state.live.show_problems);
        QuestionView {
            id: question.id.clone(),
            prompt: self.text(&question.prompt),
            help: question.help.as_ref().map(|help| self.text(help)),
            video: question.video.as_ref().map(|path| self.path(path)),
            signs: match question.kind {
                QuestionKind::Comparison(_) => Vec::new(),
                _ => question.signs.iter().map(|sign| self.choice(sign)).collect(),
            },
            required: question.required,
            optional_mark: (!question.required).then(|| self.words.optional().to_owned()),
            kind: self.kind(question),
            value,
            problem: problem.map(|problem| self.words.problem(&problem)),
        }
    }

    fn kind(&self, question: &Question) -> QuestionKindView {
        let label = |text: &Option<LocalText>| {
            text.as_ref().map_or_else(String::new, |text| self.text(text))
        };
        let options = || self.options(question);
        match &question.kind {
            QuestionKind::SingleChoice(_) => QuestionKindView::SingleChoice { options: options() },
            QuestionKind::MultipleChoice(choice) => {
                QuestionKindView::MultipleChoice { options: options(), maximum: choice.maximum }
            }
            QuestionKind::Likert(scale) => QuestionKindView::Likert {
                points: (scale.start..=scale.end())
                    .enumerate()
                    .map(|(index, number)| {
                        let label = scale.labels.get(index).map(|text| self.text(text));
                        (number, label.unwrap_or_default())
                    })
                    .collect(),
                left: label(&scale.left_label),
                right: label(&scale.right_label),
            },
            QuestionKind::Slider(slider) => QuestionKindView::Slider {
                minimum: slider.minimum,
                maximum: slider.maximum,
                step: slider.step,
                left: label(&slider.left_label),
                right: label(&slider.right_label),
            },
            QuestionKind::Number(field) => QuestionKindView::Number {
                minimum: field.minimum,
                maximum: field.maximum,
                integer: field.integer,
                unit: field.unit.as_ref().map(|unit| self.text(unit)),
            },
            QuestionKind::ShortText(field) => {
                let max_length = field.max_length.unwrap_or(SHORT_TEXT);
                QuestionKindView::Text { long: false, max_length }
            }
            QuestionKind::LongText(field) => {
                let max_length = field.max_length.unwrap_or(LONG_TEXT);
                QuestionKindView::Text { long: true, max_length }
            }
            QuestionKind::Matrix(matrix) => QuestionKindView::Matrix {
                rows: matrix.rows.iter().map(|row| self.choice(row)).collect(),
                options: options(),
            },
            QuestionKind::Ranking(_) => QuestionKindView::Ranking { options: options() },
            QuestionKind::Comparison(comparison) => {
                let words = self.words;
                let sides = [
                    ("left", words.left_one()),
                    ("same", words.both_alike()),
                    ("right", words.right_one()),
                ];
                let mut options = Vec::new();
                for (value, label) in sides {
                    if value != "same" || comparison.allow_same {
                        options.push(match question.sign(value) {
                            Some(sign) => self.choice(sign),
                            None => ChoiceView {
                                value: value.to_owned(),
                                label: label.to_owned(),
                                image: None,
                                video: None,
                            },
                        });
                    }
                }
                QuestionKindView::SingleChoice { options }
            }
            QuestionKind::ValenceArousal(grid) => QuestionKindView::ValenceArousal {
                num_items: grid.num_items,
                left: self.text(&grid.left_label),
                right: self.text(&grid.right_label),
                bottom: self.text(&grid.bottom_label),
                top: self.text(&grid.top_label),
            },
        }
    }

    /// The options in the order shown to this participant.
    fn options(&self, question: &Question) -> Vec<ChoiceView> {
        let options = question.kind.options();
        match self.plan.option_orders.get(&question.id) {
            None => options.iter().map(|choice| self.choice(choice)).collect(),
            Some(order) => order
                .iter()
                .filter_map(|&index| options.get(index))
                .map(|choice| self.choice(choice))
                .collect(),
        }
    }

    fn choice(&self, choice: &Choice) -> ChoiceView {
        ChoiceView {
            value: choice.value.clone(),
            label: self.text(&choice.label),
            image: choice.image.clone(),
            video: choice.video.as_ref().map(|path| self.path(path)),
        }
    }
}
