//! Everything that is wrong with the files that a study's clips are made of, found before anything is solved: the
//! sources of its clips in, faults at their places out. Each part is read and judged by what prepares it.

use std::collections::BTreeSet;
use std::rc::Rc;

use mimique_solver::{FrontEndError, Group, Method, MethodSpec, SpecError};
use mimique_study::{AvatarSource, CaptureSource, Clip, Issue, Problem, Study};

use super::source_files::{AvatarFile, Performance};
use super::sources::Sources;
use super::{Places, PrepareError, method_pointer, with_lowpass};
use crate::JoinedTake;

impl PrepareError {
    /// As `mimique check` lists it.
    pub fn issue(self) -> Issue {
        Issue::error(self.pointer, Problem::NotPrepared { message: self.message })
    }
}

/// What is wrong with the avatars, captures, marker maps and segments of a study's clips, and with what its methods
/// name of them: the files are opened, and nothing is solved. Of a study that refers to parts that it does not
/// have, the clips that have all of theirs.
pub fn source_faults(study: &Study, places: &Places) -> Vec<PrepareError> {
    of_sources(study, &Sources::new(study, places))
}

/// The same of sources that are opened.
pub(super) fn of_sources(study: &Study, sources: &Sources<'_>) -> Vec<PrepareError> {
    let mut examiner = Examiner { study, sources, found: Vec::new(), examined: BTreeSet::new() };
    for clip in study.clips() {
        examiner.clip(&clip, None);
    }
    for level in study.level_clips() {
        examiner.clip(&level.clip, Some(&level.method.spec));
    }
    for (clip, _) in study.clips_at_rest() {
        examiner.avatar(&clip.avatar);
    }
    examiner.found
}

/// Adds faults that are not known yet.
pub(super) fn add(found: &mut Vec<PrepareError>, faults: impl IntoIterator<Item = PrepareError>) {
    for fault in faults {
        if !found.contains(&fault) {
            found.push(fault);
        }
    }
}

struct Examiner<'a, 's> {
    study: &'a Study,
    sources: &'a Sources<'s>,
    found: Vec<PrepareError>,
    /// Parts of clips that were looked at.
    examined: BTreeSet<[String; 4]>,
}

impl Examiner<'_, '_> {
    fn clip(&mut self, clip: &Clip, spec: Option<&MethodSpec>) {
        let stimuli = &self.study.stimuli;
        let segment = stimuli.segments.iter().find(|segment| segment.id == clip.segment);
        let source = stimuli.avatars.get(&clip.avatar).and_then(|avatar| avatar.source());
        let method = stimuli.methods.get(&clip.method);
        let has_capture = segment.is_some_and(|own| stimuli.captures.contains_key(&own.capture));
        let (Some(source), Some(method), true) = (source, method, has_capture) else { return };
        if matches!(source, AvatarSource::Videos(_)) {
            return;
        }
        let Some(avatar) = self.avatar(&clip.avatar) else { return };
        let spec = spec.unwrap_or(&method.spec);
        // All performances of a built-in actor have the same markers and shapes.
        let built_in = self.built_in(&clip.segment);
        if spec.method == Method::Recorded {
            let part = built_in.as_ref().unwrap_or(&clip.segment);
            if self.is_first(["recorded", &clip.avatar, part, ""]) {
                let shapes = avatar.avatar.face_shapes();
                let recording = self.sources.recording(&clip.segment, shapes);
                add(&mut self.found, recording.err());
            }
            return;
        }
        let known = serde_json::to_string(spec).unwrap_or_default();
        if self.is_first(["shapes", &clip.avatar, &clip.method, &known])
            && spec.method.uses(Group::Shapes)
        {
            // Of the names of markers nothing is known without a capture.
            let spec = MethodSpec { importance: Default::default(), ..spec.clone() };
            add(&mut self.found, unknown(clip, &spec, avatar.avatar.face_shapes(), &[]));
        }
        if let Some(capture) = &built_in
            && !self.is_first([&clip.avatar, capture, &clip.method, &known])
        {
            return;
        }
        let (performance, faults) = self.sources.examined(&clip.segment, &avatar);
        add(&mut self.found, faults);
        if let Some(performance) = performance {
            self.performed(clip, &performance, spec);
        }
        if spec.method == Method::Regression && self.is_first(["training", &clip.method, "", ""]) {
            add(&mut self.found, self.sources.training(&clip.method).err());
        }
    }

    /// The identifier of a segment's capture where that is a built-in actor.
    fn built_in(&self, segment: &str) -> Option<String> {
        let stimuli = &self.study.stimuli;
        let segment = stimuli.segments.iter().find(|own| own.id == segment)?;
        let source = stimuli.captures.get(&segment.capture)?.source()?;
        matches!(source, CaptureSource::Builtin(_)).then(|| segment.capture.clone())
    }

    /// An avatar that can be used.
    fn avatar(&mut self, id: &str) -> Option<Rc<AvatarFile>> {
        let avatar = self.sources.avatar(id).and_then(|avatar| {
            avatar.skin()?;
            Ok(avatar)
        });
        match avatar {
            Ok(avatar) => Some(avatar),
            Err(fault) => {
                add(&mut self.found, [fault]);
                None
            }
        }
    }

    /// A capture on an avatar, and what a method names of both.
    fn performed(&mut self, clip: &Clip, performance: &Performance, spec: &MethodSpec) {
        let of = [&clip.avatar, &performance.take_key].map(String::as_str);
        if self.is_first(["joined", of[0], of[1], ""]) {
            add(&mut self.found, performance.faults());
        }
        let known = serde_json::to_string(spec).unwrap_or_default();
        if self.is_first([of[0], of[1], &clip.method, &known]) {
            add(&mut self.found, of_method(clip, performance, spec));
        }
    }

    /// Whether a part is looked at for the first time.
    fn is_first(&mut self, part: [&str; 4]) -> bool {
        self.examined.insert(part.map(str::to_owned))
    }
}

impl Performance {
    /// What is wrong with avatar, map and capture together.
    fn faults(&self) -> Vec<PrepareError> {
        match self.avatar.skin() {
            Ok(skin) => JoinedTake::faults(skin, &self.capture.capture, &self.map, &self.options)
                .into_iter()
                .map(|fault| self.error(fault))
                .collect(),
            Err(fault) => vec![fault],
        }
    }
}

/// What a method names of the markers that map and capture do not have, and a low-pass that the capture has no room for.
fn of_method(clip: &Clip, performance: &Performance, spec: &MethodSpec) -> Vec<PrepareError> {
    let spec = with_lowpass(spec, performance);
    let mut found = Vec::new();
    if spec.method.uses(Group::FrontEnd)
        && let Err(fault) = spec.head_lowpass(performance.rate_hz())
    {
        found.push(performance.error(FrontEndError::Lowpass(fault).into()));
    }
    // Where they cannot be joined there are no markers to name.
    if let Ok(joined) = performance.joined() {
        let labels: Vec<String> = joined.sites().iter().map(|site| site.label.clone()).collect();
        let spec = MethodSpec { locked: Vec::new(), bounds: Default::default(), ..spec };
        found.extend(unknown(clip, &spec, &[], &labels));
    }
    found
}

/// The names of a method that are none of these shapes and markers.
fn unknown(
    clip: &Clip,
    spec: &MethodSpec,
    shapes: &[String],
    markers: &[String],
) -> Vec<PrepareError> {
    let faults = spec.unknown_names(shapes, markers).into_iter();
    let at = |fault: &SpecError| method_pointer(clip) + &fault.pointer();
    faults
        .map(|fault| {
            let message = format!("{}; {}", fault.message(), fault.remedy());
            PrepareError::new(at(&fault), message)
        })
        .collect()
}
