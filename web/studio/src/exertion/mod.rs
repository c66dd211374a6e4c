//! A face that shows what the body does: a motion or a recording, a person and a window in; courses, the body and
//! the face out. What the page changes is computed anew from the beginning, a motion's work only where motion,
//! stature, mass or loads are others.

mod bindings;
mod saved;
mod settings;
mod source;

use mimique_exertion::{
    Clip, Expression, ExpressionModel, FRAMES_PER_SECOND, Face, Figure, Finding, Person, Plan,
    Series, Start, Window,
};
use mimique_stimulus::{Drawn, ExertionDrawing};
use serde_json::{Value, json};

use crate::problem::Problem;
use crate::workspace::Workspace;
use settings::{ModelChoice, Refused, Settings};
use source::{Moved, OpenedFile, Worked};

/// The slot of the face's weights.
pub(crate) const SLOT: &str = "exertion";
/// The longest window, s: what a browser holds of weights and pictures.
const LONGEST_WINDOW_S: f64 = 600.0;

/// What was opened for exertion, and what was computed last.
#[derive(Debug, Default)]
pub(crate) struct ExertionDesk {
    file: Option<OpenedFile>,
    model: Option<(String, ExpressionModel)>,
    moved: Moved,
    made: Option<Made>,
}

/// What was computed.
#[derive(Debug)]
struct Made {
    settings: Settings,
    name: String,
    person: Person,
    expression: Expression,
    series: Series,
    clip: Clip,
}

impl ExertionDesk {
    /// Another capture lies on the workspace.
    pub(crate) fn take_changed(&mut self) {
        self.moved.forget();
    }
}

impl Workspace {
    /// Takes a motion (BVH, or any capture with a body's joints) or a recorded activity (CSV, FIT, TCX, GPX) from a
    /// file.
    ///
    /// # Errors
    /// [`Problem`] with the file's name. Whether it has joints is said by [`Self::exertion`].
    pub fn exertion_file(
        &mut self,
        file: &str,
        bytes: &[u8],
        unit: Option<&str>,
        rate_hz: Option<f64>,
    ) -> Result<Value, Problem> {
        let opened = OpenedFile::read(file, bytes, unit, rate_hz)?;
        let facts = json!({
            "file": file, "hasHeart": opened.has_heart(), "isActivity": opened.activity().is_some(),
            // Whole seconds are computed.
            "spanS": opened.activity().and_then(|own| own.time_s.last()).map(|last| last.floor()),
        });
        self.exertion.moved.forget();
        self.exertion.file = Some(opened);
        Ok(facts)
    }

    /// Takes a model that `mimique exertion train` wrote.
    ///
    /// # Errors
    /// [`Problem`] with the file's name.
    pub fn exertion_model(&mut self, file: &str, model: &str) -> Result<Value, Problem> {
        let model = ExpressionModel::of_text(model).map_err(|e| Problem::of(file, e))?;
        self.exertion.model = Some((file.to_owned(), model));
        Ok(json!({"file": file}))
    }

    /// Computes an exertion as the page sets it (JSON) and lays its face, where there is an avatar, into the slot
    /// `exertion`. Answers what is drawn and said of it, or `{"problem": {"place", "text"}}`: which input is wrong.
    ///
    /// # Errors
    /// [`Problem`]: the settings are none of the page's.
    pub fn exertion(&mut self, settings: &str) -> Result<Value, Problem> {
        let settings = Settings::of(settings)?;
        self.exertion.made = None;
        self.forget(SLOT);
        Ok(self.exerted(settings).unwrap_or_else(|refused| refused.json()))
    }

    fn exerted(&mut self, settings: Settings) -> Result<Value, Refused> {
        let person = settings.person()?;
        let expression = self.expression(settings.model)?;
        let window = window(&settings)?;
        let Worked { name, part, findings, notes, span_s, is_repeated } =
            self.worked(settings.source, &person, settings.seconds)?;
        let refused = |error: mimique_exertion::ExertionError| Refused::plan(&name, &error);
        let plan = Plan::of(part).map_err(refused)?;
        let series = Series::of(&person, &plan, settings.heart.heart(), Start::default())
            .map_err(refused)?;
        let face = Face {
            expression,
            breathing: settings.breath,
            skin: settings.skin,
            seed: settings.seed,
            ..Face::default()
        };
        let clip = Clip::of(&person, &plan, &series, &window, &face).map_err(refused)?;
        let figure = (self.body_motion(settings.source))
            .map(|motion| Figure::of(&motion.body, window.seconds, is_repeated));
        let expression = face.expression;
        let drawing = ExertionDrawing::of(Drawn {
            person: &person,
            expression: &expression,
            series: &series,
            clip: &clip,
            frames: 0..clip.times.len(),
            span_s: plan.span_s(),
            figure,
        });
        let findings: Vec<Finding> =
            Finding::of_clip(&series, &clip).into_iter().chain(findings).collect();
        let found = |warning: bool| -> Vec<Value> {
            findings.iter().filter(|f| f.is_warning() == warning).map(|f| told(*f)).collect()
        };
        let facts = json!({
            "name": name, "sourceSpanS": span_s, "drawing": drawing, "person": of(&person),
            "end": end(&series, &clip), "warnings": found(true),
            "notes": notes, "remarks": found(false),
            "face": self.faced(&clip)?,
        });
        self.exertion.made = Some(Made { settings, name, person, expression, series, clip });
        Ok(facts)
    }

    /// Lays the face's weights into their slot; null where there is no avatar yet.
    fn faced(&mut self, clip: &Clip) -> Result<Value, Refused> {
        if self.face.is_none() {
            return Ok(Value::Null);
        }
        self.put_recorded(SLOT, &clip.table()).map_err(|problem| Refused::at("avatar", problem))
    }

    fn expression(&self, choice: ModelChoice) -> Result<Expression, Refused> {
        Ok(match choice {
            ModelChoice::Rules => Expression::Rules,
            ModelChoice::Linear => Expression::Linear,
            ModelChoice::File => {
                let none = || Refused::at("model", "no model file yet; open one");
                let (_, model) = self.exertion.model.as_ref().ok_or_else(none)?;
                Expression::Model(Box::new(model.clone()))
            }
        })
    }
}

fn window(settings: &Settings) -> Result<Window, Refused> {
    let [from, to] = settings.window;
    if to - from > LONGEST_WINDOW_S {
        let what = format!(
            "{from} to {to} s; at most {LONGEST_WINDOW_S} s are shown here, `mimique exertion` computes any window"
        );
        return Err(Refused::at("window", what));
    }
    Ok(Window { seconds: [from, to], rate_hz: FRAMES_PER_SECOND })
}

/// What follows of the person.
fn of(person: &Person) -> Value {
    json!({
        "heartRest": person.hr_rest(), "heartMost": person.hr_max(), "vo2Max": person.vo2_max(),
    })
}

/// How body and face are at the window's end.
fn end(series: &Series, clip: &Clip) -> Value {
    let second = clip.times.last().map_or(0, |t| t.round() as usize).min(series.seconds() - 1);
    let curves = clip.curves.last().copied().unwrap_or_default().to_array();
    json!({
        "second": second, "heartRate": series.heart_rate[second], "rcn": series.rcn[second],
        "breaths": series.metabolism.breaths[second], "epoc": series.metabolism.epoc[second],
        "borg": series.metabolism.borg[second], "curves": curves,
    })
}

/// A finding for the page: its code and values, and as `text` its sentence in English with the page's own remedy.
fn told(finding: Finding) -> Value {
    let remedy = match finding {
        Finding::NearMaximum { .. } => " (the heart by steady settles)",
        Finding::OverLimit { .. } => " (frames a second, where the capture is opened)",
        Finding::OtherUnit { .. } => " (unit, where the capture is opened)",
        Finding::CutFrames { .. } => " (expressivity)",
        Finding::Repeated { .. } | Finding::Jitter { .. } => "",
    };
    let mut told = json!(finding);
    told["text"] = json!(format!("{finding}{remedy}"));
    told
}
