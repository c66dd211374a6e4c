//! ELAN documents (`.eaf`, ELAN 5 and 6): tiers of annotations, read, and written so that all that
//! was there before stays as it was.
//!
//! A document keeps its text. A tier is added or replaced by splicing, so that media, other tiers,
//! vocabularies, comments and layout are the same characters before and after.

use std::collections::BTreeMap;
use std::ops::Range;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use quick_xml::reader::Reader;

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

/// A tier and its time-aligned annotations, in order of time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EafTier {
    /// Its name.
    pub id: String,
    /// Its annotations. Those that refer to another tier's are not among them.
    pub annotations: Vec<EafAnnotation>,
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
        let at = |place: u64, what: String| EafError {
            place: format!("byte {place}"),
            what,
            remedy: REMEDY,
        };
        // The reader counts from behind a byte order mark; the document keeps it.
        let marks = (text.len() - text.trim_start_matches('\u{feff}').len()) as u64;
        let mut reader = Reader::from_str(&text[marks as usize..]);
        let mut places = Places::default();
        let mut times: Vec<Option<u64>> = Vec::new();
        // Tier, slots, value of every annotation.
        let mut aligned: Vec<(usize, [String; 2], String)> = Vec::new();
        let mut open: Vec<String> = Vec::new();
        let mut inside_tier: Option<usize> = None;
        let mut value: Option<String> = None;
        let mut property: Option<usize> = None;
        loop {
            let from = marks + reader.buffer_position();
            let event = reader
                .read_event()
                .map_err(|e| at(marks + reader.error_position(), e.to_string()))?;
            let to = marks + reader.buffer_position();
            let range = from as usize..to as usize;
            match event {
                Event::Start(ref tag) | Event::Empty(ref tag) => {
                    let empty = matches!(event, Event::Empty(_));
                    let name = name_of(tag);
                    let attributes = attributes(tag).map_err(|what| at(from, what))?;
                    let attribute = |key: &str| attributes.get(key).cloned();
                    let needed = |key: &str| {
                        attribute(key).ok_or_else(|| at(from, format!("{name} without {key}")))
                    };
                    if open.is_empty() && name != "ANNOTATION_DOCUMENT" {
                        return Err(at(from, format!("the document is a {name:?}, not ELAN's")));
                    }
                    match name.as_str() {
                        "TIME_ORDER" => {
                            places.time_order = Some((range.clone(), None));
                        }
                        "TIME_SLOT" => {
                            let id = needed("TIME_SLOT_ID")?;
                            let time = attribute("TIME_VALUE")
                                .map(|t| {
                                    t.trim().parse::<u64>().map_err(|_| {
                                        at(from, format!("TIME_VALUE {t:?} is no time"))
                                    })
                                })
                                .transpose()?;
                            raise(&mut places.slot_number, &id, "ts");
                            places.slots.push((id, range.clone()));
                            times.push(time);
                        }
                        "TIER" => {
                            places.tiers.push(TierPlace {
                                id: needed("TIER_ID")?,
                                element: range.clone(),
                                open_tag: range.clone(),
                                parent: attribute("PARENT_REF"),
                                refers: false,
                            });
                            inside_tier = (!empty).then_some(places.tiers.len() - 1);
                        }
                        "ALIGNABLE_ANNOTATION" | "REF_ANNOTATION" => {
                            let Some(tier) = inside_tier else {
                                return Err(at(from, format!("{name} outside a tier")));
                            };
                            raise(&mut places.annotation_number, &needed("ANNOTATION_ID")?, "a");
                            if name == "ALIGNABLE_ANNOTATION" {
                                let slots = [needed("TIME_SLOT_REF1")?, needed("TIME_SLOT_REF2")?];
                                let id = &places.tiers[tier].id;
                                places.uses.extend(slots.iter().map(|s| (s.clone(), id.clone())));
                                aligned.push((tier, slots, String::new()));
                            } else {
                                places.tiers[tier].refers = true;
                            }
                        }
                        "ANNOTATION_VALUE" => {
                            let own = open.last().is_some_and(|o| o == "ALIGNABLE_ANNOTATION");
                            value = (own && !empty).then(String::new);
                        }
                        "LINGUISTIC_TYPE" => {
                            places.after_tiers.get_or_insert(range.start);
                            let free = !attributes.contains_key("CONSTRAINTS");
                            let aligned = attribute("TIME_ALIGNABLE").is_none_or(|a| a == "true");
                            if free && aligned {
                                places.alignable_types.push(needed("LINGUISTIC_TYPE_ID")?);
                            }
                        }
                        "PROPERTY"
                            if attribute("NAME").as_deref() == Some("lastUsedAnnotationId") =>
                        {
                            property = (!empty).then_some(range.end);
                        }
                        _ => {}
                    }
                    if !empty {
                        open.push(name);
                    }
                }
                Event::Text(text) => {
                    if let Some(value) = &mut value {
                        value.push_str(&text.xml10_content());
                    }
                }
                Event::CData(text) => {
                    if let Some(value) = &mut value {
                        value.push_str(&text.xml10_content());
                    }
                }
                Event::GeneralRef(reference) => {
                    if let Some(value) = &mut value {
                        let character = reference.resolve_char_ref().ok().flatten();
                        let name = reference.xml10_content();
                        match (character, quick_xml::escape::resolve_xml_entity(&name)) {
                            (Some(c), _) => value.push(c),
                            (None, Some(text)) => value.push_str(text),
                            (None, None) => {
                                return Err(at(from, format!("&{name}; is not known")));
                            }
                        }
                    }
                }
                Event::End(_) => {
                    let name = open.pop().unwrap_or_default();
                    match name.as_str() {
                        "TIME_ORDER" => {
                            if let Some((element, end_tag)) = &mut places.time_order {
                                *end_tag = Some(range.start);
                                element.end = range.end;
                            }
                        }
                        "TIER" => {
                            if let Some(tier) = inside_tier.take() {
                                places.tiers[tier].element.end = range.end;
                            }
                        }
                        "ANNOTATION_VALUE" => {
                            if let (Some(value), Some(last)) = (value.take(), aligned.last_mut()) {
                                last.2 = value;
                            }
                        }
                        "PROPERTY" => {
                            let number = property
                                .take()
                                .filter(|start| !text[*start..range.start].contains('<'));
                            if let Some(start) = number {
                                places.last_annotation = Some(start..range.start);
                            }
                        }
                        "ANNOTATION_DOCUMENT" => {
                            places.after_tiers.get_or_insert(range.start);
                        }
                        _ => {}
                    }
                }
                Event::Eof => break,
                Event::Decl(_) | Event::PI(_) | Event::DocType(_) | Event::Comment(_) => {}
            }
        }
        if places.after_tiers.is_none() || !open.is_empty() {
            let what = match open.last() {
                Some(name) => format!("the document ends inside {name}"),
                None => "no ANNOTATION_DOCUMENT".to_owned(),
            };
            return Err(at(text.len() as u64, what));
        }
        let tiers = tiers(&places, &times, aligned).map_err(|what| EafError {
            place: "TIME_ORDER".to_owned(),
            what,
            remedy: REMEDY,
        })?;
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

/// The tiers with their times; a slot without a time lies evenly between those around it, as ELAN
/// shows it.
fn tiers(
    places: &Places,
    times: &[Option<u64>],
    aligned: Vec<(usize, [String; 2], String)>,
) -> Result<Vec<EafTier>, String> {
    let mut whole = Vec::with_capacity(times.len());
    for (i, time) in times.iter().enumerate() {
        whole.push(time.unwrap_or_else(|| {
            let before = (0..i).rev().find_map(|j| Some((j, times[j]?)));
            let after = (i + 1..times.len()).find_map(|j| Some((j, times[j]?)));
            match (before, after) {
                (Some((a, s)), Some((b, t))) => {
                    let share = (i - a) as f64 / (b - a) as f64;
                    s + (t.saturating_sub(s) as f64 * share).round() as u64
                }
                (Some((_, t)), None) | (None, Some((_, t))) => t,
                (None, None) => 0,
            }
        }));
    }
    let by_name: BTreeMap<&str, u64> =
        places.slots.iter().zip(&whole).map(|((id, _), time)| (id.as_str(), *time)).collect();
    let mut tiers: Vec<EafTier> = places
        .tiers
        .iter()
        .map(|tier| EafTier { id: tier.id.clone(), annotations: Vec::new() })
        .collect();
    for (tier, [start, end], value) in aligned {
        let time = |slot: &String| {
            by_name.get(slot.as_str()).copied().ok_or_else(|| format!("no time slot {slot:?}"))
        };
        let (start_ms, end_ms) = (time(&start)?, time(&end)?);
        if end_ms < start_ms {
            return Err(format!("{value:?} ends at {end_ms} ms, before it begins at {start_ms}"));
        }
        tiers[tier].annotations.push(EafAnnotation { start_ms, end_ms, value });
    }
    for tier in &mut tiers {
        tier.annotations.sort_by_key(|a| (a.start_ms, a.end_ms));
    }
    Ok(tiers)
}

/// Raise `highest` to the number of an identifier `a12` or `ts12`.
fn raise(highest: &mut u64, id: &str, prefix: &str) {
    if let Some(number) = id.strip_prefix(prefix).and_then(|n| n.parse::<u64>().ok()) {
        // Far below the end of the numbers, so that there are always more.
        *highest = (*highest).max(number.min(u64::MAX / 2));
    }
}

fn name_of(tag: &BytesStart<'_>) -> String {
    tag.name().as_ref().to_owned()
}

fn attributes(tag: &BytesStart<'_>) -> Result<BTreeMap<String, String>, String> {
    tag.attributes()
        .map(|attribute| {
            let attribute = attribute.map_err(|e| e.to_string())?;
            let value =
                attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|e| e.to_string())?;
            let key = attribute.key.as_ref().to_owned();
            Ok((key, value.into_owned()))
        })
        .collect()
}
