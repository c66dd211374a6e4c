//! What a study file's stimuli are read into: avatars, captures, performances, films, recordings.

use std::cell::OnceCell;
use std::ops::Range;
use std::rc::Rc;

use mimique_face::Avatar;
use mimique_face::pack::encode_pack;
use mimique_mocap::Capture;
use mimique_solver::FrontEndError;

use super::PrepareError;
use crate::{AvatarSkin, JoinedTake, MarkerMap, SolveError, TakeOptions, WeightsTable};

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

/// A film of a segment.
pub(super) struct Film {
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

    /// Frames a second of the capture.
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
            SolveError::Segment { .. } => return PrepareError::new(&self.pointer, error),
            _ => "",
        };
        PrepareError::new(format!("{}{field}", self.capture_pointer), error)
    }
}
