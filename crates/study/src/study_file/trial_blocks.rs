//! The blocks of trials of clips: those that the file lists, and those that pairs and panels make.

use std::borrow::Cow;

use super::{Clip, Component, Study, TrialsComponent};

impl Study {
    /// The blocks of trials of clips, by name: blocks of pairs and panels as the trials that they make. What makes none
    /// is left out: the check reports it.
    pub fn trial_blocks(&self) -> Vec<(&str, Cow<'_, TrialsComponent>)> {
        let clips = std::cell::OnceCell::new();
        let of = |component| trials_of(component, || clips.get_or_init(|| self.clips()).as_slice());
        let blocks = self.components.iter();
        blocks.filter_map(|(name, component)| Some((name.as_str(), of(component)?))).collect()
    }

    /// The block of trials of this name.
    pub fn trial_block(&self, name: &str) -> Option<Cow<'_, TrialsComponent>> {
        let clips = std::cell::OnceCell::new();
        trials_of(self.components.get(name)?, || clips.get_or_init(|| self.clips()).as_slice())
    }
}

fn trials_of<'s, 'c>(
    component: &'s Component,
    clips: impl FnOnce() -> &'c [Clip],
) -> Option<Cow<'s, TrialsComponent>> {
    match component {
        Component::Trials(block) => Some(Cow::Borrowed(block)),
        Component::Pairs(block) => Some(Cow::Owned(block.read().ok()?.trials(clips()).ok()?)),
        Component::Panel(block) => Some(Cow::Owned(block.read().ok()?.trials(clips()).ok()?)),
        _ => None,
    }
}
