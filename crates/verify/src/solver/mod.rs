//! Cases of the solver: a toy with every matrix, the operators of a head, stored optima of every
//! variant from displacements and from captures.

mod captures;
mod frames;
mod head;
mod toy;
mod variants;

use std::path::Path;

use crate::{Case, Family, VerifyError};

/// Sixteen vertices and every matrix of them.
const TOY: &str = "toy.json";
/// D, H and their scales.
const OPERATORS: &str = "operators.json";
/// Constants of each variant.
const CONSTANTS: &str = "constants.json";
/// The displacements that the stored optima are of, and the optima.
const FRAMES: &str = "frames";

/// The family.
pub(crate) struct Solver;

impl Family for Solver {
    fn name(&self) -> &'static str {
        "solver"
    }

    fn holds(&self, folder: &Path) -> bool {
        [TOY, OPERATORS].iter().any(|file| folder.join(file).is_file())
            || folder.join(frames::DISPLACEMENTS).is_file()
    }

    fn run(&self, folder: &Path, each: &mut dyn FnMut(Case)) -> Result<(), VerifyError> {
        if folder.join(TOY).is_file() {
            each(toy::case(&folder.join(TOY))?);
        }
        let needs_head = [OPERATORS, frames::DISPLACEMENTS].map(|file| folder.join(file).is_file());
        if needs_head == [false, false] {
            return Ok(());
        }
        let mut head = head::Head::read(folder)?;
        if needs_head[0] {
            head::operators(&mut head, folder, each)?;
        }
        if needs_head[1] {
            let stored = frames::Stored::read(folder)?;
            frames::cases(&mut head, &stored, each)?;
            captures::cases(&mut head, &stored, folder, each)?;
        }
        Ok(())
    }
}
