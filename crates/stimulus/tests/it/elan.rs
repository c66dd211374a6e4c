//! ELAN documents: what ELAN 6 writes is read, tiers are written, everything else stays.

use mimique_stimulus::{EafAnnotation, EafDocument, EafSegments, TakeSegment};

use crate::support::any_eaf;

/// As ELAN 6.7 lays a document out: two tiers, one of them symbolic, a slot without a time, a
/// controlled vocabulary, a comment, entities.
const DOCUMENT: &str = include_str!("../../../../fuzz/corpus/eaf/seed-elan");

fn annotation(start_ms: u64, end_ms: u64, value: &str) -> EafAnnotation {
    EafAnnotation { start_ms, end_ms, value: value.to_owned() }
}

#[test]
fn what_elan_writes_is_read() {
    let document = EafDocument::parse(DOCUMENT).unwrap();
    let names: Vec<&str> = document.tiers().iter().map(|t| t.id.as_str()).collect();
    assert_eq!(names, ["Affect & mouth", "Comment", "empty"]);
    assert_eq!(
        document.tiers()[0].annotations,
        [
            // The slot without a time lies half way.
            annotation(400, 975, "NA"),
            annotation(975, 1550, "colère <3 & more"),
            annotation(2000, 3100, ""),
        ]
    );
    assert_eq!(document.tiers()[1].annotations, [annotation(975, 1550, "seen twice")]);
    let EafSegments { segments, left_out } = document.segments("Affect & mouth", 200.0).unwrap();
    assert_eq!(left_out.sentence().unwrap(), "annotations left out: 1 without a word");
    assert_eq!(segments[1], TakeSegment::new("colère <3 & more", 195..310));
    assert_eq!(segments.len(), 2, "one annotation has no word");
    assert_eq!(
        document.segments("affect", 200.0).unwrap_err().to_string(),
        "tier \"affect\": not in the document, which has Affect & mouth, Comment, empty; \
         name one of its tiers"
    );
}

/// A document of tiers; each annotation is `ID SLOT SLOT` or `ID of ID` with `after ID`.
fn tiers_document(slots: &[(&str, Option<u64>)], tiers: &[(&str, &str, &[&str])]) -> String {
    let slots: String = slots
        .iter()
        .map(|(id, time)| {
            let time = time.map_or(String::new(), |t| format!(" TIME_VALUE=\"{t}\""));
            format!("<TIME_SLOT TIME_SLOT_ID=\"{id}\"{time}/>")
        })
        .collect();
    let tiers: String = tiers
        .iter()
        .map(|(name, parent, annotations)| {
            let parent =
                if parent.is_empty() { String::new() } else { format!(" PARENT_REF=\"{parent}\"") };
            let annotations: String = annotations
                .iter()
                .map(|annotation| {
                    let words: Vec<&str> = annotation.split(' ').collect();
                    let (kind, places) = match words[..] {
                        [_, "of", to] => ("REF", format!("ANNOTATION_REF=\"{to}\"")),
                        [_, "of", to, "after", previous] => (
                            "REF",
                            format!("ANNOTATION_REF=\"{to}\" PREVIOUS_ANNOTATION=\"{previous}\""),
                        ),
                        [_, from, to] => (
                            "ALIGNABLE",
                            format!("TIME_SLOT_REF1=\"{from}\" TIME_SLOT_REF2=\"{to}\""),
                        ),
                        _ => panic!("{annotation}"),
                    };
                    let id = words[0];
                    format!(
                        "<ANNOTATION><{kind}_ANNOTATION ANNOTATION_ID=\"{id}\" {places}>\
                         <ANNOTATION_VALUE>{id}</ANNOTATION_VALUE></{kind}_ANNOTATION></ANNOTATION>"
                    )
                })
                .collect();
            format!("<TIER TIER_ID=\"{name}\"{parent}>{annotations}</TIER>")
        })
        .collect();
    format!("<ANNOTATION_DOCUMENT><TIME_ORDER>{slots}</TIME_ORDER>{tiers}</ANNOTATION_DOCUMENT>")
}

/// Slots without times stand among those of other tiers; only the tier's own chain tells where they lie.
#[test]
fn slots_without_times_follow_the_chain_of_their_tier() {
    let slots = [
        ("s1", Some(1000)),
        ("x1", Some(7000)),
        ("s2", None),
        ("x2", Some(9000)),
        ("s3", None),
        ("s4", None),
        ("s5", Some(1600)),
        ("s6", Some(2000)),
        ("s7", None),
    ];
    let text = tiers_document(
        &slots,
        &[
            // The child's slots, too, are told by the parent's chain.
            ("parts", "words", &["p1 s2 s3"]),
            ("words", "", &["a s1 s2", "b s2 s3", "c s4 s5", "d s6 s7"]),
            ("other", "", &["o x1 x2"]),
        ],
    );
    let document = EafDocument::parse(&text).unwrap();
    let [parts, words, other] = document.tiers() else { panic!("three tiers") };
    assert_eq!(
        words.annotations,
        [annotation(1000, 1200, "a"), annotation(1200, 1400, "b"), annotation(1400, 1600, "c")]
    );
    assert_eq!(parts.annotations, [annotation(1200, 1400, "p1")]);
    assert_eq!(other.annotations, [annotation(7000, 9000, "o")]);
    // The last slot of a chain: nothing tells when it is.
    assert_eq!((words.without_times, parts.without_times), (1, 0));
    let left_out = document.segments("words", 100.0).unwrap().left_out;
    assert_eq!(left_out.sentence().unwrap(), "annotations left out: 1 without times");
    // A new tier moves none of them.
    let with = document.with_tier("new", &[annotation(10, 20, "x")]).unwrap();
    assert_eq!(&with.tiers()[..3], document.tiers());
}

#[test]
fn reference_tiers_have_their_parents_times() {
    let slots = [("s1", Some(1000)), ("s2", Some(1900)), ("s3", Some(2500))];
    let text = tiers_document(
        &slots,
        &[
            ("words", "", &["a s1 s2", "b s2 s3"]),
            ("letters", "words", &["l3 of a after l2", "l1 of a", "l2 of a after l1", "m of b"]),
            ("notes", "letters", &["n of l2", "lost of nowhere"]),
        ],
    );
    let document = EafDocument::parse(&text).unwrap();
    assert_eq!(
        document.tier("letters").unwrap().annotations,
        [
            annotation(1000, 1300, "l1"),
            annotation(1300, 1600, "l2"),
            annotation(1600, 1900, "l3"),
            annotation(1900, 2500, "m")
        ]
    );
    let notes = document.tier("notes").unwrap();
    assert_eq!(
        (&notes.annotations[..], notes.without_times),
        (&[annotation(1300, 1600, "n")][..], 1)
    );
}

#[test]
fn a_tier_is_added_and_everything_else_stays() {
    let document = EafDocument::parse(DOCUMENT).unwrap();
    let clips = [annotation(500, 1700, "joy <2>"), annotation(1700, 2900, "\"fear\" & 'co'")];
    let with = document.with_tier("clips", &clips).unwrap();
    assert_eq!(with.tier("clips").unwrap().annotations, clips);
    assert_eq!(&with.tiers()[..3], document.tiers());
    // Every line that was there is there, in its order, but for the count of annotations.
    let mut lines = with.text().lines();
    for line in DOCUMENT.lines().filter(|l| !l.contains("lastUsedAnnotationId")) {
        assert!(lines.any(|l| l == line), "{line}");
    }
    assert!(with.text().contains(">9</PROPERTY>"));
    assert!(with.text().contains("<TIER LINGUISTIC_TYPE_REF=\"default-lt\" TIER_ID=\"clips\">"));
    assert_eq!(EafDocument::parse(with.text()).unwrap(), with);
    // A byte order mark, as some editors leave one, shifts nothing.
    let marked = EafDocument::parse(&format!("\u{feff}{DOCUMENT}")).unwrap();
    let with_mark = marked.with_tier("clips", &clips).unwrap();
    assert_eq!(with_mark.text(), format!("\u{feff}{}", with.text()));
    // Written again, repaired: the tier is replaced and its old time slots are gone.
    let repaired = [annotation(510, 1700, "joy2")];
    let again = with.with_tier("clips", &repaired).unwrap();
    assert_eq!(again.tier("clips").unwrap().annotations, repaired);
    assert_eq!(&again.tiers()[..3], document.tiers());
    assert_eq!(again.text().matches("<TIME_SLOT ").count(), 7);
    let removed = again.with_tier("clips", &[]).unwrap();
    assert_eq!(removed.text().matches("<TIME_SLOT ").count(), 5);
    // A tier that was closed in one tag.
    let filled = document.with_tier("empty", &repaired).unwrap();
    assert_eq!(filled.tier("empty").unwrap().annotations, repaired);
    assert_eq!(filled.tiers().len(), 3);
}

#[test]
fn a_document_is_made_and_holds_segments() {
    let segments = [
        TakeSegment { label: "anger1".into(), clip: 60..350, expression: 80..310 },
        TakeSegment::new("anger2", 390..620),
    ];
    for rate_hz in [60.0, 119.88, 200.0, 240.0] {
        let annotations: Vec<_> = segments.iter().map(|s| EafAnnotation::of(s, rate_hz)).collect();
        let document = EafDocument::new("2026-01-02T03:04:05Z", Some("film & take.mp4"))
            .unwrap()
            .with_tier("expressions", &annotations)
            .unwrap();
        let back = EafDocument::parse(document.text()).unwrap();
        let read = back.segments("expressions", rate_hz).unwrap().segments;
        let want: Vec<_> =
            segments.iter().map(|s| TakeSegment::new(&*s.label, s.expression.clone())).collect();
        assert_eq!(read, want);
        assert!(document.text().contains("MEDIA_URL=\"film &amp; take.mp4\""));
    }
}

#[test]
fn what_a_tier_cannot_hold_and_what_is_no_document_is_refused() {
    let document = EafDocument::parse(DOCUMENT).unwrap();
    let refused =
        |id: &str, a: &[EafAnnotation]| document.with_tier(id, a).unwrap_err().to_string();
    assert_eq!(
        refused("x", &[annotation(0, 10, "a"), annotation(9, 20, "b")]),
        "tier \"x\": \"a\" and \"b\" overlap; shorten one, or write them into two tiers"
    );
    assert!(refused("x", &[annotation(5, 5, "a")]).contains("lasts from 5 to 5 ms"));
    assert!(refused("Affect & mouth", &[]).contains("the tier \"Comment\" depends on it"));
    assert!(refused("Comment", &[]).contains("belong to another tier's"));
    for (text, message) in [
        ("", "byte 0: no ANNOTATION_DOCUMENT; open the file in ELAN and save it again"),
        ("<html></html>", "byte 0: the document is a \"html\", not ELAN's"),
        (&DOCUMENT[..900], "byte 892: syntax error"),
        ("<ANNOTATION_DOCUMENT><TIER/></ANNOTATION_DOCUMENT>", "byte 21: TIER without TIER_ID"),
    ] {
        let error = EafDocument::parse(text).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
    let hidden_parent = DOCUMENT.replace("PARENT_REF=\"Affect &amp; mouth\" ", "");
    let document = EafDocument::parse(&hidden_parent).unwrap();
    assert_eq!(
        document.with_tier("Affect & mouth", &[annotation(200, 300, "a")]).unwrap_err().to_string(),
        "tier \"Affect & mouth\": the tier \"Comment\" takes its times from it; write to another tier"
    );
    let before = DOCUMENT.replace("\"1550\"", "\"-40\"");
    let error = EafDocument::parse(&before).unwrap_err().to_string();
    assert!(
        error.contains("time slot \"ts3\": TIME_VALUE \"-40\" is a negative time; "),
        "{error}"
    );
    let late = DOCUMENT.replace("\"3100\"", "\"100\"");
    assert!(EafDocument::parse(&late).unwrap_err().to_string().contains("before it begins"));
    // Between a time and an earlier one nothing lies.
    let backwards = EafDocument::parse(&DOCUMENT.replace("\"1550\"", "\"100\"")).unwrap();
    let left_out: Vec<usize> = backwards.tiers().iter().map(|tier| tier.without_times).collect();
    assert_eq!(left_out, [2, 1, 0]);
    // Cut at any byte: an error, never a panic.
    for end in 0..DOCUMENT.len() - 30 {
        assert!(DOCUMENT.get(..end).is_none_or(|text| EafDocument::parse(text).is_err()));
    }
}

/// Seeds and what fuzzing found are committed; each runs as it would in the fuzzer.
#[test]
fn the_corpus_of_the_fuzzer_is_replayed() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/corpus/eaf");
    let mut files = 0;
    for file in std::fs::read_dir(folder).unwrap() {
        any_eaf::read_anyhow(&std::fs::read(file.unwrap().path()).unwrap());
        files += 1;
    }
    assert!(files >= 3, "{files} files in the corpus");
}

#[test]
fn every_byte_changed_is_answered() {
    let seed = DOCUMENT.as_bytes();
    for at in 0..seed.len() {
        for value in *b"<>&\"9\xff " {
            let mut bytes = seed.to_vec();
            bytes[at] = value;
            any_eaf::read_anyhow(&bytes);
        }
    }
}
