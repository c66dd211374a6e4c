//! Oxygen, breath, energy, and what gathers: fatigue, flush and sweat, second by second.

use crate::error::{ExertionError, from_zero, within};
use crate::person::{Person, VO2_REST};

/// Breaths per minute at rest and how many more at the heart's maximum (E10).
const BREATHS_AT_REST: f64 = 12.0;
const BREATHS_MORE: f64 = 43.0;
/// EPOC gathers by 16 (x - 0.3)^2 and goes by a twentieth per minute, ml/kg (E11).
const EPOC_GAIN: f64 = 16.0;
const EPOC_THRESHOLD: f64 = 0.3;
const EPOC_TAU_MIN: f64 = 20.0;
/// EPOC at which fatigue is 1 - 1/e, ml/kg (E11).
const EPOC_OF_FATIGUE: f64 = 30.0;
/// Litres of oxygen per ml times kcal per litre (E12).
const KCAL_PER_ML: f64 = 0.005;
const MINUTES_OF_A_DAY: f64 = 1440.0;
const SECONDS_OF_A_MINUTE: f64 = 60.0;
/// Time constants of flush and sweat, s.
const FLUSH_TAU_S: f64 = 90.0;
const SWEAT_TAU_S: f64 = 300.0;
/// The scale of perceived exertion at rest, and how much more at the maximum.
const BORG_AT_REST: f64 = 6.0;
const BORG_MORE: f64 = 14.0;

/// What follows from the heart, a value a second each.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Metabolism {
    /// 6 + 14 rcn: the scale of perceived exertion from 6 to 20.
    pub borg: Vec<f64>,
    /// E8: uptake of oxygen, ml/kg/min.
    pub vo2: Vec<f64>,
    /// The same as a share of the highest.
    pub vo2_share: Vec<f64>,
    /// E10: breaths per minute.
    pub breaths: Vec<f64>,
    /// E12: kcal per minute.
    pub kcal_min: Vec<f64>,
    /// E11: excess post-exercise oxygen consumption, ml/kg.
    pub epoc: Vec<f64>,
    /// E11: 0 to 1.
    pub fatigue: Vec<f64>,
    /// How red the skin is, 0 to 1: a guide for a skin's shader, of no person.
    pub flush: Vec<f64>,
    /// How wet it is, 0 to 1.
    pub sweat: Vec<f64>,
}

/// E11: fatigue of an EPOC in ml/kg, 1 - exp(-EPOC/30).
pub fn fatigue(epoc: f64) -> f64 {
    -libm::expm1(-epoc / EPOC_OF_FATIGUE)
}

/// E10: breaths per minute at a share of the heart's reserve.
pub fn breaths_per_minute(rcn: f64) -> f64 {
    BREATHS_AT_REST + BREATHS_MORE * rcn
}

/// E8: uptake of oxygen at a share of the heart's reserve, ml/kg/min.
pub fn vo2(person: &Person, rcn: f64) -> f64 {
    VO2_REST + rcn * (person.vo2_max() - VO2_REST)
}

impl Metabolism {
    /// Of rcn at every second and the EPOC at second 0, ml/kg.
    ///
    /// # Errors
    /// [`ExertionError`]: rcn outside 0 to 1 (`rcn/j`), an EPOC that is none or below 0 (`epoc0`).
    pub fn of(person: &Person, rcn: &[f64], epoc0: f64) -> Result<Self, ExertionError> {
        from_zero("epoc0", epoc0)?;
        let vo2_max = person.vo2_max();
        let kcal_at_rest = person.resting_kcal_day() / MINUTES_OF_A_DAY;
        let kcal_more = KCAL_PER_ML * vo2_max * person.spec().mass_kg - kcal_at_rest;
        // The exact step of a second, the uptake constant in it.
        let epoc_gone = -libm::expm1(-1.0 / (EPOC_TAU_MIN * SECONDS_OF_A_MINUTE));
        let gone = |tau_s: f64| -libm::expm1(-1.0 / tau_s);
        let (flush_gone, sweat_gone) = (gone(FLUSH_TAU_S), gone(SWEAT_TAU_S));
        let mut all = Self::default();
        let (mut epoc, mut flush, mut sweat) = (epoc0, 0.0, 0.0);
        for (second, &own) in rcn.iter().enumerate() {
            within(&format!("rcn/{second}"), own, [0.0, 1.0], None)?;
            let vo2 = vo2(person, own);
            let share = vo2 / vo2_max;
            let over = (share - EPOC_THRESHOLD).max(0.0);
            if second > 0 {
                epoc += (EPOC_TAU_MIN * EPOC_GAIN * (over * over) - epoc) * epoc_gone;
                let most = over / (1.0 - EPOC_THRESHOLD);
                flush += (most - flush) * flush_gone;
                sweat += (most - sweat) * sweat_gone;
            }
            all.borg.push(BORG_AT_REST + BORG_MORE * own);
            all.vo2.push(vo2);
            all.vo2_share.push(share);
            all.breaths.push(breaths_per_minute(own));
            all.kcal_min.push(kcal_at_rest + own * kcal_more);
            all.epoc.push(epoc);
            all.fatigue.push(fatigue(epoc));
            all.flush.push(flush);
            all.sweat.push(sweat);
        }
        Ok(all)
    }
}
