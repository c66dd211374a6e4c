//! A leg of a gait: where the ankle is, and the angles that put it there.

use super::Gait;
use super::curve::{hermite, periodic};

/// Lengths of a body, m, by its stature (Winter 2009, figure 4.1).
#[derive(Debug, Clone, Copy)]
pub(super) struct Lengths {
    pub thigh: f64,
    pub shank: f64,
    /// Height of the ankle over the ground.
    pub ankle: f64,
    /// From the ankle forwards to the ball of the foot.
    pub ball: f64,
}

impl Lengths {
    pub fn of_stature(stature: f64) -> Self {
        Self {
            thigh: 0.245 * stature,
            shank: 0.246 * stature,
            ankle: 0.039 * stature,
            ball: 0.09 * stature,
        }
    }
}

/// A place in the plane of the gait: forwards and up, m.
type Place = [f64; 2];

/// Angles of a leg, radians.
#[derive(Debug, Clone, Copy)]
pub(super) struct LegAngles {
    /// The thigh before the vertical.
    pub hip: f64,
    /// The bend of the knee.
    pub knee: f64,
    /// The foot's pitch, toes up above 0.
    pub foot: f64,
}

/// Most that a leg is stretched: with the knee straight a small step of the hips would be a large one of the
/// knee.
const STRETCH: f64 = 0.985;

impl Gait {
    /// The foot's pitch at a share of its stride, radians.
    fn pitch(&self, share: f64) -> f64 {
        periodic(self.foot_pitch, share).to_radians()
    }

    /// The ankle of a foot on the ground, from the place under the hips at that time. A foot whose heel has
    /// left the ground rolls over its ball.
    fn ankle_on_ground(&self, lengths: &Lengths, share: f64) -> Place {
        let seconds = share / self.stride_hz;
        let way = self.speed * self.duty / self.stride_hz;
        let forwards = self.reach * way - self.speed * seconds;
        let pitch = self.pitch(share).min(0.0);
        let (sine, cosine) = libm::sincos(pitch);
        // From the ball back to the ankle, turned by the pitch.
        let back = [
            -lengths.ball * cosine - lengths.ankle * sine,
            lengths.ankle * cosine - lengths.ball * sine,
        ];
        [forwards + lengths.ball + back[0], back[1]]
    }

    /// The ankle at a share of its stride, which begins with the landing: forwards from under the hips, and
    /// over the ground.
    pub(super) fn ankle(&self, lengths: &Lengths, share: f64) -> Place {
        let share = share - share.floor();
        if share < self.duty {
            return self.ankle_on_ground(lengths, share);
        }
        let swing = 1.0 - self.duty;
        let u = (share - self.duty) / swing;
        // It leaves the ground as fast as it was on it, and lands about so.
        let h = 1e-4;
        let at = |share: f64| self.ankle_on_ground(lengths, share);
        let (leaving, landing) = (at(self.duty), at(0.0));
        let (before, after) = (at(self.duty - h), at(h));
        // Highest in the first half of the swing.
        let arch = libm::sin(std::f64::consts::PI * libm::pow(u, 0.8));
        let mut place = [0.0; 2];
        for k in 0..2 {
            let from = [leaving[k], (leaving[k] - before[k]) / h * swing];
            let to = [landing[k], self.retraction * (after[k] - landing[k]) / h * swing];
            place[k] = hermite(u, from, to);
        }
        place[1] += self.lift * arch * arch;
        place
    }

    /// How far the hips are over their mean height at a share of the stride of the left foot, m.
    pub(super) fn bounce_at(&self, share: f64) -> f64 {
        let middle = self.reach * self.duty;
        self.bounce * libm::cos(4.0 * std::f64::consts::PI * (share - middle))
    }

    /// How far the hips are before the place that a constant speed would take them to, m.
    pub(super) fn surge_at(&self, share: f64) -> f64 {
        let per_second = 4.0 * std::f64::consts::PI;
        let middle = self.reach * self.duty;
        -self.surge / (per_second * self.stride_hz) * libm::sin(per_second * (share - middle))
    }

    /// The mean height of the hips, m: as high as the legs reach in every moment of a stride.
    pub(super) fn hip_height(&self, lengths: &Lengths) -> f64 {
        let reach = STRETCH * (lengths.thigh + lengths.shank);
        let at = |i: u32| {
            let share = f64::from(i) / 400.0;
            let [forwards, up] = self.ankle(lengths, share);
            let forwards = forwards - self.surge_at(share);
            up + (reach * reach - forwards * forwards).max(0.0).sqrt() - self.bounce_at(share)
        };
        (0..400).map(at).fold(f64::INFINITY, f64::min)
    }

    /// The angles of a leg at a share of its stride, the hips at a height over the ground.
    pub(super) fn leg(&self, lengths: &Lengths, share: f64, hips: f64) -> LegAngles {
        let [forwards, up] = self.ankle(lengths, share);
        let (forwards, down) = (forwards - self.surge_at(share), hips - up);
        let (thigh, shank) = (lengths.thigh, lengths.shank);
        let distance = (forwards * forwards + down * down).sqrt().min(0.999 * (thigh + shank));
        let at_hip =
            (thigh * thigh + distance * distance - shank * shank) / (2.0 * thigh * distance);
        let at_knee = (thigh * thigh + shank * shank - distance * distance) / (2.0 * thigh * shank);
        LegAngles {
            hip: libm::atan2(forwards, down) + libm::acos(at_hip.clamp(-1.0, 1.0)),
            knee: std::f64::consts::PI - libm::acos(at_knee.clamp(-1.0, 1.0)),
            foot: self.pitch(share),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foot_on_the_ground_stays_where_it_is_and_never_goes_below() {
        let lengths = Lengths::of_stature(1.75);
        for gait in Gait::ALL {
            for i in 0..1000 {
                let share = f64::from(i) / 1000.0;
                let [_, up] = gait.ankle(&lengths, share);
                assert!(up > 0.9 * lengths.ankle, "{} {share}: {up}", gait.name);
            }
            // While it is flat the ankle goes backwards as fast as the body goes forwards.
            let [first, last] = gait
                .foot_pitch
                .windows(2)
                .find(|w| w[0][1] == w[1][1])
                .map_or([0.0; 2], |w| [w[0][0], w[1][0]]);
            let at =
                |share: f64| gait.ankle(&lengths, share)[0] + gait.speed * share / gait.stride_hz;
            let middle = (first + last) / 2.0;
            assert!((at(middle) - at(middle + 0.3 * (last - first))).abs() < 0.02, "{}", gait.name);
        }
    }

    #[test]
    fn the_ankle_neither_jumps_nor_kinks() {
        let lengths = Lengths::of_stature(1.75);
        for gait in Gait::ALL {
            for (border, kink) in [(0.0, 1.0 - gait.retraction), (gait.duty, 0.0)] {
                for k in 0..2 {
                    let at = |share: f64| gait.ankle(&lengths, share)[k];
                    let (before, after) = (at(border + 1.0 - 1e-7), at(border + 1e-7));
                    assert!((before - after).abs() < 1e-5, "{} {border} {k}", gait.name);
                    let slopes = [
                        at(border + 1.0 - 1e-7) - at(border + 1.0 - 2e-7),
                        at(border + 2e-7) - at(border + 1e-7),
                    ];
                    assert!(
                        (slopes[0] - slopes[1]).abs() < 1e-7 * (1.0 + 10.0 * kink * gait.speed),
                        "{} {border} {k}: {slopes:?}",
                        gait.name
                    );
                }
            }
        }
    }
}
