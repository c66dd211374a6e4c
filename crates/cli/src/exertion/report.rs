//! What is told: the series, the figure, the report.

use std::io::Write as _;

use mimique_clip::weights_hash;
use mimique_exertion::{Course, Curves, Expression, Finding, Heart, Person, Series, VERSION};
use mimique_mocap::WeightsTable;
use mimique_report::figure::CoursePanel;
use mimique_stimulus::{ExertionTake, Provenance};
use serde_json::{Value, json};

use super::args::Options;
use super::inputs::Inputs;
use super::{hash_of, text_of};

/// Everything that was computed.
pub(super) struct Report<'a> {
    pub(super) args: &'a Options,
    pub(super) person: &'a Person,
    pub(super) inputs: &'a Inputs,
    pub(super) heart: Heart,
    pub(super) take: &'a ExertionTake,
}

impl Report<'_> {
    /// Heart rate, EPOC and curves, second by second.
    pub(super) fn panels(&self, expression: &Expression) -> Vec<CoursePanel> {
        let curves = self.take.series.curves(self.person, expression);
        Course::PLOTTED.map(|course| panel(&self.take.series, course, &curves)).into()
    }

    /// What it is, in the user's words.
    pub(super) fn name(&self) -> &str {
        self.inputs.name()
    }

    /// Mean work, J/kg in a second.
    pub(super) fn mean_work(&self) -> f64 {
        let plan = &self.inputs.plan;
        plan.at(plan.span_s()) / plan.span_s()
    }

    /// The window, where it is not all of the plan.
    pub(super) fn marked(&self) -> Option<[f64; 2]> {
        let times = &self.take.clip.times;
        self.args.window.as_ref().map(|_| [times[0], times[times.len() - 1]])
    }

    fn warnings(&self) -> Vec<String> {
        Finding::of_clip(&self.take.series, &self.take.clip).into_iter().map(words).collect()
    }

    fn heart_name(&self) -> String {
        match self.heart {
            Heart::Law(law) => law.name().to_owned(),
            Heart::Recorded => "recorded".to_owned(),
            Heart::RecordedElse(law) => {
                let recorded = self.inputs.plan.parts().iter().filter(|part| part.rcn.is_some());
                match recorded.count() {
                    0 => law.name().to_owned(),
                    n if n == self.inputs.plan.parts().len() => "recorded".to_owned(),
                    _ => format!("recorded, else {}", law.name()),
                }
            }
        }
    }

    fn person(&self) -> Value {
        let (person, spec) = (self.person, self.person.spec());
        let sex = spec.sex.map(|sex| format!("{sex:?}").to_lowercase());
        let factors: serde_json::Map<String, Value> = mimique_exertion::Expressivity::NAMES
            .iter()
            .zip(spec.expressivity.factors())
            .map(|(name, factor)| ((*name).to_owned(), json!(factor)))
            .collect();
        json!({
            "age": spec.age, "heightM": spec.height_m, "massKg": spec.mass_kg, "sex": sex,
            "level": spec.level, "hrRest": person.hr_rest(), "hrMax": person.hr_max(),
            "vo2Max": person.vo2_max(), "restingKcalDay": person.resting_kcal_day(),
            "expressivity": factors,
            "loads": {
                "leftHand": spec.loads.left_hand, "rightHand": spec.loads.right_hand,
                "back": spec.loads.back,
            },
        })
    }

    /// The state at a second of the plan.
    fn state(&self, second: usize) -> Value {
        let (series, of) = (&self.take.series, &self.take.series.metabolism);
        json!({
            "second": second, "w": series.w[second], "rcn": series.rcn[second],
            "heartRate": series.heart_rate[second], "vo2": of.vo2[second],
            "breaths": of.breaths[second], "epoc": of.epoc[second], "fatigue": of.fatigue[second],
            "borg": of.borg[second],
        })
    }

    /// Everything as JSON.
    pub(super) fn told(&self, table: &WeightsTable) -> anyhow::Result<Value> {
        let args = self.args;
        let (clip, series) = (&self.take.clip, &self.take.series);
        let last = series.seconds() - 1;
        let ends = [clip.times[0], clip.times[clip.times.len() - 1]];
        let end = (ends[1].round() as usize).min(last);
        let curves = clip.curves.last().copied().unwrap_or_default().to_array();
        let curves: serde_json::Map<String, Value> = Curves::NAMES
            .iter()
            .zip(curves)
            .map(|(name, value)| ((*name).to_owned(), json!(value)))
            .collect();
        let hash = weights_hash(&table.weights);
        let optional = |file: &Option<std::path::PathBuf>| file.as_deref().map(hash_of).transpose();
        let provenance = Provenance::default()
            .json("exertion", VERSION)
            .json("files", self.inputs.hashes.clone())
            .json("parts", parts_without_files(&self.inputs.parts))
            .json("person", self.person())
            .json("heart", self.heart_name())
            .json("model", self.model()?)
            .json("shapes", optional(&args.shapes)?)
            .json("breath", json!([!args.no_breath, args.seed]))
            .json("skin", json!(args.skin))
            .json("over", optional(&args.over)?)
            .json("joints", optional(&args.motion.joints)?)
            .json("window", json!([ends, args.out_rate]));
        Ok(json!({
            "person": self.person(),
            "parts": self.inputs.parts,
            "heart": self.heart_name(),
            "model": args.model,
            "seconds": self.inputs.plan.span_s(),
            "window": ends,
            "frames": table.frames.len(),
            "rate_hz": args.out_rate,
            "shapes": table.shape_names,
            "end": self.state(end),
            "peak": {
                "w": largest(&series.w), "heartRate": largest(&series.heart_rate),
                "epoc": largest(&series.metabolism.epoc), "borg": largest(&series.metabolism.borg),
            },
            "kcal": series.metabolism.kcal_min.iter().skip(1).sum::<f64>() / 60.0,
            "curves_at_end": curves,
            "cut_frames": clip.controls.cut_frames,
            "seconds_over_limit": series.over_limit,
            "warnings": self.warnings(),
            "notes": self.inputs.notes,
            "weights_hash": hash,
            "provenance": provenance.json("weights", hash.as_str()).hash(),
            "files": {
                "out": args.out, "series": args.series, "plot": args.plot, "report": args.report,
            },
        }))
    }

    /// The model: its name, or the hash of its file.
    fn model(&self) -> anyhow::Result<Value> {
        Ok(match self.args.model.as_str() {
            name @ ("rules" | "linear") => json!(name),
            file => {
                json!(mimique_clip::sha256_hex(text_of(std::path::Path::new(file))?.as_bytes()))
            }
        })
    }

    /// Who moves, and how body and face are at the window's end.
    fn print_state(&self, told: &Value, out: &mut impl std::io::Write) -> std::io::Result<()> {
        let (person, series) = (self.person, &self.take.series);
        writeln!(
            out,
            "{}: {:.1} s, mean work {:.1} J/kg per second, {:.0} kcal",
            self.inputs.name(),
            self.inputs.plan.span_s(),
            self.mean_work(),
            told["kcal"].as_f64().unwrap_or(0.0),
        )?;
        writeln!(
            out,
            "person  level {}, heart {:.0} to {:.0} beats per minute, VO2max {:.1} ml/kg/min",
            person.spec().level,
            person.hr_rest(),
            person.hr_max(),
            person.vo2_max(),
        )?;
        let end = (self.take.clip.times[self.take.clip.times.len() - 1].round() as usize)
            .min(series.seconds() - 1);
        let of = &series.metabolism;
        writeln!(
            out,
            "at {end} s  heart {:.0} ({:.0} % of its reserve, {}), {:.0} breaths per minute, EPOC {:.1} ml/kg, exertion \
             {:.1} of 20",
            series.heart_rate[end],
            100.0 * series.rcn[end],
            self.heart_name(),
            of.breaths[end],
            of.epoc[end],
            of.borg[end],
        )?;
        let [open, stretch, eyes, brows] =
            self.take.clip.curves.last().copied().unwrap_or_default().to_array();
        writeln!(
            out,
            "face    mouth open {open:.0} %, stretched {stretch:.0} %, eyes {eyes:.0} %, brows {brows:.0} % ({})",
            self.args.model
        )
    }

    /// Prints what matters.
    pub(super) fn print(&self, told: &Value, json: bool) -> anyhow::Result<()> {
        let mut out = std::io::stdout().lock();
        if json {
            writeln!(out, "{}", serde_json::to_string_pretty(told)?)?;
            return Ok(());
        }
        self.print_state(told, &mut out)?;
        if let Some(file) = &self.args.out {
            writeln!(
                out,
                "{}: {} frames at {} Hz, from {} to {} s, {} shapes",
                file.display(),
                told["frames"],
                self.args.out_rate,
                self.take.clip.times[0],
                self.take.clip.times[self.take.clip.times.len() - 1],
                told["shapes"].as_array().map_or(0, Vec::len),
            )?;
            let text = |key: &str| told[key].as_str().unwrap_or_default().to_owned();
            writeln!(out, "weights {}\nprovenance {}", text("weights_hash"), text("provenance"))?;
        }
        for (word, key) in [("warning", "warnings"), ("note", "notes")] {
            for line in told[key].as_array().into_iter().flatten() {
                writeln!(out, "{word}: {}", line.as_str().unwrap_or_default())?;
            }
        }
        Ok(())
    }
}

/// A course as a panel of a figure.
fn panel(series: &Series, course: Course, curves: &[Curves]) -> CoursePanel {
    let lines = series.lines(course, curves).into_iter();
    let lines = lines.map(|(name, values)| (name.to_owned(), values)).collect();
    CoursePanel { label: course.label().to_owned(), lines }
}

/// A finding with the option that changes it.
pub(super) fn words(finding: Finding) -> String {
    let option = match finding {
        Finding::NearMaximum { .. } => " (--heart steady settles)",
        Finding::OverLimit { .. } => " (--rate)",
        Finding::OtherUnit { .. } => " (--unit)",
        Finding::CutFrames { .. } | Finding::Repeated { .. } | Finding::Jitter { .. } => "",
    };
    format!("{finding}{option}")
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// Parts without the names of files: where a file lies changes nothing.
fn parts_without_files(parts: &[Value]) -> Value {
    let mut parts = parts.to_vec();
    for part in &mut parts {
        if let Value::Object(members) = part {
            members.remove("file");
        }
    }
    Value::Array(parts)
}
