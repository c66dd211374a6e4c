//! What is tuned is what is shown: `mimique solve`, the studio and a study give weights of the same
//! hash for the same settings.
//!
//! A study's take is stored in steps of 0.01 mm or more, `solve` and the studio take coordinates as
//! they were measured. So that nothing but the pipeline is compared, the markers of this take lie on the
//! steps, and the study plays all of its frames.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use mimique_actor::{
    Clip, Density, Emotion, HeadSpec, Identity, MarkerSites, SyntheticTake, build_head,
    marker_sites, range_of_motion_take, synthetic_take,
};
use mimique_avatar_files::{read_avatar, write_glb};
use mimique_clip::{TakeContent, decode_take, weights_hash};
use mimique_mocap::{
    Capture, LengthUnit, ReadOptions, WeightOptions, WeightsTable, read_weights_file, write_csv,
};
use mimique_solver::{Group, Method, MethodSpec};
use mimique_stimulus::{
    AvatarSkin, MappedMarker, MarkerMap, MarkerPlace, Places, RecordedWeights, TakeOptions,
    Training, lock_shapes, prepare, solve_take,
};
use mimique_study::ClipSource;
use mimique_study::Study;
use mimique_web_studio::Workspace;
use serde_json::{Value, json};

/// Finest step of the markers of a take pack, metres.
const STEP_M: f64 = 1e-5;
/// Neutral frames of both takes.
const NEUTRAL: [usize; 2] = [0, 100];

fn head(seed: u64) -> (HeadSpec, MarkerSites) {
    let spec = HeadSpec { identity: Identity::from_seed(seed), density: Density::COARSE };
    let sites = marker_sites(&spec);
    (spec, sites)
}

/// A capture in metres; `step` puts its coordinates on multiples.
fn capture(take: &SyntheticTake, step: Option<f64>) -> Capture {
    let place = |mm: f64| step.map_or(1e-3 * mm, |step| (1e-3 * mm / step).round() * step + 0.0);
    let positions = take.positions.iter().map(|p| p.map(place));
    Capture::new(take.labels.clone(), take.rate_hz, LengthUnit::Metre, positions)
}

/// The files of a laboratory: avatar, marker map, capture, range of motion, recorded weights.
struct Laboratory {
    folder: tempfile::TempDir,
    frames: usize,
}

impl Laboratory {
    fn new() -> Self {
        let ((actor, actor_sites), (person, sites)) = (head(41), head(3));
        let (actor, avatar) = (build_head(&actor), build_head(&person));
        let clip = Clip { emotion: Emotion::Joy, intensity: 2, seed: 9 };
        let take = synthetic_take(&actor, &actor_sites, &[clip], 6, 0.0);
        let learnt = range_of_motion_take(&actor, &actor_sites, 5, 0.1);
        let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
            MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
        });
        let map = MarkerMap {
            face: face.collect(),
            head: take.head_labels.clone(),
            neutral: Some(NEUTRAL[0]..NEUTRAL[1]),
            ..MarkerMap::default()
        };
        // Recorded weights are stored in steps of the first eight bits of 0.0001.
        let step = f64::from(f32::from_bits(1e-4f32.to_bits() & 0xffff_0000));
        let recorded = take.truth.iter().map(|w| (w / step).round() * step).collect();
        let table = |names: &[String], weights| {
            WeightsTable::at_rate(names.to_vec(), weights, 0, take.rate_hz).to_csv()
        };
        let folder = tempfile::tempdir().unwrap();
        let write = |file: &str, content: &[u8]| {
            std::fs::write(folder.path().join(file), content).unwrap();
        };
        write("head.glb", &write_glb(&avatar, &[], 60.0).unwrap());
        write("map.json", map.to_json().as_bytes());
        write("take.csv", write_csv(&capture(&take, Some(STEP_M))).unwrap().as_bytes());
        write("learnt.csv", write_csv(&capture(&learnt, None)).unwrap().as_bytes());
        write("learnt-weights.csv", table(&learnt.shape_names, learnt.truth).as_bytes());
        write("recorded.csv", table(&take.shape_names, recorded).as_bytes());
        Self { frames: take.positions.len() / take.labels.len(), folder }
    }

    fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    fn bytes(&self, file: &str) -> Vec<u8> {
        std::fs::read(self.path(file)).unwrap()
    }

    fn capture(&self, file: &str) -> Capture {
        mimique_mocap::read_recording(&self.bytes(file), &ReadOptions::default()).unwrap().capture
    }

    /// As `mimique solve` does it.
    fn solve(&self, spec: &MethodSpec) -> String {
        let read = read_avatar(&self.path("head.glb")).unwrap();
        if spec.method == Method::Recorded {
            let table =
                read_weights_file(&self.path("recorded.csv"), &WeightOptions::default()).unwrap();
            let shapes = &read.avatar.shape_names;
            return weights_hash(&RecordedWeights::of(&table, shapes).unwrap().table.weights);
        }
        let mut spec = spec.clone();
        lock_shapes(&mut spec, &read.locked);
        let skin = AvatarSkin::of(&read.avatar).unwrap();
        let map = MarkerMap::from_text(&String::from_utf8_lossy(&self.bytes("map.json"))).unwrap();
        let training = (spec.method == Method::Regression).then(|| {
            Box::new(Training {
                capture: self.capture("learnt.csv"),
                weights: read_weights_file(
                    &self.path("learnt-weights.csv"),
                    &WeightOptions::default(),
                )
                .unwrap(),
                neutral: Some(NEUTRAL[0]..NEUTRAL[1]),
                head: None,
            })
        });
        let options = TakeOptions { training, ..TakeOptions::default() };
        let take = self.capture("take.csv");
        let solved = solve_take(&skin, &take, &map, &spec, &options, &mut || 0.0).unwrap();
        solved.report.weights_hash
    }

    /// The studio with every file open.
    fn workspace(&self) -> Workspace {
        let mut workspace = Workspace::new();
        workspace.avatar_file("head.glb", self.bytes("head.glb"), None).unwrap();
        workspace.take_file("take.csv", &self.bytes("take.csv"), None, None).unwrap();
        let map = self.bytes("map.json");
        workspace.map_file("map.json", &String::from_utf8_lossy(&map)).unwrap();
        workspace.training_take("learnt.csv", &self.bytes("learnt.csv"), None, None).unwrap();
        workspace
            .training_weights("learnt-weights.csv", &self.bytes("learnt-weights.csv"))
            .unwrap();
        workspace.set_training_neutral(NEUTRAL[0], NEUTRAL[1]).unwrap();
        workspace
    }

    /// As the studio does it.
    fn studio(&self, workspace: &mut Workspace, spec: &MethodSpec) -> String {
        if spec.method == Method::Recorded {
            workspace.take_file("recorded.csv", &self.bytes("recorded.csv"), None, None).unwrap();
        }
        let facts = workspace.solve("a", &serde_json::to_string(spec).unwrap()).unwrap();
        facts["weights_hash"].as_str().unwrap().to_owned()
    }

    /// A study of these methods, prepared: what the server and every browser compute.
    fn study(&self, methods: &BTreeMap<String, MethodSpec>) -> BTreeMap<String, ClipSource> {
        let clip = |name: &String, spec: &MethodSpec| {
            let mut entry = json!(spec);
            if spec.method == Method::Regression {
                entry["training"] = json!({"capture": "learnt", "weights": "learnt-weights.csv"});
            }
            (name.clone(), entry)
        };
        let of = |recorded: bool| -> Value {
            let of_kind =
                methods.iter().filter(|(_, spec)| (spec.method == Method::Recorded) == recorded);
            Value::Object(of_kind.map(|(name, spec)| clip(name, spec)).collect())
        };
        let mut sources = BTreeMap::new();
        for (file, methods) in [("take.csv", of(false)), ("recorded.csv", of(true))] {
            let study = Study::from_value(&json!({
                "id": "test",
                "studyMetadata": {"title": "Test", "version": "1"},
                "languages": ["en"],
                "components": {},
                "sequence": {"order": "fixed", "components": []},
                "stimuli": {
                    "avatars": {"head": {"file": "head.glb"}},
                    "captures": {
                        "take": {"file": file, "markers": "map.json"},
                        "learnt": {"file": "learnt.csv", "neutral": NEUTRAL},
                    },
                    "segments": [{"id": "all", "capture": "take", "first": 0, "end": self.frames}],
                    "methods": methods,
                },
            }))
            .unwrap();
            let places = Places {
                study: self.folder.path().to_owned(),
                data: None,
                packs: self.path("packs"),
            };
            sources.extend(prepare(&study, &places, &mut |_| {}).unwrap().clips);
        }
        sources
    }
}

/// The packs hold the capture bit for bit: only then do the hashes say something of the pipeline.
fn assert_on_steps(packs: &Path, clip: &ClipSource, capture: &Capture) {
    let take = decode_take(&std::fs::read(packs.join(&clip.take)).unwrap()).unwrap();
    let TakeContent::Markers(markers) = take.content else {
        panic!("{} has no markers", clip.take)
    };
    let columns: Vec<usize> =
        markers.labels.iter().map(|label| capture.marker_index(label).unwrap()).collect();
    let frames = 0..capture.frames();
    let all: Vec<f64> = frames
        .flat_map(|f| columns.iter().flat_map(move |&c| capture.frame(f)[c].to_array()))
        .collect();
    assert_eq!(markers.positions, all);
}

/// No gaze is given, so the eyes rest; the lids, whose markers move, do not.
fn assert_eyes_rest(weights: &[f32], shapes: &[String], name: &str) {
    let most = |k: usize| {
        weights.iter().skip(k).step_by(shapes.len()).fold(0.0, |most: f32, w| most.max(w.abs()))
    };
    let moved = |prefix: &str| -> Vec<f32> {
        (0..shapes.len()).filter(|&k| shapes[k].starts_with(prefix)).map(most).collect()
    };
    assert_eq!(moved("eyeLook"), [0.0; 8], "{name}");
    assert!(moved("eyeBlink").iter().any(|&w| w > 0.0), "{name}: {:?}", moved("eyeBlink"));
}

#[test]
fn solve_studio_and_study_give_the_same_weights() {
    let laboratory = Laboratory::new();
    let mut methods = BTreeMap::new();
    for method in Method::ALL {
        let mut spec = MethodSpec::new(method);
        if method == Method::Regression {
            spec.basis_vectors = Some(40);
        }
        methods.insert(method.to_string(), spec);
    }
    // Other settings than the defaults, the head's low-pass among them.
    let lsts = MethodSpec { alpha: Some(0.7), ..MethodSpec::new(Method::Lsts) };
    for (name, cutoff_hz) in [("unfiltered", 0.0), ("slow", 4.0)] {
        methods.insert(
            name.to_owned(),
            MethodSpec { head_lowpass_hz: Some(cutoff_hz), ..lsts.clone() },
        );
    }
    methods.insert("smoothed".to_owned(), MethodSpec { rbf_smoothing: Some(0.1), ..lsts.clone() });
    let clips = laboratory.study(&methods);
    assert_eq!(clips.len(), Method::ALL.len() + 3);
    let take = laboratory.capture("take.csv");
    assert_on_steps(&laboratory.path("packs"), &clips["all.lsts"], &take);

    let mut hashes = BTreeMap::new();
    let mut workspace = laboratory.workspace();
    let avatar = read_avatar(&laboratory.path("head.glb")).unwrap().avatar;
    let (recorded, solved): (Vec<_>, Vec<_>) =
        methods.iter().partition(|(_, spec)| spec.method == Method::Recorded);
    for (name, spec) in solved.into_iter().chain(recorded) {
        let study = &clips[&format!("all.{name}")];
        let native = laboratory.solve(spec);
        assert_eq!(native, study.weights_hash, "{name}: solve and study");
        assert_eq!(native, laboratory.studio(&mut workspace, spec), "{name}: solve and studio");
        if spec.method.uses(Group::Shapes) {
            assert_eyes_rest(&workspace.weights("a").unwrap(), avatar.face_shapes(), name);
        }
        hashes.insert(native, name);
        let expected = match (spec.method, spec.head_lowpass_hz) {
            (Method::Recorded, _) => None,
            (_, None) => Some(10.0),
            (_, named) => named,
        };
        assert_eq!(study.method.head_lowpass_hz, expected, "{name}");
    }
    // They are all different solves.
    assert_eq!(hashes.len(), methods.len(), "{hashes:?}");
}
