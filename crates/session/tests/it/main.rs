//! The integration tests of `mimique-session`, in one binary.

mod adaptive;
mod admission;
mod best_worst;
mod checked_studies;
mod conditions;
mod conduct;
mod faces;
mod flow;
mod hostile;
mod key_presses;
mod mimicry;
mod panels;
mod recruitment_docs;
mod responses;
mod scales;
mod seen;
mod side_by_side;
mod signs;
mod sound;
mod standing;
mod stored_text;
mod support;
mod thesis_studies;
