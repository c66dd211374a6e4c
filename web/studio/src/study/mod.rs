//! The workspace as a study: what is open, the segments and the methods of the faces side by side in; the files of a
//! study's folder out, which the page puts into an archive.

mod bindings;

use std::path::Path;

use mimique_avatar_files::AvatarSettings;
use mimique_mocap::{Capture, write_csv};
use mimique_new_study::{
    Design, Instrument, NotComposed, Stimuli, Wishes, compose, designs, instruments, study_id,
};
use mimique_solver::{MethodSpec, Needs};
use mimique_stimulus::{TakeSegment, identifier, study_segments};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use crate::problem::{Problem, Trouble};
use crate::workspace::{Origin, Take, Workspace};

/// Folder of the files in the study's folder.
const FOLDER: &str = "stimuli";
/// The marker map in it.
const MAP: &str = "markers.json";

/// What a person wishes of the study.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct Asked {
    /// Its name, which the identifier is made of.
    name: String,
    /// What participants see above it; the design's title where none is given.
    title: Option<String>,
    /// A design of the library.
    design: String,
    /// Instruments of the library.
    instruments: Vec<String>,
    /// Codes of its languages.
    languages: Vec<String>,
    /// The faces side by side.
    faces: Vec<Shown>,
    /// Where the eyes look, as a study file has it; a file by its name alone.
    gaze: Option<Map<String, Value>>,
}

/// A face: its name, and its method as it was solved.
#[derive(Debug, Deserialize)]
struct Shown {
    name: String,
    settings: Map<String, Value>,
}

/// The files of a study's folder, as they come together.
#[derive(Debug, Default)]
struct Folder {
    /// Names and texts of what is written.
    made: Vec<(String, String)>,
    /// What is copied as it was opened, by what it is to the studio, and where it goes.
    copied: Vec<(&'static str, String)>,
}

impl Folder {
    /// A file that was opened: its path in the study's folder.
    fn copy(&mut self, role: &'static str, file: &str) -> Result<String, Problem> {
        let path = format!("{FOLDER}/{}", file_name(file));
        if self.copied.iter().any(|(_, taken)| *taken == path) {
            let words = "two files of the study have this name; rename one and open it again";
            return Err(Problem::of(file, words));
        }
        self.copied.push((role, path.clone()));
        Ok(path)
    }

    fn make(&mut self, name: &str, text: String) -> String {
        let path = format!("{FOLDER}/{name}");
        self.made.push((path.clone(), text));
        path
    }
}

/// A name that every disk and archive takes.
fn file_name(name: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    name.chars().map(|c| if plain(c) { c } else { '-' }).collect()
}

impl Workspace {
    /// What studies can be made of: designs that take stimuli of one's own, and instruments.
    ///
    /// # Errors
    /// None of this version's library.
    pub fn study_library() -> Result<Value, Problem> {
        let blame = |e| Problem::of("library", e);
        let mut names = Vec::new();
        for (name, _) in designs().map_err(blame)? {
            if matches!(Design::named(name).map_err(blame)?, Design::Parts(_)) {
                names.push(name);
            }
        }
        let instruments = instruments().map_err(blame)?;
        let told = instruments.iter().map(|own| json!({ "id": own.id, "name": own.name }));
        Ok(json!({ "designs": names, "instruments": told.collect::<Vec<_>>() }))
    }

    /// The study: `{"id", "made": [[path, text], ...], "copied": [[what, path], ...]}`; what is copied are the files
    /// that were opened as `avatar`, `settings`, `take`, `training`, `training-weights` and `gaze`.
    ///
    /// # Errors
    /// [`Problem`]: something is not there yet, or does not go into a study.
    pub fn study(&self, asked: &str) -> Result<Value, Problem> {
        let asked: Asked = serde_json::from_str(asked).map_err(|e| Problem::of("study", e))?;
        let id = study_id(&asked.name)
            .ok_or_else(|| Problem::of("name", "no letter in it; name the study"))?;
        let mut folder = Folder::default();
        let mut captures = Map::new();
        let methods = self.methods_of_study(&asked, &mut folder, &mut captures)?;
        let stimuli = self.stimuli_of_study(&asked, &mut folder, captures)?;
        let wishes = Wishes {
            id,
            title: asked.title.filter(|title| !title.trim().is_empty()),
            languages: asked.languages,
            methods,
        };
        let of_library = |e| Problem::of("library", e);
        let design = Design::named(&asked.design).map_err(of_library)?;
        let named = asked.instruments.iter().map(|name| Instrument::named(name));
        let instruments: Vec<Instrument> = named.collect::<Result<_, _>>().map_err(of_library)?;
        let composed =
            compose(&wishes, &design, &instruments, Some(&stimuli)).map_err(|e| match &e {
                NotComposed::NoSingleClips { instrument } => Problem::of(instrument, &e),
                _ => Problem::of(&asked.design, &e),
            })?;
        let files = composed.files("the studio", &asked.design, &wishes, &instruments, &[]);
        folder.made.extend(files);
        Ok(json!({ "id": wishes.id, "made": folder.made, "copied": folder.copied }))
    }

    /// Avatar, captures and segments.
    fn stimuli_of_study(
        &self,
        asked: &Asked,
        folder: &mut Folder,
        mut captures: Map<String, Value>,
    ) -> Result<Stimuli, Problem> {
        let face = self.face()?;
        let avatar = match &face.built_in {
            Some(built_in) => json!({ "builtin": built_in }),
            None => {
                let path = folder.copy("avatar", &face.file)?;
                if face.has_settings {
                    let beside = AvatarSettings::path_beside(Path::new(&path));
                    folder.copied.push(("settings", beside.to_string_lossy().into_owned()));
                }
                json!({ "file": path })
            }
        };
        let mut capture = match &self.take {
            None => return Err(Trouble::NoCapture.into()),
            Some(Take::Weights { name, file_rate_hz, .. }) => {
                let mut capture = Map::new();
                capture.insert("file".to_owned(), json!(folder.copy("take", name)?));
                put(&mut capture, "fileRateHz", *file_rate_hz);
                capture
            }
            Some(Take::Markers { name, origin, recording, .. }) => {
                let mut capture = marker_file(("take", name), origin, &recording.capture, folder)?;
                if self.map.face.is_empty() {
                    let words = "empty; place the markers on the avatar, or suggest a map";
                    return Err(Problem::of("marker map", words));
                }
                let map = folder.make(MAP, self.map_json());
                capture.insert("markers".to_owned(), json!(map));
                if !self.map.head.is_empty() {
                    capture.insert("head".to_owned(), json!(self.map.head));
                }
                put(&mut capture, "neutral", self.map.neutral.clone().map(|n| [n.start, n.end]));
                capture
            }
        };
        if let Some(mut gaze) = asked.gaze.clone() {
            if let Some(file) = gaze.get("file").and_then(Value::as_str) {
                let path = folder.copy("gaze", file)?;
                gaze.insert("file".to_owned(), json!(path));
            }
            capture.insert("gaze".to_owned(), Value::Object(gaze));
        }
        captures.insert("take".to_owned(), Value::Object(capture));
        if self.segments.is_empty() {
            let words = "none is marked; mark what is to be shown in the tab Expressions";
            return Err(Problem::of("expressions", words));
        }
        let segments = study_segments(&self.segments, "take");
        let mut expressions: Vec<[String; 3]> = Vec::new();
        for TakeSegment { label, .. } in &self.segments {
            if !expressions.iter().any(|[word, ..]| word == label) {
                expressions.push([(); 3].map(|()| label.clone()));
            }
        }
        let parts =
            json!({ "avatars": { "head": avatar }, "captures": captures, "segments": segments });
        Ok(Stimuli { parts: parts.as_object().cloned().unwrap_or_default(), expressions })
    }

    /// The methods of the faces; what one of them learns from becomes a capture, too.
    fn methods_of_study(
        &self,
        asked: &Asked,
        folder: &mut Folder,
        captures: &mut Map<String, Value>,
    ) -> Result<Map<String, Value>, Problem> {
        let word = |shown: &Shown| shown.settings.get("method").cloned();
        let mut methods = Map::new();
        for shown in &asked.faces {
            let spec =
                MethodSpec::checked(&Value::Object(shown.settings.clone())).map_err(|e| {
                    Problem::of(&shown.name, e.first().map_or(String::new(), |e| e.to_string()))
                })?;
            let mut name = identifier(&shown.name);
            for copy in 2.. {
                if !methods.contains_key(&name) {
                    break;
                }
                name = format!("{}-{copy}", identifier(&shown.name));
            }
            let mut method = shown.settings.clone();
            // The analysis tells methods apart by the factor, which is the method's own name if nothing else is said.
            if asked.faces.iter().filter(|other| word(other) == word(shown)).count() > 1 {
                method.insert("factors".to_owned(), json!({ "method": name }));
            }
            if spec.method.needs() == Needs::Training {
                method.insert("training".to_owned(), self.training_of_study(folder, captures)?);
            }
            methods.insert(name, Value::Object(method));
        }
        if methods.is_empty() {
            return Err(Trouble::NoFaceSolved.into());
        }
        Ok(methods)
    }

    /// What a regression learns from: its entry of a method, and the capture.
    fn training_of_study(
        &self,
        folder: &mut Folder,
        captures: &mut Map<String, Value>,
    ) -> Result<Value, Problem> {
        let path = |folder: &Folder| {
            let played = folder.copied.iter().find(|(role, _)| *role == "training-weights");
            played
                .map_or_else(|| format!("{FOLDER}/training-weights.csv"), |(_, path)| path.clone())
        };
        if captures.contains_key("training") {
            return Ok(json!({ "capture": "training", "weights": path(folder) }));
        }
        let learnt_from = self.training()?;
        let (origin, [take, played]) = self
            .training
            .files()
            .ok_or_else(|| Problem::of("training", "open a range of motion and its weights"))?;
        let mut capture = marker_file(("training", take), origin, &learnt_from.capture, folder)?;
        match origin {
            Origin::BuiltIn => {
                folder.make("training-weights.csv", learnt_from.weights.to_csv());
            }
            Origin::File { .. } => {
                folder.copy("training-weights", played)?;
            }
        }
        // Its markers are those of the take.
        capture.insert("markers".to_owned(), json!(format!("{FOLDER}/{MAP}")));
        if let Some(head) = &learnt_from.head {
            capture.insert("head".to_owned(), json!(head));
        }
        put(&mut capture, "neutral", learnt_from.neutral.map(|n| [n.start, n.end]));
        captures.insert("training".to_owned(), Value::Object(capture));
        Ok(json!({ "capture": "training", "weights": path(folder) }))
    }
}

/// The entry of a capture of markers: the file that was opened, or one that is written of a built-in performance.
fn marker_file(
    (role, name): (&'static str, &str),
    origin: &Origin,
    read: &Capture,
    folder: &mut Folder,
) -> Result<Map<String, Value>, Problem> {
    let mut capture = Map::new();
    let path = match origin {
        Origin::BuiltIn => {
            let text = write_csv(read).map_err(|e| Problem::of(name, e))?;
            folder.make(&format!("{role}.csv"), text)
        }
        Origin::File { unit, rate_hz } => {
            put(&mut capture, "unit", unit.clone());
            put(&mut capture, "fileRateHz", *rate_hz);
            folder.copy(role, name)?
        }
    };
    capture.insert("file".to_owned(), json!(path));
    Ok(capture)
}

fn put<T: serde::Serialize>(entry: &mut Map<String, Value>, key: &str, value: Option<T>) {
    if let Some(value) = value {
        entry.insert(key.to_owned(), json!(value));
    }
}
