//! Eyelids driven by their markers, apart from the solve (Kouadio 1997, 7.2).
//!
//! | Kouadio | here |
//! |---|---|
//! | Y, the lid point's vertical displacement on the avatar | metres, in the avatar's frame |
//! | Y_min, Y_max, extremes in the lid's bank | of the shapes that close and widen the lid |
//! | y_m_min, y_m_max, the actor's extremes | of the marker over the take |
//! | f, f_min, f_max | opening, 0 closed to 1 wide open |
//!
//! The lid's bank is its neutral, the shape that closes it and, where there is one, the shape that
//! widens it. The actor's extremes and neutral lie on the avatar's: so the neutral stays neutral,
//! and where both persons' ranges are in proportion this is the thesis's straight line.

/// Which lid a marker is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum LidEdge {
    /// It closes downwards (eq. 7.2).
    Upper,
    /// It closes upwards (eq. 7.3).
    Lower,
}

/// A lid marker and the shapes that it drives.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Lid {
    /// Label of the marker; its place is among the map's markers.
    pub marker: String,
    /// Upper or lower.
    pub edge: LidEdge,
    /// Shape that closes the lid.
    pub closed: String,
    /// Shape that opens it wider than the neutral face does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wide: Option<String>,
}

/// Vertical displacements of a lid from its neutral, metres: `[lowest, highest]`.
pub(crate) type LidRange = [f64; 2];

/// Actor's range below which the lid is taken not to have been closed in the take, metres: an upper
/// lid travels 8 to 12 mm, sensors are exact to a tenth.
const CLOSED_IN_TAKE_M: f64 = 0.004;

/// Opening factor of a displacement within a range, 0 closed to 1 wide open: eq. 7.2 for upper,
/// 7.3 for lower lids. Displacements beyond the range count as its ends.
pub(crate) fn opening_factor(y: f64, [lowest, highest]: LidRange, edge: LidEdge) -> f64 {
    let share = match edge {
        LidEdge::Upper => (y - lowest) / (highest - lowest),
        LidEdge::Lower => (y - highest) / (lowest - highest),
    };
    share.clamp(0.0, 1.0)
}

/// The actor's displacement as the avatar's: lowest, neutral and highest lie on each other.
fn on_avatar(y: f64, actor: LidRange, avatar: LidRange) -> f64 {
    let (side, other) = if y < 0.0 { (actor[0], avatar[0]) } else { (actor[1], avatar[1]) };
    if side == 0.0 { 0.0 } else { y / side * other }
}

/// The range of an actor's lid over a take: its 1st and 99th of a hundred, the neutral within. A
/// side on which the lid hardly moved is as long as the avatar's.
pub(crate) fn actor_range(track: &[f64], avatar: LidRange, edge: LidEdge) -> LidRange {
    let mut seen: Vec<f64> = track.iter().copied().filter(|y| y.is_finite()).collect();
    seen.sort_by(f64::total_cmp);
    let at = |share: f64| {
        let place = share * seen.len().saturating_sub(1) as f64;
        seen.get(place.round() as usize).copied().unwrap_or(0.0)
    };
    let (lowest, highest) = (at(0.01).min(0.0), at(0.99).max(0.0));
    // Only closing can be told from noise by its length; opening wide takes 1 or 2 mm.
    match edge {
        LidEdge::Upper if -lowest >= CLOSED_IN_TAKE_M => [lowest, avatar[1].max(highest)],
        LidEdge::Lower if highest >= 0.5 * CLOSED_IN_TAKE_M => [avatar[0].min(lowest), highest],
        _ => [avatar[0].min(lowest), avatar[1].max(highest)],
    }
}

/// Weights of the closing and the widening shape for a displacement of the actor's lid marker.
pub(crate) fn lid_weights(y: f64, actor: LidRange, avatar: LidRange, edge: LidEdge) -> (f64, f64) {
    if !y.is_finite() || avatar[1] <= avatar[0] {
        return (0.0, 0.0);
    }
    let factor = opening_factor(on_avatar(y, actor, avatar), avatar, edge);
    let neutral = opening_factor(0.0, avatar, edge);
    if factor <= neutral {
        (if neutral > 0.0 { (neutral - factor) / neutral } else { 0.0 }, 0.0)
    } else {
        (0.0, (factor - neutral) / (1.0 - neutral))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_equations_7_2_and_7_3() {
        let range = [-0.010, 0.002];
        for (y, upper) in [(-0.010, 0.0), (0.0, 10.0 / 12.0), (0.002, 1.0), (-0.004, 0.5)] {
            assert!((opening_factor(y, range, LidEdge::Upper) - upper).abs() < 1e-12);
            assert!((opening_factor(y, range, LidEdge::Lower) - (1.0 - upper)).abs() < 1e-12);
        }
        assert_eq!(opening_factor(-1.0, range, LidEdge::Upper), 0.0);
    }

    #[test]
    fn closed_neutral_and_wide_are_the_avatar_s_and_between_is_even() {
        // An actor with smaller lids than the avatar's.
        let (actor, avatar) = ([-0.007, 0.001], [-0.010, 0.002]);
        let weights = |y: f64| lid_weights(y, actor, avatar, LidEdge::Upper);
        for (y, want) in
            [(-0.007, (1.0, 0.0)), (-0.0035, (0.5, 0.0)), (0.0, (0.0, 0.0)), (0.0005, (0.0, 0.5))]
        {
            let got = weights(y);
            assert!((got.0 - want.0).abs() < 1e-9 && (got.1 - want.1).abs() < 1e-9, "{y} {got:?}");
        }
        assert_eq!(weights(f64::NAN), (0.0, 0.0));
        // A lower lid rises to close, and has nothing to widen it.
        let got = lid_weights(0.001, [0.0, 0.002], [0.0, 0.003], LidEdge::Lower);
        assert!((got.0 - 0.5).abs() < 1e-9 && got.1 == 0.0, "{got:?}");
    }

    #[test]
    fn a_take_without_a_blink_is_not_scaled_to_one() {
        let avatar = [-0.010, 0.002];
        let noise: Vec<f64> = (0..500).map(|f| 1e-4 * f64::from(f % 7 - 3)).collect();
        assert_eq!(actor_range(&noise, avatar, LidEdge::Upper), avatar);
        let mut blinks = noise;
        for start in [100, 300] {
            blinks[start..start + 20].fill(-0.008);
        }
        let range = actor_range(&blinks, avatar, LidEdge::Upper);
        assert!((range[0] + 0.008).abs() < 1e-9 && range[1] == 0.002);
    }
}
