//! What annotators have written of a take: intervals of a tier of ELAN, or of a table of segments.

use std::ops::Range;
use std::path::Path;

use anyhow::anyhow;
use mimique_stimulus::{EafDocument, EafSegments, LeftOut, TakeSegment, read_labelled_segments};

use crate::eaf_file::is_eaf;

/// Intervals, and what of the file is none.
pub struct Intervals {
    /// Frames and what is written there.
    pub intervals: Vec<(Range<usize>, String)>,
    /// What is to be said of the rest.
    pub note: Option<String>,
}

/// The intervals of a file at a rate. Of an ELAN document those of `tier`; without a name those of its
/// only tier.
pub fn read(file: &Path, tier: Option<&str>, rate_hz: f64) -> anyhow::Result<Intervals> {
    let blame = |e: String| anyhow!("{}: {e}", file.display());
    let text =
        std::fs::read_to_string(file).map_err(|e| blame(format!("open: {e}; check the path")))?;
    let found = if is_eaf(file) {
        let document = EafDocument::parse(&text).map_err(|e| blame(e.to_string()))?;
        let tier = match (tier, document.tiers()) {
            (Some(tier), _) => tier,
            (None, [only]) => only.id.as_str(),
            (None, tiers) => {
                let names: Vec<&str> = tiers.iter().map(|tier| tier.id.as_str()).collect();
                let names = names.join(", ");
                return Err(blame(format!("no tier is named of {names}; name one with --tier")));
            }
        };
        document.labelled_segments(tier, rate_hz).map_err(|e| blame(e.to_string()))?
    } else {
        let segments = read_labelled_segments(&text).map_err(|e| blame(e.to_string()))?;
        EafSegments { segments, left_out: LeftOut::default() }
    };
    let note = found.left_out.sentence();
    // Leads of neutral before and after an expression are not the expression.
    let of = |segment: TakeSegment| (segment.expression, segment.label);
    Ok(Intervals { intervals: found.segments.into_iter().map(of).collect(), note })
}
