//! Units of length: by name, and by magnitude where a file has none.

use crate::LengthUnit;
use mimique_geometry::{DVec3, Point};

impl LengthUnit {
    /// The symbol: `mm`, `cm` or `m`.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
        }
    }

    /// The unit of that name, as systems write it (`mm`, `Millimeters`, `CM`, `metres`...).
    pub fn from_name(name: &str) -> Option<Self> {
        match name.trim().to_ascii_lowercase().as_str() {
            "mm" | "millimeter" | "millimeters" | "millimetre" | "millimetres" => {
                Some(Self::Millimetre)
            }
            "cm" | "centimeter" | "centimeters" | "centimetre" | "centimetres" => {
                Some(Self::Centimetre)
            }
            "m" | "meter" | "meters" | "metre" | "metres" => Some(Self::Metre),
            _ => None,
        }
    }
}

/// Frames looked at when the size of a face is estimated.
const SAMPLED_FRAMES: usize = 64;

/// Median, over sampled frames, of the diagonal of the markers' bounding box, in the capture's
/// own unit. `None` when no frame has two markers.
pub(crate) fn marker_extent(positions: &[Point], markers: usize) -> Option<f64> {
    if markers == 0 {
        return None;
    }
    let frames = positions.len() / markers;
    let step = (frames / SAMPLED_FRAMES).max(1);
    let mut extents: Vec<f64> = positions
        .chunks_exact(markers)
        .step_by(step)
        .filter_map(|frame| {
            let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let mut seen = 0;
            for p in frame.iter().filter(|p| p.is_finite()) {
                seen += 1;
                low = low.min(p.0);
                high = high.max(p.0);
            }
            (seen >= 2).then(|| (high - low).length())
        })
        .collect();
    extents.sort_by(f64::total_cmp);
    extents.get(extents.len() / 2).copied()
}

/// The unit in which markers that far apart are on one face.
///
/// The markers of a face or head span 4 to 40 cm: 0.04-0.4 m, 4-40 cm, 40-400 mm. The bounds lie
/// between those ranges (3 keeps a whole body in metres, which spans up to 2.5).
pub(crate) fn unit_of_face_extent(extent: f64) -> LengthUnit {
    if extent < 3.0 {
        LengthUnit::Metre
    } else if extent < 40.0 {
        LengthUnit::Centimetre
    } else {
        LengthUnit::Millimetre
    }
}

/// Decide the unit: the caller's, the file's, else by magnitude (noted).
pub(crate) fn decide_unit(
    asked: Option<LengthUnit>,
    declared: Option<LengthUnit>,
    positions: &[Point],
    markers: usize,
    notes: &mut Vec<String>,
) -> LengthUnit {
    if let Some(unit) = asked.or(declared) {
        return unit;
    }
    match marker_extent(positions, markers) {
        Some(extent) => {
            let unit = unit_of_face_extent(extent);
            notes.push(format!(
                "unit not in the file: {} by magnitude (the markers span {extent:.3})",
                unit.symbol()
            ));
            unit
        }
        None => {
            notes.push("unit not in the file and no frame with two markers: mm assumed".to_owned());
            LengthUnit::Millimetre
        }
    }
}
