//! Three numbers with the few operations that the head needs; plain f64, so every platform agrees.

use std::ops::{Add, AddAssign, Mul, Sub};

/// A position or a displacement, millimetres while the head is being built.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Vec3 {
    pub x: f64,
    pub y: f64,
    pub z: f64,
}

/// Short constructor.
pub(crate) const fn v3(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3 { x, y, z }
}

impl Vec3 {
    pub(crate) fn dot(self, o: Vec3) -> f64 {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    pub(crate) fn cross(self, o: Vec3) -> Vec3 {
        v3(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }

    pub(crate) fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// Unit vector; the zero vector stays zero.
    pub(crate) fn unit(self) -> Vec3 {
        let length = self.length();
        if length > 0.0 { self * (1.0 / length) } else { self }
    }

    pub(crate) fn lerp(self, o: Vec3, t: f64) -> Vec3 {
        self * (1.0 - t) + o * t
    }

    /// The mirror image across the plane between left and right.
    pub(crate) fn mirrored(self) -> Vec3 {
        v3(-self.x, self.y, self.z)
    }

    /// Rotated about the X axis through `centre`; positive angles tip +Y towards +Z.
    pub(crate) fn turned_about_x(self, centre: Vec3, radians: f64) -> Vec3 {
        let (s, c) = (libm::sin(radians), libm::cos(radians));
        let d = self - centre;
        centre + v3(d.x, c * d.y - s * d.z, s * d.y + c * d.z)
    }

    /// Rotated about the Y axis through `centre`; positive angles tip +Z towards +X.
    pub(crate) fn turned_about_y(self, centre: Vec3, radians: f64) -> Vec3 {
        let (s, c) = (libm::sin(radians), libm::cos(radians));
        let d = self - centre;
        centre + v3(c * d.x + s * d.z, d.y, c * d.z - s * d.x)
    }

    /// Rotated about the Z axis through `centre`; positive angles tip +X towards +Y.
    pub(crate) fn turned_about_z(self, centre: Vec3, radians: f64) -> Vec3 {
        let (s, c) = (libm::sin(radians), libm::cos(radians));
        let d = self - centre;
        centre + v3(c * d.x - s * d.y, s * d.x + c * d.y, d.z)
    }

    /// As a colour.
    pub(crate) fn linear_rgb(self) -> [f32; 3] {
        [self.x as f32, self.y as f32, self.z as f32]
    }

    /// Metres in single precision, from millimetres.
    pub(crate) fn metres(self) -> [f32; 3] {
        [(self.x * 1e-3) as f32, (self.y * 1e-3) as f32, (self.z * 1e-3) as f32]
    }
}

impl Add for Vec3 {
    type Output = Vec3;
    fn add(self, o: Vec3) -> Vec3 {
        v3(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl AddAssign for Vec3 {
    fn add_assign(&mut self, o: Vec3) {
        *self = *self + o;
    }
}

impl Sub for Vec3 {
    type Output = Vec3;
    fn sub(self, o: Vec3) -> Vec3 {
        v3(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Mul<f64> for Vec3 {
    type Output = Vec3;
    fn mul(self, s: f64) -> Vec3 {
        v3(self.x * s, self.y * s, self.z * s)
    }
}

/// 0 below `a`, 1 above `b`, a smooth cubic between; `a > b` turns it round.
pub(crate) fn smoothstep(a: f64, b: f64, x: f64) -> f64 {
    let t = ((x - a) / (b - a)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Gaussian bump: 1 at 0, exp(-1/2) at distance 1.
pub(crate) fn bump(distance: f64) -> f64 {
    libm::exp(-0.5 * distance * distance)
}

/// The same, but exactly 0 beyond distance 3.
pub(crate) fn local_bump(distance: f64) -> f64 {
    const TAIL: f64 = 0.011_108_996_538_242_306; // exp(-4.5)
    if distance >= 3.0 { 0.0 } else { (bump(distance) - TAIL) / (1.0 - TAIL) }
}

/// Linear interpolation.
pub(crate) fn mix(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}
