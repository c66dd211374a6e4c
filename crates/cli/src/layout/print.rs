//! What `mimique layout` says.

use std::io::Write as _;

use mimique_layout::{FacePart, MotionSource, Side};
use serde_json::json;

use super::args::Make;
use super::{CountReason, Made, about};

/// A few lines of text, or all of it as JSON.
pub(super) fn print(
    args: &Make,
    made: &Made<'_, '_>,
    notes: &[String],
    json: bool,
) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    if json {
        let value = json!({
            "out": args.out,
            "sheet": args.sheet,
            "report": args.report,
            "markers": made.layout.markers,
            "head": made.layout.head,
            "layout": about::about(args, made),
            "comparison": made.comparison,
            "notes": notes,
            "warnings": made.warnings,
        });
        writeln!(out, "{}", serde_json::to_string_pretty(&value)?)?;
        return Ok(());
    }
    let (markers, heads) = (&made.layout.markers, made.layout.head.len());
    let method = if args.as_thesis { "kmeans as in the thesis" } else { made.ground.method.word() };
    if let Some(path) = &args.out {
        let path = path.display();
        writeln!(
            out,
            "{path}: {} face markers and {heads} head markers by {method}",
            markers.len()
        )?;
    }
    let of_part = |part: FacePart| markers.iter().filter(|m| m.part == Some(part)).count();
    let parts: Vec<String> = (FacePart::ALL.into_iter())
        .map(|part| (part.name().to_lowercase(), of_part(part)))
        .filter(|(_, count)| *count > 0)
        .map(|(name, count)| format!("{name} {count}"))
        .collect();
    writeln!(out, "places: {}", parts.join(", "))?;
    let middle = markers.iter().filter(|m| m.side == Side::Middle).count();
    let counts = made.ground.candidates.counts;
    writeln!(
        out,
        "of {} vertices {} move by 1 mm, {} of these are seen, {} are allowed; {:.1} mm apart; {middle} in the middle",
        counts.vertices,
        counts.moved,
        counts.seen,
        counts.allowed,
        1e3 * made.ground.distance
    )?;
    writeln!(out, "motion: {}", motion(made))?;
    if let Some(error) = made.rehearsed_mm {
        let conditions = made.ground.conditions;
        let put = if conditions.slip > 0.0 {
            format!(
                "markers {:.1} mm beside their places, another face in every other take",
                1e3 * conditions.slip
            )
        } else {
            "markers at their places".to_owned()
        };
        writeln!(
            out,
            "rehearsed error: {error:.3} mm a vertex ({put}, noise {:.1} mm)",
            1e3 * conditions.noise
        )?;
    }
    if let Some(heads) = &made.heads {
        let error = 1e3 * heads.error;
        writeln!(out, "head: noise of 0.3 mm turns into {error:.2} mm on the face")?;
    }
    enough(&mut out, made)?;
    for path in [&args.sheet, &args.report].into_iter().flatten() {
        writeln!(out, "written: {}", path.display())?;
    }
    notes.iter().try_for_each(|note| writeln!(out, "note: {note}"))?;
    made.warnings.iter().try_for_each(|warning| writeln!(out, "warning: {warning}"))?;
    Ok(())
}

fn motion(made: &Made<'_, '_>) -> String {
    if made.ground.motion.source == MotionSource::IndependentShapes {
        return "every shape by itself".to_owned();
    }
    let people: Vec<String> = (made.ground.motion.people.iter())
        .map(|person| {
            format!(
                "{} ({} frames)",
                person.name,
                person.frames.len() / made.ground.motion.basis.width
            )
        })
        .collect();
    people.join(", ")
}

/// Why so many markers, and the curve.
fn enough(out: &mut impl std::io::Write, made: &Made<'_, '_>) -> std::io::Result<()> {
    let Some(comparison) = &made.comparison else { return Ok(()) };
    let curve = comparison.main_curve(made.ground.method.word());
    let points: Vec<String> = (curve.iter())
        .map(|row| format!("{}: {:.3}", row.markers, row.errors.per_vertex_mm))
        .collect();
    if !points.is_empty() {
        writeln!(out, "error a vertex by markers, takes left out, mm: {}", points.join(", "))?;
    }
    let count = made.layout.markers.len();
    match made.count {
        CountReason::Asked => Ok(()),
        CountReason::Enough => {
            writeln!(
                out,
                "{count} markers are enough: the least within a tenth of the best of the range"
            )
        }
        CountReason::Reaches(wanted) => {
            writeln!(out, "{count} markers are enough for {wanted} mm")
        }
        CountReason::NotReached(wanted) => writeln!(
            out,
            "no number of the range reaches {wanted} mm: {count} markers are within a tenth of the best"
        ),
    }
}
