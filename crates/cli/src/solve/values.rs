//! Values of options: spans, lengths, factors, and what is given by name.

use std::collections::BTreeMap;

use std::ops::Range;
use std::str::FromStr;

use anyhow::bail;
use mimique_avatar::GazeAngles;

/// `FIRST:END`.
#[derive(Debug, Clone)]
pub(crate) struct Span(pub(crate) Range<usize>);

/// Metres, from `12mm`, `1.2cm` or `0.012m`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Length(pub(crate) f64);

/// A factor, or one for each of x, y, z.
#[derive(Debug, Clone, Copy)]
pub(super) struct Factors(pub(super) [f64; 3]);

/// Azimuth, elevation and vergence of a gaze, degrees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Angles(pub(super) GazeAngles);

/// `NAME=VALUE`.
#[derive(Debug, Clone)]
pub(crate) struct Named<T>(pub(crate) String, pub(crate) T);

/// What is given by name, each name once.
pub(super) fn unique<T: Clone>(
    option: &str,
    list: &[Named<T>],
) -> anyhow::Result<BTreeMap<String, T>> {
    let mut map = BTreeMap::new();
    for Named(name, value) in list {
        if map.insert(name.clone(), value.clone()).is_some() {
            bail!("{option}: {name} is given twice; give it once");
        }
    }
    Ok(map)
}

impl FromStr for Factors {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> = text
            .split(',')
            .map(|x| x.trim().parse().ok().filter(|x: &f64| x.is_finite() && *x >= 0.0))
            .collect();
        match numbers.as_deref() {
            Some(&[x]) => Ok(Self([x; 3])),
            Some(&[x, y, z]) => Ok(Self([x, y, z])),
            _ => Err("give a number of 0 or more, or three for x, y and z".to_owned()),
        }
    }
}

impl FromStr for Angles {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f64>> = text
            .split(',')
            .map(|x| x.trim().parse().ok().filter(|x: &f64| x.abs() <= 90.0))
            .collect();
        match numbers.as_deref() {
            Some(&[azimuth, elevation]) => {
                Ok(Self(GazeAngles { azimuth, elevation, vergence: 0.0 }))
            }
            Some(&[azimuth, elevation, vergence]) => {
                Ok(Self(GazeAngles { azimuth, elevation, vergence }))
            }
            _ => Err(
                "give azimuth and elevation in degrees, and vergence if it is known, as 10,-5,3"
                    .to_owned(),
            ),
        }
    }
}

impl FromStr for Span {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers =
            text.split_once(':').and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
        numbers
            .filter(|span: &Range<usize>| span.start < span.end)
            .map(Span)
            .ok_or_else(|| "give the first frame and the one after the last, as 0:60".to_owned())
    }
}

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        // Dividing keeps 12 mm the nearest number to 0.012.
        let units = [("mm", 1000.0), ("cm", 100.0), ("m", 1.0)];
        let metres = units.iter().find_map(|(unit, per_metre)| {
            let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
            Some(number / per_metre)
        });
        metres.map(Length).ok_or_else(|| "give a length with its unit, as 12mm".to_owned())
    }
}

impl<T: FromStr> FromStr for Named<T> {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = text.split_once('=').ok_or("give it as NAME=VALUE")?;
        let value = value.parse().map_err(|_| format!("{value:?} cannot be read"))?;
        Ok(Named(name.to_owned(), value))
    }
}
