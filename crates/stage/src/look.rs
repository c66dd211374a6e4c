//! How a head looks: backdrop, skin, irises. The same for every condition of a study.

/// Colours and materials of a picture. All colours are linear RGB, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// The plain backdrop.
    pub background: [f32; 3],
    /// Multiplies the skin's base colour.
    pub skin_tint: [f32; 3],
    /// Roughness of the skin's oily layer, 0 (mirror) to 1 (chalk).
    pub skin_roughness: f32,
    /// Colour of the irises.
    pub iris: [f32; 3],
    /// Colour of painted brows (avatars without colours of their own).
    pub brows: [f32; 3],
    /// Multiplies all light.
    pub exposure: f32,
    /// Paint lips, brows and blush on skins that come without colours, placed from the eyes.
    pub paint: bool,
}

impl Look {
    /// The look of the stimuli that are judged.
    pub const STIMULUS: Self = Self {
        background: [0.40, 0.41, 0.42],
        skin_tint: [1.0, 1.0, 1.0],
        skin_roughness: 0.46,
        iris: [0.115, 0.125, 0.105],
        brows: [0.055, 0.034, 0.022],
        exposure: 1.0,
        paint: true,
    };

    /// The look of reference clips, which nobody should take for a stimulus: uniform grey clay, darker
    /// than the backdrop.
    pub const REFERENCE: Self = Self {
        skin_tint: [0.80, 0.79, 0.78],
        skin_roughness: 0.60,
        iris: [0.20, 0.20, 0.20],
        paint: false,
        ..Self::STIMULUS
    };

    /// The same look on another backdrop, given as sRGB bytes (`#rrggbb`).
    #[must_use]
    pub fn with_background_srgb(self, rgb: [u8; 3]) -> Self {
        Self { background: rgb.map(linear_from_srgb), ..self }
    }
}

impl Default for Look {
    fn default() -> Self {
        Self::STIMULUS
    }
}

/// IEC 61966-2-1: linear light of an sRGB byte.
fn linear_from_srgb(byte: u8) -> f32 {
    let c = f32::from(byte) / 255.0;
    if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn look_background_from_srgb_bytes() {
        let look = Look::STIMULUS.with_background_srgb([0, 128, 255]);
        assert_eq!(look.background[0], 0.0);
        assert!((look.background[1] - 0.215_86).abs() < 1e-4);
        assert!((look.background[2] - 1.0).abs() < 1e-6);
    }
}
