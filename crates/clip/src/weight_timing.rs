//! Weights over time, after every method: a low-pass and a delay that a study may ask for.

use mimique_solver::{Lowpass, LowpassError, MethodSpec};

/// Filters and delays weights, rows of `columns` at `rate_hz`, as the method asks for: nothing where it names neither
/// `lowpassHz` nor `delayMs`.
///
/// A column is filtered forwards and backwards, within the values that it had. A delayed face stands at its first frame
/// until it moves; one that is early stands at its last frame at the end. Between frames weights are linear.
///
/// # Errors
/// [`LowpassError`]: a cut-off that the rate does not allow.
pub(crate) fn time_weights(
    weights: &mut [f64],
    columns: usize,
    rate_hz: f64,
    spec: &MethodSpec,
) -> Result<(), LowpassError> {
    let cutoff_hz = spec.lowpass_hz.filter(|cutoff_hz| *cutoff_hz != 0.0);
    let lowpass = cutoff_hz.map(|cutoff_hz| Lowpass::new(cutoff_hz, rate_hz)).transpose()?;
    let delay = spec.delay_ms.unwrap_or_default() * rate_hz / 1000.0;
    if columns == 0 || (lowpass.is_none() && delay == 0.0) {
        return Ok(());
    }
    for column in 0..columns {
        let mut course: Vec<f64> = weights.iter().skip(column).step_by(columns).copied().collect();
        if let Some(lowpass) = &lowpass {
            let low = course.iter().copied().fold(f64::INFINITY, f64::min);
            let high = course.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            lowpass.filter(&mut course);
            course.iter_mut().for_each(|weight| *weight = weight.clamp(low, high));
        }
        let places = weights.iter_mut().skip(column).step_by(columns);
        for (frame, weight) in places.enumerate() {
            *weight = at(&course, frame as f64 - delay);
        }
    }
    Ok(())
}

/// A course at a frame, between frames linear; its ends beyond them.
fn at(course: &[f64], frame: f64) -> f64 {
    let last = course.len().saturating_sub(1);
    let frame = frame.clamp(0.0, last as f64);
    let before = frame.floor();
    let (share, place) = (frame - before, before as usize);
    if share == 0.0 {
        return course[place];
    }
    course[place] + share * (course[(place + 1).min(last)] - course[place])
}

#[cfg(test)]
mod tests {
    use super::*;
    use mimique_solver::Method;

    const RATE_HZ: f64 = 60.0;

    fn timed(weights: &[f64], columns: usize, change: impl FnOnce(&mut MethodSpec)) -> Vec<f64> {
        let mut spec = MethodSpec::new(Method::Box);
        change(&mut spec);
        let mut weights = weights.to_vec();
        time_weights(&mut weights, columns, RATE_HZ, &spec).unwrap();
        weights
    }

    fn wave(hz: f64) -> Vec<f64> {
        let at =
            |frame: usize| 0.5 + 0.4 * (std::f64::consts::TAU * hz * frame as f64 / RATE_HZ).sin();
        (0..240).map(at).collect()
    }

    #[test]
    fn without_either_every_bit_stays() {
        let weights = wave(3.0);
        assert_eq!(timed(&weights, 2, |_| ()), weights);
        assert_eq!(timed(&weights, 2, |spec| spec.delay_ms = Some(0.0)), weights);
        assert_eq!(timed(&weights, 2, |spec| spec.lowpass_hz = Some(0.0)), weights);
    }

    #[test]
    fn a_delay_moves_the_course_and_holds_its_ends() {
        // Two columns: one runs up, one runs down.
        let weights: Vec<f64> = (0..60)
            .flat_map(|frame| [f64::from(frame) / 100.0, 1.0 - f64::from(frame) / 100.0])
            .collect();
        let late = timed(&weights, 2, |spec| spec.delay_ms = Some(100.0));
        for frame in 0..60 {
            let from = (frame as f64 - 6.0).max(0.0) / 100.0;
            assert!((late[2 * frame] - from).abs() < 1e-12, "{frame}");
            assert!((late[2 * frame + 1] - (1.0 - from)).abs() < 1e-12, "{frame}");
        }
        // Half a frame: between two of them.
        let half = timed(&weights, 2, |spec| spec.delay_ms = Some(-1000.0 / 120.0));
        assert!((half[20] - 0.105).abs() < 1e-12, "{}", half[20]);
        assert!((half[118] - 0.59).abs() < 1e-12, "it stands at its last frame");
    }

    #[test]
    fn a_low_pass_leaves_the_slow_and_takes_the_fast_without_delay() {
        let range = |course: &[f64]| {
            let middle = &course[60..180];
            middle.iter().copied().fold(f64::MIN, f64::max)
                - middle.iter().copied().fold(f64::MAX, f64::min)
        };
        let two_hz = |spec: &mut MethodSpec| spec.lowpass_hz = Some(2.0);
        // Both ways: gain 1 / (1 + (f / fc)^4).
        let slow = timed(&wave(0.5), 1, two_hz);
        assert!((range(&slow) / 0.8 - 1.0 / (1.0 + 0.25_f64.powi(4))).abs() < 0.01);
        let fast = timed(&wave(8.0), 1, two_hz);
        assert!(range(&fast) / 0.8 < 0.01, "{}", range(&fast));
        let peak = |course: &[f64]| (0..60).max_by(|a, b| course[*a].total_cmp(&course[*b]));
        assert_eq!(peak(&slow), peak(&wave(0.5)));
        assert!(slow.iter().all(|weight| (0.1..=0.9).contains(weight)));
    }

    #[test]
    fn a_cut_off_beyond_half_the_rate_is_refused() {
        let spec = MethodSpec { lowpass_hz: Some(40.0), ..MethodSpec::new(Method::Recorded) };
        let error = time_weights(&mut [0.0; 4], 1, RATE_HZ, &spec).unwrap_err();
        assert_eq!(error, LowpassError { cutoff_hz: 40.0, rate_hz: RATE_HZ });
    }
}
