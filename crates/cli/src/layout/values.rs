//! Values of the options of layouts: numbers of markers, cameras.

use std::str::FromStr;

use mimique_layout::Camera;

/// Numbers of markers of a range without a step of its own.
const STEPS: [usize; 14] = [4, 6, 8, 10, 15, 20, 25, 30, 35, 40, 50, 60, 80, 100];

/// A number of markers, or several in ascending order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Counts {
    /// This one.
    One(usize),
    /// Of these the least that is enough.
    Range(Vec<usize>),
}

impl FromStr for Counts {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "give a number of 4 or more, FIRST..LAST or FIRST..LAST:STEP";
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| FORM.to_owned());
        let Some((first, rest)) = text.split_once("..") else {
            let one = number(text)?;
            return if one >= 4 { Ok(Self::One(one)) } else { Err(FORM.to_owned()) };
        };
        let (last, step) = match rest.split_once(':') {
            Some((last, step)) => (number(last)?, Some(number(step)?)),
            None => (number(rest)?, None),
        };
        let first = number(first)?;
        if first < 4 || last <= first || step == Some(0) {
            return Err(FORM.to_owned());
        }
        let mut counts: Vec<usize> = match step {
            Some(step) => (first..=last).step_by(step).collect(),
            None => STEPS.into_iter().filter(|n| (first..=last).contains(n)).collect(),
        };
        counts.extend([first, last]);
        counts.sort_unstable();
        counts.dedup();
        Ok(Self::Range(counts))
    }
}

/// `DISTANCE,FOCAL LENGTH,PIXEL`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CameraValue(pub(super) Camera);

impl FromStr for CameraValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "give distance, focal length and size of a pixel, as 1.5m,16mm,5.5um";
        let units = [("um", 1e6), ("mm", 1e3), ("cm", 1e2), ("m", 1.0)];
        let length = |text: &str| {
            units.iter().find_map(|(unit, per_metre)| {
                let number: f64 = text.trim().strip_suffix(unit)?.trim().parse().ok()?;
                Some(number / per_metre).filter(|metres| metres.is_finite() && *metres > 0.0)
            })
        };
        let lengths: Option<Vec<f64>> = text.split(',').map(length).collect();
        match lengths.as_deref() {
            Some(&[distance, focal_length, pixel]) => {
                Ok(Self(Camera { distance, focal_length, pixel }))
            }
            _ => Err(FORM.to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_ranges_of_markers() {
        let counts = |text: &str| text.parse::<Counts>();
        assert_eq!(counts("40"), Ok(Counts::One(40)));
        assert_eq!(counts("10..40"), Ok(Counts::Range(vec![10, 15, 20, 25, 30, 35, 40])));
        assert_eq!(counts("12..20:4"), Ok(Counts::Range(vec![12, 16, 20])));
        assert_eq!(counts("11..14"), Ok(Counts::Range(vec![11, 14])));
        for text in ["3", "40..10", "x", "10..", "10..20:0", "2..9", "-4"] {
            assert!(counts(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_camera_has_three_lengths() {
        let CameraValue(camera) = "1.5m,16mm,5.5um".parse().unwrap();
        assert!((camera.pixel_on_face() - 0.000_515_625).abs() < 1e-12);
        for text in ["1.5m,16mm", "1.5,16,5", "1m,16mm,0um", "1m,16mm,5um,3mm"] {
            assert!(text.parse::<CameraValue>().is_err(), "{text}");
        }
    }
}
