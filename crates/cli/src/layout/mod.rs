//! `mimique layout`: how many markers a face needs, and where; a map, a sheet, curves.

mod about;
mod args;
mod check;
mod figure;
mod inputs;
mod print;
mod progress;
mod report;
mod values;

use anyhow::{anyhow, bail};
use mimique_layout::{
    Candidates, Choice, Comparing, Comparison, Conditions, Distance, Effort, Excluded, Face,
    FaceMotion, Heads, Layout, LayoutError, MarkerWorth, Method, MotionSource, NamedSet, Progress,
    Rehearsal, Sheet, SheetOptions, Spacing, Task, Units, Where, choose_heads, enough, enough_for,
    face_robot, mixed, mpeg4, unseen_shapes, worth,
};
use mimique_solver::{MarkerSite, Method as Solver, MethodSpec};

use self::args::{Command, Make};
use self::inputs::{AvatarFile, blame};
use self::progress::Bar;
use self::values::Counts;
use crate::output;

pub use self::args::Args;

/// Noise of head markers, metres, that their error is told for.
const HEAD_NOISE_M: f64 = 3e-4;
/// Distance of markers where nothing else is said, metres.
const DISTANCE_M: f64 = 0.008;
/// Numbers of markers of the curves around a single number.
const AROUND: [usize; 6] = [10, 15, 20, 30, 40, 60];
/// The thesis's thinned sets (3.5.2).
const MAN: [usize; 4] = [62, 46, 30, 15];

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    if let Some(Command::Check(args)) = args.command {
        return check::run(&args, json);
    }
    make(&args.make, json)
}

/// A layout with everything that is told of it.
struct Made<'m, 'a> {
    face: &'m Face<'a>,
    motion: &'m FaceMotion,
    candidates: &'m Candidates,
    place: &'m Where,
    distance: f64,
    conditions: Conditions,
    method: Method,
    layout: Layout,
    heads: Option<Heads>,
    /// Error in the simulated takes that layouts were sought with, millimetres.
    rehearsed_mm: Option<f64>,
    worth: Vec<MarkerWorth>,
    comparison: Option<Comparison>,
    /// Why so many markers.
    count: CountReason,
    warnings: Vec<String>,
    key: String,
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
    let avatar_path = given(&args.avatar, "avatar")?;
    let out = given(&args.out, "out")?;
    let counts = given(&args.markers, "markers")?;
    let solvers = solvers(args)?;
    let bar = Bar::new();
    let AvatarFile { skin, key, mut notes } = inputs::avatar(avatar_path)?;
    let face = inputs::face(avatar_path, &skin)?;
    let (takes, said) = inputs::takes(&skin, &args.rom, &args.take, args.rate)?;
    notes.extend(said);
    let place = places(args, &skin)?;
    let candidates = Candidates::of(&face, &place);
    let blame_layout = |e: LayoutError| blame(avatar_path, e);
    let unseen = unseen_shapes(&face, &candidates.vertices);
    let motion = FaceMotion::of(&face, &takes, &unseen).map_err(|e| anyhow!("--take: {e}"))?;
    let whole = FaceMotion::of(&face, &takes, &[]).map_err(|e| anyhow!("--take: {e}"))?;
    let distance = distance(args);
    let symmetric = !args.free && !args.as_thesis;
    let kept = kept(args, &face)?;
    let mut conditions =
        Conditions { noise: args.noise.0, slip: args.slip.0, others: args.slip.0 > 0.0 };
    let mut smoothing = args.smoothing;
    if args.as_thesis {
        conditions = Conditions { noise: 0.0, slip: 0.0, others: false };
        smoothing = 0.0;
    }
    let mut search = solvers[0].clone();
    search.rbf_smoothing = Some(if conditions.slip > 0.0 { smoothing } else { 0.0 });
    let rehearsal = Rehearsal::new(
        &face,
        &motion,
        Some(&motion),
        &search,
        conditions,
        Effort::SEARCH,
        args.seed,
    );
    let spacing = Spacing::of(&face, &motion, &candidates.vertices, distance);
    let stay = if args.method == Method::Reduce { &[][..] } else { &kept };
    let units = Units::of(&face, &candidates, spacing, symmetric, stay).map_err(blame_layout)?;
    let task = Task {
        units: &units,
        motion: &motion,
        rehearsal: &rehearsal,
        noise: conditions.noise,
        slip: conditions.slip,
        seed: args.seed,
        progress: &bar,
    };
    let method = if args.as_thesis { Method::Kmeans } else { args.method };
    let choice = Choice { start: thinned_from(&face, &kept), ..Choice::default() };

    // Where curves are wanted, or say how many markers are enough.
    let curves =
        args.report.is_some() || !args.compare.is_empty() || matches!(counts, Counts::Range(_));
    let comparison = match curves {
        false => None,
        true => {
            let sets = sets(args, &face, &task)?;
            let counts = curve_counts(counts);
            let comparing = Comparing {
                face: &face,
                candidates: &candidates,
                distance,
                symmetric,
                kept: stay,
                motion: &motion,
                whole: &whole,
                conditions,
                smoothing,
                solvers: &solvers,
                method,
                counts: &counts,
                sets: &sets,
                seed: args.seed,
                progress: &bar,
            };
            Some(comparing.run().map_err(blame_layout)?)
        }
    };
    let (count, reason) = how_many(args, counts, comparison.as_ref(), method, smoothing);
    let chosen = method.choose(&task, count, &choice).map_err(blame_layout)?;
    let vertices = chosen.vertices();
    let heads = heads(args, &face, &units, &vertices)?;
    let layout =
        Layout::named(&face, &chosen.units, heads.as_ref().map_or(&[], |heads| &heads.vertices));
    bar.stage("worth", 1);
    let rehearsed_mm = rehearsal.mean_square(&vertices).ok().map(|square| 1e3 * square.sqrt());
    let worth = if args.as_thesis { Vec::new() } else { worth(&rehearsal, &vertices) };
    bar.done();

    let warnings = warnings(args, &face, &motion, &units, &chosen.without_room, &vertices);
    let made = Made {
        face: &face,
        motion: &motion,
        candidates: &candidates,
        place: &place,
        distance,
        conditions,
        method,
        layout,
        heads,
        rehearsed_mm,
        worth,
        comparison,
        count: reason,
        warnings,
        key,
    };
    write(args, &made, out)?;
    print::print(args, &made, &notes, json)
}

/// Map, sheet and report.
fn write(args: &Make, made: &Made<'_, '_>, out: &std::path::Path) -> anyhow::Result<()> {
    let sheet = |made: &Made<'_, '_>| {
        let options = SheetOptions {
            face_width: args.face_width.map(|length| length.0),
            face_height: args.face_height.map(|length| length.0),
        };
        Sheet::of(made.face, &made.layout, &options)
    };
    let about = about::about(args, made);
    let map = made.layout.to_json(made.face, about);
    let sheet_bytes = match &args.sheet {
        None => None,
        Some(path) => {
            let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase());
            let bytes = match ending.as_deref() {
                Some("pdf") => sheet(made).to_pdf(),
                Some("svg") => sheet(made).to_svg().into_bytes(),
                _ => {
                    bail!("--sheet: {}: is neither .pdf nor .svg; name one of them", path.display())
                }
            };
            Some((path, bytes))
        }
    };
    if let Some(folder) = &args.report {
        report::write(folder, args, made, &sheet(made).measures)?;
    }
    if let Some((path, bytes)) = sheet_bytes {
        output::write(path, &bytes)?;
    }
    output::write(out, map.as_bytes())
}

/// The methods of `--solve`.
fn solvers(args: &Make) -> anyhow::Result<Vec<MethodSpec>> {
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

/// Where markers may be.
fn places(args: &Make, skin: &mimique_stimulus::AvatarSkin) -> anyhow::Result<Where> {
    let mut place = Where::default();
    if args.as_thesis {
        place.exclude = vec![Excluded::Ears, Excluded::Neck, Excluded::Hair];
    } else {
        place.exclude = args.exclude.iter().filter_map(|part| part.0).collect();
        place.exclude.sort_unstable();
        place.exclude.dedup();
    }
    if let Some(file) = &args.region {
        inputs::region(skin, file, &mut place)?;
    }
    Ok(place)
}

/// The distance that markers keep, metres.
fn distance(args: &Make) -> f64 {
    if args.as_thesis {
        return 0.0;
    }
    match (args.min_distance, args.diameter) {
        (Some(given), _) => Distance::Given(given.0).metres(),
        (None, Some(diameter)) => {
            let camera = args.camera.map(|camera| camera.0);
            Distance::Seen { diameter: diameter.0, camera }.metres()
        }
        (None, None) => DISTANCE_M,
    }
}

/// The vertices of the map of `--keep`.
fn kept(args: &Make, face: &Face<'_>) -> anyhow::Result<Vec<usize>> {
    let Some(file) = &args.keep else { return Ok(Vec::new()) };
    let sites = inputs::map(face.skin, file)?.sites;
    Ok(sites.iter().map(MarkerSite::vertex).collect())
}

/// What `reduce` thins: the map of `--keep`, else MPEG-4's and Face Robot's points.
fn thinned_from(face: &Face<'_>, kept: &[usize]) -> Vec<usize> {
    if kept.is_empty() { mixed(face).vertices } else { kept.to_vec() }
}

/// The sets to compare with: those of the thesis that can be rebuilt, its thinned ones, a laboratory's own.
fn sets(args: &Make, face: &Face<'_>, task: &Task<'_, '_>) -> anyhow::Result<Vec<NamedSet>> {
    let mut sets = vec![mpeg4(face), face_robot(face)];
    let mut start = mixed(face).vertices;
    for count in MAN {
        if start.len() > count {
            let choice = Choice { start: start.clone(), ..Choice::default() };
            let thinned = Method::Reduce.choose(task, count, &choice);
            start = thinned.map_err(|e| anyhow!("{e}"))?.vertices();
        }
        sets.push(NamedSet { name: format!("MAN {count}"), vertices: start.clone() });
    }
    for named in &args.compare {
        sets.push(inputs::named_set(face.skin, &named.0, &named.1)?);
    }
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
    method: Method,
    smoothing: f64,
) -> (usize, CountReason) {
    let range = match counts {
        Counts::One(count) => return (*count, CountReason::Asked),
        Counts::Range(range) => range,
    };
    let curve: Vec<(usize, f64)> = comparison
        .map(|comparison| report::main_curve(comparison, &method.to_string(), smoothing))
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
    face: &Face<'_>,
    units: &Units<'_>,
    taken: &[usize],
) -> anyhow::Result<Option<Heads>> {
    if args.head == 0 || args.as_thesis {
        return Ok(None);
    }
    let heads = choose_heads(face, &units.spacing, taken, args.head, HEAD_NOISE_M);
    heads.map(Some).map_err(|e| anyhow!("--{e}"))
}

/// What should be looked at.
fn warnings(
    args: &Make,
    face: &Face<'_>,
    motion: &FaceMotion,
    units: &Units<'_>,
    without_room: &[usize],
    vertices: &[usize],
) -> Vec<String> {
    let mut warnings = Vec::new();
    if motion.source == MotionSource::IndependentShapes {
        warnings.push(
            "no motion is given: every shape counts by itself, standard deviation 0.25; give --rom or --take of the \
             people to be captured"
                .to_owned(),
        );
    }
    let unseen: Vec<&str> =
        motion.rested.iter().map(|&k| face.skin.shape_names[k].as_str()).collect();
    if !unseen.is_empty() && !args.as_thesis {
        warnings.push(format!(
            "{} shapes move no allowed place by 1 mm, or turn the eyes: no layout tells them, and they rest in the \
             simulated takes: {}",
            unseen.len(),
            unseen.join(", ")
        ));
    }
    if !without_room.is_empty() {
        let names: Vec<String> = without_room.iter().map(ToString::to_string).collect();
        warnings.push(format!(
            "clusters {} found no room at {:.1} mm: markers stand where others are farthest instead",
            names.join(", "),
            1e3 * units.spacing.minimum()
        ));
    }
    if let (Some(rate), Some(speed)) = (args.capture_rate, motion.top_speed(vertices)) {
        let least = units.spacing.minimum() * rate;
        if speed > least {
            warnings.push(format!(
                "markers go up to {speed:.2} m/s and could jump to a neighbour's place between two frames: at {rate} \
                 Hz keep {:.1} mm, or capture at {:.0} Hz",
                1e3 * speed / rate,
                speed / units.spacing.minimum()
            ));
        }
    }
    warnings
}
