//! The mechanical energy of a body's segments, and of what they carry (E3).

use mimique_geometry::{Displacement, Point};
use mimique_mocap::BodyJoint;

use crate::body::Body;
use crate::error::ExertionError;
use crate::loads::Loads;
use crate::person::Person;
use crate::segments::{End, Segment, TRUNK};

/// Gravity, m/s^2.
const GRAVITY: f64 = 9.81;

impl Body {
    /// E3: the energy of every segment in every frame, with what it carries: a load is a point mass at the
    /// centre of the hand (without a hand's end at the wrist, with the forearm) or of the trunk.
    ///
    /// # Errors
    /// [`ExertionError::NoLength`] for a segment whose ends lie in one place in some frame.
    pub fn energies(&self, person: &Person) -> Result<Vec<PartEnergy>, ExertionError> {
        let mut parts = Vec::new();
        self.each_part(person, |part| parts.push(part.clone()))?;
        Ok(parts)
    }

    /// Hands out the energy of one segment after the other, in room that is used again.
    pub(crate) fn each_part(
        &self,
        person: &Person,
        mut each: impl FnMut(&PartEnergy),
    ) -> Result<(), ExertionError> {
        let Loads { left_hand, right_hand, back } = person.spec().loads;
        let has = |joint: BodyJoint| !self.tracks[joint as usize].is_empty();
        let (mut part, mut room) = (PartEnergy::default(), Room::default());
        for segment in self.segments() {
            self.segment_energy(&segment, person.spec().mass_kg, &mut part, &mut room)?;
            let carried = match segment.name {
                TRUNK => (back, None),
                "leftHand" => (left_hand, None),
                "rightHand" => (right_hand, None),
                "leftForearm" if !has(BodyJoint::LeftHandEnd) => {
                    (left_hand, Some(BodyJoint::LeftWrist))
                }
                "rightForearm" if !has(BodyJoint::RightHandEnd) => {
                    (right_hand, Some(BodyJoint::RightWrist))
                }
                _ => (0.0, None),
            };
            match carried {
                (load, None) if load > 0.0 => self.add_point(&room.centres, load, &mut part),
                (load, Some(wrist)) if load > 0.0 => {
                    self.add_point(&self.tracks[wrist as usize], load, &mut part);
                }
                _ => {}
            }
            each(&part);
        }
        Ok(())
    }

    /// m g y + m v^2 / 2 + m (rho L)^2 |du/dt|^2 / 2, u the segment's axis, L its mean length.
    fn segment_energy(
        &self,
        segment: &Segment,
        mass_kg: f64,
        part: &mut PartEnergy,
        room: &mut Room,
    ) -> Result<(), ExertionError> {
        room.centres.clear();
        room.axes.clear();
        let (from, to) = (self.end(segment.from), self.end(segment.to));
        let (mut length, mut shortest) = (0.0, f64::INFINITY);
        for frame in 0..self.frames {
            let (p, d) = (from.at(frame), to.at(frame));
            let way = d - p;
            let own = way.length();
            shortest = own.min(shortest);
            length += own;
            room.centres.push(p + way * segment.centre);
            room.axes.push(way / own);
        }
        if !(shortest > 0.0) {
            let place = format!("joints/{}", segment.name);
            return Err(ExertionError::NoLength { place });
        }
        length /= self.frames as f64;
        let mass = segment.mass * mass_kg;
        let arm = segment.gyration * length;
        let inertia = 0.5 * mass * (arm * arm);
        part.clear();
        part.potential.resize(self.frames, 0.0);
        part.translational.resize(self.frames, 0.0);
        self.add_point(&room.centres, mass, part);
        let turns = self.derivative(&room.axes, |a, b| a - b);
        part.rotational.extend(turns.map(|turn| inertia * turn.length_squared()));
        Ok(())
    }

    /// Adds the energy of a point mass.
    fn add_point(&self, places: &[Point], mass: f64, part: &mut PartEnergy) {
        let weight = mass * GRAVITY;
        for (own, place) in part.potential.iter_mut().zip(places) {
            *own += weight * place.dot(self.up.0);
        }
        let speeds = self.derivative(places, |a, b| a - b);
        for (own, speed) in part.translational.iter_mut().zip(speeds) {
            *own += 0.5 * mass * speed.length_squared();
        }
    }

    /// One end of a segment.
    fn end(&self, end: End) -> Track<'_> {
        let track = |joint: BodyJoint| &self.tracks[joint as usize][..];
        match end {
            End::At(joint) => Track::One(track(joint)),
            End::Between(a, b) => Track::Between(track(a), track(b)),
        }
    }

    /// Change per second: over both neighbours, at the ends over one.
    fn derivative<'a, T: Copy>(
        &self,
        values: &'a [T],
        minus: impl Fn(T, T) -> Displacement + 'a,
    ) -> impl Iterator<Item = Displacement> + 'a {
        let (last, rate_hz) = (values.len() - 1, self.rate_hz);
        (0..values.len()).map(move |i| match i {
            0 => minus(values[1], values[0]) * rate_hz,
            _ if i == last => minus(values[last], values[last - 1]) * rate_hz,
            _ => minus(values[i + 1], values[i - 1]) * (0.5 * rate_hz),
        })
    }
}

/// An end of a segment in all frames.
enum Track<'a> {
    One(&'a [Point]),
    Between(&'a [Point], &'a [Point]),
}

impl Track<'_> {
    #[inline]
    fn at(&self, frame: usize) -> Point {
        match self {
            Self::One(track) => track[frame],
            Self::Between(a, b) => Point((a[frame].0 + b[frame].0) * 0.5),
        }
    }
}

/// Centres of mass and axes of a segment.
#[derive(Default)]
struct Room {
    centres: Vec<Point>,
    axes: Vec<Displacement>,
}

/// The energy of a segment and of what it carries in every frame, J.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PartEnergy {
    /// Of its height.
    pub potential: Vec<f64>,
    /// Of its centre's speed.
    pub translational: Vec<f64>,
    /// Of its turning.
    pub rotational: Vec<f64>,
}

impl PartEnergy {
    fn clear(&mut self) {
        self.potential.clear();
        self.translational.clear();
        self.rotational.clear();
    }
}
