//! On which side a clip shown beside another stands: as the study says, or drawn.

use super::{Draw, OrderedItem};
use crate::projection::StudyProjection;
use crate::study_file::{Beside, Component, Side};

/// The sides that are drawn, by component: each side in half of the trials.
pub struct Sides(Vec<(String, std::vec::IntoIter<bool>)>);

impl Sides {
    /// Draws them for the items of a participant's [`super::order`].
    pub fn new(study: &StudyProjection, draw: Draw<'_>, items: &[OrderedItem]) -> Self {
        let drawn = study.components.iter().filter(|(_, component)| {
            matches!(component, Component::Trials(block)
                if block.beside.as_ref().is_some_and(|beside| beside.side == Side::Random))
        });
        let mut sides = Vec::new();
        for (name, _) in drawn {
            let of = |item: &&OrderedItem| matches!(item, OrderedItem::Trial { component, .. } if component == name);
            let count = items.iter().filter(of).count();
            let mut left: Vec<bool> = (0..count).map(|trial| trial % 2 == 0).collect();
            draw.stream(&format!("sides/{name}")).shuffle(&mut left);
            sides.push((name.clone(), left.into_iter()));
        }
        Self(sides)
    }

    /// Whether the next companion of this component stands left.
    pub fn is_left(&mut self, component: &str, beside: &Beside) -> bool {
        let drawn = self.0.iter_mut().find(|(name, _)| name == component);
        drawn.and_then(|(_, left)| left.next()).unwrap_or(beside.side == Side::Left)
    }
}
