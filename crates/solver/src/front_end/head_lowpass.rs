//! The low-pass of the head's pose that a method asks for at a rate.

use crate::front_end::lowpass::{Lowpass, LowpassError};
use crate::parameters::group::Group;
use crate::parameters::table::MethodSpec;

/// Cut-off where a method names none, Hz.
pub const HEAD_LOWPASS_HZ: f64 = 10.0;
/// The default cut-off is used where it is at most this part of the rate: 10 Hz from 25 frames per
/// second on. A cut-off exists up to half the rate, but near it the filter rings: at two fifths 6 % of its
/// response (the sum of its magnitudes) lie beyond 0.25 s, the margin that a clip carries on both sides,
/// and at nine twentieths a quarter.
pub const MOST_HEAD_LOWPASS_OF_RATE: f64 = 0.4;

impl MethodSpec {
    /// Cut-off of the low-pass of the head's pose at a rate, Hz; `None` where there is no filter.
    ///
    /// It is the method's own `headLowpassHz`, 0 for none; [`HEAD_LOWPASS_HZ`] where the method names
    /// none and the rate has room for it; no filter where a method does not look at markers.
    pub fn head_lowpass_hz(&self, rate_hz: f64) -> Option<f64> {
        if !self.method.uses(Group::FrontEnd) {
            return None;
        }
        match self.head_lowpass_hz {
            Some(cutoff_hz) => (cutoff_hz != 0.0).then_some(cutoff_hz),
            None => {
                (HEAD_LOWPASS_HZ <= MOST_HEAD_LOWPASS_OF_RATE * rate_hz).then_some(HEAD_LOWPASS_HZ)
            }
        }
    }

    /// The low-pass of the head's pose at a rate; `None` where there is no filter.
    ///
    /// # Errors
    /// [`LowpassError`] for a cut-off that the method names and the rate does not allow.
    pub fn head_lowpass(&self, rate_hz: f64) -> Result<Option<Lowpass>, LowpassError> {
        self.head_lowpass_hz(rate_hz).map(|cutoff_hz| Lowpass::new(cutoff_hz, rate_hz)).transpose()
    }

    /// The same method with the cut-off that it uses at a rate written out, 0 for none.
    pub fn at_rate(&self, rate_hz: f64) -> MethodSpec {
        let mut spec = self.clone();
        if spec.method.uses(Group::FrontEnd) {
            spec.head_lowpass_hz = Some(self.head_lowpass_hz(rate_hz).unwrap_or(0.0));
        }
        spec
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::names::Method;

    #[test]
    fn the_default_is_ten_hertz_where_the_rate_has_room_for_it() {
        let absent = MethodSpec::new(Method::Lsts);
        for (rate_hz, cutoff_hz) in
            [(200.0, Some(10.0)), (60.0, Some(10.0)), (25.0, Some(10.0)), (24.9, None)]
        {
            assert_eq!(absent.head_lowpass_hz(rate_hz), cutoff_hz, "{rate_hz}");
            assert_eq!(absent.at_rate(rate_hz).head_lowpass_hz, Some(cutoff_hz.unwrap_or(0.0)));
            assert!(absent.head_lowpass(rate_hz).is_ok());
        }
        let named = |cutoff_hz| MethodSpec { head_lowpass_hz: Some(cutoff_hz), ..absent.clone() };
        assert_eq!(named(0.0).head_lowpass(200.0), Ok(None));
        assert_eq!(named(6.0).head_lowpass_hz(24.0), Some(6.0));
        assert!(named(12.0).head_lowpass(24.0).is_err(), "half the rate");
        assert_eq!(MethodSpec::new(Method::Recorded).head_lowpass_hz(200.0), None);
    }

    #[test]
    fn at_the_edge_the_filter_settles_within_the_margin_of_a_clip() {
        // The response to an impulse beyond a quarter of a second, as a sum of magnitudes.
        let beyond = |share: f64| {
            let rate_hz = HEAD_LOWPASS_HZ / share;
            let lowpass = Lowpass::new(HEAD_LOWPASS_HZ, rate_hz).expect("below half the rate");
            let mut impulse = vec![0.0; 401];
            impulse[200] = 1.0;
            lowpass.filter(&mut impulse);
            let margin = (0.25 * rate_hz).ceil() as usize;
            2.0 * impulse[200 + margin..].iter().map(|x| x.abs()).sum::<f64>()
        };
        let (at, above) = (beyond(MOST_HEAD_LOWPASS_OF_RATE), beyond(0.45));
        assert!(beyond(0.1) < 1e-3 && at < 0.07 && above > 0.2, "{at} {above}");
    }
}
