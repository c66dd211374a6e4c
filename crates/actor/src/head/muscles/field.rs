//! What the muscles pull on: each cage vertex with its place on lips and lids, and soft fields of
//! displacement over the face.

use super::super::Cage;
use super::super::topology::{Feature, Site};
use super::super::vec3::{Vec3, local_bump, mix, smoothstep};
use super::super::{eyelids, lips};

/// A vertex of a loop round the mouth.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnLip {
    /// Place along the lip, -1 (right corner) to 1 (left corner).
    pub along: f64,
    pub upper: bool,
    /// Loop: 2 just outside the red to 7 inside, 8 and more the lining.
    pub ring: i32,
}

/// A vertex of a loop round the left eye.
#[derive(Debug, Clone, Copy)]
pub(crate) struct OnLid {
    /// 0 at the inner corner, 1 at the outer.
    pub along: f64,
    pub upper: bool,
    pub ring: i32,
}

/// One cage vertex as the muscles see it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bit {
    pub p: Vec3,
    pub lip: Option<OnLip>,
    pub lid: Option<OnLid>,
    /// How freely it follows a field of the skin: 0 on lids' margins, ears and inside the mouth.
    pub loose: f64,
}

/// The face under the muscles.
pub(crate) struct Flesh<'a> {
    pub cage: &'a Cage,
    pub bits: Vec<Bit>,
}

impl<'a> Flesh<'a> {
    pub(crate) fn new(cage: &'a Cage) -> Flesh<'a> {
        let bits =
            cage.topology.sites.iter().zip(&cage.surface).map(|(&site, &p)| bit(site, p)).collect();
        Flesh { cage, bits }
    }

    /// No displacement anywhere.
    pub(crate) fn still(&self) -> Vec<Vec3> {
        vec![Vec3::default(); self.bits.len()]
    }

    /// A displacement for every vertex.
    pub(crate) fn map(&self, mut f: impl FnMut(&Bit) -> Vec3) -> Vec<Vec3> {
        self.bits.iter().map(&mut f).collect()
    }

    /// The mirror image of a displacement.
    pub(crate) fn mirrored(&self, d: &[Vec3]) -> Vec<Vec3> {
        (0..d.len()).map(|v| d[self.cage.topology.mirror[v] as usize].mirrored()).collect()
    }

    /// A left-side action done on both sides.
    pub(crate) fn on_both_sides(&self, d: &[Vec3]) -> Vec<Vec3> {
        self.mirrored(d).into_iter().zip(d).map(|(a, &b)| a + b).collect()
    }

    /// Weight of a soft spot on the skin of the left side: centre and radii as seen from the front.
    pub(crate) fn spot(&self, bit: &Bit, centre: (f64, f64), radius: (f64, f64)) -> f64 {
        let (dx, dy) = ((bit.p.x - centre.0) / radius.0, (bit.p.y - centre.1) / radius.1);
        let near = local_bump((dx * dx + dy * dy).sqrt());
        near * bit.loose * left_side(bit.p.x) * smoothstep(0.0, 45.0, bit.p.z)
    }

    /// Weight near the lips: 1 on the red, falling off over `reach` mm of skin round it.
    /// `along` and `upper` say which part of the lips acts there.
    pub(crate) fn near_lips(&self, bit: &Bit, reach: f64) -> Option<NearLips> {
        let at = &self.cage.at;
        if let Some(lip) = bit.lip {
            let inside = match lip.ring {
                ..=1 => None,
                2..=6 => Some(1.0),
                7 => Some(0.9),
                8 => Some(0.45),
                _ => Some(0.0),
            };
            if let Some(weight) = inside {
                let upper = if lip.upper { 1.0 } else { 0.0 };
                // The corner belongs to both lips.
                let share = mix(upper, 0.5, smoothstep(0.8, 1.0, lip.along.abs()));
                return Some(NearLips { weight, along: lip.along, upper: share });
            }
        } else if bit.loose <= 0.0 {
            return None;
        }
        let half = at.mouth_half;
        let nearest = bit.p.x.clamp(-half, half);
        let along = libm::asin(nearest / half) / std::f64::consts::FRAC_PI_2;
        let dx = bit.p.x - nearest;
        let dy = bit.p.y - at.mouth_y;
        let red = (if dy > 0.0 { at.lip_upper } else { at.lip_lower })
            * (1.0 - (nearest / half).powi(2)).max(0.0).sqrt();
        let beyond = ((dx * dx + dy * dy).sqrt() - red - 1.5).max(0.0);
        let weight = local_bump(beyond / reach) * smoothstep(10.0, 55.0, bit.p.z) * bit.loose;
        let blur = mix(2.0, 10.0, smoothstep(0.7 * half, 1.3 * half, bit.p.x.abs()));
        Some(NearLips { weight, along, upper: smoothstep(-blur, blur, dy) })
    }
}

/// A vertex's relation to the lips.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NearLips {
    pub weight: f64,
    pub along: f64,
    /// 1 = wholly with the upper lip, 0 = with the lower.
    pub upper: f64,
}

/// 1 on the left, 0 on the right, and left + right = 1 across the midline.
pub(crate) fn left_side(x: f64) -> f64 {
    smoothstep(-9.0, 9.0, x)
}

/// The same along the lips.
pub(crate) fn left_along(t: f64) -> f64 {
    smoothstep(-0.35, 0.35, t)
}

fn bit(site: Site, p: Vec3) -> Bit {
    let mut bit = Bit { p, lip: None, lid: None, loose: 1.0 };
    match site {
        Site::Ring(Feature::Mouth, ring, k) => {
            let (along, upper) = lips::along(k);
            bit.lip = Some(OnLip { along, upper, ring });
            bit.loose = if ring >= 8 { 0.0 } else { 1.0 };
        }
        Site::Fill(Feature::Mouth, i, _) => {
            bit.lip = Some(OnLip { along: 0.0, upper: i < 2, ring: 11 });
            bit.loose = 0.0;
        }
        Site::Ring(Feature::EyeLeft | Feature::EyeRight, ring, k) => {
            if matches!(site, Site::Ring(Feature::EyeLeft, ..)) {
                let (upper, along) = eyelids::along(k);
                bit.lid = Some(OnLid { along, upper, ring });
            }
            bit.loose = [1.0, 0.8, 0.42, 0.1, 0.0, 0.0, 0.0, 0.0][(ring as usize).min(7)];
        }
        Site::Ring(Feature::EarLeft | Feature::EarRight, ..)
        | Site::Fill(Feature::EarLeft | Feature::EarRight, ..) => bit.loose = 0.0,
        _ => {}
    }
    bit
}
