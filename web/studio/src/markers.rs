//! Which marker sits where: suggested, read from a file, corrected by a click.

use mimique_stimulus::{MappedMarker, MarkerMap, MarkerPlace, suggest_map};
use serde_json::{Value, json};

use crate::problem::Problem;
use crate::workspace::Workspace;

impl Workspace {
    /// Takes the map of a file: JSON, or CSV with `marker,role,vertex`.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn map_file(&mut self, file: &str, text: &str) -> Result<Value, Problem> {
        let map = MarkerMap::from_text(text).map_err(|e| Problem::of(file, e))?;
        // Said now where it is read, not at the next solve.
        map.resolve(&self.face()?.skin).map_err(|e| Problem::of(file, e))?;
        self.map = map;
        self.map_state()
    }

    /// Suggests a map from the capture's shape and motion.
    ///
    /// # Errors
    /// [`Problem`]: no avatar, no capture, too few markers.
    pub fn suggest_map(&mut self) -> Result<Value, Problem> {
        let face = self.face()?;
        let neutral = self.map.neutral.clone();
        let found = suggest_map(&face.skin, self.capture()?, neutral)
            .map_err(|e| Problem::of("marker map", e))?;
        let map = found.to_map(&face.skin);
        self.map = map;
        let mut state = self.map_state()?;
        state["suggestion"] = json!(found);
        Ok(state)
    }

    /// Puts a marker on a vertex of the skin, or takes it off; `head` says whether it moves with the
    /// head.
    ///
    /// # Errors
    /// [`Problem`]: no such marker or vertex.
    pub fn place(
        &mut self,
        label: &str,
        vertex: Option<usize>,
        head: bool,
    ) -> Result<Value, Problem> {
        if self.capture()?.marker_index(label).is_none() {
            return Err(Problem::of(
                label,
                "the capture has no such marker; choose one of its own",
            ));
        }
        let positions = &self.face()?.skin.mesh.positions;
        let place = match vertex {
            None => None,
            Some(v) => Some(MarkerPlace::Position(*positions.get(v).ok_or_else(|| {
                Problem::of(label, format!("vertex {v} of {}; click on the face", positions.len()))
            })?)),
        };
        let map = &mut self.map;
        match (map.face.iter().position(|m| m.label == label), place) {
            (Some(at), Some(place)) => map.face[at].place = place,
            (Some(at), None) => drop(map.face.remove(at)),
            (None, Some(place)) => map.face.push(MappedMarker { label: label.to_owned(), place }),
            (None, None) => {}
        }
        map.head.retain(|l| l != label);
        if head {
            map.head.push(label.to_owned());
        }
        self.map_state()
    }

    /// Names the neutral frames, counted from 0, `end` not included.
    ///
    /// # Errors
    /// [`Problem`]: not frames of the capture.
    pub fn set_neutral(&mut self, first: usize, end: usize) -> Result<Value, Problem> {
        let frames = self.capture()?.frames();
        if first >= end || end > frames {
            let what = format!("{first}:{end} of {frames}; give a range inside the capture");
            return Err(Problem::of("neutral frames", what));
        }
        self.map.neutral = Some(first..end);
        self.map_state()
    }

    /// The map as the JSON that `mimique solve --markers` takes.
    pub fn map_json(&self) -> String {
        self.map.to_json()
    }

    /// Every marker of the capture with its place and role.
    ///
    /// # Errors
    /// [`Problem`]: the map does not fit the avatar.
    pub fn map_state(&self) -> Result<Value, Problem> {
        let face = self.face()?;
        let sites = self.map.resolve(&face.skin).map_err(|e| Problem::of("marker map", e))?;
        let labels: Vec<String> = match self.capture() {
            Ok(capture) => capture.labels.clone(),
            Err(_) => self.map.face_labels().map(str::to_owned).collect(),
        };
        let markers: Vec<Value> = (labels.iter())
            .map(|label| {
                let site = sites.iter().find(|s| s.label == *label);
                let vertex = site.map(mimique_solver::MarkerSite::vertex);
                json!({
                    "label": label,
                    "vertex": vertex,
                    "position": vertex.map(|v| face.skin.mesh.positions[v]),
                    "head": self.map.head.contains(label),
                })
            })
            .collect();
        let absent: Vec<&str> =
            self.map.face_labels().filter(|l| labels.iter().all(|x| x != l)).collect();
        Ok(json!({
            "markers": markers,
            "absent": absent,
            "neutral": self.map.neutral.as_ref().map(|n| [n.start, n.end]),
        }))
    }
}
