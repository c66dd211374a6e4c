//! `mimique layout`: how many markers a face needs, and where; a map, a sheet, curves.

mod about;
mod args;
mod check;
mod ground;
mod inputs;
mod print;
mod progress;
mod report;
mod search;
mod targets;
mod values;
mod warnings;

use anyhow::anyhow;
use mimique_layout::{Comparison, Heads, Layout, MarkerWorth, Sheet, SheetOptions};

use self::args::{Command, Make};
use self::ground::Ground;
use self::progress::Bar;
use self::targets::{SheetFormat, Targets};
use crate::output;

pub use self::args::Args;

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    if let Some(Command::Check(args)) = args.command {
        return check::run(&args, json);
    }
    make(&args.make, json)
}

/// A layout with everything that is told of it.
struct Made<'m, 'a> {
    ground: &'m Ground<'a>,
    layout: Layout,
    heads: Option<Heads>,
    /// Error in the simulated takes that layouts were sought with, millimetres.
    rehearsed_mm: Option<f64>,
    worth: Vec<MarkerWorth>,
    comparison: Option<Comparison>,
    /// Why so many markers.
    count: CountReason,
    warnings: Vec<String>,
}

/// Why a layout has as many markers as it has.
#[derive(Debug, Clone, Copy, PartialEq)]
enum CountReason {
    /// They were asked for.
    Asked,
    /// Within a tenth of the best of the range.
    Enough,
    /// They reach the wanted error.
    Reaches(f64),
    /// No number of the range reaches the wanted error.
    NotReached(f64),
}

/// The options that clap has asked for.
fn given<'a, T>(value: &'a Option<T>, option: &str) -> anyhow::Result<&'a T> {
    value.as_ref().ok_or_else(|| anyhow!("--{option}: is missing; give it"))
}

fn make(args: &Make, json: bool) -> anyhow::Result<()> {
    let path = given(&args.avatar, "avatar")?;
    let targets = Targets::of(args)?;
    let solvers = search::solvers(args)?;
    let avatar = inputs::avatar(path)?;
    let face = inputs::face(path, &avatar.skin)?;
    let ground = Ground::of(args, &face, &avatar.key)?;
    let bar = Bar::new();
    let made = search::search(args, &ground, &solvers, &bar)?;
    bar.done();
    write(args, &made, &targets)?;
    let notes = [avatar.notes, ground.notes.clone()].concat();
    print::print(args, &made, &notes, json)
}

/// Report, sheet and, last, the map.
fn write(args: &Make, made: &Made<'_, '_>, targets: &Targets<'_>) -> anyhow::Result<()> {
    let map = made.layout.to_json(made.ground.face, about::about(args, made));
    let sheet = (targets.sheet.is_some() || targets.report.is_some()).then(|| {
        let options = SheetOptions {
            face_width: args.face_width.map(|length| length.0),
            face_height: args.face_height.map(|length| length.0),
        };
        Sheet::of(made.ground.face, &made.layout, &options)
    });
    if let Some(sheet) = &sheet {
        if let Some(folder) = targets.report {
            report::write(folder, args, made, &sheet.measures)?;
        }
        match targets.sheet {
            Some((path, SheetFormat::Pdf)) => output::write(path, &sheet.to_pdf())?,
            Some((path, SheetFormat::Svg)) => output::write(path, sheet.to_svg().as_bytes())?,
            None => {}
        }
    }
    output::write(targets.map, map.as_bytes())
}
