//! `mimique arena submit`: a method's weights or vertices, checked and written into the arena.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use mimique_arena::{
    Arena, ArenaFolder, Given, GivenWeights, Submission, SubmissionDetails, SubmissionProblem,
    TOLERANCE_MM, check_details, check_vertices, check_weights, submission_files,
};
use mimique_avatar_files::{read_avatar, read_template};
use mimique_locale::counted;

use super::inputs::{all_of, open, today, write_folder};

/// Options.
#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).args(["weights", "vertices"])))]
pub struct Args {
    /// Folder of the arena
    folder: PathBuf,
    /// The method's name in the ranking: lower-case letters, digits, hyphens
    #[arg(long, value_name = "NAME")]
    method: String,
    /// Weights of the head, of a whole capture or of a segment each: [ID=]FILE, of any format that `solve` writes
    #[arg(long, value_name = "FILE", num_args = 1..)]
    weights: Vec<String>,
    /// Places of the vertices of the head's skin, of a whole capture or of a segment each: [ID=]FILE (.npy, .npz)
    #[arg(long, value_name = "FILE", num_args = 1.., requires = "rate")]
    vertices: Vec<String>,
    /// Frames per second of the vertices
    #[arg(long, value_name = "HZ")]
    rate: Option<f64>,
    /// Who made it; may be given several times
    #[arg(long = "author", value_name = "NAME")]
    authors: Vec<String>,
    /// What to cite
    #[arg(long, value_name = "TEXT")]
    citation: Option<String>,
    /// Licence of what is submitted, as in CC-BY-4.0
    #[arg(long, value_name = "LICENCE", default_value = "")]
    licence: String,
    /// Where its code is
    #[arg(long, value_name = "ADDRESS")]
    code: Option<String>,
    /// The day it is submitted, YYYY-MM-DD [default: today]
    #[arg(long, value_name = "DAY")]
    date: Option<String>,
    /// Take the place of an earlier submission of this name; votes on its clips no longer count
    #[arg(long)]
    replace: bool,
}

/// A submission with its files.
pub struct Made {
    /// The submission.
    pub submission: Submission,
    /// The files of its folder.
    pub files: Vec<(String, Vec<u8>)>,
    /// What should be said of it.
    pub notes: Vec<String>,
}

/// Runs the command.
pub fn run(args: Args, json: bool) -> anyhow::Result<()> {
    let folder = open(&args.folder)?;
    let place = args.folder.join(ArenaFolder::place_of(&args.method));
    if folder.submissions.contains_key(&args.method) && !args.replace {
        bail!(
            "--method {}: it was submitted already; give another name, or --replace, which leaves votes on its earlier \
             clips out",
            args.method
        );
    }
    let details = SubmissionDetails {
        name: args.method.clone(),
        authors: args.authors,
        citation: args.citation,
        licence: args.licence,
        code: args.code,
        submitted: args.date.unwrap_or_else(today),
        reference: false,
    };
    let avatar = args.folder.join(&folder.arena.avatar);
    let made = match args.rate {
        Some(rate_hz) if !args.vertices.is_empty() => {
            let given: Vec<Given> = args.vertices.iter().map(|text| Given::of(text)).collect();
            vertices_of(&folder.arena, &avatar, &given, rate_hz, details)?
        }
        _ => {
            let given: Vec<Given> = args.weights.iter().map(|text| Given::of(text)).collect();
            weights_of(&folder.arena, &avatar, &given, details)
        }
    };
    let nothing = format!("{}: nothing was written", place.display());
    let made = made.map_err(|problems| all_of(&problems, &nothing))?;
    write_folder(&place, "submission.json", &made.files, &[])?;
    tell(&place, &made, json)
}

/// A submission of weights, or everything that is wrong with it.
pub fn weights_of(
    arena: &Arena,
    avatar: &Path,
    given: &[Given],
    details: SubmissionDetails,
) -> Result<Made, Vec<SubmissionProblem>> {
    let mut problems = check_details(&details);
    let unreadable =
        |why: String| SubmissionProblem::Unreadable { file: avatar.display().to_string(), why };
    let head = read_avatar(avatar).map_err(|e| vec![unreadable(e.to_string())])?.avatar;
    let shapes = head.face_shapes();
    let mut tables = Vec::new();
    for own in given {
        match GivenWeights::read(own, shapes) {
            Ok(table) => tables.push(table),
            Err(problem) => problems.push(problem),
        }
    }
    // What cannot be read is not said to be missing, too.
    if tables.len() < given.len() {
        return Err(problems);
    }
    let checked = check_weights(arena, shapes, &tables);
    let (checked, found) = match checked {
        Ok(checked) => (Some(checked), Vec::new()),
        Err(found) => (None, found),
    };
    problems.extend(found);
    let Some(checked) = checked.filter(|_| problems.is_empty()) else { return Err(problems) };
    let notes = match checked.absent.len() {
        0 => Vec::new(),
        all if all == shapes.len() => vec!["no shape of the head moves".to_owned()],
        _ => {
            vec![format!("shapes that rest, since no file has them: {}", checked.absent.join(", "))]
        }
    };
    let (submission, files) = submission_files(details, checked);
    Ok(Made { submission, files, notes })
}

/// A submission of vertices, or everything that is wrong with it.
fn vertices_of(
    arena: &Arena,
    avatar: &Path,
    given: &[Given],
    rate_hz: f64,
    details: SubmissionDetails,
) -> anyhow::Result<Result<Made, Vec<SubmissionProblem>>> {
    if !(rate_hz > 0.0 && rate_hz.is_finite()) {
        bail!("--rate: {rate_hz}; give frames per second");
    }
    let blame = |e: &dyn std::fmt::Display| anyhow!("{}: {e}", avatar.display());
    let head = read_avatar(avatar).map_err(|e| blame(&e))?.avatar;
    let template = read_template(avatar).map_err(|e| blame(&e))?;
    let mut problems = check_details(&details);
    Ok(match check_vertices(arena, &head, &template, given, rate_hz) {
        Ok(checked) if problems.is_empty() => {
            let (submission, files) = submission_files(details, checked);
            Ok(Made { submission, files, notes: Vec::new() })
        }
        Ok(_) => Err(problems),
        Err(found) => {
            problems.extend(found);
            Err(problems)
        }
    })
}

fn tell(place: &Path, made: &Made, json: bool) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let submission = &made.submission;
    if json {
        writeln!(out, "{}", serde_json::to_string_pretty(submission)?)?;
        return Ok(());
    }
    let frames: usize = submission.segments.values().map(|own| own.frames).sum();
    writeln!(
        out,
        "{}: {} with {}, SHA-256 {}",
        place.display(),
        counted(submission.segments.len(), "segment"),
        counted(frames, "frame"),
        submission.hash
    )?;
    if let Some(avatar) = &submission.avatar {
        writeln!(
            out,
            "{} principal shapes give every vertex again to within {:.4} mm ({TOLERANCE_MM} mm at most), {:.4} mm root mean square",
            avatar.shapes, avatar.largest_error_mm, avatar.rms_error_mm
        )?;
    }
    for note in &made.notes {
        writeln!(out, "note: {note}")?;
    }
    Ok(())
}
