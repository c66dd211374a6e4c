//! Whom ITU-R BS.1534-3, section 4.1.2, leaves out of a study's panels: computed for every panel with a hidden
//! reference, applied where the study file says so.

use mimique_stats::{Factor, Numbers, Panel, PanelOptions, PanelRatings, Table, panel};
use mimique_study::{PanelComponent, Study, component_of};
use serde::Serialize;

use crate::trials::column::Column;
use crate::trials::error::ExportError;
use crate::trials::export::{Flow, Person};
use crate::trials::reason::Reason;
use crate::trials::rule::Rule;

/// Whom the rule leaves out of a block of panels.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Screening {
    /// Name of the block.
    pub block: String,
    /// The question.
    pub response: String,
    /// Whether the people are left out, or only named.
    pub applied: bool,
    /// Each person, and what is left of the rest.
    pub found: Panel,
}

/// Screens the people who are not left out for another reason, page by page; those whom a rule that applies leaves
/// out are marked and counted.
pub(super) fn screen(
    table: &Table,
    study: &Study,
    person_of_row: &[usize],
    people: &mut [Person],
    flow: &mut Flow,
) -> Result<Vec<Screening>, ExportError> {
    let mut screened = Vec::new();
    for (name, block) in study.panel_blocks() {
        let rated = rated(table, (name, &block), person_of_row, people)?;
        screened.extend(rated.and_then(|ratings| {
            let reference = block.reference.as_ref()?;
            let options = PanelOptions::new(reference, block.anchor.clone());
            let found = panel(&ratings, &options).ok()?;
            let (response, applied) = (block.question.clone(), block.exclude.is_some());
            Some(Screening { block: name.to_owned(), response, applied, found })
        }));
        if block.exclude.is_some() {
            flow.rules.push(Rule::Bs1534(name.to_owned()));
        }
    }
    let out = screened.iter().filter(|it| it.applied).flat_map(|it| &it.found.people);
    for left_out in out.filter(|person| person.excluded) {
        let person = people.iter_mut().find(|person| person.id == left_out.participant);
        if let Some(person) = person.filter(|person| person.excluded.is_none()) {
            person.excluded = Some(Reason::Bs1534);
            *flow.people_left_out.entry(Reason::Bs1534).or_insert(0) += 1;
            flow.people_used -= 1;
        }
    }
    Ok(screened)
}

/// The ratings of a block, a page being a segment; none where there are no such ratings.
fn rated(
    table: &Table,
    (name, block): (&str, &PanelComponent),
    person_of_row: &[usize],
    people: &[Person],
) -> Result<Option<PanelRatings>, ExportError> {
    let column = |name: &str| Column::of(table, name);
    let (kind, trial, response) = (column("trial_type"), column("trial_id"), column("response_id"));
    let (condition, answer) = (column("panel_condition"), column("answer"));
    let mut values = Vec::new();
    let (mut persons, mut pages, mut conditions) = (Vec::new(), Vec::new(), Vec::new());
    for (row, &person) in person_of_row.iter().enumerate() {
        let of_block = kind.text(row) == Some("trial")
            && trial.text(row).is_some_and(|id| component_of(id) == name)
            && response.text(row) == Some(&block.question);
        if !of_block || people[person].excluded.is_some() {
            continue;
        }
        values.push(answer.number(row)?.unwrap_or(f64::NAN));
        persons.push(Some(people[person].id.as_str()));
        pages.push(trial.text(row));
        conditions.push(condition.text(row));
    }
    let factor = |name: &str, cells: Vec<Option<&str>>| {
        Factor::from_cells(name, cells.into_iter(), |_| None)
    };
    let ratings = Numbers { name: block.question.clone(), values };
    let factors = [
        factor("participant_id", persons),
        factor("trial_id", pages),
        factor("panel_condition", conditions),
    ];
    let [person, page, condition] = &factors;
    Ok(PanelRatings::of(&ratings, [person, page, condition]).ok())
}
