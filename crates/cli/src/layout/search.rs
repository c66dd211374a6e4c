//! A layout is sought: curves first where they are wanted, then places, then the head.

use anyhow::{anyhow, bail};
use mimique_layout::{
    Choice, Comparing, Comparison, Effort, HEAD_NOISE_M, Heads, Layout, LayoutError, Method,
    NamedSet, Progress, Rehearsal, Spacing, Task, Units, choose_heads, enough, enough_for,
    face_robot, mixed, mpeg4, worth,
};
use mimique_solver::{Method as Solver, MethodSpec};

use super::args::Make;
use super::ground::Ground;
use super::inputs::blame;
use super::values::Counts;
use super::{CountReason, Made, given, warnings};

/// Numbers of markers of the curves around a single number.
const AROUND: [usize; 6] = [10, 15, 20, 30, 40, 60];
/// The thesis's thinned sets (3.5.2).
const MAN: [usize; 4] = [62, 46, 30, 15];

/// Seeks a layout.
pub(super) fn search<'m, 'a>(
    args: &Make,
    ground: &'m Ground<'a>,
    solvers: &[MethodSpec],
    progress: &dyn Progress,
) -> anyhow::Result<Made<'m, 'a>> {
    let avatar = given(&args.avatar, "avatar")?;
    let counts = given(&args.markers, "markers")?;
    let blame_layout = |e: LayoutError| blame(avatar, e);
    let (face, motion, conditions) = (ground.face, &ground.motion, ground.conditions);
    let mut spec = solvers[0].clone();
    spec.rbf_smoothing = Some(if conditions.slip > 0.0 { ground.smoothing } else { 0.0 });
    let learnt = Some(motion);
    let effort = Effort::SEARCH;
    let rehearsal = Rehearsal::new(face, motion, learnt, &spec, conditions, effort, args.seed);
    let spacing = Spacing::of(face, motion, &ground.candidates.vertices, ground.distance);
    let units = Units::of(face, &ground.candidates, spacing, ground.symmetric, &ground.kept);
    let units = units.map_err(blame_layout)?;
    let task = Task {
        units: &units,
        motion,
        rehearsal: &rehearsal,
        noise: conditions.noise,
        slip: conditions.slip,
        seed: args.seed,
        progress,
    };
    let comparison = compare(args, ground, solvers, &task, counts).map_err(blame_layout)?;
    let (number, count) = how_many(args, counts, comparison.as_ref(), ground);
    let choice = Choice { start: ground.thinned.clone(), ..Choice::default() };
    let chosen = ground.method.choose(&task, number, &choice).map_err(blame_layout)?;
    let vertices = chosen.vertices();
    let heads = heads(args, ground, &units, &vertices)?;
    let of_head = heads.as_ref().map_or(&[][..], |heads| &heads.vertices);
    progress.stage("worth", 1);
    let layout = Layout::named(face, &chosen.units, of_head);
    Ok(Made {
        ground,
        heads,
        rehearsed_mm: rehearsal.mean_square(&vertices).ok().map(|square| 1e3 * square.sqrt()),
        worth: if args.as_thesis { Vec::new() } else { worth(&rehearsal, &vertices) },
        comparison,
        count,
        warnings: warnings::warnings(args, ground, &units, &chosen, &layout),
        layout,
    })
}

/// Curves, where they are wanted or say how many markers are enough.
fn compare(
    args: &Make,
    ground: &Ground<'_>,
    solvers: &[MethodSpec],
    task: &Task<'_, '_>,
    counts: &Counts,
) -> Result<Option<Comparison>, LayoutError> {
    let range = matches!(counts, Counts::Range(_));
    if args.report.is_none() && args.compare.is_empty() && !range {
        return Ok(None);
    }
    let sets = sets(ground, task)?;
    let counts = curve_counts(counts);
    let comparing = Comparing {
        face: ground.face,
        candidates: &ground.candidates,
        distance: ground.distance,
        symmetric: ground.symmetric,
        kept: &ground.kept,
        motion: &ground.motion,
        whole: &ground.whole,
        conditions: ground.conditions,
        smoothing: ground.smoothing,
        solvers,
        method: ground.method,
        thinned: &ground.thinned,
        counts: &counts,
        sets: &sets,
        seed: args.seed,
        progress: task.progress,
    };
    comparing.run().map(Some)
}

/// The methods of `--solve`.
pub(super) fn solvers(args: &Make) -> anyhow::Result<Vec<MethodSpec>> {
    let of = |name: &String| -> anyhow::Result<MethodSpec> {
        let known = Solver::ALL.into_iter().filter(|method| *method != Solver::Recorded);
        match known.clone().find(|method| method.name() == name) {
            Some(method) => Ok(MethodSpec::new(method)),
            None => {
                let names: Vec<&str> = known.map(Solver::name).collect();
                bail!("--solve: {name:?} solves nothing; use {}", names.join(", "))
            }
        }
    };
    if !(args.smoothing.is_finite() && (0.0..=100.0).contains(&args.smoothing)) {
        bail!("--smoothing: is {}; give a number between 0 and 100", args.smoothing);
    }
    args.solve.iter().map(of).collect()
}

/// The sets to compare with: those of the thesis that can be rebuilt, its thinned ones, a laboratory's own.
fn sets(ground: &Ground<'_>, task: &Task<'_, '_>) -> Result<Vec<NamedSet>, LayoutError> {
    let face = ground.face;
    let mut sets = vec![mpeg4(face), face_robot(face)];
    let mut start = mixed(face).vertices;
    for count in MAN {
        if start.len() > count {
            let choice = Choice { start: start.clone(), ..Choice::default() };
            start = Method::Reduce.choose(task, count, &choice)?.vertices();
        }
        sets.push(NamedSet { name: format!("MAN {count}"), vertices: start.clone() });
    }
    sets.extend(ground.compared.iter().cloned());
    Ok(sets)
}

/// The numbers of markers of the curves.
fn curve_counts(counts: &Counts) -> Vec<usize> {
    match counts {
        Counts::Range(counts) => counts.clone(),
        Counts::One(count) => {
            let mut around: Vec<usize> = AROUND.to_vec();
            around.push(*count);
            around.sort_unstable();
            around.dedup();
            around
        }
    }
}

/// How many markers, and why.
fn how_many(
    args: &Make,
    counts: &Counts,
    comparison: Option<&Comparison>,
    ground: &Ground<'_>,
) -> (usize, CountReason) {
    let range = match counts {
        Counts::One(count) => return (*count, CountReason::Asked),
        Counts::Range(range) => range,
    };
    let curve: Vec<(usize, f64)> = comparison
        .map(|comparison| comparison.main_curve(ground.method.word()))
        .unwrap_or_default()
        .iter()
        .map(|row| (row.markers, row.errors.per_vertex_mm))
        .collect();
    let most = range[range.len() - 1];
    match args.wanted_error {
        None => (enough(&curve).unwrap_or(most), CountReason::Enough),
        Some(wanted) => {
            let millimetres = 1e3 * wanted.0;
            match enough_for(&curve, millimetres) {
                Some(count) => (count, CountReason::Reaches(millimetres)),
                None => (enough(&curve).unwrap_or(most), CountReason::NotReached(millimetres)),
            }
        }
    }
}

/// The head's markers.
fn heads(
    args: &Make,
    ground: &Ground<'_>,
    units: &Units<'_>,
    taken: &[usize],
) -> anyhow::Result<Option<Heads>> {
    if args.head == 0 || args.as_thesis {
        return Ok(None);
    }
    let heads = choose_heads(ground.face, &units.spacing, taken, args.head, HEAD_NOISE_M);
    heads.map(Some).map_err(|e| anyhow!("--{e}"))
}
