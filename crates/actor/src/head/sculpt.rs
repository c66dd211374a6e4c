//! The head as blended implicit volumes (after Inigo Quilez' smooth minimum): cranium, brow, cheek
//! bones, nose, jaw, neck. The cage is shrink-wrapped onto its zero level. Millimetres.

use super::identity::Identity;
use super::vec3::{Vec3, mix, v3};

enum Volume {
    Ellipsoid {
        centre: Vec3,
        radii: Vec3,
    },
    /// Two spheres and the cone between them.
    RoundCone {
        a: Vec3,
        b: Vec3,
        ra: f64,
        rb: f64,
    },
}

struct Piece {
    volume: Volume,
    /// Width of the blend with what was there before.
    blend: f64,
    /// A pair, one on each side.
    pair: bool,
    /// Carved out instead of added.
    carve: bool,
}

/// The blended volumes of one person.
pub(crate) struct Sculpt {
    pieces: Vec<Piece>,
}

/// Where the features of one person stand, from which sculpt and loops are both made.
#[derive(Debug, Clone)]
pub(crate) struct Landmarks {
    /// Centre of the left eyeball, and its radius.
    pub eye: Vec3,
    pub eye_radius: f64,
    /// Height of the line between the lips; half the width of the mouth.
    pub mouth_y: f64,
    pub mouth_half: f64,
    /// Heights of the red of the lips, and how far they stand out (1 = average).
    pub lip_upper: f64,
    pub lip_lower: f64,
    pub lip_swell: f64,
    /// Height of the nose's tip and base; half breadth over the wings.
    pub nose_tip: Vec3,
    pub nose_base_y: f64,
    pub wing_half: f64,
    /// Lowest point of the chin.
    pub chin_y: f64,
    /// Middle of the left ear.
    pub ear: Vec3,
    pub ear_scale: f64,
    /// Height of the brow's middle.
    pub brow_y: f64,
    /// Breadth of the neck, 1 = average.
    pub neck: f64,
    /// Hinge of the jaw (on the midline plane).
    pub jaw_hinge: Vec3,
}

impl Landmarks {
    pub(crate) fn new(who: &Identity) -> Landmarks {
        let m = who.masculinity;
        let nose_base_y = -46.0 - 2.0 * who.nose_length - 1.0 * m;
        let mouth_y = nose_base_y - 21.0 - 0.8 * m;
        Landmarks {
            eye: v3(31.5 + 0.8 * who.eye_spacing, 0.0, 70.2),
            eye_radius: 16.6 + 0.45 * who.eye_size - 0.6 * m,
            mouth_y,
            mouth_half: 24.5 + 1.3 * who.mouth_width + 1.0 * m,
            lip_upper: (8.2 + 0.9 * who.lip_fullness - 1.0 * m - 1.5 * who.age).max(3.5),
            lip_lower: (10.2 + 1.0 * who.lip_fullness - 0.8 * m - 1.5 * who.age).max(4.5),
            lip_swell: 1.0 + 0.06 * who.lip_fullness - 0.08 * m - 0.12 * who.age,
            nose_tip: v3(0.0, nose_base_y + 8.5, 112.5 + 1.2 * who.nose_bridge),
            nose_base_y,
            wing_half: 16.5 + 1.1 * who.nose_width + 0.8 * m,
            chin_y: mouth_y - 38.5 - 2.0 * who.chin - 3.0 * m,
            ear: v3(70.0, -17.0, -6.0),
            ear_scale: 1.0 + 0.06 * who.ear_size + 0.05 * m + 0.06 * who.age,
            brow_y: 22.5 + 1.2 * who.brow_height - 2.0 * m - 1.0 * who.age,
            neck: 1.0 + 0.16 * (m - 0.35),
            jaw_hinge: v3(0.0, -22.0, 8.0),
        }
    }
}

impl Sculpt {
    pub(crate) fn new(who: &Identity, at: &Landmarks) -> Sculpt {
        let m = who.masculinity;
        let mut s = Sculpt { pieces: Vec::new() };
        let width = 1.0 + 0.022 * who.face_width + 0.01 * m;
        let jaw = 1.0 + 0.03 * who.jaw_width + 0.07 * (m - 0.35);
        let chin = at.chin_y;
        let tip = at.nose_tip;
        // Skull and face.
        s.ellipsoid(v3(0.0, 25.0, -3.0), v3(74.5, 80.0, 94.0), 1.0);
        s.ellipsoid(v3(0.0, -24.0, 26.0), v3(59.0 * width, 64.0, 58.0), 26.0);
        // Jaw: body from angle to chin, muzzle, chin.
        let angle = v3(43.5 * jaw, at.mouth_y + 3.0, 14.0);
        let body = v3(24.5 * jaw, mix(at.mouth_y, chin, 0.50), 63.0);
        s.pair_cone(angle, body, 11.5, 11.5, 34.0);
        s.pair_cone(body, v3(14.0, chin + 16.5, 78.0), 11.5, 11.5, 22.0);
        s.ellipsoid(v3(0.0, at.mouth_y + 1.0, 62.0), v3(37.0, 33.0, 37.5), 16.0);
        let chin_half = mix(5.5, 10.5, m);
        s.pair_cone(
            v3(chin_half, chin + 15.5, 87.0 + 1.5 * who.chin),
            v3(-chin_half, chin + 15.5, 87.0 + 1.5 * who.chin),
            11.5,
            11.5,
            14.0,
        );
        // Cheeks.
        s.pair_ellipsoid(
            v3(43.0 * width, -25.0, 55.0),
            v3(20.0, 15.0, 24.0 + 1.3 * who.cheekbones),
            16.0,
        );
        s.pair_ellipsoid(
            v3(35.0 * width, -51.0, 51.0),
            v3(22.0 + 1.2 * who.fullness, 27.0, 29.0 + 0.8 * who.fullness - 2.5 * who.age),
            18.0,
        );
        s.pair_cone(v3(54.0 * width, -20.0, 44.0), v3(62.0, -14.0, 6.0), 8.0, 7.0, 24.0);
        // Brow ridge and sockets.
        s.pair_cone(
            v3(11.0, at.brow_y - 4.0, 79.5 + 2.5 * m),
            v3(42.0, at.brow_y - 1.0, 66.0 + 1.5 * m),
            8.5,
            8.5,
            16.0,
        );
        s.carve_pair(v3(at.eye.x + 1.0, 0.0, 98.5), v3(18.0, 13.0, 15.0), 14.0);
        // Nose: bridge, tip, wings, base.
        s.cone(v3(0.0, 7.0, 83.5), tip + v3(0.0, 5.0, -8.5), 6.5, 7.0, 10.0);
        s.pair_cone(v3(6.0, -14.0, 84.0), v3(8.0, tip.y + 2.0, 93.0), 5.0, 7.0, 9.0);
        s.ellipsoid(tip + v3(0.0, -0.3, -9.5), v3(8.8, 8.8, 9.5), 6.0);
        s.pair_ellipsoid(v3(at.wing_half - 6.0, tip.y - 1.6, tip.z - 16.0), v3(6.0, 6.6, 9.0), 5.0);
        s.cone(
            tip + v3(0.0, -4.8, -8.0),
            v3(0.0, at.nose_base_y + 1.5, tip.z - 17.0),
            4.0,
            5.0,
            5.0,
        );
        // Neck.
        let neck = at.neck;
        s.cone(v3(0.0, -40.0, -19.0), v3(0.0, -220.0, -27.0), 42.0 * neck, 50.0 * neck, 20.0);
        // The sternomastoids, from behind the ears to the notch of the breastbone.
        s.pair_cone(
            v3(43.0 * neck, -62.0, -10.0),
            v3(10.0, -182.0, 21.0 + 50.0 * (neck - 1.0)),
            8.5,
            7.0,
            9.0,
        );
        s
    }

    fn push(&mut self, volume: Volume, blend: f64, pair: bool, carve: bool) {
        self.pieces.push(Piece { volume, blend, pair, carve });
    }

    fn ellipsoid(&mut self, centre: Vec3, radii: Vec3, blend: f64) {
        self.push(Volume::Ellipsoid { centre, radii }, blend, false, false);
    }

    fn pair_ellipsoid(&mut self, centre: Vec3, radii: Vec3, blend: f64) {
        self.push(Volume::Ellipsoid { centre, radii }, blend, true, false);
    }

    fn carve_pair(&mut self, centre: Vec3, radii: Vec3, blend: f64) {
        self.push(Volume::Ellipsoid { centre, radii }, blend, true, true);
    }

    fn cone(&mut self, a: Vec3, b: Vec3, ra: f64, rb: f64, blend: f64) {
        self.push(Volume::RoundCone { a, b, ra, rb }, blend, false, false);
    }

    fn pair_cone(&mut self, a: Vec3, b: Vec3, ra: f64, rb: f64, blend: f64) {
        self.push(Volume::RoundCone { a, b, ra, rb }, blend, true, false);
    }

    /// Signed distance, nearly: negative inside, zero on the skin.
    pub(crate) fn distance(&self, p: Vec3) -> f64 {
        let mut d = f64::INFINITY;
        for piece in &self.pieces {
            let mut q = volume_distance(&piece.volume, p);
            if piece.pair {
                q = smooth_min(q, volume_distance(&piece.volume, p.mirrored()), piece.blend);
            }
            d = if d.is_infinite() {
                q
            } else if piece.carve {
                -smooth_min(-d, q, piece.blend)
            } else {
                smooth_min(d, q, piece.blend)
            };
        }
        d
    }

    /// Forward differences from the distance `d` at `p`.
    fn gradient(&self, p: Vec3, d: f64) -> Vec3 {
        let h = 1e-3;
        let along = |e: Vec3| (self.distance(p + e) - d) / h;
        v3(along(v3(h, 0.0, 0.0)), along(v3(0.0, h, 0.0)), along(v3(0.0, 0.0, h)))
    }

    /// Outward unit normal of the level through `p`.
    pub(crate) fn normal(&self, p: Vec3) -> Vec3 {
        self.gradient(p, self.distance(p)).unit()
    }

    /// Onto the skin along the gradient (damped Newton steps).
    pub(crate) fn project(&self, start: Vec3) -> Vec3 {
        let mut p = start;
        for _ in 0..12 {
            let d = self.distance(p);
            if d.abs() < 1e-4 {
                break;
            }
            let g = self.gradient(p, d);
            let square = g.dot(g).max(0.05);
            p = p - g * (0.9 * d / square);
        }
        p
    }

    /// One Newton step towards the skin: enough for a place that is nearly on it.
    pub(crate) fn towards(&self, p: Vec3) -> Vec3 {
        let d = self.distance(p);
        let g = self.gradient(p, d);
        p - g * (d / g.dot(g).max(0.05))
    }

    /// The skin seen from the front at (x, y).
    pub(crate) fn front(&self, x: f64, y: f64) -> Vec3 {
        self.march(v3(x, y, 170.0), v3(0.0, 0.0, -1.0))
    }

    /// The skin seen from below at (x, z).
    pub(crate) fn below(&self, x: f64, z: f64) -> Vec3 {
        self.march(v3(x, -190.0, z), v3(0.0, 1.0, 0.0))
    }

    /// The first skin on the way from outside.
    fn march(&self, from: Vec3, direction: Vec3) -> Vec3 {
        let mut p = from;
        for _ in 0..120 {
            let d = self.distance(p);
            if d.abs() < 1e-3 || (p - from).length() > 220.0 {
                break;
            }
            // The blends overstate distance a little: short steps keep the march outside.
            p += direction * (0.7 * d);
        }
        p
    }
}

fn volume_distance(volume: &Volume, p: Vec3) -> f64 {
    match *volume {
        Volume::Ellipsoid { centre, radii } => {
            let q = p - centre;
            let k0 = v3(q.x / radii.x, q.y / radii.y, q.z / radii.z).length();
            let k1 =
                v3(q.x / (radii.x * radii.x), q.y / (radii.y * radii.y), q.z / (radii.z * radii.z))
                    .length();
            if k1 > 0.0 { k0 * (k0 - 1.0) / k1 } else { -radii.x.min(radii.y).min(radii.z) }
        }
        Volume::RoundCone { a, b, ra, rb } => {
            let ab = b - a;
            let t = ((p - a).dot(ab) / ab.dot(ab)).clamp(0.0, 1.0);
            (p - (a + ab * t)).length() - mix(ra, rb, t)
        }
    }
}

/// Polynomial smooth minimum: the plain one where the two differ by more than `k`.
fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}
