//! The labelled stretches of a take: suggestions, and what a person has confirmed. Confirmed ones are
//! truth: no suggestion, and no other box that is moved, ever takes a frame of theirs.

use std::ops::Range;

use mimique_annotate::Suggested;

/// A labelled stretch.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LabelBox {
    /// First frame, one past the last.
    pub frames: Range<usize>,
    /// The label, by its index.
    pub label: usize,
    /// How probable a model holds the label to be; 1 where nobody has asked one.
    pub probability: f64,
    /// The next most probable label.
    pub second: Option<(usize, f64)>,
    /// A person has confirmed it.
    pub confirmed: bool,
    /// A person has given it another label.
    pub relabelled: bool,
    /// A person has moved its borders.
    pub moved: bool,
}

impl LabelBox {
    /// What a person says.
    pub fn truth(frames: Range<usize>, label: usize) -> Self {
        let (probability, second) = (1.0, None);
        let (relabelled, moved) = (false, false);
        Self { frames, label, probability, second, confirmed: true, relabelled, moved }
    }

    /// What a model suggests.
    fn suggestion(frames: Range<usize>, of: &Suggested) -> Self {
        let Suggested { label, probability, second, .. } = *of;
        Self { probability, second, confirmed: false, ..Self::truth(frames, label) }
    }
}

/// Boxes in order of time, apart.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Boxes(Vec<LabelBox>);

impl Boxes {
    /// All of them.
    pub fn all(&self) -> &[LabelBox] {
        &self.0
    }

    /// A box, to be changed in anything but its frames.
    pub fn get_mut(&mut self, index: usize) -> Option<&mut LabelBox> {
        self.0.get_mut(index)
    }

    /// The confirmed ones.
    pub fn confirmed(&self) -> impl Iterator<Item = &LabelBox> {
        self.0.iter().filter(|own| own.confirmed)
    }

    /// Puts suggestions in the place of the old ones, wherever nothing is confirmed.
    pub fn suggest(&mut self, suggested: &[Suggested]) {
        self.0.retain(|own| own.confirmed);
        let truths: Vec<Range<usize>> = self.0.iter().map(|own| own.frames.clone()).collect();
        for suggestion in suggested {
            for part in outside(suggestion.frames.clone(), &truths) {
                self.0.push(LabelBox::suggestion(part, suggestion));
            }
        }
        self.sort();
    }

    /// Puts what a person says in the place of everything.
    pub fn put(&mut self, boxes: Vec<LabelBox>) {
        self.0 = boxes;
        self.sort();
    }

    /// Moves the borders of a box, which becomes truth: it stops at confirmed ones, takes frames of
    /// suggestions, and leaves them those that it gives up. Answers where it is now; none where
    /// nothing would be left of it.
    pub fn move_to(&mut self, index: usize, wanted: Range<usize>) -> Option<usize> {
        let old = self.0.get(index)?.frames.clone();
        let before = self.0[..index].iter().rfind(|own| own.confirmed);
        let low = before.map_or(0, |own| own.frames.end);
        let after = self.0[index + 1..].iter().find(|own| own.confirmed);
        let high = after.map_or(usize::MAX, |own| own.frames.start);
        let now = wanted.start.max(low)..wanted.end.min(high);
        if now.is_empty() {
            return None;
        }
        // A suggestion that ended where the box began goes on to where it begins now.
        if let Some(own) = index.checked_sub(1).and_then(|before| self.0.get_mut(before))
            && !own.confirmed
            && own.frames.end == old.start
            && now.start > old.start
        {
            own.frames.end = now.start;
        }
        if let Some(own) = self.0.get_mut(index + 1)
            && !own.confirmed
            && own.frames.start == old.end
            && now.end < old.end
        {
            own.frames.start = now.end;
        }
        let moved =
            LabelBox { frames: now.clone(), confirmed: true, moved: true, ..self.0.remove(index) };
        let others = std::mem::take(&mut self.0);
        for own in others {
            for part in outside(own.frames.clone(), std::slice::from_ref(&now)) {
                self.0.push(LabelBox { frames: part, ..own.clone() });
            }
        }
        self.0.push(moved);
        self.sort();
        self.0.iter().position(|own| own.frames == now)
    }

    fn sort(&mut self) {
        self.0.sort_by_key(|own| own.frames.start);
    }
}

/// What of a range lies outside of others, which are in order and apart.
pub(crate) fn outside(range: Range<usize>, others: &[Range<usize>]) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let mut start = range.start;
    for other in others.iter().filter(|other| other.start < range.end && other.end > range.start) {
        parts.push(start..other.start);
        start = other.end;
    }
    parts.push(start..range.end);
    parts.retain(|part| part.start < part.end);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn suggested(frames: Range<usize>, label: usize) -> Suggested {
        Suggested { frames, label, probability: 0.5, second: None }
    }

    fn three() -> Boxes {
        let mut boxes = Boxes::default();
        boxes.suggest(&[suggested(0..10, 0), suggested(10..20, 1), suggested(20..30, 2)]);
        boxes
    }

    fn frames(boxes: &Boxes) -> Vec<(Range<usize>, usize)> {
        boxes.all().iter().map(|own| (own.frames.clone(), own.label)).collect()
    }

    #[test]
    fn suggestions_never_take_a_confirmed_frame() {
        let mut boxes = three();
        boxes.get_mut(1).unwrap().confirmed = true;
        boxes.suggest(&[suggested(0..15, 3), suggested(15..18, 4), suggested(18..30, 5)]);
        assert_eq!(frames(&boxes), [(0..10, 3), (10..20, 1), (20..30, 5)]);
        boxes.suggest(&[suggested(0..30, 6)]);
        assert_eq!(frames(&boxes), [(0..10, 6), (10..20, 1), (20..30, 6)]);
    }

    #[test]
    fn a_box_that_is_moved_pushes_suggestions_and_stops_at_truth() {
        let mut boxes = three();
        assert_eq!(boxes.move_to(1, 5..22), Some(1));
        assert_eq!(frames(&boxes), [(0..5, 0), (5..22, 1), (22..30, 2)]);
        assert!(boxes.all()[1].confirmed && boxes.all()[1].moved);
        // What it gives up goes to its neighbours.
        assert_eq!(boxes.move_to(1, 8..15), Some(1));
        assert_eq!(frames(&boxes), [(0..8, 0), (8..15, 1), (15..30, 2)]);
        // A suggestion that is moved becomes truth and stops at the one before.
        assert_eq!(boxes.move_to(2, 3..30), Some(2));
        assert_eq!(frames(&boxes), [(0..8, 0), (8..15, 1), (15..30, 2)]);
        assert_eq!(boxes.move_to(2, 3..12), None, "nothing of it would be left");
        assert_eq!(frames(&boxes), [(0..8, 0), (8..15, 1), (15..30, 2)]);
        // A suggestion that is swallowed goes, one that is crossed is cut in two.
        let mut boxes = three();
        assert_eq!(boxes.move_to(0, 0..25), Some(0));
        assert_eq!(frames(&boxes), [(0..25, 0), (25..30, 2)]);
    }

    #[test]
    fn parts_outside() {
        assert_eq!(outside(0..10, &[]), Vec::from_iter(std::iter::once(0..10)));
        assert_eq!(outside(0..10, &[2..4, 6..12]), [0..2, 4..6]);
        assert!(outside(3..4, std::slice::from_ref(&(2..5))).is_empty());
    }
}
