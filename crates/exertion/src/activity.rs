//! Work without a skeleton: of power on a bicycle, of speed and grade on foot, of a heart rate (E13).

use crate::error::{ExertionError, as_many, from_zero, within};
use crate::heart::VO2_PER_WORK;
use crate::metabolism::vo2;
use crate::person::{Person, VO2_REST};

/// Speed from which it is running, m/s.
const RUNNING_MS: f64 = 2.0;
const SECONDS_OF_A_MINUTE: f64 = 60.0;
/// Grades that roads have, rise over run.
const GRADES: [f64; 2] = [-1.0, 1.0];
/// Speeds of people, m/s, and powers, W.
const SPEEDS: [f64; 2] = [0.0, 15.0];
const POWERS: [f64; 2] = [0.0, 3000.0];

/// Uptake of oxygen on a bicycle, ml/kg/min: 10.8 W/kg + 7, at 0 W that of rest (ACSM).
pub fn vo2_cycling(power_w: f64, mass_kg: f64) -> f64 {
    if power_w > 0.0 { 10.8 * power_w / mass_kg + 7.0 } else { VO2_REST }
}

/// Uptake of oxygen on foot, ml/kg/min: with v in m/min 0.1 v + 1.8 v g + 3.5 below 2 m/s, from there
/// 0.2 v + 0.9 v g + 3.5 (ACSM). Downhill counts as level.
pub fn vo2_on_foot(speed_ms: f64, grade: f64) -> f64 {
    let (v, g) = (speed_ms * SECONDS_OF_A_MINUTE, grade.max(0.0));
    if speed_ms < RUNNING_MS {
        0.1 * v + 1.8 * v * g + VO2_REST
    } else {
        0.2 * v + 0.9 * v * g + VO2_REST
    }
}

/// E13: w of an uptake of oxygen in ml/kg/min, J/kg in a second.
pub fn w_of_vo2(vo2: f64) -> f64 {
    ((vo2 - VO2_REST) / VO2_PER_WORK).max(0.0)
}

/// w of power at every second.
///
/// # Errors
/// [`ExertionError`] for a power that is none, below 0 or no person's (`powerW/j`).
pub fn w_of_power(person: &Person, power_w: &[f64]) -> Result<Vec<f64>, ExertionError> {
    let mass_kg = person.spec().mass_kg;
    let of = |(second, power): (usize, &f64)| {
        let place = format!("powerW/{second}");
        from_zero(&place, *power)?;
        within(&place, *power, POWERS, Some("W"))?;
        Ok(w_of_vo2(vo2_cycling(*power, mass_kg)))
    };
    power_w.iter().enumerate().map(of).collect()
}

/// w of speed, m/s, and grade, rise over run, at every second; no grade at all is level.
///
/// # Errors
/// [`ExertionError`] for a speed that is none, below 0 or no person's (`speed/j`), or a grade outside -1 to 1
/// (`grade/j`).
pub fn w_on_foot(speed_ms: &[f64], grade: &[f64]) -> Result<Vec<f64>, ExertionError> {
    if !grade.is_empty() {
        as_many("grade", grade.len(), speed_ms.len())?;
    }
    let of = |(second, speed): (usize, &f64)| {
        let place = format!("speed/{second}");
        from_zero(&place, *speed)?;
        within(&place, *speed, SPEEDS, Some("m/s"))?;
        let own = grade.get(second).copied().unwrap_or(0.0);
        within(&format!("grade/{second}"), own, GRADES, Some("(rise over run)"))?;
        Ok(w_of_vo2(vo2_on_foot(*speed, own)))
    };
    speed_ms.iter().enumerate().map(of).collect()
}

/// w of the share of the heart's reserve at every second, by the uptake of oxygen that goes with it.
pub fn w_of_heart(person: &Person, rcn: &[f64]) -> Vec<f64> {
    rcn.iter().map(|share| w_of_vo2(vo2(person, *share))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::person::PersonSpec;

    #[test]
    fn rest_is_no_work_and_downhill_is_level() {
        let person = Person::new(PersonSpec::default()).unwrap();
        assert_eq!(w_of_power(&person, &[0.0]).unwrap(), [0.0]);
        assert_eq!(w_on_foot(&[0.0, 3.0], &[]).unwrap()[0], 0.0);
        assert_eq!(w_on_foot(&[3.0], &[-0.2]).unwrap(), w_on_foot(&[3.0], &[0.0]).unwrap());
        assert_eq!(w_of_heart(&person, &[0.0]), [0.0]);
    }

    #[test]
    fn what_no_person_does_is_refused() {
        let person = Person::new(PersonSpec::default()).unwrap();
        let place = |e: ExertionError| e.place().to_owned();
        assert_eq!(place(w_of_power(&person, &[0.0, -5.0]).unwrap_err()), "powerW/1");
        assert_eq!(place(w_on_foot(&[18.0], &[]).unwrap_err()), "speed/0");
        assert_eq!(place(w_on_foot(&[2.0, 2.0], &[0.0, 5.0]).unwrap_err()), "grade/1");
        assert_eq!(place(w_on_foot(&[2.0, 2.0], &[0.0]).unwrap_err()), "grade");
    }
}
