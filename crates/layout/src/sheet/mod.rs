//! The placement sheet: the head from the front, from three quarters and in profile with numbered marks, to print
//! at its own size and lay beside the actor, and a table of what to measure.

mod along_skin;
mod measures;
mod page;
mod pdf;
mod picture;
mod svg;
mod widths;

pub use along_skin::AlongSkin;
pub use measures::{Measures, ToLandmark};

use mimique_geometry::{DVec3, Point};
use mimique_solver::{SkinGradients, SkinMesh};

use crate::face::Face;
use crate::layout::{Layout, LayoutMarker, Side};
use crate::view::View;
use page::{A4_MM, Anchor, Item, Mark, Page};
use picture::HeadPicture;

/// Rows of the table on a page.
const ROWS: usize = 52;
/// How far below the chin and behind the ears pictures reach, metres.
const BELOW_CHIN_M: f64 = 0.02;
/// See [`BELOW_CHIN_M`].
const BEHIND_EAR_M: f64 = 0.055;
/// Skin that is turned away farther than this shows no marks.
const FACING: f64 = 0.12;
/// A mark is seen where nothing is in front of it by more, metres.
const HIDDEN_M: f64 = 0.003;

/// What a sheet is drawn for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SheetOptions {
    /// Breadth of the actor's face between the cheekbones, metres; the avatar's where it is not given.
    pub face_width: Option<f64>,
    /// Height of the actor's face from the nasion to the bottom of the chin, metres.
    pub face_height: Option<f64>,
}

/// A sheet, ready to be written.
#[derive(Debug, Clone)]
pub struct Sheet {
    pages: Vec<Page>,
    /// What to measure, marker by marker.
    pub measures: Vec<Measures>,
}

/// The views of a sheet: words, and degrees towards the person's left.
const VIEWS: [(&str, f64); 5] = [
    ("front", 0.0),
    ("three-quarter, the person's left", 45.0),
    ("three-quarter, the person's right", -45.0),
    ("profile, the person's left", 90.0),
    ("profile, the person's right", -90.0),
];

impl Sheet {
    /// Of a layout.
    pub fn of(face: &Face<'_>, layout: &Layout, options: &SheetOptions) -> Self {
        let factors = factors(face, options);
        let scaled = |p: Point| Point(p.0 * factors);
        let mesh = SkinMesh {
            positions: face.skin.mesh.positions.iter().map(|&p| scaled(p)).collect(),
            triangles: face.skin.mesh.triangles.clone(),
            shapes: Vec::new(),
        };
        let gradients = SkinGradients::new(&mesh);
        let normals: Vec<DVec3> = (0..mesh.positions.len())
            .map(|v| gradients.normal(v).map_or(DVec3::ZERO, |n| n.0))
            .collect();
        let measures = Measures::of(face, layout, &mesh, &scaled);
        let size = format!(
            "face: {:.0} mm wide, {:.0} mm from nasion to chin",
            1e3 * factors.x * face_width(face),
            1e3 * factors.y * face_height(face)
        );
        let head = Head { face, mesh: &mesh, normals: &normals, size, scaled: &scaled };
        let mut pages: Vec<Page> =
            VIEWS.iter().map(|(name, degrees)| head.page(layout, name, *degrees)).collect();
        let count = measures.len().div_ceil(ROWS);
        for (number, rows) in measures.chunks(ROWS).enumerate() {
            pages.push(table(rows, number + 1, count, &face.skin.name));
        }
        Self { pages, measures }
    }

    /// As PDF, a page each.
    pub fn to_pdf(&self) -> Vec<u8> {
        pdf::pdf(&self.pages)
    }

    /// As SVG, the pages below each other.
    pub fn to_svg(&self) -> String {
        svg::svg(&self.pages)
    }
}

/// How much wider, higher and deeper the actor's face is than the avatar's; depth goes with the width.
fn factors(face: &Face<'_>, options: &SheetOptions) -> DVec3 {
    let ratio = |wanted: Option<f64>, own: f64| {
        wanted.filter(|_| own > 0.0).map_or(1.0, |wanted| wanted / own)
    };
    let across = ratio(options.face_width, face_width(face));
    let up = ratio(options.face_height, face_height(face));
    DVec3::new(across, up, across)
}

/// Breadth of an avatar's face between the cheekbones, metres: the widest in front of the ears between eyes and
/// nose.
pub fn face_width(face: &Face<'_>) -> f64 {
    let marks = &face.landmarks;
    let [low, high] = [marks.subnasale.y, marks.eye[0].y];
    let here = |p: &&Point| p.y > low && p.y < high && p.z > marks.ear_front_z + 0.015;
    let half = (face.skin.mesh.positions.iter())
        .filter(here)
        .map(|p| face.mirror.plane.distance(*p).abs())
        .fold(0.0, f64::max);
    2.0 * half
}

/// Height of an avatar's face from the nasion to the bottom of the chin, metres.
pub fn face_height(face: &Face<'_>) -> f64 {
    face.landmarks.nasion.y - face.landmarks.gnathion.y
}

/// A head to be drawn.
struct Head<'h> {
    face: &'h Face<'h>,
    mesh: &'h SkinMesh,
    normals: &'h [DVec3],
    /// The face's own size in words.
    size: String,
    scaled: &'h dyn Fn(Point) -> Point,
}

impl Head<'_> {
    fn page(&self, layout: &Layout, name: &str, degrees: f64) -> Page {
        let marks = &self.face.landmarks;
        let view = View::turned(degrees);
        let bottom = (self.scaled)(marks.gnathion).y - BELOW_CHIN_M;
        let top = self.mesh.positions.iter().fold(bottom, |most, p| most.max(p.y));
        // A page holds the face and what is around it, not the back of the head.
        let back = (self.scaled)(Point::new(0.0, 0.0, marks.ear_front_z - BEHIND_EAR_M));
        let across = if degrees.abs() > 60.0 {
            let edge = view.project(back)[0];
            if degrees > 0.0 { [f64::NEG_INFINITY, edge] } else { [edge, f64::INFINITY] }
        } else {
            [f64::NEG_INFINITY, f64::INFINITY]
        };
        let picture = HeadPicture::of(self.mesh, self.normals, view, [bottom, top], across);
        let size = picture.size_mm();
        let corner = [(A4_MM[0] - size[0]) / 2.0, 20.0 + (250.0 - size[1]).max(0.0) / 2.0];
        let mut page = Page::default();
        let title = format!("{}: {name}", self.face.skin.name);
        page.bold([10.0, 11.0], Anchor::Start, 4.6, title);
        let (face, heads) = (layout.markers.len(), layout.head.len());
        let words = format!(
            "{face} face markers, {heads} head markers (dark). Round: the person's left. Square: right. Diamond: middle."
        );
        page.text([10.0, 16.5], Anchor::Start, 3.2, words);
        page.text([200.0, 288.0], Anchor::End, 3.2, self.size.clone());
        page.items.push(Item::Picture {
            at: corner,
            size,
            points: picture.points,
            jpeg: picture.jpeg.clone(),
        });
        let all = layout.markers.iter().chain(&layout.head).enumerate();
        for (number, marker) in all {
            let p = self.mesh.positions[marker.vertex];
            let facing = self.normals[marker.vertex].dot(view.towards()) > FACING;
            if facing && picture.depth.sees(p, HIDDEN_M) {
                let [x, y] = picture.at_mm(p);
                page.items.push(mark(marker, number, [corner[0] + x, corner[1] + y]));
            }
        }
        page.bar([10.0, 288.0]);
        page
    }
}

fn mark(marker: &LayoutMarker, number: usize, at: [f64; 2]) -> Item {
    let mark = match marker.side {
        Side::Left => Mark::Circle,
        Side::Right => Mark::Square,
        Side::Middle => Mark::Diamond,
    };
    Item::Mark { at, mark, head: marker.part.is_none(), number: (number + 1).to_string() }
}

/// A page of the table.
fn table(rows: &[Measures], number: usize, of: usize, avatar: &str) -> Page {
    let mut page = Page::default();
    let title = format!("{avatar}: distances in millimetres, page {number} of {of}");
    page.bold([10.0, 11.0], Anchor::Start, 4.6, title);
    let words = "left and right: from the middle plane; height: above (+) or below (-) the nasion; straight: \
                 from the nasion; the rest along the skin, as a tape lies";
    page.text([10.0, 16.5], Anchor::Start, 2.9, words);
    let columns = [
        (16.0, Anchor::End, "no."),
        (19.0, Anchor::Start, "label"),
        (66.0, Anchor::End, "side"),
        (81.0, Anchor::End, "height"),
        (98.0, Anchor::End, "straight"),
        (112.0, Anchor::End, "skin"),
        (115.0, Anchor::Start, "to landmark"),
        (156.0, Anchor::End, "skin"),
        (159.0, Anchor::Start, "to landmark"),
    ];
    let top = 24.0;
    for (x, anchor, name) in columns {
        page.bold([x, top], anchor, 3.0, name);
    }
    page.line([10.0, top + 1.4], [200.0, top + 1.4], 0.3);
    for (row, m) in rows.iter().enumerate() {
        let y = top + 5.6 + 5.0 * row as f64;
        for ((x, anchor, _), cell) in columns.into_iter().zip(m.cells()) {
            page.text([x, y], anchor, 3.0, cell);
        }
        page.line([10.0, y + 1.5], [200.0, y + 1.5], 0.08);
    }
    page
}
