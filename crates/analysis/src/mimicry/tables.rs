//! The tables that the section on mimicry is made of: participants' faces (`mimique export --format tracks`), and the courses
//! of the clips (`mimique export --courses`).

use std::collections::BTreeMap;

use mimique_stats::Table;
use mimique_study::TRACKED_SHAPES;

use crate::trials::error::MimicryError;

/// Times in seconds and a value of each shape, none where there is none.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Samples {
    pub times_s: Vec<f64>,
    /// By the shapes that move, in their order.
    pub values: Vec<Vec<Option<f64>>>,
}

impl Default for Samples {
    /// No time yet; a column for each shape.
    fn default() -> Self {
        Self { times_s: Vec::new(), values: vec![Vec::new(); shapes().count()] }
    }
}

impl Samples {
    /// Times and values of a shape.
    pub fn of(&self, shape: usize) -> Vec<(f64, Option<f64>)> {
        self.times_s.iter().copied().zip(self.values[shape].iter().copied()).collect()
    }
}

/// The shapes that are held against each other: all that are measured but the score of a face at rest.
pub(crate) fn shapes() -> impl Iterator<Item = &'static str> {
    TRACKED_SHAPES.into_iter().skip(1)
}

/// One whole play of a clip by itself.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TrackedPlay {
    pub participant: String,
    pub stimulus: String,
    pub provenance: String,
    pub samples: Samples,
}

/// What was measured of faces, and how the clips move.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct FaceTables {
    /// The first whole play of each trial.
    pub plays: Vec<TrackedPlay>,
    /// By stimulus and provenance.
    pub clips: BTreeMap<(String, String), Samples>,
}

impl FaceTables {
    /// Reads both tables. Practice, plays that do not count, and clips beside others are left out.
    pub(crate) fn read(tracks: &Table, courses: &Table) -> Result<Self, MimicryError> {
        Ok(Self { plays: read_tracks(tracks)?, clips: read_courses(courses)? })
    }
}

/// Cells of a table by its columns' names.
struct Cells<'t> {
    table: &'t Table,
    which: &'static str,
    shapes: Vec<usize>,
    time: usize,
}

impl<'t> Cells<'t> {
    fn new(table: &'t Table, which: &'static str) -> Result<Self, MimicryError> {
        let place = |name| place(table, which, name);
        let shapes = shapes().map(place).collect::<Result<_, _>>()?;
        Ok(Self { table, which, shapes, time: place("time_ms")? })
    }

    fn text(&self, row: usize, place: usize) -> &'t str {
        self.table.cell(row, place).unwrap_or_default()
    }

    fn number(&self, row: usize, place: usize) -> Result<Option<f64>, MimicryError> {
        let Some(cell) = self.table.cell(row, place) else { return Ok(None) };
        let number = cell.trim().parse::<f64>().ok().filter(|number| number.is_finite());
        number.map(Some).ok_or_else(|| MimicryError::NotANumber {
            table: self.which,
            column: self.table.names()[place].clone(),
            line: self.table.line(row),
            cell: cell.to_owned(),
        })
    }

    /// Adds the row's time and values.
    fn add(&self, row: usize, to: &mut Samples) -> Result<(), MimicryError> {
        let time_ms = self.number(row, self.time)?.unwrap_or(f64::NAN);
        if !time_ms.is_finite() || to.times_s.last().is_some_and(|last| time_ms / 1e3 <= *last) {
            let line = self.table.line(row);
            return Err(MimicryError::Time { table: self.which, line });
        }
        to.times_s.push(time_ms / 1e3);
        for (values, &place) in to.values.iter_mut().zip(&self.shapes) {
            values.push(self.number(row, place)?);
        }
        Ok(())
    }
}

fn place(table: &Table, which: &'static str, name: &str) -> Result<usize, MimicryError> {
    let missing = |_| MimicryError::NoColumn { table: which, column: name.to_owned() };
    table.position(name).map_err(missing)
}

fn read_tracks(table: &Table) -> Result<Vec<TrackedPlay>, MimicryError> {
    const WHICH: &str = "tracks";
    let cells = Cells::new(table, WHICH)?;
    let at = |name| place(table, WHICH, name);
    let (participant, trial, stimulus) = (at("participant_id")?, at("trial_id")?, at("stimulus")?);
    let (beside, provenance) = (at("beside")?, at("provenance")?);
    let (play, whole) = (at("play")?, at("whole")?);
    let mut plays: Vec<TrackedPlay> = Vec::new();
    // The play that the row before belongs to, and the first whole play of each trial.
    let mut first: BTreeMap<(&str, &str), (&str, usize)> = BTreeMap::new();
    for row in 0..table.rows() {
        let own = (cells.text(row, participant), cells.text(row, trial));
        let counts = cells.text(row, whole) == "true"
            && cells.text(row, beside).is_empty()
            && !own.1.starts_with("training/");
        if !counts {
            continue;
        }
        let number = cells.text(row, play);
        let (known, index) = *first.entry(own).or_insert((number, plays.len()));
        if known != number {
            continue;
        }
        if index == plays.len() {
            plays.push(TrackedPlay {
                participant: own.0.to_owned(),
                stimulus: cells.text(row, stimulus).to_owned(),
                provenance: cells.text(row, provenance).to_owned(),
                samples: Samples::default(),
            });
        }
        cells.add(row, &mut plays[index].samples)?;
    }
    Ok(plays)
}

fn read_courses(table: &Table) -> Result<BTreeMap<(String, String), Samples>, MimicryError> {
    const WHICH: &str = "courses";
    let cells = Cells::new(table, WHICH)?;
    let at = |name| place(table, WHICH, name);
    let (stimulus, provenance) = (at("stimulus")?, at("provenance")?);
    let mut clips: BTreeMap<(String, String), Samples> = BTreeMap::new();
    for row in 0..table.rows() {
        let key = [stimulus, provenance].map(|place| cells.text(row, place).to_owned());
        let [stimulus, provenance] = key;
        let own = clips.entry((stimulus, provenance)).or_default();
        cells.add(row, own)?;
    }
    Ok(clips)
}
