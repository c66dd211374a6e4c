//! How simulated people rate panels: the ratings of the question, a shift that the clips of a page have in common, and
//! the hidden reference, which most people find.

use std::collections::BTreeMap;

use mimique_session::flow::Panel;
use mimique_study::{Study, component_of};

use super::parameters::{PanelRatings, Parameters};
use super::random::Draws;

/// The panels of a study, if nothing else is said: one person in ten misses the reference.
pub(super) fn defaults(study: &Study) -> BTreeMap<String, PanelRatings> {
    let own = PanelRatings { page_sd: 5.0, misses_reference: 0.1 };
    study.panel_blocks().map(|(name, _)| (name.to_owned(), own)).collect()
}

/// How a person rates a page of a panel.
#[derive(Debug, Clone, Copy)]
pub(super) struct RatedPage {
    /// What all of its clips have in common, points.
    pub shift: f64,
    /// Whether the person finds the hidden reference.
    pub finds_reference: bool,
}

impl RatedPage {
    /// The page of this step, for the person of this number.
    pub fn of(parameters: &Parameters, seed: u64, number: u64, step: &str) -> Self {
        let block = component_of(step);
        let Some(own) = parameters.panels.get(block) else {
            return Self { shift: 0.0, finds_reference: true };
        };
        let draws = |purpose: String| Draws::new(seed, Some(number), &purpose);
        Self {
            shift: own.page_sd * draws(format!("page of {step}")).normal(),
            finds_reference: !draws(format!("reference of {block}")).happens(own.misses_reference),
        }
    }

    /// Whether the person rates a clip of the panel as the reference.
    pub fn is_found(self, panel: &Panel, clip: &str) -> bool {
        self.finds_reference && panel.reference.as_deref() == Some(clip)
    }
}
