//! Kouadio 1997: points of the face that the markers move, and the rules of a bank of shapes.

pub(crate) mod associated_rows;
pub(crate) mod bank;
pub(crate) mod marker_triangles;
