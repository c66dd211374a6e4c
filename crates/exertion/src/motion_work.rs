//! The work of a captured motion, once and for as long as is asked for.

use mimique_mocap::{BodyJoints, Capture};

use crate::body::{Body, BodyOptions};
use crate::error::ExertionError;
use crate::finding::Finding;
use crate::person::Person;
use crate::plan::Part;
use crate::work::{Accumulated, BodyWork, Convention};

/// Work without the low-pass in works with it from which jitter is said.
const JITTER: f64 = 1.5;

/// A body in motion and its work.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionWork {
    /// The joints, in metres and filtered.
    pub body: Body,
    /// The work of the motion once, J/kg.
    pub once: Accumulated,
}

impl MotionWork {
    /// Of a capture whose joints are known.
    ///
    /// # Errors
    /// As [`Body::new`] and [`BodyWork::of`].
    pub fn of(
        capture: &Capture,
        joints: &BodyJoints,
        person: &Person,
        options: &BodyOptions,
        convention: Convention,
    ) -> Result<Self, ExertionError> {
        let body = Body::new(capture, joints, person, options)?;
        let once = BodyWork::of(&body, person, convention, false)?.accumulated;
        Ok(Self { body, once })
    }

    /// That the motion jitters: the work once more, without the low-pass that `options` ask for.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn jitter(
        &self,
        capture: &Capture,
        joints: &BodyJoints,
        person: &Person,
        options: &BodyOptions,
        convention: Convention,
    ) -> Result<Option<Finding>, ExertionError> {
        if options.lowpass_hz.is_none() {
            return Ok(None);
        }
        let options = BodyOptions { lowpass_hz: None, ..*options };
        let unfiltered = Self::of(capture, joints, person, &options, convention)?;
        let ratio = unfiltered.once.total() / self.once.total();
        Ok((ratio > JITTER).then_some(Finding::Jitter { ratio }))
    }

    /// Whether the motion is repeated to last so long.
    pub fn is_repeated(&self, seconds: f64) -> bool {
        seconds > self.once.span_s()
    }

    /// That it is repeated, where it is.
    pub fn repetition(&self, seconds: f64) -> Option<Finding> {
        let times = seconds / self.once.span_s();
        self.is_repeated(seconds).then_some(Finding::Repeated { times })
    }

    /// As a part of a plan that lasts `seconds`. A shorter motion repeats its work, not its positions, whose jump
    /// back would be work that nobody did.
    pub fn part(&self, seconds: f64) -> Part {
        let work = self.once.clone().repeated(self.is_repeated(seconds));
        Part { work, seconds, rcn: None }
    }
}
