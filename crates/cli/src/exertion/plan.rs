//! `--plan`: parts one after the other, in words.

use std::path::PathBuf;

use anyhow::bail;

use super::values::Duration;

/// A part of a plan as it is written.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Written {
    /// `rest 60`.
    Rest(f64),
    /// `work 12 60`: J/kg in a second, and how long.
    Work(f64, f64),
    /// `run.bvh 300`, or a file once.
    File(PathBuf, Option<f64>),
}

/// The parts of a plan.
pub(super) fn parse(text: &str) -> anyhow::Result<Vec<Written>> {
    let mut parts = Vec::new();
    for (number, part) in text.split(',').enumerate() {
        let (number, part) = (number + 1, part.trim());
        let words: Vec<&str> = part.split_whitespace().collect();
        let duration = |word: &str| word.parse::<Duration>().ok().map(|duration| duration.0);
        let written = match words[..] {
            [] => bail!("--plan: part {number} is empty; write \"rest 60, run.bvh 5min\""),
            ["rest", length] => duration(length).map(Written::Rest),
            ["work", w, length] => w
                .parse::<f64>()
                .ok()
                .filter(|w| w.is_finite() && *w >= 0.0)
                .zip(duration(length))
                .map(|(w, seconds)| Written::Work(w, seconds)),
            ["rest" | "work", ..] => None,
            [.., last] => {
                let seconds = duration(last).filter(|_| words.len() > 1);
                let file = match seconds {
                    Some(_) => part[..part.len() - last.len()].trim_end(),
                    None => part,
                };
                Some(Written::File(PathBuf::from(file), seconds))
            }
        };
        match written {
            Some(written) => parts.push(written),
            None => bail!(
                "--plan: part {number}: {part:?} is none; write \"rest DURATION\", \"work J/KG DURATION\" or \
                 \"FILE DURATION\", durations such as 60, 5min"
            ),
        }
    }
    Ok(parts)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_every_kind() {
        let parts = parse("rest 60, my run.bvh 5min,ride.fit , work 12.5 90s").unwrap();
        assert_eq!(
            parts,
            [
                Written::Rest(60.0),
                Written::File("my run.bvh".into(), Some(300.0)),
                Written::File("ride.fit".into(), None),
                Written::Work(12.5, 90.0),
            ]
        );
        for (text, said) in [
            ("", "part 1 is empty"),
            ("rest 60,", "part 2 is empty"),
            ("rest", "part 1: \"rest\" is none"),
            ("work 60", "\"work 60\" is none"),
            ("work -1 60", "is none"),
            ("rest soon", "is none"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.starts_with("--plan: ") && error.contains(said), "{text}: {error}");
        }
    }
}
