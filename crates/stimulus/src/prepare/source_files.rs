//! What a study file's stimuli are read into: avatars, captures, performances, videos, recordings.

use std::cell::OnceCell;
use std::ops::Range;
use std::rc::Rc;

use mimique_avatar::Avatar;
use mimique_avatar::pack::encode_pack;
use mimique_mocap::{Capture, WeightsTable, resample};
use mimique_solver::FrontEndError;

use super::PrepareError;
use crate::provenance::Provenance;
use crate::{AvatarSkin, GivenGaze, JoinedTake, MarkerMap, SolveError, TakeOptions};

/// An avatar, and what its bytes or its making are known by.
pub(super) struct AvatarFile {
    pub key: String,
    pub avatar: Avatar,
    /// Shapes that stay at 0, as the JSON beside the file asks.
    pub locked: Vec<String>,
    /// The marker map of the built-in head.
    pub sites: Option<MarkerMap>,
    pub skin: OnceCell<AvatarSkin>,
    pub pointer: String,
}

/// A capture, likewise.
pub(super) struct CaptureFile {
    pub key: String,
    pub capture: Capture,
    pub head: Vec<String>,
    /// What its repair is known by.
    pub repair: Option<String>,
    /// Neutral and played frames of a built-in performance.
    pub known: Option<(Range<usize>, Range<usize>)>,
    /// What its frames became.
    pub frames: FrameCount,
}

/// The frames of a recording, and how many there are at the rate that is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FrameCount {
    recorded: usize,
    shown: usize,
    shown_per_recorded: f64,
}

/// A segment of a capture, to be played by an avatar.
pub(super) struct Performance {
    /// Pointer of the segment.
    pub pointer: String,
    /// Pointer of its capture.
    pub capture_pointer: String,
    /// Frames played.
    pub frames: Range<usize>,
    /// Cut-off that the capture asks for, Hz.
    pub head_lowpass_hz: Option<f64>,
    /// What markers, head, neutral and capture are known by.
    pub take_key: String,
    /// The same with the frames.
    pub key: String,
    pub avatar: Rc<AvatarFile>,
    pub capture: Rc<CaptureFile>,
    pub map: MarkerMap,
    pub options: TakeOptions,
}

/// A video of a segment.
pub(super) struct Video {
    pub bytes: Vec<u8>,
    pub media_type: &'static str,
}

/// A segment whose weights were recorded.
pub(super) struct Recording {
    /// Pointer of the segment.
    pub pointer: String,
    /// Weights in the file's own columns.
    pub table: WeightsTable,
    /// Frames played.
    pub frames: Range<usize>,
    /// The gaze that is given in the place of the recorded one.
    pub gaze: Option<GivenGaze>,
    /// Whether they were computed, of which not every shape is expected.
    pub is_computed: bool,
    /// What should be said of where they come from, with the pointers.
    pub warnings: Vec<(String, String)>,
}

impl FrameCount {
    /// `recorded` frames at a rate, `shown` at another.
    pub fn new([recorded, shown]: [usize; 2], [recorded_hz, shown_hz]: [f64; 2]) -> Self {
        Self { recorded, shown, shown_per_recorded: shown_hz / recorded_hz }
    }

    /// The shown frames of recorded ones: at least one, the nearest at both ends.
    ///
    /// # Errors
    /// [`SolveError::Segment`] in the recording's own frames where they are not there.
    pub fn shown(&self, of: Range<usize>) -> Result<Range<usize>, SolveError> {
        let Range { start: first, end } = of;
        if first >= end || end > self.recorded {
            return Err(SolveError::Segment { first, end, frames: self.recorded });
        }
        let at = |frame: usize| (frame as f64 * self.shown_per_recorded).round() as usize;
        let start = at(first).min(self.shown.saturating_sub(1));
        Ok(start..at(end).clamp(start + 1, self.shown.max(start + 1)))
    }
}

impl CaptureFile {
    /// A capture as it was recorded.
    pub fn new(key: String, capture: Capture) -> Self {
        let (count, rate) = (capture.frames(), capture.rate_hz);
        let frames = FrameCount::new([count; 2], [rate; 2]);
        Self { key, capture, head: vec![], repair: None, known: None, frames }
    }

    /// The same at a lower rate.
    ///
    /// # Errors
    /// [`PrepareError`] at `pointer` for a rate above the capture's.
    pub fn at_rate(mut self, rate_hz: f64, pointer: &str) -> Result<Self, PrepareError> {
        let recorded_hz = self.capture.rate_hz;
        lower(rate_hz, recorded_hz, pointer)?;
        let before = self.capture.frames();
        self.capture =
            resample(&self.capture, rate_hz).map_err(|e| PrepareError::new(pointer, e))?;
        self.frames = FrameCount::new([before, self.capture.frames()], [recorded_hz, rate_hz]);
        let shown = |frames: Range<usize>| {
            self.frames.shown(frames).map_err(|e| PrepareError::new(pointer, e))
        };
        self.known = match self.known {
            Some((neutral, played)) => Some((shown(neutral)?, shown(played)?)),
            None => None,
        };
        let key = Provenance::default().json("capture", self.key.as_str());
        self.key = key.json("rateHz", rate_hz).hash();
        Ok(self)
    }
}

impl Recording {
    /// The same at a lower rate.
    ///
    /// # Errors
    /// [`PrepareError`] at `pointer` for a rate above the file's.
    pub fn at_rate(self, rate_hz: f64, pointer: &str) -> Result<Self, PrepareError> {
        let Some(recorded_hz) = self.table.rate_hz() else { return Ok(self) };
        lower(rate_hz, recorded_hz, pointer)?;
        let table = self.table.resampled(rate_hz);
        let frames =
            FrameCount::new([self.table.frames.len(), table.frames.len()], [recorded_hz, rate_hz]);
        let frames = frames.shown(self.frames).map_err(|e| PrepareError::new(&self.pointer, e))?;
        Ok(Self { table, frames, ..self })
    }
}

/// More frames than were recorded would show nothing more.
fn lower(rate_hz: f64, recorded_hz: f64, pointer: &str) -> Result<(), PrepareError> {
    // The rate of a file may be written with few digits.
    if rate_hz <= recorded_hz * (1.0 + 1e-6) {
        return Ok(());
    }
    let message =
        format!("{rate_hz} frames per second of a recording of {recorded_hz}; leave rateHz out");
    Err(PrepareError::new(pointer, message))
}

impl AvatarFile {
    /// The avatar pack.
    pub fn pack(&self) -> Vec<u8> {
        encode_pack(&self.avatar).bytes
    }

    pub fn skin(&self) -> Result<&AvatarSkin, PrepareError> {
        if let Some(skin) = self.skin.get() {
            return Ok(skin);
        }
        let skin = AvatarSkin::of(&self.avatar).map_err(|e| PrepareError::new(&self.pointer, e))?;
        Ok(self.skin.get_or_init(|| skin))
    }
}

impl Performance {
    /// What the capture's repair is known by; `None` for one as it was recorded.
    pub fn repair(&self) -> Option<String> {
        self.capture.repair.clone()
    }

    /// Whether the capture is a file's, and no built-in actor's.
    pub fn is_recorded(&self) -> bool {
        self.capture.known.is_none()
    }

    /// Frames per second of the capture.
    pub fn rate_hz(&self) -> f64 {
        self.capture.capture.rate_hz
    }

    /// Avatar, map and capture brought together.
    pub fn joined(&self) -> Result<JoinedTake<'_>, PrepareError> {
        JoinedTake::new(self.avatar.skin()?, &self.capture.capture, &self.map, &self.options)
            .map_err(|e| self.error(e))
    }

    /// An error of the solve, at the part of the study file that it comes from.
    pub fn error(&self, error: SolveError) -> PrepareError {
        let field = match &error {
            SolveError::Map(_)
            | SolveError::NoCommonLabel { .. }
            | SolveError::NoScaledMarker { .. }
            | SolveError::ScaleFrames { .. } => "/markers",
            SolveError::NoHeadMarker { .. } => "/head",
            SolveError::FrontEnd(FrontEndError::Head { .. }) => "/head",
            SolveError::FrontEnd(FrontEndError::NeutralRange { .. })
            | SolveError::NeutralUnseen(_) => "/neutral",
            SolveError::FrontEnd(FrontEndError::Lowpass(_)) => "/headLowpassHz",
            SolveError::NoGazeShapes | SolveError::NoGazeTarget { .. } => "/gaze",
            SolveError::Segment { .. } => return PrepareError::new(&self.pointer, error),
            _ => "",
        };
        PrepareError::new(format!("{}{field}", self.capture_pointer), error)
    }
}
