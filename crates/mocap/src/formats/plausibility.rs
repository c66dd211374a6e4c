//! What every reader does to what it read: unique labels, whole or missing markers, zeros that
//! stand for missing.

use crate::LengthUnit;
use mimique_geometry::Point;
use std::collections::HashSet;

/// Make labels unique and not empty: `A`, `A` becomes `A`, `A_2`; an empty one `M001` by its
/// place. Each change is noted.
pub(crate) fn unique_labels(labels: Vec<String>, notes: &mut Vec<String>) -> Vec<String> {
    let mut taken: HashSet<String> = HashSet::with_capacity(labels.len());
    let reserved: HashSet<String> = labels.iter().cloned().collect();
    let mut renamed = Vec::new();
    let unique = labels
        .into_iter()
        .enumerate()
        .map(|(index, label)| {
            let base = if label.is_empty() { format!("M{:03}", index + 1) } else { label.clone() };
            let mut name = base.clone();
            let mut copy = 2;
            while taken.contains(&name) || (name != label && reserved.contains(&name)) {
                name = format!("{base}_{copy}");
                copy += 1;
            }
            if name != label {
                renamed.push(name.clone());
            }
            taken.insert(name.clone());
            name
        })
        .collect();
    if !renamed.is_empty() {
        notes.push(format!(
            "{} labels empty or repeated in the file, renamed: {}",
            renamed.len(),
            shortened(&renamed)
        ));
    }
    unique
}

/// A list of names cut to a readable length.
pub(crate) fn shortened(names: &[String]) -> String {
    const SHOWN: usize = 8;
    let mut text = names.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > SHOWN {
        text.push_str(&format!(" and {} more", names.len() - SHOWN));
    }
    text
}

/// Make a marker with a coordinate that is not finite missing in all three; noted when only some
/// coordinates were missing.
pub(crate) fn whole_or_missing(positions: &mut [Point], notes: &mut Vec<String>) {
    let mut partial = 0_usize;
    for p in positions {
        let finite = p.to_array().iter().filter(|v| v.is_finite()).count();
        if finite < 3 {
            partial += usize::from(finite > 0);
            *p = Point::UNSEEN;
        }
    }
    if partial > 0 {
        notes.push(format!("{partial} positions with one or two coordinates: taken as missing"));
    }
}

/// Take a position of exactly 0, 0, 0 as missing where the marker cannot have been at the origin:
/// everywhere else it stays farther than 10 mm from it. Many exporters write a gap as zeros.
pub(crate) fn zeros_to_missing(
    positions: &mut [Point],
    labels: &[String],
    unit: LengthUnit,
    notes: &mut Vec<String>,
) {
    let markers = labels.len();
    if markers == 0 {
        return;
    }
    let away = 0.01 / unit.metres();
    let mut zeros = vec![0_usize; markers];
    let mut nearest = vec![f64::INFINITY; markers];
    for frame in positions.chunks_exact(markers) {
        for (marker, p) in frame.iter().enumerate() {
            if *p == Point::ORIGIN {
                zeros[marker] += 1;
            } else if p.is_finite() {
                nearest[marker] = nearest[marker].min(p.length());
            }
        }
    }
    // A marker that is never anywhere else is missing too, unless it is alone there.
    let any_elsewhere = nearest.iter().any(|r| r.is_finite());
    let gone: Vec<bool> =
        (0..markers).map(|m| zeros[m] > 0 && any_elsewhere && nearest[m] > away).collect();
    if !gone.contains(&true) {
        return;
    }
    for frame in positions.chunks_exact_mut(markers) {
        for (marker, p) in frame.iter_mut().enumerate() {
            if gone[marker] && *p == Point::ORIGIN {
                *p = Point::UNSEEN;
            }
        }
    }
    let names: Vec<String> = (0..markers).filter(|&m| gone[m]).map(|m| labels[m].clone()).collect();
    let count: usize = (0..markers).filter(|&m| gone[m]).map(|m| zeros[m]).sum();
    notes.push(format!(
        "{count} positions at exactly 0, 0, 0 taken as missing: {}",
        shortened(&names)
    ));
}
