//! Who moves: age, height, mass, level of training, what is carried, and what follows from these.

use serde_json::Value;

use crate::error::{ExertionError, from_zero, within};
use crate::expressivity::Expressivity;
use crate::json::{Object, number};
use crate::loads::Loads;

/// Sex, where a formula asks for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sex {
    /// Female.
    Female,
    /// Male.
    Male,
}

/// What is known of a person; what is `None` follows from the rest ([`Person::new`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PersonSpec {
    /// Years.
    pub age: f64,
    /// Stature, m.
    pub height_m: f64,
    /// Mass without loads, kg.
    pub mass_kg: f64,
    /// Sex, where it is said.
    pub sex: Option<Sex>,
    /// Level of training N, 0 to 10: the activity class of a sports watch. Every two weeks is 1 to 2, ten
    /// hours a week 8.5.
    pub level: f64,
    /// Heart rate at rest, beats per minute.
    pub hr_rest: Option<f64>,
    /// Highest heart rate, beats per minute.
    pub hr_max: Option<f64>,
    /// Highest uptake of oxygen, ml/kg/min.
    pub vo2_max: Option<f64>,
    /// Energy of a day at rest, kcal.
    pub resting_kcal_day: Option<f64>,
    /// Factors of the expressions.
    pub expressivity: Expressivity,
    /// What is carried.
    pub loads: Loads,
}

impl Default for PersonSpec {
    fn default() -> Self {
        Self {
            age: 30.0,
            height_m: 1.75,
            mass_kg: 70.0,
            sex: None,
            level: 5.0,
            hr_rest: None,
            hr_max: None,
            vo2_max: None,
            resting_kcal_day: None,
            expressivity: Expressivity::default(),
            loads: Loads::default(),
        }
    }
}

/// Levels of training that are allowed: the law of the heart turns round at 13.02, and the document's
/// figures show 0 to 10.
pub const LEVELS: [f64; 2] = [0.0, 10.0];
const AGES: [f64; 2] = [10.0, 100.0];
const HEIGHTS_M: [f64; 2] = [1.0, 2.5];
const MASSES_KG: [f64; 2] = [20.0, 300.0];
/// Heart rates that a heart can have, beats per minute.
pub(crate) const HEART_RATES: [f64; 2] = [25.0, 250.0];
/// How far the highest heart rate must be above the one at rest, beats per minute.
const LEAST_RESERVE: f64 = 20.0;
/// Uptakes of oxygen that are taken for a highest one, ml/kg/min: from three times rest.
const VO2_MAXIMA: [f64; 2] = [10.0, 100.0];
const RESTING_KCAL: [f64; 2] = [300.0, 6000.0];

/// Uptake of oxygen at rest, ml/kg/min: one metabolic equivalent.
pub(crate) const VO2_REST: f64 = 3.5;
/// The least highest uptake that E9 gives, ml/kg/min.
const LEAST_VO2_MAX: f64 = 15.0;

/// A person whose numbers are possible, what was missing found by formulas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Person {
    spec: PersonSpec,
    hr_rest: f64,
    hr_max: f64,
    vo2_max: f64,
    resting_kcal_day: f64,
}

impl Person {
    /// Finds what is missing. With s = 1 for a man, 0 for a woman, 1/2 where it is not said:
    ///
    /// - E2: the highest heart rate is 220 - age, that at rest 84 - 3.2 N + 4 (1 - s);
    /// - E9 (Jackson 1990): VO2max = 56.363 + 1.921 N - 0.381 age - 0.754 BMI + 10.987 s, at least 15;
    /// - Mifflin 1990: a day at rest takes 10 mass + 625 height - 5 age - 161 + 166 s kcal.
    ///
    /// # Errors
    /// [`ExertionError`] for a number out of range, at its key.
    pub fn new(spec: PersonSpec) -> Result<Self, ExertionError> {
        within("age", spec.age, AGES, Some("years"))?;
        within("heightM", spec.height_m, HEIGHTS_M, Some("m"))?;
        within("massKg", spec.mass_kg, MASSES_KG, Some("kg"))?;
        within("level", spec.level, LEVELS, None)?;
        let s = match spec.sex {
            Some(Sex::Female) => 0.0,
            Some(Sex::Male) => 1.0,
            None => 0.5,
        };
        let beats = Some("beats per minute");
        if let Some(rest) = spec.hr_rest {
            within("hrRest", rest, HEART_RATES, beats)?;
        }
        if let Some(max) = spec.hr_max {
            within("hrMax", max, HEART_RATES, beats)?;
        }
        let hr_rest = spec.hr_rest.unwrap_or(84.0 - 3.2 * spec.level + 4.0 * (1.0 - s));
        let hr_max = spec.hr_max.unwrap_or(220.0 - spec.age);
        if hr_max - hr_rest < LEAST_RESERVE {
            let place =
                if spec.hr_max.is_none() && spec.hr_rest.is_some() { "hrRest" } else { "hrMax" };
            let (place, least) = (place.to_owned(), LEAST_RESERVE);
            return Err(ExertionError::HeartReserve { place, max: hr_max, rest: hr_rest, least });
        }
        if let Some(vo2_max) = spec.vo2_max {
            within("vo2Max", vo2_max, VO2_MAXIMA, Some("ml/kg/min"))?;
        }
        let bmi = spec.mass_kg / (spec.height_m * spec.height_m);
        let jackson = 56.363 + 1.921 * spec.level - 0.381 * spec.age - 0.754 * bmi + 10.987 * s;
        if let Some(kcal) = spec.resting_kcal_day {
            within("restingKcalDay", kcal, RESTING_KCAL, Some("kcal"))?;
        }
        let mifflin =
            10.0 * spec.mass_kg + 625.0 * spec.height_m - 5.0 * spec.age - 161.0 + 166.0 * s;
        for (name, factor) in Expressivity::NAMES.iter().zip(spec.expressivity.factors()) {
            from_zero(&format!("expressivity/{name}"), factor)?;
        }
        let Loads { left_hand, right_hand, back } = spec.loads;
        for (name, load) in [("leftHand", left_hand), ("rightHand", right_hand), ("back", back)] {
            from_zero(&format!("loads/{name}"), load)?;
        }
        Ok(Self {
            spec,
            hr_rest,
            hr_max,
            vo2_max: spec.vo2_max.unwrap_or(jackson.max(LEAST_VO2_MAX)),
            resting_kcal_day: spec.resting_kcal_day.unwrap_or(mifflin),
        })
    }

    /// What was given.
    pub fn spec(&self) -> &PersonSpec {
        &self.spec
    }

    /// Heart rate at rest, beats per minute.
    pub fn hr_rest(&self) -> f64 {
        self.hr_rest
    }

    /// Highest heart rate, beats per minute.
    pub fn hr_max(&self) -> f64 {
        self.hr_max
    }

    /// Highest uptake of oxygen, ml/kg/min.
    pub fn vo2_max(&self) -> f64 {
        self.vo2_max
    }

    /// Energy of a day at rest, kcal.
    pub fn resting_kcal_day(&self) -> f64 {
        self.resting_kcal_day
    }

    /// E1, kept in 0 to 1: the share of the heart's reserve at a heart rate in beats per minute.
    pub fn heart_share(&self, heart_rate: f64) -> f64 {
        ((heart_rate - self.hr_rest) / (self.hr_max - self.hr_rest)).clamp(0.0, 1.0)
    }

    /// E1 the other way: beats per minute at a share of the reserve.
    pub fn heart_rate(&self, rcn: f64) -> f64 {
        self.hr_rest + rcn * (self.hr_max - self.hr_rest)
    }
}

impl PersonSpec {
    /// Of a JSON object: any of `age`, `heightM`, `massKg`, `sex` (`female`, `male` or null), `level`,
    /// `hrRest`, `hrMax`, `vo2Max`, `restingKcalDay`, `expressivity`, `loads`. What is missing keeps its
    /// default.
    ///
    /// # Errors
    /// [`ExertionError`] at the key that is unknown or holds something else.
    pub fn of_json(value: &Value) -> Result<Self, ExertionError> {
        let mut spec = Self::default();
        for (place, key, value) in Object::of("", value)?.members() {
            match key {
                "age" => spec.age = number(&place, value)?,
                "heightM" => spec.height_m = number(&place, value)?,
                "massKg" => spec.mass_kg = number(&place, value)?,
                "level" => spec.level = number(&place, value)?,
                "hrRest" => spec.hr_rest = Some(number(&place, value)?),
                "hrMax" => spec.hr_max = Some(number(&place, value)?),
                "vo2Max" => spec.vo2_max = Some(number(&place, value)?),
                "restingKcalDay" => spec.resting_kcal_day = Some(number(&place, value)?),
                "sex" => spec.sex = sex(&place, value)?,
                "expressivity" => spec.expressivity.read(&place, value)?,
                "loads" => spec.loads = Loads::of_json(&place, value)?,
                _ => return Err(ExertionError::Unknown { place, known: KEYS.to_vec() }),
            }
        }
        Ok(spec)
    }

    /// The same of a text.
    ///
    /// # Errors
    /// As [`Self::of_json`]; [`ExertionError::Json`] with line and column.
    pub fn of_text(text: &str) -> Result<Self, ExertionError> {
        Self::of_json(&crate::json::parse(text)?)
    }
}

const KEYS: [&str; 11] = [
    "age",
    "heightM",
    "massKg",
    "sex",
    "level",
    "hrRest",
    "hrMax",
    "vo2Max",
    "restingKcalDay",
    "expressivity",
    "loads",
];

fn sex(place: &str, value: &Value) -> Result<Option<Sex>, ExertionError> {
    match value {
        Value::Null => Ok(None),
        Value::String(word) if word == "female" => Ok(Some(Sex::Female)),
        Value::String(word) if word == "male" => Ok(Some(Sex::Male)),
        _ => {
            let needed = "\"female\", \"male\" or null";
            Err(ExertionError::Shape { place: place.to_owned(), needed })
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn place(value: Value) -> String {
        let spec = PersonSpec::of_json(&value);
        spec.and_then(Person::new).unwrap_err().place().to_owned()
    }

    #[test]
    fn what_is_missing_follows_from_the_rest() {
        let person = Person::new(PersonSpec::default()).unwrap();
        assert_eq!((person.hr_rest(), person.hr_max()), (70.0, 190.0));
        let bmi = 70.0 / 1.75 / 1.75;
        let jackson = 56.363 + 1.921 * 5.0 - 0.381 * 30.0 - 0.754 * bmi + 10.987 / 2.0;
        assert!((person.vo2_max() - jackson).abs() < 1e-12);
        assert_eq!(person.resting_kcal_day(), 1565.75);
        for rcn in [0.0, 0.3, 1.0] {
            assert!((person.heart_share(person.heart_rate(rcn)) - rcn).abs() < 1e-12);
        }
        assert_eq!(person.heart_share(30.0), 0.0);
        assert_eq!(person.heart_share(240.0), 1.0);
    }

    #[test]
    fn what_is_wrong_is_named_by_its_key() {
        for (value, expected) in [
            (json!({"level": 10.001}), "level"),
            (json!({"level": null}), "level"),
            (json!({"age": "thirty"}), "age"),
            (json!({"heightM": 175}), "heightM"),
            (json!({"massKg": -70}), "massKg"),
            (json!({"hrMax": 90, "hrRest": 80}), "hrMax"),
            (json!({"hrRest": 180}), "hrRest"),
            (json!({"hrMax": 80}), "hrMax"),
            (json!({"hrRest": 10}), "hrRest"),
            (json!({"vo2Max": 6}), "vo2Max"),
            (json!({"restingKcalDay": 0}), "restingKcalDay"),
            (json!({"sex": "other"}), "sex"),
            (json!({"expressivity": {"nose": 1}}), "expressivity/nose"),
            (json!({"expressivity": {"brows": -0.1}}), "expressivity/brows"),
            (json!({"expressivity": 1}), "expressivity"),
            (json!({"loads": {"head": 1}}), "loads/head"),
            (json!({"loads": {"leftHand": null}}), "loads/leftHand"),
            (json!({"weight": 70}), "weight"),
            (json!([]), ""),
        ] {
            assert_eq!(place(value.clone()), expected, "{value}");
        }
        assert!(
            PersonSpec::of_text("{\n ]").unwrap_err().to_string().starts_with("line 2, column 2")
        );
    }

    #[test]
    fn the_ends_of_ranges_are_allowed() {
        for value in [
            json!({"level": 0, "age": 100, "sex": "female", "hrRest": 60}),
            json!({"level": 10, "age": 10, "expressivity": {"eyes": 0}}),
            json!({"hrMax": 100, "hrRest": 80}),
        ] {
            PersonSpec::of_json(&value).and_then(Person::new).unwrap();
        }
    }
}
