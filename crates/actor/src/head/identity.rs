//! Who the head is: proportions, age, sex-typical traits, colours.

use super::rng::Rng;

/// A person: every number is a trait of the neutral head. `0.0` is the average; proportions are in
/// standard deviations and look human between -2 and 2.
#[derive(Debug, Clone, PartialEq)]
pub struct Identity {
    /// 0 = female-typical, 1 = male-typical: brow ridge, jaw, neck, lips, brows.
    pub masculinity: f64,
    /// 0 = about twenty, 1 = about seventy: sagging, thinner lips, greying hair.
    pub age: f64,
    /// Breadth of the face.
    pub face_width: f64,
    /// Breadth of the jaw at its angles.
    pub jaw_width: f64,
    /// Height and projection of the chin.
    pub chin: f64,
    /// Prominence of the cheekbones.
    pub cheekbones: f64,
    /// Fullness of the cheeks.
    pub fullness: f64,
    /// Length of the nose.
    pub nose_length: f64,
    /// Breadth of the nose at the wings.
    pub nose_width: f64,
    /// Height of the bridge.
    pub nose_bridge: f64,
    /// Size of the eyes.
    pub eye_size: f64,
    /// Distance between the eyes.
    pub eye_spacing: f64,
    /// Slant of the eyes: positive lifts the outer corner.
    pub eye_tilt: f64,
    /// Height of the brows over the eyes.
    pub brow_height: f64,
    /// Thickness of the brows.
    pub brow_weight: f64,
    /// Breadth of the mouth.
    pub mouth_width: f64,
    /// Fullness of the lips.
    pub lip_fullness: f64,
    /// Size of the ears.
    pub ear_size: f64,
    /// Linear RGB of the skin.
    pub skin_colour: [f32; 3],
    /// Linear RGB of the iris.
    pub iris_colour: [f32; 3],
    /// Linear RGB of hair and brows.
    pub hair_colour: [f32; 3],
}

/// Skin tones from light to dark, linear RGB (measured reflectances fall on such a curve).
const SKIN: [[f32; 3]; 6] = [
    [0.70, 0.42, 0.31],
    [0.62, 0.35, 0.24],
    [0.52, 0.28, 0.175],
    [0.38, 0.19, 0.11],
    [0.23, 0.105, 0.058],
    [0.115, 0.05, 0.028],
];

/// Iris colours, linear RGB: brown, hazel, green, grey, blue.
const IRIS: [[f32; 3]; 5] = [
    [0.11, 0.045, 0.015],
    [0.17, 0.10, 0.035],
    [0.10, 0.15, 0.07],
    [0.16, 0.20, 0.22],
    [0.10, 0.17, 0.24],
];

/// Hair colours, linear RGB: black, dark brown, brown, auburn, blond.
const HAIR: [[f32; 3]; 5] = [
    [0.010, 0.008, 0.007],
    [0.026, 0.015, 0.010],
    [0.060, 0.032, 0.018],
    [0.110, 0.040, 0.016],
    [0.330, 0.210, 0.095],
];

/// Hair that has lost its pigment, linear RGB.
const GREY: [f32; 3] = [0.42, 0.41, 0.40];

impl Default for Identity {
    /// The house face: a young adult between the sexes, every proportion average.
    fn default() -> Self {
        Identity {
            masculinity: 0.25,
            age: 0.12,
            face_width: 0.0,
            jaw_width: 0.0,
            chin: 0.0,
            cheekbones: 0.0,
            fullness: 0.0,
            nose_length: 0.0,
            nose_width: 0.0,
            nose_bridge: 0.0,
            eye_size: 0.0,
            eye_spacing: 0.0,
            eye_tilt: 0.0,
            brow_height: 0.0,
            brow_weight: 0.0,
            mouth_width: 0.0,
            lip_fullness: 0.0,
            ear_size: 0.0,
            skin_colour: SKIN[1],
            iris_colour: IRIS[4],
            hair_colour: HAIR[2],
        }
    }
}

impl Identity {
    /// One of any number of people; the same seed is the same person on every platform.
    pub fn from_seed(seed: u64) -> Self {
        let mut rng = Rng::new(seed ^ 0x6d69_6d69_7175_6531);
        let masculinity = if rng.unit() < 0.5 { rng.range(0.0, 0.3) } else { rng.range(0.7, 1.0) };
        let age = rng.range(0.0, 0.85);
        let tone = rng.unit();
        let skin_colour = along(&SKIN, tone);
        // Light eyes and light hair go with light skin.
        let lightness = (1.0 - 1.6 * tone).max(0.0);
        let iris_colour = along(&IRIS, rng.unit() * lightness);
        let pigment = along(&HAIR, rng.unit() * (0.3 + 0.7 * lightness).min(1.0));
        let grey = (rng.range(0.6, 1.6) * (age - 0.45)).clamp(0.0, 0.9) as f32;
        let hair_colour = [0, 1, 2].map(|a| pigment[a] + (GREY[a] - pigment[a]) * grey);
        Identity {
            masculinity,
            age,
            face_width: rng.trait_value(),
            jaw_width: rng.trait_value(),
            chin: rng.trait_value(),
            cheekbones: rng.trait_value(),
            fullness: rng.trait_value(),
            nose_length: rng.trait_value(),
            nose_width: rng.trait_value(),
            nose_bridge: rng.trait_value(),
            eye_size: rng.trait_value(),
            eye_spacing: rng.trait_value(),
            eye_tilt: rng.trait_value(),
            brow_height: rng.trait_value(),
            brow_weight: rng.trait_value(),
            mouth_width: rng.trait_value(),
            lip_fullness: rng.trait_value(),
            ear_size: rng.trait_value(),
            skin_colour,
            iris_colour,
            hair_colour,
        }
    }
}

/// A colour on the polyline through `stops`, `t` in [0, 1].
fn along(stops: &[[f32; 3]], t: f64) -> [f32; 3] {
    let at = t.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let i = (at as usize).min(stops.len() - 2);
    let f = (at - i as f64) as f32;
    [0, 1, 2].map(|a| stops[i][a] + (stops[i + 1][a] - stops[i][a]) * f)
}
