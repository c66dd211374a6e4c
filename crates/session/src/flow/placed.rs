//! Which clip a trial shows on which canvas.

use serde::Serialize;

use crate::event::ChosenClips;
use crate::panel::Panel;
use crate::plan::TrialStep;

/// A clip on its canvas.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct PlacedClip {
    /// The canvas: [`OWN_CANVAS`], [`BESIDE_CANVAS`], or that of a place of a panel ([`canvas_of_place`]).
    pub canvas: String,
    /// Identifier of the clip; of a face that is drawn for one trial its step.
    pub clip: String,
}

/// The canvas of a trial's own clip.
pub const OWN_CANVAS: &str = "clip";
/// The canvas of the clip beside it.
pub const BESIDE_CANVAS: &str = "beside";

/// The canvas of a place of a panel, from 1; 0 is the open reference.
pub fn canvas_of_place(place: u32) -> String {
    ["panel-", &place.to_string()].concat()
}

impl TrialStep {
    /// The clips that are played, on their canvases: of a trial of one or two its own first, of a panel the open
    /// reference and then A, B, C. Clips that follow from answers have no name before they are
    /// `chosen`.
    pub fn placed(&self, chosen: Option<&ChosenClips>) -> Vec<PlacedClip> {
        if let Some(panel) = &self.panel {
            return panel.places().filter_map(|place| panel.placed(place)).collect();
        }
        let on = |canvas: &str, clip: &str| PlacedClip {
            canvas: canvas.to_owned(),
            clip: clip.to_owned(),
        };
        let (clip, beside) = self.pair(chosen);
        let clip = self.face.as_deref().unwrap_or(clip);
        let beside = beside.map(|(clip, _)| on(BESIDE_CANVAS, clip));
        [on(OWN_CANVAS, clip)].into_iter().chain(beside).collect()
    }

    /// Whether its clips are played one after the other, not in step.
    pub fn is_in_turn(&self) -> bool {
        self.panel.as_ref().map_or_else(
            || self.beside.as_ref().is_some_and(|beside| beside.in_turn),
            |panel| panel.in_turn,
        )
    }
}

impl Panel {
    /// The clip at a place from 1, or 0 for the open reference, on the canvas of that place.
    pub fn placed(&self, place: u32) -> Option<PlacedClip> {
        let clip = self.clip(place)?.to_owned();
        Some(PlacedClip { canvas: canvas_of_place(place), clip })
    }
}
