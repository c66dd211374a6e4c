//! Whether a device can take part: what the study wants against what was measured.

use serde::{Deserialize, Serialize};

use crate::study_file::{BackendRule, DeviceKind, DeviceRules, FullscreenRule};

/// What the browser and its display can do.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Display {
    /// Width and height of the window, CSS pixels.
    pub viewport: [u32; 2],
    /// Device pixels per CSS pixel.
    pub device_pixel_ratio: f64,
    /// The rate at which the browser draws, Hz; none if it drew nothing (a hidden page).
    pub refresh_hz: Option<f64>,
    /// `webgpu` or `webgl2`; none if it has neither.
    pub backend: Option<String>,
    /// Whether the main pointer is a mouse or a touch pad.
    pub desktop: bool,
    /// Whether a page may fill the screen.
    pub fullscreen: bool,
}

/// A requirement that is not met.
#[derive(Debug, Clone, PartialEq)]
pub enum Unmet {
    /// The window is narrower than this many CSS pixels.
    Width {
        /// What is wanted.
        least: u32,
        /// What was found.
        found: u32,
    },
    /// The window is lower than this many CSS pixels.
    Height {
        /// What is wanted.
        least: u32,
        /// What was found.
        found: u32,
    },
    /// A computer is wanted.
    Kind,
    /// The browser cannot draw the clips (or not by WebGPU, where that is wanted).
    Backend,
    /// The browser draws fewer frames a second than this.
    Refresh {
        /// What is wanted, Hz.
        least: f64,
        /// What was found, Hz.
        found: f64,
    },
    /// Pages cannot fill the screen here.
    Fullscreen,
}

/// Share of the wanted refresh rate that is enough: displays of "60 Hz" run at 59.94, and an
/// estimate from two dozen frames wavers by a few per cent.
const RATE_TOLERANCE: f64 = 0.95;

/// Frames a second of which a share is asked at most: a faster display need not show more of a clip.
const MOST_FRAMES_HZ: f64 = 60.0;

impl DeviceRules {
    /// Whether a play showed enough frames: `shown` of a clip of that many milliseconds, on a display of that
    /// rate (Hz).
    pub fn shows_enough(&self, shown: usize, clip_ms: f64, refresh_hz: f64) -> bool {
        let Some(least) = self.minimum_frame_share else { return true };
        let hz = if refresh_hz > 0.0 { refresh_hz.min(MOST_FRAMES_HZ) } else { MOST_FRAMES_HZ };
        shown as f64 >= least * (clip_ms.max(0.0) / 1000.0 * hz).floor()
    }

    /// Whether the display is measured while it draws the study's own head.
    pub fn measures_load(&self) -> bool {
        self.minimum_refresh_hz.is_some() || self.minimum_frame_share.is_some()
    }
}

impl Unmet {
    /// The rule's key in the study file, for events and export.
    pub fn key(&self) -> &'static str {
        match self {
            Self::Width { .. } => "minimumWidth",
            Self::Height { .. } => "minimumHeight",
            Self::Kind => "kind",
            Self::Backend => "backend",
            Self::Refresh { .. } => "minimumRefreshHz",
            Self::Fullscreen => "fullscreen",
        }
    }
}

impl DeviceRules {
    /// The requirements that a display does not meet.
    pub fn unmet(&self, display: &Display) -> Vec<Unmet> {
        let mut unmet = Vec::new();
        if self.kind == DeviceKind::Desktop && !display.desktop {
            unmet.push(Unmet::Kind);
        }
        let backend = display.backend.as_deref();
        if backend.is_none() || (self.backend == BackendRule::Webgpu && backend != Some("webgpu")) {
            unmet.push(Unmet::Backend);
        }
        let [width, height] = display.viewport;
        if let Some(least) = self.minimum_width.filter(|least| width < *least) {
            unmet.push(Unmet::Width { least, found: width });
        }
        if let Some(least) = self.minimum_height.filter(|least| height < *least) {
            unmet.push(Unmet::Height { least, found: height });
        }
        let rate = display.refresh_hz.unwrap_or(0.0);
        // Who cannot show the share of frames that a play needs learns it before the first clip.
        let share_hz = self.minimum_frame_share.map(|share| share * MOST_FRAMES_HZ);
        let wanted = self.minimum_refresh_hz.into_iter().chain(share_hz).reduce(f64::max);
        if let Some(least) = wanted.filter(|hz| rate < hz * RATE_TOLERANCE) {
            unmet.push(Unmet::Refresh { least, found: rate });
        }
        if self.fullscreen == FullscreenRule::Required && !display.fullscreen {
            unmet.push(Unmet::Fullscreen);
        }
        unmet
    }
}
