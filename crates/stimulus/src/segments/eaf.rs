//! ELAN documents (`.eaf`, ELAN 5 and 6): tiers of annotations, read, and written so that all that
//! was there before stays as it was.
//!
//! A document keeps its text. A tier is added or replaced by splicing, so that media, other tiers,
//! vocabularies, comments and layout are the same characters before and after.

use std::ops::Range;

use quick_xml::events::Event;
use quick_xml::reader::Reader;

use super::eaf_read::{Reading, at};
use super::eaf_times;

/// An annotation: a stretch of time and a word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EafAnnotation {
    /// First millisecond.
    pub start_ms: u64,
    /// One past the last.
    pub end_ms: u64,
    /// What is written there.
    pub value: String,
}

/// A tier and its annotations, in order of time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EafTier {
    /// Its name.
    pub id: String,
    /// Its annotations; those that refer to another tier's have the times of what they refer to.
    pub annotations: Vec<EafAnnotation>,
    /// How many annotations more it has, whose times nothing in the document tells.
    pub without_times: usize,
}

/// A document that cannot be read or a tier that cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {what}; {remedy}")]
pub struct EafError {
    /// Byte of the document, or tier.
    pub place: String,
    /// What is wrong, with the value.
    pub what: String,
    /// What to do.
    pub remedy: &'static str,
}

/// An ELAN document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EafDocument {
    pub(super) text: String,
    tiers: Vec<EafTier>,
    pub(super) places: Places,
}

/// Where things stand in the text, and what numbers are taken.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Places {
    /// The element `TIME_ORDER` and, unless it is empty, where its end tag begins.
    pub(super) time_order: Option<(Range<usize>, Option<usize>)>,
    /// Every tier: name, element, its linguistic type, name of the tier that it depends on.
    pub(super) tiers: Vec<TierPlace>,
    /// Names of the linguistic types whose annotations have times of their own, not of a parent's.
    pub(super) alignable_types: Vec<String>,
    /// Where the first linguistic type begins, or else what follows it.
    pub(super) after_tiers: Option<usize>,
    /// The text of the property `lastUsedAnnotationId`.
    pub(super) last_annotation: Option<Range<usize>>,
    /// Highest number of an annotation `aN` and of a time slot `tsN`.
    pub(super) annotation_number: u64,
    pub(super) slot_number: u64,
    /// The time slots: identifier, element.
    pub(super) slots: Vec<(String, Range<usize>)>,
    /// Time slots that annotations use: identifier, tier.
    pub(super) uses: Vec<(String, String)>,
}

/// A tier in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct TierPlace {
    pub(super) id: String,
    pub(super) element: Range<usize>,
    pub(super) open_tag: Range<usize>,
    pub(super) parent: Option<String>,
    /// Whether it holds annotations that refer to others.
    pub(super) refers: bool,
}

pub(super) const REMEDY: &str = "open the file in ELAN and save it again";

impl EafDocument {
    /// Read a document.
    ///
    /// # Errors
    /// [`EafError`] with the byte.
    pub fn parse(text: &str) -> Result<Self, EafError> {
        // The reader counts from behind a byte order mark; the document keeps it.
        let marks = text.len() - text.trim_start_matches('\u{feff}').len();
        let mut reader = Reader::from_str(&text[marks..]);
        let mut reading = Reading::of(text);
        loop {
            let from = marks + reader.buffer_position() as usize;
            let event = reader
                .read_event()
                .map_err(|e| at(marks + reader.error_position() as usize, e.to_string()))?;
            let range = from..marks + reader.buffer_position() as usize;
            match event {
                Event::Start(tag) => reading.start(&tag, range, false)?,
                Event::Empty(tag) => reading.start(&tag, range, true)?,
                Event::Text(text) => reading.characters(&text.xml10_content()),
                Event::CData(text) => reading.characters(&text.xml10_content()),
                Event::GeneralRef(reference) => reading.reference(&reference, from)?,
                Event::End(_) => reading.end(range),
                Event::Eof => break,
                Event::Decl(_) | Event::PI(_) | Event::DocType(_) | Event::Comment(_) => {}
            }
        }
        let Reading { places, times, annotations, .. } = reading.whole()?;
        let tiers = eaf_times::tiers(&places, &times, &annotations)?;
        Ok(Self { text: text.to_owned(), tiers, places })
    }

    /// The tiers, in the document's order.
    pub fn tiers(&self) -> &[EafTier] {
        &self.tiers
    }

    /// The tier of that name.
    pub fn tier(&self, id: &str) -> Option<&EafTier> {
        self.tiers.iter().find(|tier| tier.id == id)
    }

    /// The document's text.
    pub fn text(&self) -> &str {
        &self.text
    }
}
