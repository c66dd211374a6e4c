//! What is learnt from: rows of a body's state beside the curves of a face, of several people.

use mimique_exertion::{
    Control, Curves, Feature, Features, Heart, Person, Plan, Series, ShapeTable, Start,
};
use mimique_mocap::WeightsTable;

use crate::TrainingError;
use crate::regression::ROWS;

/// One recording of somebody: what the body did, and the face beside it. Both begin in the same instant.
#[derive(Debug, Clone, PartialEq)]
pub struct LessonTake {
    /// Who it is: takes of one person have the same name.
    pub who: String,
    /// The same person in numbers.
    pub person: Person,
    /// What the body did, with the heart that was recorded.
    pub plan: Plan,
    /// The face's weights, by names of a table's shapes.
    pub weights: WeightsTable,
}

/// Rows and targets of all takes, one after the other.
#[derive(Debug, Clone, PartialEq)]
pub struct Lesson {
    /// What a row holds.
    pub features: Vec<Feature>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
    /// The curves in the order of [`Curves::NAMES`], per cent of the person's own maximum, a number a row.
    pub targets: [Vec<f64>; 4],
    /// The people, in the order in which they first appear.
    pub people: Vec<Pupil>,
    /// Whose each row is: a place in `people`.
    pub of_person: Vec<usize>,
}

/// A person that is learnt from.
#[derive(Debug, Clone, PartialEq)]
pub struct Pupil {
    /// Who it is.
    pub who: String,
    /// The largest value of each curve, in the order of [`Curves::NAMES`], 1 a whole control: the person's
    /// expressivity (thesis 3.3.2).
    pub expressivity: [f64; 4],
    /// Rows.
    pub rows: usize,
}

impl Lesson {
    /// Of takes, a row every so many seconds: features at that time, curves as the mean of the face over the
    /// time since the row before and until the next. A person's largest value of a curve becomes 100 %.
    ///
    /// # Errors
    /// [`TrainingError`]: a plan that cannot be computed, too few or too many rows, a curve that never moves
    /// in the takes of a person.
    pub fn of(
        takes: &[LessonTake],
        features: &[Feature],
        shapes: &ShapeTable,
        every_s: f64,
    ) -> Result<Self, TrainingError> {
        if !(every_s > 0.0 && every_s.is_finite()) {
            let (setting, range) = ("every", "of seconds above 0");
            return Err(TrainingError::Setting { setting, value: every_s, range });
        }
        let mut lesson = Self {
            features: features.to_vec(),
            rows: Vec::new(),
            targets: Default::default(),
            people: Vec::new(),
            of_person: Vec::new(),
        };
        for take in takes {
            lesson.add(take, shapes, every_s)?;
        }
        let (found, [least, most]) = (lesson.rows.len(), ROWS);
        if !(least..=most).contains(&found) {
            return Err(TrainingError::Rows { found, least, most });
        }
        lesson.divide_by_own_maximum()?;
        Ok(lesson)
    }

    fn add(
        &mut self,
        take: &LessonTake,
        shapes: &ShapeTable,
        every_s: f64,
    ) -> Result<(), TrainingError> {
        let series = Series::of(&take.person, &take.plan, Heart::default(), Start::default())?;
        let of_person = match self.people.iter().position(|pupil| pupil.who == take.who) {
            Some(place) => place,
            None => {
                let (who, expressivity) = (take.who.clone(), [0.0; 4]);
                self.people.push(Pupil { who, expressivity, rows: 0 });
                self.people.len() - 1
            }
        };
        let face = Face::of(&take.weights, shapes);
        let end = take.plan.span_s().min(face.span_s);
        // The body's state is of the last second.
        for row in 1.. {
            let t = every_s * f64::from(row);
            if t + 0.5 * every_s > end || self.rows.len() > ROWS[1] {
                break;
            }
            if t < 1.0 {
                continue;
            }
            let Some(curves) = face.mean(t - 0.5 * every_s, t + 0.5 * every_s) else { continue };
            let state = Features {
                w: take.plan.w(t),
                p: take.plan.p(t),
                rcn: at(&series.rcn, t),
                epoc: at(&series.metabolism.epoc, t),
            };
            self.rows.push(self.features.iter().map(|feature| feature.of(&state)).collect());
            for (own, curve) in self.targets.iter_mut().zip(curves) {
                own.push(curve);
            }
            self.of_person.push(of_person);
            self.people[of_person].rows += 1;
        }
        Ok(())
    }

    /// Divides every curve by the person's largest value, and makes per cent of it.
    fn divide_by_own_maximum(&mut self) -> Result<(), TrainingError> {
        for (curve, own) in self.targets.iter_mut().enumerate() {
            for (value, &person) in own.iter().zip(&self.of_person) {
                let most = &mut self.people[person].expressivity[curve];
                *most = most.max(value.abs());
            }
            for pupil in &self.people {
                // Less than a hundredth of a control is the noise of a face at rest.
                if pupil.rows > 0 && pupil.expressivity[curve] < 0.01 {
                    let (person, curve) = (pupil.who.clone(), Curves::NAMES[curve]);
                    return Err(TrainingError::Still { person, curve });
                }
            }
            for (value, &person) in own.iter_mut().zip(&self.of_person) {
                *value *= 100.0 / self.people[person].expressivity[curve];
            }
        }
        Ok(())
    }

    /// Every n-th row, so that at most so many are left.
    pub fn thinned(&self, most: usize) -> Self {
        let step = self.rows.len().div_ceil(most.max(1)).max(1);
        let of = |values: &Vec<f64>| -> Vec<f64> { values.iter().step_by(step).copied().collect() };
        Self {
            features: self.features.clone(),
            rows: self.rows.iter().step_by(step).cloned().collect(),
            targets: [0, 1, 2, 3].map(|curve| of(&self.targets[curve])),
            people: self.people.clone(),
            of_person: self.of_person.iter().step_by(step).copied().collect(),
        }
    }
}

/// Values of seconds at a time, straight between.
fn at(seconds: &[f64], t: f64) -> f64 {
    let last = seconds.len() - 1;
    let low = (t.floor() as usize).min(last);
    let (from, to) = (seconds[low], seconds[(low + 1).min(last)]);
    from + (t - low as f64).clamp(0.0, 1.0) * (to - from)
}

/// The curves of a recorded face, frame by frame.
struct Face {
    times: Vec<f64>,
    curves: Vec<[f64; 4]>,
    span_s: f64,
}

impl Face {
    /// Of weights: each curve is what of its control stands in the shapes.
    fn of(weights: &WeightsTable, shapes: &ShapeTable) -> Self {
        let begin = weights.times.first().copied().unwrap_or(0.0);
        let times: Vec<f64> = weights.times.iter().map(|t| t - begin).collect();
        let names = &weights.shape_names;
        let place = |name: &str| names.iter().position(|own| own.eq_ignore_ascii_case(name));
        let curves = (0..times.len()).map(|row| {
            let row = weights.row(row);
            let weight = |name: &str| place(name).map_or(0.0, |place| row[place]);
            let of = |control: Control| shapes.control_of(control, weight);
            [
                of(Control::MouthOpen),
                of(Control::MouthStretch),
                of(Control::Eyes),
                of(Control::BrowsDown) - of(Control::BrowsUp),
            ]
        });
        Self { curves: curves.collect(), span_s: times.last().copied().unwrap_or(0.0), times }
    }

    /// The mean over some time; `None` where no frame lies in it.
    fn mean(&self, from: f64, to: f64) -> Option<[f64; 4]> {
        let first = self.times.partition_point(|t| *t < from);
        let end = self.times.partition_point(|t| *t < to);
        let own = self.curves.get(first..end).filter(|own| !own.is_empty())?;
        let mean = |k: usize| own.iter().map(|curves| curves[k]).sum::<f64>() / own.len() as f64;
        Some([0, 1, 2, 3].map(mean))
    }
}
