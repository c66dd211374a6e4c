//! What lies on the workspace: an avatar, a take, a marker map, solved takes.

use std::collections::BTreeMap;

use mimique_actor::{
    Clip, Density, Emotion, HeadSpec, NOISE_MM, build_head, marker_sites, synthetic_take,
};
use mimique_avatar_files::{AvatarSettings, ReadAvatar, read_avatar_bytes};
use mimique_geometry::Point;
use mimique_mocap::{
    Capture, CaptureFacts, Format, LengthUnit, ReadOptions, Recording, WeightOptions, WeightsTable,
    read_weights,
};
use mimique_stimulus::{
    AvatarSkin, GivenGaze, MappedMarker, MarkerMap, MarkerPlace, TakeSegment, built_in_capture,
};
use mimique_study::BuiltinAvatar;
use serde_json::{Value, json};

use crate::exertion::ExertionDesk;
use crate::labels::Labelling;
use crate::layout::LayoutDesk;
use crate::problem::{Problem, Trouble};
use crate::solved::Solved;
use crate::training::TrainingFiles;

/// Everything that the studio knows.
#[derive(Debug, Default)]
pub struct Workspace {
    pub(crate) face: Option<Face>,
    pub(crate) take: Option<Take>,
    pub(crate) map: MarkerMap,
    pub(crate) solved: BTreeMap<String, Solved>,
    pub(crate) segments: Vec<TakeSegment>,
    pub(crate) labels: Labelling,
    pub(crate) training: TrainingFiles,
    /// Where the eyes look; they rest where it is not given.
    pub(crate) gaze: Option<GivenGaze>,
    pub(crate) layout: LayoutDesk,
    pub(crate) exertion: ExertionDesk,
}

/// An avatar and its skin.
#[derive(Debug)]
pub(crate) struct Face {
    pub read: ReadAvatar,
    pub skin: AvatarSkin,
    /// The file's name.
    pub file: String,
    /// Whether settings stood beside it.
    pub has_settings: bool,
    /// Which person of the built-in head it is.
    pub built_in: Option<BuiltinAvatar>,
    /// Where the built-in head's markers sit.
    pub sites: Option<MarkerMap>,
}

/// Where a capture comes from.
#[derive(Debug, Clone)]
pub(crate) enum Origin {
    /// A built-in actor.
    BuiltIn,
    /// A file, with what was said of it that it does not say.
    File { unit: Option<String>, rate_hz: Option<f64> },
}

impl Origin {
    pub(crate) fn is_built_in(&self) -> bool {
        matches!(self, Self::BuiltIn)
    }
}

/// What is played on it.
#[derive(Debug)]
pub(crate) enum Take {
    /// Marker trajectories.
    Markers { name: String, origin: Origin, recording: Recording, head: Vec<String> },
    /// Weights that were recorded or solved elsewhere, and the rate where their file does not say one.
    Weights { name: String, file_rate_hz: Option<f64>, table: WeightsTable },
}

impl Workspace {
    /// An empty workspace.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes an avatar from a file: GLB, glTF with its data inside, or an archive of OBJ poses;
    /// `settings` is the text of its `NAME.avatar.json`. What was solved for another avatar goes.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn avatar_file(
        &mut self,
        file: &str,
        bytes: Vec<u8>,
        settings: Option<&str>,
    ) -> Result<Value, Problem> {
        let settings = settings
            .map(|text| AvatarSettings::from_json(file, text.as_bytes()))
            .transpose()
            .map_err(|e| Problem::of(file, e))?;
        let stem = file.split('.').next().unwrap_or(file);
        let has_settings = settings.is_some();
        let read =
            read_avatar_bytes(bytes, stem, None, settings).map_err(|e| Problem::of(file, e))?;
        self.put_avatar(file, read, has_settings, None)
    }

    /// Takes a person of the built-in head.
    ///
    /// # Errors
    /// None for heads that this version builds.
    pub fn built_in_avatar(&mut self, seed: u64, vertices: usize) -> Result<Value, Problem> {
        let built_in = BuiltinAvatar {
            seed,
            vertices: Some(u32::try_from(vertices).unwrap_or(u32::MAX)),
            actor: None,
        };
        let spec = HeadSpec { density: Density::nearest(vertices), ..HeadSpec::person(seed) };
        let sites = marker_sites(&spec);
        let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
            MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
        });
        let map = MarkerMap { face: face.collect(), ..MarkerMap::default() };
        let read = ReadAvatar {
            avatar: build_head(&spec),
            unit_metres: 1.0,
            locked: Vec::new(),
            notes: Vec::new(),
        };
        self.put_avatar("built-in head", read, false, Some((built_in, map)))
    }

    fn put_avatar(
        &mut self,
        file: &str,
        read: ReadAvatar,
        has_settings: bool,
        built_in: Option<(BuiltinAvatar, MarkerMap)>,
    ) -> Result<Value, Problem> {
        let skin = AvatarSkin::of(&read.avatar).map_err(|e| Problem::of(file, e))?;
        self.solved.clear();
        self.layout.avatar_changed();
        self.map.face.clear();
        let (built_in, sites) = built_in.unzip();
        let file_name = file.to_owned();
        let face =
            self.face.insert(Face { read, skin, file: file_name, has_settings, built_in, sites });
        let avatar = &face.read.avatar;
        // A box around the skin, metres: what a camera shows whole.
        let ends = |pick: fn(f64, f64) -> f64, from: f64| {
            let fold = |ends: [f64; 3], p: &Point| [0, 1, 2].map(|a| pick(ends[a], p[a]));
            face.skin.mesh.positions.iter().fold([from; 3], fold)
        };
        let facts = json!({
            "bounds": [ends(f64::min, f64::INFINITY), ends(f64::max, f64::NEG_INFINITY)],
            "file": file,
            "builtIn": face.built_in.is_some(),
            "name": avatar.name,
            "vertices": face.skin.mesh.positions.len(),
            "shapes": avatar.shape_names,
            "locked": face.read.locked,
            "notes": face.read.notes,
            "meshes": avatar.meshes.iter().map(|m| json!({
                "name": m.name, "part": format!("{:?}", m.part), "vertices": m.positions.len(),
            })).collect::<Vec<_>>(),
        });
        self.map_built_in();
        Ok(facts)
    }

    /// The avatar as the stage draws it.
    ///
    /// # Errors
    /// [`Problem`]: no avatar yet.
    pub fn avatar_pack(&self) -> Result<Vec<u8>, Problem> {
        Ok(mimique_avatar::pack::encode_pack(&self.face()?.read.avatar).bytes)
    }

    /// Takes a capture, or recorded weights (Live Link Face, CSV of `mimique solve`), from a file.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn take_file(
        &mut self,
        file: &str,
        bytes: &[u8],
        unit: Option<&str>,
        rate_hz: Option<f64>,
    ) -> Result<Value, Problem> {
        if mimique_mocap::recognise(bytes).is_some_and(Format::holds_weights) {
            let shape_names = self.face().map_or(&[][..], |face| &face.read.avatar.shape_names);
            let options = WeightOptions { rate_hz, shape_names, animation: None };
            let table = read_weights(bytes, &options).map_err(|e| Problem::of(file, e))?;
            let name = file.to_owned();
            return Ok(self.put_take(Take::Weights { name, file_rate_hz: rate_hz, table }));
        }
        let recording = read_capture(file, bytes, unit, rate_hz)?;
        let origin = Origin::File { unit: unit.map(str::to_owned), rate_hz };
        let take = Take::Markers { name: file.to_owned(), origin, recording, head: Vec::new() };
        Ok(self.put_take(take))
    }

    /// Takes the built-in actor's performance of six emotions, each weak, middling and strong.
    pub fn built_in_take(&mut self, actor: u64) -> Value {
        let spec = HeadSpec::actor(actor);
        let clips: Vec<Clip> = Emotion::ALL
            .iter()
            .flat_map(|&emotion| (1..=3).map(move |intensity| (emotion, intensity)))
            .map(|(emotion, intensity)| Clip { emotion, intensity, seed: actor })
            .collect();
        let take =
            synthetic_take(&build_head(&spec), &marker_sites(&spec), &clips, actor, NOISE_MM);
        let capture = built_in_capture(&take);
        let recording = Recording {
            capture,
            format: &mimique_mocap::WIDE_CSV,
            system: None,
            analog_channels: 0,
            events: Vec::new(),
        };
        let name = "built-in actor".to_owned();
        self.put_take(Take::Markers {
            name,
            origin: Origin::BuiltIn,
            recording,
            head: take.head_labels,
        })
    }

    fn put_take(&mut self, take: Take) -> Value {
        self.solved.clear();
        self.segments.clear();
        self.labels.take_changed();
        self.layout.motion_changed();
        self.exertion.take_changed();
        let facts = match &take {
            Take::Markers { name, origin, recording, .. } => {
                let facts = CaptureFacts::of(recording);
                json!({"file": name, "builtIn": origin.is_built_in(), "kind": "markers",
                       "labels": recording.capture.labels, "facts": facts})
            }
            Take::Weights { name, table, .. } => json!({
                "file": name, "kind": "weights", "frames": table.frames.len(),
                "rate_hz": table.rate_hz(), "columns": table.shape_names,
            }),
        };
        self.take = Some(take);
        self.gaze = None;
        self.map_built_in();
        facts
    }

    /// The built-in actor's markers sit at known places of the built-in head.
    fn map_built_in(&mut self) {
        let (Some(face), Some(Take::Markers { head, recording, .. })) = (&self.face, &self.take)
        else {
            return;
        };
        let Some(sites) = &face.sites else { return };
        let has = |label: &String| recording.capture.marker_index(label).is_some();
        if !head.is_empty() && sites.face.iter().all(|m| has(&m.label)) {
            self.map = MarkerMap {
                avatar: Some(face.read.avatar.name.clone()),
                head: head.clone(),
                neutral: Some(0..60),
                ..sites.clone()
            };
        }
    }

    pub(crate) fn face(&self) -> Result<&Face, Problem> {
        self.face.as_ref().ok_or_else(|| Problem::from(Trouble::NoAvatar))
    }

    pub(crate) fn capture(&self) -> Result<&Capture, Problem> {
        match &self.take {
            Some(Take::Markers { recording, .. }) => Ok(&recording.capture),
            Some(Take::Weights { name, .. }) => Err(Problem::at(name, Trouble::HoldsWeights)),
            None => Err(Trouble::NoCapture.into()),
        }
    }
}

/// The capture of a file; `unit` and `rate_hz` are for files that do not say them.
pub(crate) fn read_capture(
    file: &str,
    bytes: &[u8],
    unit: Option<&str>,
    rate_hz: Option<f64>,
) -> Result<Recording, Problem> {
    let unit = unit
        .map(|word| match word {
            "mm" => Ok(LengthUnit::Millimetre),
            "cm" => Ok(LengthUnit::Centimetre),
            "m" => Ok(LengthUnit::Metre),
            _ => Err(Problem::of("unit", format!("{word:?}; use m, cm or mm"))),
        })
        .transpose()?;
    mimique_mocap::read_recording(bytes, &ReadOptions { unit, rate_hz })
        .map_err(|e| Problem::of(file, e))
}
