//! Values of options: durations, spans, what is given by name; and the person that follows from them.

use std::str::FromStr;

use anyhow::{anyhow, bail};
use mimique_exertion::{ExertionError, Expressivity, Heart, HeartModel, Loads, Person, PersonSpec};

use super::args::{Options, PersonOptions};
use super::{blame, text_of};

/// Seconds, from `300`, `90s`, `5min` or `1h`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Duration(pub(super) f64);

impl FromStr for Duration {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let units = [("min", 60.0), ("h", 3600.0), ("s", 1.0), ("", 1.0)];
        let of_unit = |(unit, seconds): (&str, f64)| {
            let number = text.strip_suffix(unit)?.trim_end();
            let plain = number.bytes().all(|b| b.is_ascii_digit() || b == b'.');
            Some(number.parse::<f64>().ok().filter(|_| plain)? * seconds)
        };
        let seconds = units.into_iter().find_map(of_unit);
        seconds
            .filter(|s| s.is_finite() && *s > 0.0)
            .map(Self)
            .ok_or_else(|| "give a duration above 0, such as 300, 90s, 5min or 1h".to_owned())
    }
}

/// `FROM:TO`, seconds of a plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Seconds(pub(super) [f64; 2]);

impl FromStr for Seconds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once(':').and_then(|(from, to)| {
            let from = if from.trim().trim_start_matches('0').is_empty() && !from.trim().is_empty()
            {
                0.0
            } else {
                from.parse::<Duration>().ok()?.0
            };
            Some([from, to.parse::<Duration>().ok()?.0])
        });
        ends.filter(|[from, to]| from < to)
            .map(Self)
            .ok_or_else(|| "give two times, the first smaller, such as 290:300".to_owned())
    }
}

/// `FROM:TO`, exponents of ten.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Exponents(pub(super) [f64; 2]);

impl FromStr for Exponents {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let ends = text.split_once(':').and_then(|(from, to)| {
            Some([from.trim().parse::<f64>().ok()?, to.trim().parse::<f64>().ok()?])
        });
        ends.filter(|ends| ends.iter().all(|e| (-15.0..=15.0).contains(e)) && ends[0] <= ends[1])
            .map(Self)
            .ok_or_else(|| "give two exponents of ten from -15 to 15, such as -2:6".to_owned())
    }
}

/// A cut-off in hertz, or `none`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cutoff(pub(super) Option<f64>);

impl FromStr for Cutoff {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "none" {
            return Ok(Self(None));
        }
        let cutoff = text.parse::<f64>().ok().filter(|hz| hz.is_finite() && *hz > 0.0);
        cutoff.map(|hz| Self(Some(hz))).ok_or_else(|| "give hertz above 0, or none".to_owned())
    }
}

/// `NAME=NUMBER`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named(pub(super) String, pub(super) f64);

impl FromStr for Named {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let pair = text.split_once('=').and_then(|(name, value)| {
            Some(Self(name.trim().to_owned(), value.trim().parse().ok()?))
        });
        pair.ok_or_else(|| "give NAME=NUMBER, several joined by commas".to_owned())
    }
}

/// An expressivity of a study's design: `NAME=FACTOR`, or a letter of table 3.2 of the thesis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NamedExpressivity {
    pub(super) name: String,
    pub(super) factors: Expressivity,
}

impl FromStr for NamedExpressivity {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim();
        if let Some((name, factors)) =
            Expressivity::OF_THE_THESIS.iter().find(|(own, _)| *own == text)
        {
            return Ok(Self { name: (*name).to_owned(), factors: *factors });
        }
        let Named(name, factor) = text.parse().map_err(|_| {
            "give NAME=FACTOR, or a letter from a to e of table 3.2 of the thesis, several joined by commas"
                .to_owned()
        })?;
        Ok(Self { name, factors: Expressivity::new([factor; 5]) })
    }
}

/// Takes over what is given by name.
pub(super) fn named(
    option: &str,
    given: &[Named],
    known: &[&'static str],
    mut own: impl FnMut(&str, f64) -> bool,
) -> anyhow::Result<()> {
    for (place, Named(name, value)) in given.iter().enumerate() {
        if given[..place].iter().any(|Named(other, _)| other == name) {
            bail!("{option}: {name} is given twice; give it once");
        }
        if !own(name, *value) {
            bail!("{option}: {name}: not known; use one of {}", known.join(", "));
        }
    }
    Ok(())
}

/// Whoever the options say.
pub(super) fn person(args: &Options) -> anyhow::Result<Person> {
    let PersonOptions { person, level, loads, expressivity } = &args.person;
    let mut spec = match person {
        None => PersonSpec::default(),
        Some(file) => PersonSpec::of_text(&text_of(file)?).map_err(|e| blame(file, e))?,
    };
    if let Some(level) = level {
        spec.level = *level;
    }
    named("--loads", loads, &Loads::NAMES, |name, kg| {
        spec.loads.by_name(name).map(|own| *own = kg).is_some()
    })?;
    named("--expressivity", expressivity, &Expressivity::NAMES, |name, factor| {
        spec.expressivity.by_name(name).map(|own| *own = factor).is_some()
    })?;
    Person::new(spec).map_err(|error| {
        // Whoever said it last.
        let option = |given: bool, option: &str| given.then(|| anyhow!("{option}: {error}"));
        let place = error.place();
        let said = match place.split('/').next().unwrap_or_default() {
            "level" => option(level.is_some(), "--level"),
            "loads" => option(!loads.is_empty(), "--loads"),
            "expressivity" => option(!expressivity.is_empty(), "--expressivity"),
            _ => None,
        };
        said.unwrap_or_else(|| match person {
            Some(file) => blame(file, &error),
            None => anyhow!("{error}"),
        })
    })
}

/// A person of a file, or nobody in particular.
pub(super) fn person_of(file: Option<&std::path::Path>) -> anyhow::Result<Person> {
    let Some(file) = file else { return Ok(Person::new(PersonSpec::default())?) };
    let spec = PersonSpec::of_text(&text_of(file)?);
    spec.and_then(Person::new).map_err(|e: ExertionError| blame(file, e))
}

/// Where the heart comes from.
pub(super) fn heart(args: &Options) -> anyhow::Result<Heart> {
    match args.heart.as_deref() {
        None => Ok(Heart::default()),
        Some("recorded") => Ok(Heart::Recorded),
        Some(name) => match HeartModel::by_name(name) {
            Some(law) => Ok(Heart::Law(law)),
            None => bail!("--heart: {name:?}; use thesis, steady or recorded"),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_and_windows() {
        for (text, seconds) in
            [("300", 300.0), ("90s", 90.0), ("5min", 300.0), ("1.5h", 5400.0), (" 2 min ", 120.0)]
        {
            assert_eq!(text.parse(), Ok(Duration(seconds)), "{text}");
        }
        for text in ["", "0", "-5", "5m", "min", "1e9", "inf", "NaN", "5 5"] {
            assert!(text.parse::<Duration>().is_err(), "{text}");
        }
        assert_eq!("290:300".parse(), Ok(Seconds([290.0, 300.0])));
        assert_eq!("0:5min".parse(), Ok(Seconds([0.0, 300.0])));
        for text in ["300:290", "5", "5:", ":5", "5:5", "-1:5"] {
            assert!(text.parse::<Seconds>().is_err(), "{text}");
        }
        assert_eq!("-2:6".parse(), Ok(Exponents([-2.0, 6.0])));
        assert_eq!("none".parse(), Ok(Cutoff(None)));
        assert!("0".parse::<Cutoff>().is_err());
    }
}
