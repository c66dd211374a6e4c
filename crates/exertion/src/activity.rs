//! Work without a skeleton: of power on a bicycle, of speed and grade on foot, of a heart rate (E13).

use mimique_mocap::{Activity, ActivityColumn, Sport};

use crate::error::{ExertionError, as_many, from_zero, within};
use crate::heart::VO2_PER_WORK;
use crate::metabolism::vo2;
use crate::person::{Person, VO2_REST};
use crate::samples::with_gaps_at_whole_seconds;

/// Speed from which it is running, m/s.
const RUNNING_MS: f64 = 2.0;
const SECONDS_OF_A_MINUTE: f64 = 60.0;
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
        within(
            &place,
            *power,
            ActivityColumn::PowerW.range(),
            Some(ActivityColumn::PowerW.unit()),
        )?;
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
        within(&place, *speed, ActivityColumn::Speed.range(), Some(ActivityColumn::Speed.unit()))?;
        let own = grade.get(second).copied().unwrap_or(0.0);
        let unit = Some(ActivityColumn::Grade.unit());
        within(&format!("grade/{second}"), own, ActivityColumn::Grade.range(), unit)?;
        Ok(w_of_vo2(vo2_on_foot(*speed, own)))
    };
    speed_ms.iter().enumerate().map(of).collect()
}

/// w of the share of the heart's reserve at every second, by the uptake of oxygen that goes with it.
pub fn w_of_heart(person: &Person, rcn: &[f64]) -> Vec<f64> {
    rcn.iter().map(|share| w_of_vo2(vo2(person, *share))).collect()
}

/// A recorded activity, second by second.
#[derive(Debug, Clone, PartialEq)]
pub struct ActivityWork {
    /// Work of every second, J/kg.
    pub w: Vec<f64>,
    /// The share of the heart's reserve, where the heart was recorded.
    pub rcn: Option<Vec<f64>>,
    /// What the work follows from.
    pub from: ActivityColumn,
}

impl ActivityWork {
    /// Of an activity: of its work where it has one; else of speed on foot, of power on a bicycle, of
    /// whichever of these there is where the file does not say the sport (power first); else of the heart.
    ///
    /// # Errors
    /// [`ExertionError`]: times that leave a gap of more than 5 s, in the file or in a column that is used
    /// (`time/i`), values that no person has.
    pub fn of(person: &Person, activity: &Activity) -> Result<Self, ExertionError> {
        use ActivityColumn::{Grade, HeartRate, PowerW, Speed, Work};
        let column = |column: ActivityColumn| -> Result<Option<Vec<f64>>, ExertionError> {
            let Some(values) = activity.column(column) else { return Ok(None) };
            with_gaps_at_whole_seconds(&activity.time_s, values, column.name()).map(Some)
        };
        let heart = column(HeartRate)?;
        let rcn: Option<Vec<f64>> =
            heart.map(|rates| rates.iter().map(|rate| person.heart_share(*rate)).collect());
        let order = match activity.sport {
            Some(Sport::OnFoot) => [Work, Speed, PowerW],
            Some(Sport::Cycling) | None => [Work, PowerW, Speed],
        };
        let from = order.into_iter().find(|own| activity.column(*own).is_some());
        let own = from.map(column).transpose()?.flatten();
        let (w, from) = match (from, own) {
            (Some(PowerW), Some(power)) => (w_of_power(person, &power)?, PowerW),
            (Some(Speed), Some(speed)) => {
                (w_on_foot(&speed, &column(Grade)?.unwrap_or_default())?, Speed)
            }
            (_, Some(work)) => (work, Work),
            (_, None) => match &rcn {
                Some(rcn) => (w_of_heart(person, rcn), HeartRate),
                None => {
                    let place = "power_w, work, speed, heart_rate".to_owned();
                    return Err(ExertionError::Few { place, found: 0, least: 1 });
                }
            },
        };
        Ok(Self { w, rcn, from })
    }
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
    fn the_work_of_an_activity_follows_from_what_it_has() {
        let person = Person::new(PersonSpec::default()).unwrap();
        let of = |text: &str| {
            let activity = mimique_mocap::read_activity_bytes(text.as_bytes()).unwrap();
            ActivityWork::of(&person, &activity)
        };
        let ride =
            of("time,speed,power_w,heart_rate\n0,5,200,100\n1,5,200,\n3,5,200,130\n").unwrap();
        assert_eq!(ride.from, ActivityColumn::PowerW);
        assert_eq!(ride.w, w_of_power(&person, &[200.0; 4]).unwrap());
        assert_eq!(ride.rcn.unwrap(), [100.0, 110.0, 120.0, 130.0].map(|r| person.heart_share(r)));
        let run = of("time,speed,grade\n0,3,0.1\n1,3,0.1\n").unwrap();
        assert_eq!(
            (run.from, run.w),
            (ActivityColumn::Speed, w_on_foot(&[3.0; 2], &[0.1; 2]).unwrap())
        );
        let work = of("time,work,speed\n0,7,3\n1,9,3\n").unwrap();
        assert_eq!((work.from, work.w), (ActivityColumn::Work, vec![7.0, 9.0]));
        let heart = of("time,heart_rate\n0,130\n1,130\n").unwrap();
        assert_eq!(
            (heart.from, heart.w),
            (ActivityColumn::HeartRate, w_of_heart(&person, &[0.5; 2]))
        );
        let gap = of("time,heart_rate,speed\n0,130,3\n3,,3\n6,,3\n9,130,3\n").unwrap_err();
        assert_eq!(gap.place(), "time/3", "the heart was not seen for nine seconds");
        let late = of("time,heart_rate,speed\n0,,3\n4,,3\n8,130,3\n9,130,3\n").unwrap_err();
        assert_eq!(late.place(), "time/2");
        assert_eq!(of("time,speed\n0,3\n").unwrap_err().place(), "time");
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
