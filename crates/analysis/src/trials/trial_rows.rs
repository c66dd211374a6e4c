//! The rows of the tidy export that are trials: trials with their answers, several stretches of the
//! file at the same time.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;
use std::sync::Arc;

use mimique_stats::Table;
use mimique_study::{Clip, Exclusions, ShownCourse, Study, component_of};

use crate::trials::column::Column;
use crate::trials::error::ExportError;
use crate::trials::export::{
    Answer, Beside, ExcludedTrial, Export, Person, ShownFace, ShownLevel, Trial, why_left_out,
};
use crate::trials::reason::Reason;

/// Stretches that a file is cut into: more than there are cores, so that none waits long.
const STRETCHES: usize = 16;

/// The columns that say what was shown and answered.
pub(crate) struct TrialReader<'t> {
    rules: Exclusions,
    people: &'t [Person],
    person_of_row: &'t [usize],
    kind: Column<'t>,
    trial_id: Column<'t>,
    /// Tells the clips of a panel apart.
    panel_place: Column<'t>,
    rt: Column<'t>,
    rt_open: Column<'t>,
    stimulus: Column<'t>,
    beside: Column<'t>,
    beside_side: Column<'t>,
    track: Column<'t>,
    level: Column<'t>,
    level_catch: Column<'t>,
    level_replayed: Column<'t>,
    trajectories: Column<'t>,
    weights_expected: Column<'t>,
    scaled_levels: Column<'t>,
    order: Column<'t>,
    frames: Column<'t>,
    late: Column<'t>,
    longest: Column<'t>,
    sound: Column<'t>,
    sound_offset: Column<'t>,
    sound_delay: Column<'t>,
    response: Column<'t>,
    answer: Column<'t>,
    correct: Column<'t>,
    truth: Column<'t>,
    trace: Column<'t>,
    levels: Vec<Column<'t>>,
    /// Levels of each clip of the study, by its identifier: the rows have those of the trial's own clip alone.
    of_clips: HashMap<String, Vec<Option<Arc<str>>>>,
    /// Segment of each clip of the study.
    segments: HashMap<String, Arc<str>>,
}

/// What tells a trial.
type TrialKey<'t> = (usize, &'t str, Option<&'t str>);

/// Where a trial is stored.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// In [`TrialRows::trials`].
    Used(usize),
    /// In [`TrialRows::excluded`].
    Excluded(usize),
    /// Nowhere: its participant is excluded.
    OfExcludedPerson,
}

/// What a stretch of rows holds.
#[derive(Default)]
pub(crate) struct TrialRows {
    /// The person of each trial, of those left out too.
    pub person_of_trial: Vec<usize>,
    /// Trials of people who are used.
    pub considered: usize,
    /// Those left out, by reason.
    pub left_out: BTreeMap<Reason, usize>,
    /// Rows of trials that name no trial or no response: they are in no trial.
    pub unread: usize,
    /// Those left out themselves.
    pub excluded: Vec<ExcludedTrial>,
    /// Trials used.
    pub trials: Vec<Trial>,
    /// Their answers, a trial being its place in `trials`.
    pub answers: BTreeMap<String, Vec<Answer>>,
}

/// Rows in stretches that keep each person's together; one stretch where a person's rows do not follow
/// each other.
pub(crate) fn stretches(person_of_row: &[usize]) -> Vec<Range<usize>> {
    let rows = person_of_row.len();
    if !person_of_row.is_sorted() {
        return std::iter::once(0..rows).collect();
    }
    let mut ends: Vec<usize> = (1..=STRETCHES)
        .map(|stretch| {
            let end = stretch * rows / STRETCHES;
            let next = |last: usize| person_of_row.partition_point(|&person| person <= last);
            person_of_row[..end].last().map_or(0, |&last| next(last))
        })
        .collect();
    ends.dedup();
    ends.retain(|&end| end > 0);
    let starts = std::iter::once(0).chain(ends.iter().copied());
    starts.zip(ends.iter().copied()).map(|(start, end)| start..end).collect()
}

impl<'t> TrialReader<'t> {
    /// `export` has its people and factors.
    pub(crate) fn new(
        table: &'t Table,
        study: &Study,
        export: &'t Export,
        person_of_row: &'t [usize],
    ) -> Self {
        let column = |name: &str| Column::of(table, name);
        Self {
            rules: study.exclusions.clone().unwrap_or_default(),
            people: &export.people,
            person_of_row,
            kind: column("trial_type"),
            trial_id: column("trial_id"),
            panel_place: column("panel_place"),
            rt: column("rt"),
            rt_open: column("rt_open"),
            stimulus: column("stimulus"),
            beside: column("beside"),
            beside_side: column("beside_side"),
            track: column("track"),
            level: column("level"),
            level_catch: column("level_catch"),
            level_replayed: column("level_replayed"),
            trajectories: column("trajectories"),
            weights_expected: column("weights_expected"),
            scaled_levels: column("scaled_levels"),
            order: column("trial_order"),
            frames: column("frames"),
            late: column("frames_late"),
            longest: column("frame_longest_ms"),
            sound: column("sound_status"),
            sound_offset: column("sound_offset_ms"),
            sound_delay: column("sound_delay_ms"),
            response: column("response_id"),
            answer: column("answer"),
            correct: column("correct"),
            truth: column("truth"),
            trace: column("trace"),
            levels: export.factors.iter().map(|factor| column(factor)).collect(),
            of_clips: levels_of_clips(study, &export.factors),
            segments: segments_of_clips(study),
        }
    }

    /// Reads a stretch that has all rows of its people.
    pub(crate) fn read(&self, rows: Range<usize>) -> Result<TrialRows, ExportError> {
        // A trial is left out for its first reason; the quickest answer decides for all of it.
        let mut quickest: HashMap<TrialKey<'_>, f64> = HashMap::new();
        for row in rows.clone() {
            // Exports of before there was that column have the time from the onset alone.
            let open = self.rt_open.number(row)?;
            let rt = if self.rt_open.is_there() { open } else { self.rt.number(row)? };
            if let (Some("trial"), Some(trial), Some(rt)) =
                (self.kind.text(row), self.trial_id.text(row), rt)
                && self.rules.shortest_rt_ms.is_some()
            {
                let least = quickest.entry(self.key(row, trial)).or_insert(rt);
                *least = least.min(rt);
            }
        }
        let mut read = TrialRows::default();
        let mut texts = Texts::default();
        let mut seen: HashMap<TrialKey<'_>, Place> = HashMap::new();
        // Rows of one trial mostly follow each other.
        let mut last: Option<(TrialKey<'_>, Place)> = None;
        for row in rows {
            if self.kind.text(row) != Some("trial") {
                continue;
            }
            let (Some(id), Some(question)) = (self.trial_id.text(row), self.response.text(row))
            else {
                read.unread += 1;
                continue;
            };
            let person = self.person_of_row[row];
            let key = self.key(row, id);
            let same = last.filter(|(known, _)| *known == key).map(|(_, trial)| trial);
            let trial = match same.or_else(|| seen.get(&key).copied()) {
                Some(trial) => trial,
                None => {
                    let trial = self.trial(row, &mut texts)?;
                    let place = read.place(self, person, trial, quickest.get(&key).copied());
                    seen.insert(key, place);
                    place
                }
            };
            last = Some((key, trial));
            let Some(text) = self.answer.text(row) else { continue };
            if let Place::Excluded(place) = trial {
                read.excluded[place].questions.push(question.to_owned());
            }
            if let Place::Used(trial) = trial {
                let answer = Answer {
                    person,
                    text: texts.shared(text),
                    number: text.parse().ok().filter(|number: &f64| number.is_finite()),
                    correct: match self.correct.text(row) {
                        Some("true") => Some(true),
                        Some("false") => Some(false),
                        _ => None,
                    },
                    truth: self.truth.text(row).map(|truth| texts.shared(truth)),
                    rt_ms: self.rt.number(row)?,
                    trial,
                    trace: self.course(row),
                };
                match read.answers.get_mut(question) {
                    Some(answers) => answers.push(answer),
                    None => {
                        read.answers.insert(question.to_owned(), vec![answer]);
                    }
                }
            }
        }
        Ok(read)
    }

    /// What tells a trial: its person, its identifier, and of a panel the place of its clip.
    fn key(&self, row: usize, trial: &'t str) -> TrialKey<'t> {
        (self.person_of_row[row], trial, self.panel_place.text(row))
    }

    /// Where a rating that followed the clip stood; none of others, and of a cell that is no list of numbers.
    fn course(&self, row: usize) -> Option<Arc<[f32]>> {
        let course: Vec<f32> = serde_json::from_str(self.trace.text(row)?).ok()?;
        Some(course.into())
    }

    /// How far a clip's sound was from its time; infinitely far where it was not played, none of a clip without.
    fn sound_off(&self, row: usize) -> Result<Option<f64>, ExportError> {
        let Some(status) = self.sound.text(row) else { return Ok(None) };
        let offset = self.sound_offset.number(row)?.filter(|_| status == "played");
        let asked = self.sound_delay.number(row)?.unwrap_or_default();
        Ok(Some(offset.map_or(f64::INFINITY, |offset| (offset - asked).abs())))
    }

    /// The level of a trial of an adaptive block.
    fn shown_level(
        &self,
        row: usize,
        texts: &mut Texts<'t>,
    ) -> Result<Option<ShownLevel>, ExportError> {
        // Without a track "level" may be a factor of the study's own.
        let Some(track) = self.track.number(row)? else { return Ok(None) };
        let Some(level) = self.level.number(row)? else { return Ok(None) };
        let component = self.trial_id.text(row).map_or("", component_of);
        Ok(Some(ShownLevel {
            block: texts.shared(component),
            track: track as usize,
            level,
            catch: self.level_catch.text(row) == Some("true"),
            replayed: self.level_replayed.text(row) != Some("false"),
        }))
    }

    /// The face of a trial of a block of reverse correlation; none of others, and of a cell that is no list of courses.
    fn shown_face(&self, row: usize, texts: &mut Texts<'t>) -> Option<ShownFace> {
        let courses: Vec<ShownCourse> = serde_json::from_str(self.trajectories.text(row)?).ok()?;
        let component = self.trial_id.text(row).map_or("", component_of);
        Some(ShownFace {
            block: texts.shared(component),
            courses: courses.into(),
            replayed: self.weights_expected.text(row) != Some("false"),
        })
    }

    /// The levels of a judgement of differences; none of other trials, and of a cell that is no list of numbers.
    fn scaled(&self, row: usize, texts: &mut Texts<'t>) -> Option<(Arc<str>, Arc<[f64]>)> {
        let levels: Vec<f64> = serde_json::from_str(self.scaled_levels.text(row)?).ok()?;
        let component = self.trial_id.text(row).map_or("", component_of);
        Some((texts.shared(component), levels.into()))
    }

    fn trial(&self, row: usize, texts: &mut Texts<'t>) -> Result<Trial, ExportError> {
        let shown = self.shown_level(row, texts)?;
        let face = self.shown_face(row, texts);
        let scaled = self.scaled(row, texts);
        let mut level = |own: &Column<'t>| own.text(row).map(|level| texts.shared(level));
        let stimulus = self.stimulus.text(row).unwrap_or_default();
        let left = self.beside_side.text(row) == Some("left");
        Ok(Trial {
            levels: self.levels.iter().map(&mut level).collect(),
            beside: level(&self.beside).map(|clip| Beside {
                levels: self.levels_of(&clip),
                clip,
                left,
            }),
            stimulus: texts.shared(stimulus),
            segment: self.segments.get(stimulus).cloned(),
            level: shown,
            face,
            scaled,
            order: self.order.number(row)?.map(|order| order as usize),
            frames: self.frames.number(row)?,
            late: self.late.number(row)?,
            longest_ms: self.longest.number(row)?,
            sound_off_ms: self.sound_off(row)?,
        })
    }
}

impl TrialReader<'_> {
    fn levels_of(&self, clip: &str) -> Vec<Option<Arc<str>>> {
        self.of_clips.get(clip).cloned().unwrap_or_else(|| vec![None; self.levels.len()])
    }
}

/// The value of each factor of each clip.
fn levels_of_clips(study: &Study, factors: &[String]) -> HashMap<String, Vec<Option<Arc<str>>>> {
    let levels = |clip: &Clip| {
        factors.iter().map(|factor| clip.factor_text(factor).map(Arc::from)).collect()
    };
    let clips = study.clips().into_iter();
    clips.map(|clip| (clip.id.clone(), levels(&clip))).collect()
}

/// The segment of each clip, each kept once.
fn segments_of_clips(study: &Study) -> HashMap<String, Arc<str>> {
    let mut texts: HashMap<String, Arc<str>> = HashMap::new();
    let clips = study.clips().into_iter();
    let own = clips.map(|clip| {
        let text = texts.entry(clip.segment.clone()).or_insert_with(|| clip.segment.into());
        (clip.id, Arc::clone(text))
    });
    own.collect()
}

impl TrialRows {
    /// Counts a trial and stores it.
    fn place(
        &mut self,
        reader: &TrialReader<'_>,
        person: usize,
        trial: Trial,
        quickest_ms: Option<f64>,
    ) -> Place {
        self.person_of_trial.push(person);
        if reader.people[person].excluded.is_some() {
            return Place::OfExcludedPerson;
        }
        self.considered += 1;
        if let Some(reason) = why_left_out(&reader.rules, &trial, quickest_ms) {
            *self.left_out.entry(reason).or_insert(0) += 1;
            self.excluded.push(ExcludedTrial { person, trial, questions: Vec::new() });
            return Place::Excluded(self.excluded.len() - 1);
        }
        self.trials.push(trial);
        Place::Used(self.trials.len() - 1)
    }
}

/// Texts that were met, each kept once.
#[derive(Default)]
struct Texts<'t>(HashMap<&'t str, Arc<str>>);

impl<'t> Texts<'t> {
    fn shared(&mut self, text: &'t str) -> Arc<str> {
        Arc::clone(self.0.entry(text).or_insert_with(|| Arc::from(text)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_keep_people_together_and_leave_no_row_out() {
        let together: Vec<usize> =
            (0..50).flat_map(|person| vec![person; 1 + person % 7]).collect();
        let found = stretches(&together);
        assert!(found.len() > 8);
        assert_eq!(found[0].start, 0);
        assert_eq!(found[found.len() - 1].end, together.len());
        for pair in found.windows(2) {
            assert_eq!(pair[0].end, pair[1].start);
            assert_ne!(together[pair[0].end - 1], together[pair[1].start]);
        }
        // One stretch: of people whose rows do not follow each other, and of one person.
        for rows in [&[0, 1, 0, 1][..], &[0, 0, 0]] {
            let found = stretches(rows);
            assert_eq!((found.len(), &found[0]), (1, &(0..rows.len())));
        }
    }
}
