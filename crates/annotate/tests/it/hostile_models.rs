//! Models whose parts somebody has changed, their hash made anew: they are refused or they label, and never
//! panic.

use mimique_annotate::{
    AnnotateError, AnnotatedTake, BaumWelch, Decode, Decoding, ForestOptions, HmmOptions, Lesson,
    LogisticOptions, Mark, Marked, Method, Model, Segmentation, SvmOptions, Take,
};
use mimique_test_support::Random;
use serde_json::{Value, json};

/// Six seconds at 20 Hz of three faces.
fn annotated() -> AnnotatedTake {
    let mut random = Random::new(3);
    let faces = [[0.0, 0.1], [0.8, 0.1], [0.1, 0.7]];
    let values = (0..120).flat_map(|f| faces[f / 40].map(|w| w + 0.04 * random.normal()));
    let marked =
        (0..3).map(|i| Marked { frames: 40 * i..40 * (i + 1), mark: Mark::Stable(i) }).collect();
    AnnotatedTake {
        name: "made".to_owned(),
        person: "p".to_owned(),
        kind: String::new(),
        take: Take::new(values.collect(), 2, 20.0).unwrap(),
        marked,
    }
}

fn models() -> Vec<Value> {
    let learning = BaumWelch { steps: 2, ..BaumWelch::default() };
    let methods = [
        Method::Knn { k: 3 },
        Method::Svm(SvmOptions::default()),
        Method::Logistic(LogisticOptions::default()),
        Method::Forest(ForestOptions { trees: 3, ..ForestOptions::default() }),
        Method::Hmm(HmmOptions { states: 2, components: 2, learning, ..HmmOptions::default() }),
    ];
    let decodings = [Decoding::default(), Decoding::Segments(Segmentation::as_in_the_thesis())];
    let each = methods.into_iter().zip(decodings.into_iter().cycle());
    let models = each.map(|(method, decoding)| {
        let lesson = Lesson {
            channel: "affect".to_owned(),
            labels: ["a", "b", "c"].map(str::to_owned).to_vec(),
            shapes: ["x", "y"].map(str::to_owned).to_vec(),
            method,
            thinned_to_hz: Some(10.0),
            decoding,
        };
        let text = lesson.learn(&[annotated()]).unwrap().to_json().unwrap();
        serde_json::from_str(&text).unwrap()
    });
    models.collect()
}

/// Every place of a value, as a pointer.
fn places(value: &Value, at: &str, all: &mut Vec<String>) {
    all.push(at.to_owned());
    match value {
        Value::Array(items) => {
            // Long lists of numbers: their ends.
            let ends = [0, 1, items.len().saturating_sub(1)];
            let short = items.len() <= 8;
            for (i, item) in items.iter().enumerate().filter(|(i, _)| short || ends.contains(i)) {
                places(item, &format!("{at}/{i}"), all);
            }
        }
        Value::Object(members) => {
            members.iter().for_each(|(key, member)| places(member, &format!("{at}/{key}"), all));
        }
        _ => {}
    }
}

/// What may stand there instead.
fn others(value: &Value) -> Vec<Value> {
    let mut others = vec![json!(null), json!([]), json!("x"), json!(0), json!(-1), json!(1e300)];
    others.push(json!(u32::MAX));
    others.push(json!(1e-300));
    if let Value::Array(items) = value {
        others.push(items.iter().skip(1).cloned().collect());
        others.push(items.iter().chain(items.first()).cloned().collect());
        others.push(items.iter().rev().cloned().collect());
    }
    others
}

fn with_hash(mut file: Value) -> String {
    file["hash"] = json!(mimique_study::config_hash(&file["model"]));
    file.to_string()
}

#[test]
fn every_part_changed_is_refused_or_labels() {
    let take = annotated().take;
    let (mut tried, mut read, mut labelled) = (0, 0, 0);
    for file in models() {
        assert!(Model::from_json(&with_hash(file.clone())).is_ok());
        let mut all = Vec::new();
        places(&file["model"], "/model", &mut all);
        for place in all {
            for other in others(file.pointer(&place).unwrap()) {
                let mut changed = file.clone();
                *changed.pointer_mut(&place).unwrap() = other;
                tried += 1;
                let Ok(model) = Model::from_json(&with_hash(changed)) else { continue };
                read += 1;
                let decodes = [
                    model.decoding.of(&take, &model.shapes),
                    Ok(Decode::default()),
                    Ok(Decode::Frames),
                    Ok(Decode::Segments(vec![0..20, 30..120])),
                ];
                for decode in decodes.into_iter().flatten() {
                    labelled += usize::from(model.label(&take, &decode).is_ok());
                }
            }
        }
    }
    eprintln!("{tried} tried, {read} read, {labelled} labelled");
    assert!(tried > 3000 && read > 100 && labelled > 100);
}

#[test]
fn every_byte_of_a_model_counts() {
    let [file, ..] = &models()[..] else { panic!("no model") };
    let text = with_hash(file.clone());
    let mut random = Random::new(8);
    for _ in 0..2000 {
        let mut bytes = text.clone().into_bytes();
        let place = (random.uniform() * bytes.len() as f64) as usize;
        bytes[place] = (32.0 + 90.0 * random.uniform()) as u8;
        let changed = String::from_utf8(bytes).unwrap();
        let same = serde_json::from_str::<Value>(&changed).ok() == serde_json::from_str(&text).ok();
        assert_eq!(Model::from_json(&changed).is_ok(), same, "byte {place}");
    }
    assert!(matches!(Model::from_json(""), Err(AnnotateError::Json { .. })));
}
