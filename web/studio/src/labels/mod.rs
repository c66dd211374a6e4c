//! Labels of a take: suggested by a model, confirmed, relabelled and moved by a person, learnt from
//! again. What is confirmed is truth and never overwritten.

mod boxes;
mod carry;

use mimique_annotate::{
    AnnotatedTake, Decode, Decoding, Lesson, Mark, Marked, Method, Model, Rows, Take as MotionTake,
};
use serde_json::{Value, json};

use boxes::{Boxes, LabelBox};

use crate::problem::Problem;
use crate::workspace::{Take, Workspace};

/// What errors of labels are about.
const WHAT: &str = "labels";
/// Frames a second that are learnt from.
const THINNED_HZ: f64 = 10.0;

/// What is known of the labels of a take.
#[derive(Debug, Default)]
pub(crate) struct Labelling {
    /// The model of a file, or what was learnt here. Its labels are the first of `names`.
    model: Option<Model>,
    /// Names of the labels; boxes have indices.
    names: Vec<String>,
    boxes: Boxes,
    /// Probability of each of the model's labels: a frame a row.
    probabilities: Option<Rows>,
    /// Labels that were last learnt from suggestions, as none of theirs was confirmed.
    from_suggestions: Vec<usize>,
    /// The boxes as they were kept, to be taken back to; those of another model are gone.
    kept: Vec<Boxes>,
}

impl Labelling {
    /// Another take: the model stays, with its labels.
    pub fn take_changed(&mut self) {
        let model = self.model.take();
        let names = model.as_ref().map_or_else(Vec::new, |model| model.labels.clone());
        *self = Self { model, names, ..Self::default() };
    }

    /// The index of a label, which is new where nobody has named it.
    fn label(&mut self, name: &str) -> usize {
        let known = self.names.iter().position(|own| own == name);
        known.unwrap_or_else(|| {
            self.names.push(name.to_owned());
            self.names.len() - 1
        })
    }
}

impl Workspace {
    /// Takes a model that `mimique annotate train` has written. Suggestions of another model go, what
    /// is confirmed stays.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn label_model(&mut self, file: &str, text: &str) -> Result<Value, Problem> {
        let model = Model::from_json(text).map_err(|e| Problem::of(file, e))?;
        let old = std::mem::take(&mut self.labels);
        self.labels.names = model.labels.clone();
        self.labels.model = Some(model);
        let mut kept = Vec::new();
        for own in old.boxes.confirmed() {
            let label = self.labels.label(&old.names[own.label]);
            let second = None;
            kept.push(LabelBox { label, second, ..own.clone() });
        }
        self.labels.boxes.put(kept);
        Ok(self.labels_state())
    }

    /// Suggests a label for every stretch that is not confirmed, from the weights of `slot`.
    ///
    /// # Errors
    /// [`Problem`]: no model, no weights, or weights of other shapes.
    pub fn suggest_labels(&mut self, slot: &str) -> Result<Value, Problem> {
        let (take, shapes) = self.motion(slot)?;
        let Some(model) = &self.labels.model else {
            let what =
                "no model; open one, or take the expressions as confirmed and learn from these";
            return Err(Problem::of(WHAT, what));
        };
        let said = |error| Problem::of(WHAT, error);
        let take = take.columns(&model.columns(&shapes).map_err(said)?).map_err(said)?;
        let answer = model.label(&take, &Decode::default()).map_err(said)?;
        self.labels.boxes.suggest(&answer.segments);
        self.labels.probabilities = Some(answer.probabilities);
        Ok(self.labels_state())
    }

    /// Learns from what is confirmed, by the model's own method or a forest, and suggests anew what is
    /// not. A label of which nothing is confirmed is learnt from its suggestions.
    ///
    /// # Errors
    /// [`Problem`]: no weights, or fewer than two labels to learn from.
    pub fn learn_labels(&mut self, slot: &str) -> Result<Value, Problem> {
        let (take, all_shapes) = self.motion(slot)?;
        let labelling = &self.labels;
        let confirmed = |label: usize| labelling.boxes.confirmed().any(|own| own.label == label);
        let all = labelling.boxes.all();
        let learnt: Vec<&LabelBox> =
            all.iter().filter(|own| own.confirmed || !confirmed(own.label)).collect();
        let mut from_suggestions: Vec<usize> =
            learnt.iter().filter(|own| !own.confirmed).map(|own| own.label).collect();
        from_suggestions.sort_unstable();
        from_suggestions.dedup();
        let marked = learnt
            .iter()
            .map(|own| Marked { frames: own.frames.clone(), mark: Mark::Stable(own.label) });
        let said = |error| Problem::of(WHAT, error);
        let (shapes, columns, method) = match &labelling.model {
            Some(model) => {
                let columns = model.columns(&all_shapes).map_err(said)?;
                (model.shapes.clone(), columns, model.settings.of_labels())
            }
            None => (all_shapes.clone(), (0..all_shapes.len()).collect(), Method::default()),
        };
        let lesson = Lesson {
            channel: WHAT.to_owned(),
            labels: labelling.names.clone(),
            shapes,
            method,
            thinned_to_hz: Some(THINNED_HZ),
            decoding: Decoding::default(),
        };
        let annotated = AnnotatedTake {
            name: self.take_name().to_owned(),
            person: String::new(),
            kind: String::new(),
            take: take.columns(&columns).map_err(said)?,
            marked: marked.collect(),
        };
        let mut model = lesson.learn(&[annotated]).map_err(said)?;
        if let Some(before) = &labelling.model {
            // One take cannot be held out of itself.
            model.temperature = before.temperature;
        }
        self.labels.kept.clear();
        self.labels.model = Some(model);
        self.labels.from_suggestions = from_suggestions;
        self.suggest_labels(slot)
    }

    /// Confirms a box.
    ///
    /// # Errors
    /// [`Problem`]: no such box.
    pub fn confirm_label(&mut self, index: usize) -> Result<Value, Problem> {
        self.label_box(index)?.confirmed = true;
        Ok(self.labels_state())
    }

    /// Keeps the boxes as they are now; answers the number that [`Workspace::restore_labels`] takes.
    pub fn keep_labels(&mut self) -> usize {
        self.labels.kept.push(self.labels.boxes.clone());
        self.labels.kept.len() - 1
    }

    /// The boxes as they were kept under a number, under the same model.
    ///
    /// # Errors
    /// [`Problem`]: nothing is kept under it.
    pub fn restore_labels(&mut self, kept: usize) -> Result<Value, Problem> {
        let boxes = self.labels.kept.get(kept).cloned();
        self.labels.boxes = boxes.ok_or_else(|| {
            Problem::of("labels", format!("nothing is kept under {kept}; they were learnt anew"))
        })?;
        Ok(self.labels_state())
    }

    /// Makes a suggestion of a confirmed box again.
    ///
    /// # Errors
    /// [`Problem`]: no such box.
    pub fn release_label(&mut self, index: usize) -> Result<Value, Problem> {
        let own = self.label_box(index)?;
        (own.confirmed, own.relabelled, own.moved) = (false, false, false);
        Ok(self.labels_state())
    }

    /// Gives a box another label, which confirms it; a label that is not known is new.
    ///
    /// # Errors
    /// [`Problem`]: no such box, no name.
    pub fn relabel(&mut self, index: usize, name: &str) -> Result<Value, Problem> {
        let name = name.trim();
        if name.is_empty() {
            return Err(Problem::of(WHAT, "a label without a name; type one"));
        }
        self.label_box(index)?;
        let label = self.labels.label(name);
        let own = self.label_box(index)?;
        own.relabelled |= own.label != label;
        (own.label, own.confirmed) = (label, true);
        Ok(self.labels_state())
    }

    /// Moves the borders of a box, which confirms it; `at` of the answer is its place now.
    ///
    /// # Errors
    /// [`Problem`]: no such box, frames beyond the take, or nothing left of it between confirmed ones.
    pub fn move_label(&mut self, index: usize, first: usize, end: usize) -> Result<Value, Problem> {
        let (frames, _) = self.length()?;
        self.label_box(index)?;
        if first >= end || end > frames {
            let what = format!("frames {first}:{end} of {frames}; give a range inside the take");
            return Err(Problem::of(WHAT, what));
        }
        let Some(at) = self.labels.boxes.move_to(index, first..end) else {
            let what = format!("frames {first}:{end} are confirmed as others; move those first");
            return Err(Problem::of(WHAT, what));
        };
        let mut state = self.labels_state();
        state["at"] = json!(at);
        Ok(state)
    }

    /// Boxes, labels, the model and what has been confirmed.
    pub fn labels_state(&self) -> Value {
        let labelling = &self.labels;
        let name = |label: usize| &labelling.names[label];
        let boxes = labelling.boxes.all().iter().map(|own| {
            json!({
                "frames": [own.frames.start, own.frames.end],
                "label": name(own.label),
                "color": own.label,
                "probability": own.probability,
                "second": own.second.map(|(label, probability)| {
                    json!({"label": name(label), "probability": probability})
                }),
                "confirmed": own.confirmed,
            })
        });
        let count =
            |of: fn(&LabelBox) -> bool| labelling.boxes.all().iter().filter(|own| of(own)).count();
        let model = labelling.model.as_ref().map(|model| {
            let takes = model.learnt_from.takes.iter().map(|take| take.name.as_str());
            json!({
                "labels": model.labels,
                "takes": takes.collect::<Vec<_>>(),
                "holdsFrames": model.classifier().holds_frames(),
            })
        });
        let from_suggestions = labelling.from_suggestions.iter().map(|&label| name(label));
        json!({
            "names": labelling.names,
            "boxes": boxes.collect::<Vec<Value>>(),
            "counts": {
                "confirmed": count(|own| own.confirmed),
                "relabelled": count(|own| own.relabelled),
                "moved": count(|own| own.moved),
            },
            "model": model,
            "learntFromSuggestions": from_suggestions.collect::<Vec<_>>(),
        })
    }

    /// Probability of a label at every frame; empty where the model does not know the label.
    pub fn label_probabilities(&self, label: usize) -> Vec<f32> {
        let rows = self.labels.probabilities.iter().flat_map(Rows::iter);
        rows.filter_map(|row| row.get(label).map(|p| *p as f32)).collect()
    }

    /// The model as JSON: that of a file, or what was learnt here.
    ///
    /// # Errors
    /// [`Problem`]: no model yet.
    pub fn label_model_json(&self) -> Result<String, Problem> {
        let none = || Problem::of(WHAT, "no model; open one, or learn from confirmed boxes");
        let model = self.labels.model.as_ref().ok_or_else(none)?;
        model.to_json().map_err(|e| Problem::of(WHAT, e))
    }

    fn label_box(&mut self, index: usize) -> Result<&mut LabelBox, Problem> {
        let count = self.labels.boxes.all().len();
        let what = format!("box {index} of {count}; suggest labels anew");
        self.labels.boxes.get_mut(index).ok_or_else(|| Problem::of(WHAT, what))
    }

    pub(crate) fn take_name(&self) -> &str {
        match &self.take {
            Some(Take::Markers { name, .. } | Take::Weights { name, .. }) => name,
            None => "",
        }
    }

    /// Weights of a slot, else those of the take, and the names of their shapes.
    fn motion(&self, slot: &str) -> Result<(MotionTake, Vec<String>), Problem> {
        let (table, rate_hz) = match (self.solved.get(slot), &self.take) {
            (Some(solved), _) if solved.surface.is_none() => (&solved.table, solved.rate_hz),
            (_, Some(Take::Weights { table, .. })) => (table, self.length()?.1),
            _ => {
                let what = "labels are found in weights of blendshapes; solve the capture first";
                return Err(Problem::of(WHAT, what));
            }
        };
        let (names, weights) = (table.shape_names.clone(), table.weights.clone());
        let take = MotionTake::new(weights, names.len(), rate_hz);
        Ok((take.map_err(|e| Problem::of(WHAT, e))?, names))
    }
}
