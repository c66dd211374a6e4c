//! Twins of an ELAN document: a benign one has the same annotations; a hostile one is refused with place and
//! remedy, has the same, or says that annotations are without times. None loses or moves one in silence.

use mimique_stimulus::{EafDocument, EafTier};

const DOCUMENT: &str = include_str!("../../../../fuzz/corpus/eaf/seed-elan");

/// What is done, what is replaced, by what.
type Replacement = (&'static str, &'static str, &'static str);

const BENIGN: [Replacement; 8] = [
    (
        "attributes in another order",
        "TIME_SLOT_ID=\"ts1\" TIME_VALUE=\"400\"",
        "TIME_VALUE=\"400\" TIME_SLOT_ID=\"ts1\"",
    ),
    ("single quotes", "TIME_VALUE=\"400\"", "TIME_VALUE='400'"),
    ("blanks around a time", "TIME_VALUE=\"400\"", "TIME_VALUE=\" 400 \""),
    ("a comment among the slots", "<TIME_ORDER>", "<TIME_ORDER><!-- TIME_SLOT -->"),
    ("no declaration", "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", ""),
    ("a value as CDATA", "seen twice", "<![CDATA[seen twice]]>"),
    ("another character's number", "&#232;", "&#xE8;"),
    ("an older format", "FORMAT=\"3.0\" VERSION=\"3.0\"", "FORMAT=\"2.7\" VERSION=\"2.7\""),
];

const HOSTILE: [Replacement; 20] = [
    ("time of words", "TIME_VALUE=\"1550\"", "TIME_VALUE=\"late\""),
    ("time below 0", "TIME_VALUE=\"1550\"", "TIME_VALUE=\"-1550\""),
    ("time with a point", "TIME_VALUE=\"1550\"", "TIME_VALUE=\"1550.5\""),
    ("time NaN", "TIME_VALUE=\"1550\"", "TIME_VALUE=\"NaN\""),
    ("time huge", "TIME_VALUE=\"1550\"", "TIME_VALUE=\"99999999999999999999999\""),
    ("time empty", "TIME_VALUE=\"1550\"", "TIME_VALUE=\"\""),
    ("time of the first missing", " TIME_VALUE=\"400\"", ""),
    ("end before the beginning", "TIME_VALUE=\"3100\"", "TIME_VALUE=\"310\""),
    ("other units", "TIME_UNITS=\"milliseconds\"", "TIME_UNITS=\"NTSC-frames\""),
    ("slot without a name", "TIME_SLOT_ID=\"ts3\" ", ""),
    ("slot twice", "TIME_SLOT_ID=\"ts4\"", "TIME_SLOT_ID=\"ts3\""),
    ("slot that is nowhere", "TIME_SLOT_REF2=\"ts3\"", "TIME_SLOT_REF2=\"ts30\""),
    ("reference missing", " TIME_SLOT_REF2=\"ts3\"", ""),
    ("parent that is nowhere", "ANNOTATION_REF=\"a2\"", "ANNOTATION_REF=\"a20\""),
    ("annotation's name twice", "ANNOTATION_ID=\"a6\"", "ANNOTATION_ID=\"a2\""),
    ("tier's name twice", "TIER_ID=\"empty\"", "TIER_ID=\"Comment\""),
    ("tier without a name", " TIER_ID=\"Comment\"", ""),
    ("tag not closed", "</TIER>", ""),
    ("another document", "ANNOTATION_DOCUMENT", "DOCUMENT"),
    ("slots missing", "<TIME_SLOT TIME_SLOT_ID=\"ts1\" TIME_VALUE=\"400\"/>", ""),
];

fn tiers(text: &str) -> Result<Vec<EafTier>, String> {
    EafDocument::parse(text).map(|document| document.tiers().to_vec()).map_err(|e| e.to_string())
}

fn without_times(tiers: &[EafTier]) -> usize {
    tiers.iter().map(|tier| tier.without_times).sum()
}

fn replaced((name, what, by): Replacement) -> (&'static str, String) {
    assert!(DOCUMENT.contains(what), "{name}: no {what}");
    (name, DOCUMENT.replace(what, by))
}

#[test]
fn benign_twins_have_the_same_annotations() {
    let seed = tiers(DOCUMENT);
    let layouts = [
        ("CRLF", DOCUMENT.replace('\n', "\r\n")),
        ("byte order mark", format!("\u{feff}{DOCUMENT}")),
        ("blank lines at the end", format!("{DOCUMENT}\n\n \n")),
        ("one line", DOCUMENT.replace('\n', " ")),
    ];
    for (name, twin) in BENIGN.map(replaced).into_iter().chain(layouts) {
        assert_eq!(tiers(&twin), seed, "{name}");
    }
}

#[test]
fn hostile_twins_are_refused_or_say_what_is_left_out() {
    let seed = tiers(DOCUMENT).unwrap();
    let damaged = [
        ("two documents in one", DOCUMENT.repeat(2)),
        ("cut in a tier", DOCUMENT[..DOCUMENT.find("<REF_ANNOTATION").unwrap() + 9].to_owned()),
        ("cut between tiers", DOCUMENT[..DOCUMENT.find("<LINGUISTIC_TYPE").unwrap()].to_owned()),
        ("another file in front", format!("frame,time,a\n{DOCUMENT}")),
    ];
    let mut faults = Vec::new();
    for (name, twin) in HOSTILE.map(replaced).into_iter().chain(damaged) {
        match tiers(&twin) {
            Err(error) if error.contains(": ") && error.contains("; ") => {}
            Err(error) => faults.push(format!("{name}: neither place nor remedy: {error}")),
            // The same numbers, but of frames.
            Ok(_) if name == "other units" => faults.push(format!("{name}: in silence")),
            Ok(read) if read == seed || without_times(&read) > without_times(&seed) => {}
            Ok(read) => faults.push(format!("{name}: in silence: {read:?}")),
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
