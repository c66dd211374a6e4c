//! Exports whose answers are made by a test.

use mimique_study::Study;

use crate::support::{Raters, export};

/// The export of people who met every clip `times` times and answer anew each time; who has not finished is left out.
pub fn export_of_passes(study: &Study, people: usize, times: usize) -> String {
    let pass = |time: usize| {
        export(study, &Raters { people: people + 1, effect: 0.0, seed: 9 + time as u64 })
    };
    let passes: Vec<String> = (0..times).map(pass).collect();
    let mut text = passes[0].lines().next().unwrap().to_owned() + "\n";
    for person in 1..=people {
        for (time, csv) in passes.iter().enumerate() {
            let id = format!("p{person:04},");
            for line in csv.lines().filter(|line| line.starts_with(&id)) {
                text += &line.replace(",faces/", &format!(",faces/{time}-"));
                text.push('\n');
            }
        }
    }
    text
}

/// The same export with other answers to a question; `answer` is told the cells of a row by the names of their columns.
pub fn answered(
    csv: &str,
    question: &str,
    mut answer: impl FnMut(&dyn Fn(&str) -> String) -> String,
) -> String {
    let mut lines = csv.lines();
    let heading = lines.next().unwrap();
    let names: Vec<&str> = heading.split(',').collect();
    let place = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let [asked, given, response, truth, correct] =
        ["response_id", "answer", "response", "truth", "correct"].map(place);
    let mut text = heading.to_owned() + "\n";
    for line in lines {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if cells[asked] == question {
            let own = answer(&|name| cells[place(name)].clone());
            if !cells[truth].is_empty() {
                cells[correct] = (own == cells[truth]).to_string();
            }
            (cells[given], cells[response]) = (own.clone(), own);
        }
        text += &cells.join(",");
        text.push('\n');
    }
    text
}

/// The same export with other cells in a column, where `change` returns one.
pub fn cells_changed(
    csv: &str,
    column: &str,
    change: impl Fn(&dyn Fn(&str) -> String) -> Option<String>,
) -> String {
    let mut lines = csv.lines();
    let heading = lines.next().unwrap();
    let names: Vec<&str> = heading.split(',').collect();
    let place = |name: &str| names.iter().position(|own| *own == name).unwrap();
    let changed = place(column);
    let mut text = heading.to_owned() + "\n";
    for line in lines {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Some(own) = change(&|name| cells[place(name)].clone()) {
            cells[changed] = own;
        }
        text += &cells.join(",");
        text.push('\n');
    }
    text
}
