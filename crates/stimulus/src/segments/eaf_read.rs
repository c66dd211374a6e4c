//! An ELAN document while it is read, tag by tag.

use std::collections::BTreeMap;
use std::ops::Range;

use quick_xml::XmlVersion;
use quick_xml::events::{BytesRef, BytesStart};

use super::eaf::{EafError, Places, REMEDY, TierPlace};

/// An annotation as it stands in the document.
pub(super) struct Annotation {
    /// Index of its tier.
    pub(super) tier: usize,
    /// Its identifier.
    pub(super) id: String,
    /// What says when it is.
    pub(super) bounds: Bounds,
    /// What is written there.
    pub(super) value: String,
}

/// What says when an annotation is.
pub(super) enum Bounds {
    /// The time slots at its ends.
    Slots([String; 2]),
    /// The annotation that it refers to, and the one before it among those that refer to the same.
    Of { annotation: String, previous: Option<String> },
}

/// What is known of a document while it is read.
pub(super) struct Reading<'t> {
    text: &'t str,
    pub(super) places: Places,
    /// Millisecond of each time slot, where it has one.
    pub(super) times: Vec<Option<u64>>,
    pub(super) annotations: Vec<Annotation>,
    /// Names of the elements that are open.
    open: Vec<String>,
    /// The tier that is open.
    tier: Option<usize>,
    /// The text of the annotation that is open.
    value: Option<String>,
    /// Where the text of the property `lastUsedAnnotationId` begins.
    property: Option<usize>,
}

/// A tag with its attributes, and where it stands.
struct Tag {
    name: String,
    attributes: BTreeMap<String, String>,
    range: Range<usize>,
    empty: bool,
}

/// What is wrong at a byte of the document.
pub(super) fn at(byte: usize, what: String) -> EafError {
    EafError { place: format!("byte {byte}"), what, remedy: REMEDY }
}

impl Tag {
    fn attribute(&self, key: &str) -> Option<String> {
        self.attributes.get(key).cloned()
    }

    fn needed(&self, key: &str) -> Result<String, EafError> {
        self.attribute(key).ok_or_else(|| self.refuse(format!("{} without {key}", self.name)))
    }

    fn refuse(&self, what: String) -> EafError {
        at(self.range.start, what)
    }
}

impl<'t> Reading<'t> {
    pub(super) fn of(text: &'t str) -> Self {
        Self {
            text,
            places: Places::default(),
            times: Vec::new(),
            annotations: Vec::new(),
            open: Vec::new(),
            tier: None,
            value: None,
            property: None,
        }
    }

    /// A tag that opens an element, or is one.
    pub(super) fn start(
        &mut self,
        tag: &BytesStart<'_>,
        range: Range<usize>,
        empty: bool,
    ) -> Result<(), EafError> {
        let name = tag.name().as_ref().to_owned();
        let attributes = attributes(tag).map_err(|what| at(range.start, what))?;
        let tag = Tag { name, attributes, range, empty };
        if self.open.is_empty() && tag.name != "ANNOTATION_DOCUMENT" {
            return Err(tag.refuse(format!("the document is a {:?}, not ELAN's", tag.name)));
        }
        if self.open.is_empty() && self.places.after_tiers.is_some() {
            return Err(tag.refuse("a second document in the file".to_owned()));
        }
        match tag.name.as_str() {
            "HEADER" => in_milliseconds(&tag)?,
            "TIME_ORDER" => self.places.time_order = Some((tag.range.clone(), None)),
            "TIME_SLOT" => self.time_slot(&tag)?,
            "TIER" => self.tier(&tag)?,
            "ALIGNABLE_ANNOTATION" | "REF_ANNOTATION" => self.annotation(&tag)?,
            "ANNOTATION_VALUE" => {
                let kinds = ["ALIGNABLE_ANNOTATION", "REF_ANNOTATION"];
                let of_one = self.open.last().is_some_and(|o| kinds.contains(&o.as_str()));
                self.value = (of_one && !empty).then(String::new);
            }
            "LINGUISTIC_TYPE" => self.linguistic_type(&tag)?,
            "PROPERTY" if tag.attribute("NAME").as_deref() == Some("lastUsedAnnotationId") => {
                self.property = (!empty).then_some(tag.range.end);
            }
            _ => {}
        }
        if !empty {
            self.open.push(tag.name);
        }
        Ok(())
    }

    fn time_slot(&mut self, tag: &Tag) -> Result<(), EafError> {
        let id = tag.needed("TIME_SLOT_ID")?;
        let time = match tag.attribute("TIME_VALUE") {
            None => None,
            Some(value) => Some(value.trim().parse::<u64>().map_err(|_| {
                let negative = value.trim().parse::<i64>().is_ok();
                let what = if negative { "a negative time" } else { "no time in milliseconds" };
                tag.refuse(format!("time slot {id:?}: TIME_VALUE {value:?} is {what}"))
            })?),
        };
        raise(&mut self.places.slot_number, &id, "ts");
        self.places.slots.push((id, tag.range.clone()));
        self.times.push(time);
        Ok(())
    }

    fn tier(&mut self, tag: &Tag) -> Result<(), EafError> {
        let id = tag.needed("TIER_ID")?;
        if self.places.tiers.iter().any(|tier| tier.id == id) {
            return Err(tag.refuse(format!("tier {id:?} twice")));
        }
        self.places.tiers.push(TierPlace {
            id,
            element: tag.range.clone(),
            open_tag: tag.range.clone(),
            parent: tag.attribute("PARENT_REF"),
            refers: false,
        });
        self.tier = (!tag.empty).then_some(self.places.tiers.len() - 1);
        Ok(())
    }

    fn annotation(&mut self, tag: &Tag) -> Result<(), EafError> {
        let Some(tier) = self.tier else {
            return Err(tag.refuse(format!("{} outside a tier", tag.name)));
        };
        let id = tag.needed("ANNOTATION_ID")?;
        raise(&mut self.places.annotation_number, &id, "a");
        let bounds = if tag.name == "REF_ANNOTATION" {
            self.places.tiers[tier].refers = true;
            let previous = tag.attribute("PREVIOUS_ANNOTATION");
            Bounds::Of { annotation: tag.needed("ANNOTATION_REF")?, previous }
        } else {
            let slots = [tag.needed("TIME_SLOT_REF1")?, tag.needed("TIME_SLOT_REF2")?];
            let tier = &self.places.tiers[tier].id;
            self.places.uses.extend(slots.iter().map(|slot| (slot.clone(), tier.clone())));
            Bounds::Slots(slots)
        };
        self.annotations.push(Annotation { tier, id, bounds, value: String::new() });
        Ok(())
    }

    fn linguistic_type(&mut self, tag: &Tag) -> Result<(), EafError> {
        self.places.after_tiers.get_or_insert(tag.range.start);
        let free = !tag.attributes.contains_key("CONSTRAINTS");
        let aligned = tag.attribute("TIME_ALIGNABLE").is_none_or(|a| a == "true");
        if free && aligned {
            self.places.alignable_types.push(tag.needed("LINGUISTIC_TYPE_ID")?);
        }
        Ok(())
    }

    /// Characters of the annotation that is open.
    pub(super) fn characters(&mut self, text: &str) {
        if let Some(value) = &mut self.value {
            value.push_str(text);
        }
    }

    /// A character by its number or name.
    pub(super) fn reference(
        &mut self,
        reference: &BytesRef<'_>,
        byte: usize,
    ) -> Result<(), EafError> {
        let Some(value) = &mut self.value else { return Ok(()) };
        let character = reference.resolve_char_ref().ok().flatten();
        let name = reference.xml10_content();
        match (character, quick_xml::escape::resolve_xml_entity(&name)) {
            (Some(c), _) => value.push(c),
            (None, Some(text)) => value.push_str(text),
            (None, None) => return Err(at(byte, format!("&{name}; is not known"))),
        }
        Ok(())
    }

    /// A tag that closes the last element that is open.
    pub(super) fn end(&mut self, range: Range<usize>) {
        let name = self.open.pop().unwrap_or_default();
        match name.as_str() {
            "TIME_ORDER" => {
                if let Some((element, end_tag)) = &mut self.places.time_order {
                    *end_tag = Some(range.start);
                    element.end = range.end;
                }
            }
            "TIER" => {
                if let Some(tier) = self.tier.take() {
                    self.places.tiers[tier].element.end = range.end;
                }
            }
            "ANNOTATION_VALUE" => {
                if let (Some(value), Some(last)) = (self.value.take(), self.annotations.last_mut())
                {
                    last.value = value;
                }
            }
            "PROPERTY" => {
                let plain = |start: &usize| !self.text[*start..range.start].contains('<');
                if let Some(start) = self.property.take().filter(plain) {
                    self.places.last_annotation = Some(start..range.start);
                }
            }
            "ANNOTATION_DOCUMENT" => {
                self.places.after_tiers.get_or_insert(range.start);
            }
            _ => {}
        }
    }

    /// What was read, if it is a whole document.
    pub(super) fn whole(self) -> Result<Self, EafError> {
        if self.places.after_tiers.is_some() && self.open.is_empty() {
            return Ok(self);
        }
        let what = match self.open.last() {
            Some(name) => format!("the document ends inside {name}"),
            None => "no ANNOTATION_DOCUMENT".to_owned(),
        };
        Err(at(self.text.len(), what))
    }
}

/// Refuse times that count frames: the format allows it, ELAN writes milliseconds.
fn in_milliseconds(header: &Tag) -> Result<(), EafError> {
    match header.attribute("TIME_UNITS") {
        Some(unit) if unit != "milliseconds" => {
            Err(header.refuse(format!("TIME_UNITS {unit:?}, not milliseconds")))
        }
        _ => Ok(()),
    }
}

/// Raise `highest` to the number of an identifier `a12` or `ts12`.
fn raise(highest: &mut u64, id: &str, prefix: &str) {
    if let Some(number) = id.strip_prefix(prefix).and_then(|n| n.parse::<u64>().ok()) {
        // Far below the end of the numbers, so that there are always more.
        *highest = (*highest).max(number.min(u64::MAX / 2));
    }
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
