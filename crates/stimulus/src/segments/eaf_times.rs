//! When the annotations of an ELAN document are: what has times, what lies between its neighbours, and
//! what takes the times of the annotation that it refers to.
//!
//! A time slot without a time belongs to the chain of its own tier: it lies evenly between the nearest
//! slots of that tier that have one, as ELAN shows it. A tier's parent comes before it, so that what the
//! parent's chain says of a shared slot holds. Annotations that refer to another one share its time evenly
//! in their order (symbolic association: one; symbolic subdivision: a chain).

use std::collections::{BTreeMap, HashMap};

use super::eaf::{EafAnnotation, EafError, EafTier, Places, REMEDY};
use super::eaf_read::{Annotation, Bounds};

/// The tiers with the times of their annotations.
///
/// # Errors
/// [`EafError`]: a slot that is nowhere, an annotation that ends before it begins.
pub(super) fn tiers(
    places: &Places,
    times: &[Option<u64>],
    annotations: &[Annotation],
) -> Result<Vec<EafTier>, EafError> {
    let mut clock = Clock::of(places, times);
    let mut of_tier: Vec<Vec<&Annotation>> = vec![Vec::new(); places.tiers.len()];
    for annotation in annotations {
        of_tier[annotation.tier].push(annotation);
    }
    let mut tiers: Vec<EafTier> = places
        .tiers
        .iter()
        .map(|tier| EafTier { id: tier.id.clone(), annotations: Vec::new(), without_times: 0 })
        .collect();
    for tier in parents_first(places) {
        clock.tell_chain(&of_tier[tier])?;
        let shared = clock.shared(&of_tier[tier]);
        let into = &mut tiers[tier];
        for (annotation, shared) in of_tier[tier].iter().zip(shared) {
            let span = match &annotation.bounds {
                Bounds::Slots(slots) => clock.between(slots, &annotation.value)?,
                Bounds::Of { .. } => shared,
            };
            let Some((start_ms, end_ms)) = span else {
                into.without_times += 1;
                continue;
            };
            clock.annotations.entry(&annotation.id).or_insert((start_ms, end_ms));
            let value = annotation.value.clone();
            into.annotations.push(EafAnnotation { start_ms, end_ms, value });
        }
        into.annotations.sort_by_key(|a| (a.start_ms, a.end_ms));
    }
    Ok(tiers)
}

/// What is known so far.
struct Clock<'d> {
    /// Place of each slot in the document's order, and its own time.
    slots: HashMap<&'d str, (usize, Option<u64>)>,
    /// Milliseconds of the slots whose own time, or whose place in a chain, is known.
    times: HashMap<&'d str, u64>,
    /// First and last millisecond of the annotations told so far.
    annotations: HashMap<&'d str, (u64, u64)>,
}

impl<'d> Clock<'d> {
    fn of(places: &'d Places, times: &[Option<u64>]) -> Self {
        let (mut slots, mut known) = (HashMap::new(), HashMap::new());
        for (place, ((id, _), time)) in places.slots.iter().zip(times).enumerate() {
            slots.insert(id.as_str(), (place, *time));
            if let Some(time) = time {
                known.insert(id.as_str(), *time);
            }
        }
        Self { slots, times: known, annotations: HashMap::new() }
    }

    fn slot(&self, id: &str) -> Result<(usize, Option<u64>), EafError> {
        self.slots.get(id).copied().ok_or_else(|| wrong(format!("no time slot {id:?}")))
    }

    /// Tells the slots of a tier that have no time of their own from those around them in the tier.
    fn tell_chain(&mut self, tier: &[&'d Annotation]) -> Result<(), EafError> {
        let mut own: Vec<(usize, usize, [&'d str; 2])> = Vec::new();
        for annotation in tier {
            if let Bounds::Slots([start, end]) = &annotation.bounds {
                own.push((self.slot(start)?.0, self.slot(end)?.0, [start, end]));
            }
        }
        own.sort();
        // The end of one annotation and the beginning of the next, both without a time, are one point.
        let mut points: Vec<Vec<&'d str>> = Vec::new();
        for (_, _, [start, end]) in own {
            match points.last_mut() {
                Some(last) if last.contains(&start) => {}
                Some(last)
                    if !self.times.contains_key(last[0]) && !self.times.contains_key(start) =>
                {
                    last.push(start);
                }
                _ => points.push(vec![start]),
            }
            if start != end {
                points.push(vec![end]);
            }
        }
        let known: Vec<Option<u64>> =
            points.iter().map(|point| self.times.get(point[0]).copied()).collect();
        let anchors: Vec<(usize, u64)> =
            known.iter().enumerate().filter_map(|(i, time)| Some((i, (*time)?))).collect();
        for pair in anchors.windows(2) {
            let [(a, from), (b, to)] = [pair[0], pair[1]];
            let Some(span) = to.checked_sub(from) else { continue };
            for (i, point) in points.iter().enumerate().take(b).skip(a + 1) {
                let share = (i - a) as f64 / (b - a) as f64;
                let time = from + (span as f64 * share).round() as u64;
                for slot in point {
                    self.times.entry(slot).or_insert(time);
                }
            }
        }
        Ok(())
    }

    /// The times of an annotation with slots; `None` where nothing tells them.
    fn between(
        &self,
        [start, end]: &[String; 2],
        value: &str,
    ) -> Result<Option<(u64, u64)>, EafError> {
        if let ((_, Some(from)), (_, Some(to))) = (self.slot(start)?, self.slot(end)?)
            && to < from
        {
            return Err(wrong(format!(
                "{value:?} ends at {to} ms (time slot {end:?}), before it begins at {from} ms ({start:?})"
            )));
        }
        let time = |slot: &String| self.times.get(slot.as_str()).copied();
        Ok(time(start).zip(time(end)).filter(|(from, to)| from <= to))
    }

    /// For each annotation of a tier that refers to another: its share of that one's time.
    fn shared(&self, tier: &[&'d Annotation]) -> Vec<Option<(u64, u64)>> {
        let mut groups: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (index, annotation) in tier.iter().enumerate() {
            if let Bounds::Of { annotation: parent, .. } = &annotation.bounds {
                groups.entry(parent).or_default().push(index);
            }
        }
        let mut shares = vec![None; tier.len()];
        for (parent, members) in groups {
            let Some(&(from, to)) = self.annotations.get(parent) else { continue };
            let count = members.len() as u64;
            let end = |place: u64| {
                from + ((to - from) as f64 * place as f64 / count as f64).round() as u64
            };
            for (place, index) in in_order(tier, members).into_iter().enumerate() {
                shares[index] = Some((end(place as u64), end(place as u64 + 1)));
            }
        }
        shares
    }
}

/// Members of a chain, each after the one that it names as the previous; what is in no chain as it stands.
fn in_order(tier: &[&Annotation], members: Vec<usize>) -> Vec<usize> {
    let previous = |index: usize| match &tier[index].bounds {
        Bounds::Of { previous, .. } => previous.as_deref(),
        Bounds::Slots(_) => None,
    };
    let next: HashMap<&str, usize> =
        members.iter().filter_map(|&index| Some((previous(index)?, index))).collect();
    let mut taken = vec![false; tier.len()];
    let mut order = Vec::with_capacity(members.len());
    let firsts = members.iter().filter(|&&index| previous(index).is_none());
    for &first in firsts.chain(&members) {
        let mut at = Some(first);
        while let Some(index) = at.filter(|&index| !taken[index]) {
            taken[index] = true;
            order.push(index);
            at = next.get(tier[index].id.as_str()).copied();
        }
    }
    order
}

/// The tiers, each after the one that it depends on; tiers that depend on each other come last.
fn parents_first(places: &Places) -> Vec<usize> {
    let mut by_name: HashMap<&str, usize> = HashMap::new();
    for (index, tier) in places.tiers.iter().enumerate() {
        by_name.entry(&tier.id).or_insert(index);
    }
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); places.tiers.len()];
    let mut order = Vec::with_capacity(places.tiers.len());
    let mut reached = vec![false; places.tiers.len()];
    for (index, tier) in places.tiers.iter().enumerate() {
        match tier.parent.as_deref().and_then(|parent| by_name.get(parent)) {
            Some(&parent) => children[parent].push(index),
            None => {
                reached[index] = true;
                order.push(index);
            }
        }
    }
    let mut at = 0;
    while let Some(&tier) = order.get(at) {
        for &child in &children[tier] {
            if !std::mem::replace(&mut reached[child], true) {
                order.push(child);
            }
        }
        at += 1;
    }
    order.extend((0..places.tiers.len()).filter(|&index| !reached[index]));
    order
}

fn wrong(what: String) -> EafError {
    EafError { place: "TIME_ORDER".to_owned(), what, remedy: REMEDY }
}
