//! ELAN documents made anew, and tiers put into documents that are there.

use std::fmt::Write as _;
use std::ops::Range;

use quick_xml::escape::escape;

use super::TakeSegment;
use super::eaf::{EafAnnotation, EafDocument, EafError, EafTier, REMEDY};

/// Linguistic type of the tiers made here, where a document has none that fits.
const TYPE: &str = "mimique-expression";

impl EafDocument {
    /// A document without tiers; `date` as ISO 8601, `media` a path or address of the video.
    ///
    /// # Errors
    /// [`EafError`]: `date` or `media` hold what XML cannot.
    pub fn new(date: &str, media: Option<&str>) -> Result<Self, EafError> {
        let media = media.map_or(String::new(), |url| {
            let kind = match url.rsplit('.').next().map(str::to_ascii_lowercase).as_deref() {
                Some("wav") => "audio/x-wav",
                Some("mp4") => "video/mp4",
                Some("mpg" | "mpeg") => "video/mpeg",
                Some("mov") => "video/quicktime",
                _ => "video/*",
            };
            format!(
                "        <MEDIA_DESCRIPTOR MEDIA_URL=\"{}\" MIME_TYPE=\"{kind}\"/>\n",
                escape(url)
            )
        });
        Self::parse(&format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <ANNOTATION_DOCUMENT AUTHOR=\"\" DATE=\"{}\" FORMAT=\"3.0\" VERSION=\"3.0\" \
             xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
             xsi:noNamespaceSchemaLocation=\"http://www.mpi.nl/tools/elan/EAFv3.0.xsd\">\n    \
             <HEADER MEDIA_FILE=\"\" TIME_UNITS=\"milliseconds\">\n{media}        \
             <PROPERTY NAME=\"lastUsedAnnotationId\">0</PROPERTY>\n    </HEADER>\n    \
             <TIME_ORDER>\n    </TIME_ORDER>\n    \
             <LINGUISTIC_TYPE GRAPHIC_REFERENCES=\"false\" LINGUISTIC_TYPE_ID=\"{TYPE}\" \
             TIME_ALIGNABLE=\"true\"/>\n\
             </ANNOTATION_DOCUMENT>\n",
            escape(date)
        ))
    }

    /// The document with a tier of that name, which takes the place of one that was there.
    /// Everything else stays, character by character.
    ///
    /// # Errors
    /// [`EafError`]: annotations that overlap or are empty, which a tier of ELAN cannot hold, or a tier
    /// from which others take their times.
    pub fn with_tier(&self, id: &str, annotations: &[EafAnnotation]) -> Result<Self, EafError> {
        let refuse =
            |what: String, remedy| EafError { place: format!("tier {id:?}"), what, remedy };
        let mut sorted = annotations.to_vec();
        sorted.sort_by_key(|a| (a.start_ms, a.end_ms));
        for a in &sorted {
            if a.start_ms >= a.end_ms {
                let what = format!("{:?} lasts from {} to {} ms", a.value, a.start_ms, a.end_ms);
                return Err(refuse(what, "give annotations of a millisecond or more"));
            }
        }
        if let Some(pair) = sorted.windows(2).find(|p| p[1].start_ms < p[0].end_ms) {
            let what = format!("{:?} and {:?} overlap", pair[0].value, pair[1].value);
            return Err(refuse(what, "shorten one, or write them into two tiers"));
        }
        if id.trim().is_empty() {
            return Err(refuse("no name".to_owned(), "name the tier"));
        }
        let old = self.places.tiers.iter().find(|tier| tier.id == id);
        if let Some(old) = old {
            if let Some(child) = self.places.tiers.iter().find(|t| t.parent.as_deref() == Some(id))
            {
                let what = format!("the tier {:?} depends on it", child.id);
                return Err(refuse(what, "write to another tier"));
            }
            if old.parent.is_some() || old.refers {
                let what = "its annotations belong to another tier's".to_owned();
                return Err(refuse(what, "write to another tier"));
            }
        }
        let old = old.map(|tier| (tier.element.clone(), tier.open_tag.clone()));
        let with = self.spliced(id, &sorted, old)?;
        // Some tool's document refers to a tier without naming it as the parent.
        let others = |document: &Self| -> Vec<EafTier> {
            document.tiers().iter().filter(|tier| tier.id != id).cloned().collect()
        };
        let (before, after) = (others(self), others(&with));
        if before != after {
            let same = before.iter().zip(&after).take_while(|(before, after)| before == after);
            let moved = before.get(same.count()).map_or("", |tier| &tier.id);
            let what = format!("the tier {moved:?} takes its times from it");
            return Err(refuse(what, "write to another tier"));
        }
        Ok(with)
    }

    /// The text with time slots, tier and linguistic type put in.
    fn spliced(
        &self,
        id: &str,
        annotations: &[EafAnnotation],
        old: Option<(Range<usize>, Range<usize>)>,
    ) -> Result<Self, EafError> {
        let places = &self.places;
        // Slots that only the old tier used go with it.
        let unused = |slot: &str| {
            let mut users = places.uses.iter().filter(|(s, _)| s == slot).peekable();
            users.peek().is_some() && users.all(|(_, tier)| tier == id)
        };
        let mut edits: Vec<Edit> = (places.slots.iter())
            .filter(|(slot, _)| unused(slot))
            .map(|(_, element)| (self.with_blank_before(element), String::new()))
            .collect();
        let written = Written::of(annotations, places.slot_number, places.annotation_number);
        edits.push(self.tier_edit(id, &written.tier, old));
        edits.push(self.slots_edit(&written.slots));
        if let Some(property) = &places.last_annotation {
            let said = self.text[property.clone()].trim().parse::<u64>().unwrap_or(0);
            edits.push((property.clone(), said.max(written.last_annotation).to_string()));
        }
        // Of two edits at one place the one made first comes first: slots stand before tiers.
        edits.sort_by_key(|(range, text)| (range.start, !text.starts_with("<TIME_ORDER")));
        Self::parse(&self.edited(&edits)?)
    }

    /// The tier in the place of the old one, or after the others with a linguistic type that it may be of.
    fn tier_edit(&self, id: &str, tier: &str, old: Option<(Range<usize>, Range<usize>)>) -> Edit {
        if let Some((element, open_tag)) = old {
            let open = self.text[open_tag].trim_end_matches('>').trim_end_matches('/');
            return (element, format!("{}>{tier}", open.trim_end()));
        }
        let fits = self.places.alignable_types.first();
        let kind = fits.map_or(TYPE, String::as_str);
        let open =
            format!("<TIER LINGUISTIC_TYPE_REF=\"{}\" TIER_ID=\"{}\">", escape(kind), escape(id));
        let types = match fits {
            Some(_) => String::new(),
            None => format!(
                "<LINGUISTIC_TYPE GRAPHIC_REFERENCES=\"false\" \
                 LINGUISTIC_TYPE_ID=\"{TYPE}\" TIME_ALIGNABLE=\"true\"/>\n    "
            ),
        };
        let after_tiers = self.after_tiers();
        (after_tiers..after_tiers, format!("{open}{tier}\n    {types}"))
    }

    /// The time slots at the end of the others, or in an element of their own.
    fn slots_edit(&self, slots: &str) -> Edit {
        let element = format!("<TIME_ORDER>\n    {slots}</TIME_ORDER>");
        match &self.places.time_order {
            Some((_, Some(end))) => (*end..*end, slots.to_owned()),
            Some((empty, None)) => (empty.clone(), element),
            None => {
                let tiers = &self.places.tiers;
                let first = tiers.first().map_or(self.after_tiers(), |t| t.element.start);
                (first..first, format!("{element}\n    "))
            }
        }
    }

    fn after_tiers(&self) -> usize {
        self.places.after_tiers.unwrap_or(self.text.len())
    }

    /// The text with edits in the order of their places.
    fn edited(&self, edits: &[Edit]) -> Result<String, EafError> {
        let new: usize = edits.iter().map(|(_, text)| text.len()).sum();
        let mut text = String::with_capacity(self.text.len() + new);
        let mut at = 0;
        for (range, new) in edits {
            // A tier inside a property, as no ELAN writes it.
            if range.start < at {
                return Err(EafError {
                    place: format!("byte {}", range.start),
                    what: "one part of the document lies inside another".to_owned(),
                    remedy: REMEDY,
                });
            }
            text.push_str(&self.text[at..range.start]);
            text.push_str(new);
            at = range.end;
        }
        text.push_str(&self.text[at..]);
        Ok(text)
    }

    /// An element and the blanks before it, so that no empty line stays.
    fn with_blank_before(&self, element: &Range<usize>) -> Range<usize> {
        let before = self.text[..element.start].trim_end().len();
        before..element.end
    }

    /// The expressions of a tier at a rate: [`EafDocument::labelled_segments`] without those of the
    /// neutral face, which are counted among what is left out.
    ///
    /// # Errors
    /// [`EafError`]: no such tier.
    pub fn segments(&self, tier: &str, rate_hz: f64) -> Result<EafSegments, EafError> {
        let mut found = self.labelled_segments(tier, rate_hz)?;
        let all = found.segments.len();
        found.segments.retain(|segment| !segment.is_neutral());
        found.left_out.neutral = all - found.segments.len();
        Ok(found)
    }

    /// The segments of a tier at a rate, those of the neutral face and of transitions, too; each
    /// annotation is a clip that is all expression. Annotations without a word, without times or
    /// shorter than a frame are left out and counted. Annotations of a tier that belong to another
    /// tier's have its times.
    ///
    /// # Errors
    /// [`EafError`]: no such tier.
    pub fn labelled_segments(&self, tier: &str, rate_hz: f64) -> Result<EafSegments, EafError> {
        let found = self.tier(tier).ok_or_else(|| {
            let names: Vec<&str> = self.tiers().iter().map(|t| t.id.as_str()).collect();
            EafError {
                place: format!("tier {tier:?}"),
                what: format!("not in the document, which has {}", names.join(", ")),
                remedy: "name one of its tiers",
            }
        })?;
        let mut left_out = LeftOut { without_times: found.without_times, ..LeftOut::default() };
        let mut segments = Vec::new();
        for annotation in &found.annotations {
            let word = annotation.value.trim();
            let frames = annotation.frames(rate_hz);
            if word.is_empty() {
                left_out.without_word += 1;
            } else if frames.is_empty() {
                left_out.without_frame += 1;
            } else {
                segments.push(TakeSegment::new(word, frames));
            }
        }
        Ok(EafSegments { segments, left_out })
    }
}

/// The segments of a tier, and what of it is none.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct EafSegments {
    /// The segments, in order of time.
    pub segments: Vec<TakeSegment>,
    /// The annotations that are no segments.
    pub left_out: LeftOut,
}

/// How many annotations of a tier are no segments, and why.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Their times are not in the document.
    pub without_times: usize,
    /// Nothing is written there.
    pub without_word: usize,
    /// They say that the face is neutral.
    pub neutral: usize,
    /// They are shorter than a frame of the take.
    pub without_frame: usize,
}

impl LeftOut {
    /// What to tell of them; nothing where all annotations are segments.
    pub fn sentence(&self) -> Option<String> {
        let counts = [
            (self.without_times, "without times"),
            (self.without_word, "without a word"),
            (self.neutral, "of the neutral face"),
            (self.without_frame, "shorter than a frame"),
        ];
        let told: Vec<String> = counts
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, why)| format!("{count} {why}"))
            .collect();
        (!told.is_empty()).then(|| format!("annotations left out: {}", told.join(", ")))
    }
}

/// Annotations and frames.
impl EafAnnotation {
    /// The frames of an annotation: milliseconds times rate / 1000, halves up.
    pub fn frames(&self, rate_hz: f64) -> Range<usize> {
        let frame = |ms: u64| (ms as f64 * rate_hz / 1000.0).round() as usize;
        frame(self.start_ms)..frame(self.end_ms)
    }

    /// The expression of a segment, without lead-in and lead-out.
    pub fn of(segment: &TakeSegment, rate_hz: f64) -> Self {
        let ms = |frame: usize| (frame as f64 * 1000.0 / rate_hz).round() as u64;
        Self {
            start_ms: ms(segment.expression.start),
            end_ms: ms(segment.expression.end),
            value: segment.label.clone(),
        }
    }
}

/// What takes the place of a part of the text.
type Edit = (Range<usize>, String);

/// Annotations as ELAN writes them.
struct Written {
    /// Their time slots.
    slots: String,
    /// The tier from behind its open tag.
    tier: String,
    /// Number of the last annotation.
    last_annotation: u64,
}

impl Written {
    /// With the numbers that follow those of the last slot and annotation.
    fn of(annotations: &[EafAnnotation], mut slot: u64, mut annotation: u64) -> Self {
        // ELAN wants time slots in order of time; those without one stay where they are, so the
        // new ones go after all that are not later.
        let (mut slots, mut tier) = (String::new(), String::new());
        for a in annotations {
            let [start, end] = [slot + 1, slot + 2];
            slot += 2;
            annotation += 1;
            // Writing to a String does not fail.
            let _ = write!(
                slots,
                "    <TIME_SLOT TIME_SLOT_ID=\"ts{start}\" TIME_VALUE=\"{}\"/>\n        \
                 <TIME_SLOT TIME_SLOT_ID=\"ts{end}\" TIME_VALUE=\"{}\"/>\n    ",
                a.start_ms, a.end_ms
            );
            let _ = write!(
                tier,
                "\n        <ANNOTATION>\n            \
                 <ALIGNABLE_ANNOTATION ANNOTATION_ID=\"a{annotation}\" \
                 TIME_SLOT_REF1=\"ts{start}\" TIME_SLOT_REF2=\"ts{end}\">\n                \
                 <ANNOTATION_VALUE>{}</ANNOTATION_VALUE>\n            \
                 </ALIGNABLE_ANNOTATION>\n        </ANNOTATION>",
                escape(&a.value)
            );
        }
        tier.push_str("\n    </TIER>");
        Self { slots, tier, last_annotation: annotation }
    }
}
