//! Colours of the skin, painted on the cage and carried along by subdivision. Linear RGB.

use super::Cage;
use super::identity::Identity;
use super::topology::{Feature, Site};
use super::vec3::{Vec3, bump, mix, smoothstep, v3};

/// The tint of each cage vertex.
pub(crate) fn cage_tints(cage: &Cage, who: &Identity) -> Vec<Vec3> {
    let [r, g, b] = who.skin_colour.map(f64::from);
    let skin = v3(r, g, b);
    // Blood shows through: redder, and more so on light skin.
    let flushed = v3(r * 0.97, g * 0.74, b * 0.74);
    let lip = v3(r * 0.80, g * 0.48, b * 0.52);
    let shade = v3(r * 0.72, g * 0.62, b * 0.64);
    let inner = v3(0.30 * r, 0.16 * g, 0.16 * b);
    let dark = v3(0.03 * r + 0.004, 0.02 * g + 0.002, 0.02 * b + 0.002);
    let at = &cage.at;
    cage.topology
        .sites
        .iter()
        .zip(&cage.surface)
        .map(|(&site, &p)| {
            let side = p.x.abs();
            let near = |x: f64, y: f64, rx: f64, ry: f64| {
                bump((((side - x) / rx).powi(2) + ((p.y - y) / ry).powi(2)).sqrt())
                    * smoothstep(20.0, 60.0, p.z)
            };
            let mut blush = 0.55 * near(40.0, -32.0, 14.0, 11.0)
                + 0.5 * near(0.0, at.nose_tip.y, 9.0, 8.0)
                + 0.2 * near(0.0, at.chin_y + 14.0, 12.0, 8.0);
            let mut dusk = 0.12 * near(at.eye.x, -12.0, 14.0, 5.0);
            let mut red = 0.0;
            let mut deep = 0.0;
            let mut hollow = 0.0;
            match site {
                Site::Ring(Feature::Mouth, ring, _) => {
                    red = [0.0, 0.0, 0.10, 0.8, 1.0, 1.0, 1.0, 0.9, 0.6][(ring as usize).min(8)];
                    deep = if ring >= 7 { 0.7 } else { 0.0 };
                }
                Site::Fill(Feature::Mouth, ..) => deep = 1.0,
                Site::Ring(Feature::EyeLeft | Feature::EyeRight, ring, _) => {
                    let lid = [0.0, 0.05, 0.2, 0.45, 0.4, 0.5, 0.2, 0.2][(ring as usize).min(7)];
                    dusk = dusk.max(lid * if p.y > at.eye.y - 3.0 { 1.0 } else { 0.4 });
                    blush = [0.0, 0.0, 0.1, 0.2, 0.2, 0.5, 1.0, 1.0][(ring as usize).min(7)];
                }
                Site::Ring(Feature::NostrilLeft | Feature::NostrilRight, ring, _) => {
                    hollow = [0.0, 0.75, 1.0, 1.0][(ring as usize).min(3)];
                }
                Site::Fill(Feature::NostrilLeft | Feature::NostrilRight, ..) => hollow = 1.0,
                Site::Ring(Feature::EarLeft | Feature::EarRight, ..)
                | Site::Fill(Feature::EarLeft | Feature::EarRight, ..) => blush = 0.55,
                _ => {}
            }
            let stubble = smoothstep(0.6, 1.0, who.masculinity)
                * smoothstep(at.mouth_y + 14.0, at.mouth_y + 2.0, p.y + 0.15 * side)
                * smoothstep(at.chin_y - 14.0, at.chin_y + 4.0, p.y)
                * smoothstep(5.0, 40.0, p.z);
            let mut c = skin.lerp(flushed, blush.min(1.0));
            c = c.lerp(shade, (dusk + 0.35 * stubble).min(1.0));
            c = c.lerp(lip, red * mix(1.0, 0.6, who.masculinity));
            c.lerp(inner, deep).lerp(dark, hollow)
        })
        .collect()
}
