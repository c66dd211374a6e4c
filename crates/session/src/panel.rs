//! Several clips of one page: rated on one scale, or beside each other to be told apart.

use mimique_study::{LocalText, PanelPages, Question, answer_about};

/// Several clips that are rated on one scale.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The clips, from the first place to the last.
    pub clips: Vec<String>,
    /// The clip that stands on the page as the reference.
    pub reference: Option<String>,
    /// Whether they are played one after the other.
    pub in_turn: bool,
    /// Identifier of the question that is asked of each; empty where none is.
    pub question: String,
    /// What is asked.
    pub prompt: LocalText,
}

impl Panel {
    /// The panel at the places that were drawn, and its questions: what is asked of each of its clips.
    pub(crate) fn of(
        pages: &PanelPages,
        clips: &[String],
        asked: Vec<Question>,
    ) -> Option<(Self, Vec<Question>)> {
        let page =
            pages.pages.iter().find(|page| clips.iter().all(|it| page.clips.contains(it)))?;
        let asked = asked.into_iter().next()?;
        let of = |(place, clip): (usize, &String)| Question {
            id: answer_about(&asked.id, clip),
            prompt: LocalText::Plain(letter(place)),
            help: None,
            video: None,
            ..asked.clone()
        };
        let questions = clips.iter().enumerate().map(of).collect();
        let panel = Self {
            clips: clips.to_vec(),
            reference: pages.reference.and_then(|at| page.clips.get(at)).cloned(),
            in_turn: pages.in_turn,
            question: asked.id.clone(),
            prompt: asked.prompt.clone(),
        };
        Some((panel, questions))
    }

    /// Clips that stand beside each other and are not rated one by one.
    pub(crate) fn unrated(clips: &[String]) -> Self {
        Self {
            clips: clips.to_vec(),
            reference: None,
            in_turn: false,
            question: String::new(),
            prompt: LocalText::Plain(String::new()),
        }
    }

    /// Whether each of the clips is rated.
    pub fn is_rated(&self) -> bool {
        !self.question.is_empty()
    }

    /// The clip at a place from 1; 0 is the open reference.
    pub fn clip(&self, place: u32) -> Option<&str> {
        match (place as usize).checked_sub(1) {
            Some(at) => self.clips.get(at).map(String::as_str),
            None => self.reference.as_deref(),
        }
    }

    /// The places that are played, in the order in which they stand: the open reference, then the clips.
    pub fn places(&self) -> impl Iterator<Item = u32> {
        let first = if self.reference.is_some() { 0 } else { 1 };
        first..=self.clips.len() as u32
    }
}

/// A, B, C: what the clip at a place of a panel is called.
pub fn letter(place: usize) -> String {
    char::from(b'A' + (place % 26) as u8).to_string()
}
