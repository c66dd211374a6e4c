//! Places and the ways between them, as two types: the sum of two places is nonsense, and a place is
//! moved where a displacement is only turned.

use std::iter::Sum;
use std::ops::{Add, AddAssign, Deref, DerefMut, Div, Mul, Neg, Sub};

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use serde::{Deserialize, Serialize};

macro_rules! three_numbers {
    ($(#[$about:meta])* $name:ident) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, Default, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
        #[serde(from = "[f64; 3]", into = "[f64; 3]")]
        #[repr(transparent)]
        pub struct $name(pub DVec3);

        impl $name {
            /// Of its three coordinates.
            pub const fn new(x: f64, y: f64, z: f64) -> Self {
                Self(DVec3::new(x, y, z))
            }

            /// The same function of each coordinate.
            pub fn map(self, f: impl Fn(f64) -> f64) -> Self {
                Self(DVec3::new(f(self.0.x), f(self.0.y), f(self.0.z)))
            }
        }

        impl From<[f64; 3]> for $name {
            fn from(coordinates: [f64; 3]) -> Self {
                Self(DVec3::from_array(coordinates))
            }
        }

        impl From<$name> for [f64; 3] {
            fn from(it: $name) -> Self {
                it.0.to_array()
            }
        }

        impl PartialEq<[f64; 3]> for $name {
            fn eq(&self, other: &[f64; 3]) -> bool {
                self.0.to_array() == *other
            }
        }

        /// The coordinates, lengths and products of glam's vector.
        impl Deref for $name {
            type Target = DVec3;
            fn deref(&self) -> &DVec3 {
                &self.0
            }
        }

        impl DerefMut for $name {
            fn deref_mut(&mut self) -> &mut DVec3 {
                &mut self.0
            }
        }
    };
}

three_numbers! {
    /// A place in space. A marker that is not seen is at [`Point::UNSEEN`].
    Point
}

three_numbers! {
    /// A way from one place to another.
    Displacement
}

impl Point {
    /// The origin.
    pub const ORIGIN: Point = Point(DVec3::ZERO);
    /// Where a marker is that is not seen: nowhere, three NaN.
    pub const UNSEEN: Point = Point(DVec3::NAN);

    /// Whether it is a place: a marker was seen there.
    pub fn is_seen(self) -> bool {
        !self.0.is_nan()
    }
}

impl Displacement {
    /// No way at all.
    pub const ZERO: Displacement = Displacement(DVec3::ZERO);

    /// The inner product.
    pub fn dot(self, other: Displacement) -> f64 {
        self.0.dot(other.0)
    }

    /// The vector product.
    pub fn cross(self, other: Displacement) -> Displacement {
        Displacement(self.0.cross(other.0))
    }
}

impl Sub for Point {
    type Output = Displacement;
    fn sub(self, from: Point) -> Displacement {
        Displacement(self.0 - from.0)
    }
}

impl Add<Displacement> for Point {
    type Output = Point;
    fn add(self, by: Displacement) -> Point {
        Point(self.0 + by.0)
    }
}

impl Sub<Displacement> for Point {
    type Output = Point;
    fn sub(self, by: Displacement) -> Point {
        Point(self.0 - by.0)
    }
}

impl AddAssign<Displacement> for Point {
    fn add_assign(&mut self, by: Displacement) {
        self.0 += by.0;
    }
}

impl Add for Displacement {
    type Output = Displacement;
    fn add(self, other: Displacement) -> Displacement {
        Displacement(self.0 + other.0)
    }
}

impl AddAssign for Displacement {
    fn add_assign(&mut self, other: Displacement) {
        self.0 += other.0;
    }
}

impl Sub for Displacement {
    type Output = Displacement;
    fn sub(self, other: Displacement) -> Displacement {
        Displacement(self.0 - other.0)
    }
}

impl Neg for Displacement {
    type Output = Displacement;
    fn neg(self) -> Displacement {
        Displacement(-self.0)
    }
}

impl Mul<f64> for Displacement {
    type Output = Displacement;
    fn mul(self, factor: f64) -> Displacement {
        Displacement(self.0 * factor)
    }
}

impl Mul<Displacement> for f64 {
    type Output = Displacement;
    fn mul(self, displacement: Displacement) -> Displacement {
        Displacement(self * displacement.0)
    }
}

impl Div<f64> for Displacement {
    type Output = Displacement;
    fn div(self, divisor: f64) -> Displacement {
        Displacement(self.0 / divisor)
    }
}

impl Sum for Displacement {
    fn sum<I: Iterator<Item = Displacement>>(displacements: I) -> Displacement {
        displacements.fold(Displacement::ZERO, |sum, d| sum + d)
    }
}

/// The mean of some points; NaN of none.
pub fn centroid(points: impl IntoIterator<Item = Point>) -> Point {
    let mut count = 0_usize;
    let mut sum = DVec3::ZERO;
    for point in points {
        count += 1;
        sum += point.0;
    }
    Point(sum / count as f64)
}

/// The coordinates of points or displacements one after the other: x, y, z of the first, then of the
/// second, and so on.
pub fn coordinates<T: Pod>(points: &[T]) -> &[f64] {
    bytemuck::cast_slice(points)
}

/// Points or displacements as rows of three numbers, to be changed.
pub fn rows_mut<T: Pod>(points: &mut [T]) -> &mut [[f64; 3]] {
    bytemuck::cast_slice_mut(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_ways_add_up() {
        let (a, b) = (Point::new(1.0, 2.0, 3.0), Point::new(-1.0, 0.5, 4.0));
        let way = b - a;
        assert_eq!(way, [-2.0, -1.5, 1.0]);
        assert_eq!(a + way, b);
        assert_eq!(b - way, a);
        assert_eq!((way * 2.0 - way).dot(way), way.length_squared());
        assert_eq!(centroid([a, b]), [0.0, 1.25, 3.5]);
        assert!(!Point::UNSEEN.is_seen() && a.is_seen());
    }

    #[test]
    fn points_lie_as_numbers_in_memory() {
        let mut points = [Point::new(1.0, 2.0, 3.0), Point::new(4.0, 5.0, 6.0)];
        points[1][0] += 0.5;
        assert_eq!(coordinates(&points), [1.0, 2.0, 3.0, 4.5, 5.0, 6.0]);
    }
}
