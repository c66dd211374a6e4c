//! The face that people have in mind, drawn in lines on the built-in head: still at several moments, and moving.

use mimique_actor::{Density, FaceLine, FaceLinePart, HeadSpec, build_head, face_lines};
use mimique_avatar::{ActionUnit, Avatar};
use mimique_report::svg::{Anchor, Moving, Svg, WIDTH};
use mimique_stats::UnitCourse;

/// Key frames of the moving face: between them browsers interpolate.
const KEY_FRAMES: usize = 16;
/// Moments that are drawn still.
const STILLS: usize = 4;
/// Heights of the moving face and of a still one.
const LARGE: f64 = 190.0;
const SMALL: f64 = 86.0;

/// What is said beside the faces.
pub(super) struct PlayedWords<'w> {
    /// `Press to see it move`.
    pub press: &'w str,
    /// After the time of a still face: `s`.
    pub seconds: &'w str,
}

/// The lines of the built-in head, and how far each shape moves their points.
pub(super) struct DrawnHead {
    avatar: Avatar,
    lines: Vec<FaceLine>,
    /// Left, right, lowest, highest point of the lines at rest, metres.
    bounds: [f64; 4],
}

impl DrawnHead {
    /// Height of the drawing.
    pub(super) const HEIGHT: f64 = LARGE + 52.0;

    /// The built-in head, coarse: lines are all that is drawn of it.
    pub(super) fn new() -> Self {
        let spec = HeadSpec { density: Density::nearest(2000), ..HeadSpec::person(1) };
        let (avatar, lines) = (build_head(&spec), face_lines(&spec));
        let mut head = Self { avatar, lines, bounds: [0.0; 4] };
        let points: Vec<[f64; 2]> = head.points(&[]).into_iter().flatten().collect();
        let least = |axis: usize| points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let most = |axis: usize| points.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        head.bounds = [least(0), most(0), least(1), most(1)];
        head
    }

    /// The points of every line at these weights of the head's shapes, metres.
    fn points(&self, weights: &[f64]) -> Vec<Vec<[f64; 2]>> {
        let Some(skin) = self.avatar.skin() else { return Vec::new() };
        let posed = skin.posed(weights);
        let at = |&vertex: &u32| {
            let [x, y, _] = posed[vertex as usize].map(f64::from);
            [x, y]
        };
        self.lines.iter().map(|line| line.vertices.iter().map(at).collect()).collect()
    }

    /// The face at each of these moments (shares of the clip), in a box: its left end, top and height.
    fn in_box(
        &self,
        courses: &[UnitCourse],
        moments: &[f64],
        [left, top, height]: [f64; 3],
    ) -> Vec<Vec<Vec<[f64; 2]>>> {
        let [low_x, _, low_y, high_y] = self.bounds;
        let scale = height / (high_y - low_y);
        let place = |[x, y]: [f64; 2]| [left + (x - low_x) * scale, top + (high_y - y) * scale];
        let shape_names = &self.avatar.shape_names;
        let units: Vec<(ActionUnit, &UnitCourse)> = courses
            .iter()
            .filter_map(|course| Some((ActionUnit::of(&course.unit, shape_names)?, course)))
            .collect();
        let of = |&moment: &f64| {
            let mut weights = vec![0.0; shape_names.len()];
            for (unit, course) in &units {
                for (shape, share) in &unit.shapes {
                    weights[*shape] += activation(course, moment) * share;
                }
            }
            let lines = self.points(&weights).into_iter();
            lines.map(|line| line.into_iter().map(place).collect()).collect()
        };
        moments.iter().map(of).collect()
    }

    fn width(&self, height: f64) -> f64 {
        let [low_x, high_x, low_y, high_y] = self.bounds;
        height * (high_x - low_x) / (high_y - low_y)
    }

    /// Draws the moving face at the left, still ones beside it.
    pub(super) fn draw(
        &self,
        svg: &mut Svg,
        (id, words): (&str, &PlayedWords<'_>),
        (courses, lasts_s): (&[UnitCourse], f64),
        top: f64,
    ) {
        let moments: Vec<f64> =
            (0..=KEY_FRAMES).map(|frame| frame as f64 / KEY_FRAMES as f64).collect();
        let all = |moment: f64| courses.iter().map(|own| activation(own, moment)).sum::<f64>();
        let peak = moments.iter().enumerate().max_by(|a, b| all(*a.1).total_cmp(&all(*b.1)));
        let still = peak.map_or(0, |(frame, _)| frame);
        let left = 24.0;
        let frames = self.in_box(courses, &moments, [left, top + 6.0, LARGE]);
        svg.begin_playable(id, words.press);
        let backdrop = [left - 12.0, top, self.width(LARGE) + 24.0, LARGE + 20.0];
        svg.class_rect(backdrop, "backdrop");
        self.lines_of(svg, &frames, Moving { id, still, lasts_s: Some(lasts_s) });
        svg.end_playable();
        let under = left + self.width(LARGE) / 2.0;
        svg.text(under, top + LARGE + 36.0, "small", Anchor::Middle, words.press);
        let first = left + self.width(LARGE) + 30.0;
        let step = (WIDTH - first) / 2.0;
        for place in 0..STILLS {
            let moment = (place as f64 + 0.5) / STILLS as f64;
            let x = first + step * (place % 2) as f64 + (step - self.width(SMALL)) / 2.0;
            let y = top + 6.0 + (SMALL + 22.0) * (place / 2) as f64;
            let frames = self.in_box(courses, &[0.0, moment], [x, y, SMALL]);
            let own = format!("{id}_{place}");
            self.lines_of(svg, &frames, Moving { id: &own, still: 1, lasts_s: None });
            let time = format!("{:.2} {}", moment * lasts_s, words.seconds);
            let middle = x + self.width(SMALL) / 2.0;
            svg.text(middle, y + SMALL + 14.0, "small", Anchor::Middle, &time);
        }
    }

    /// The lines at the frames, of which the first is at rest.
    fn lines_of(&self, svg: &mut Svg, frames: &[Vec<Vec<[f64; 2]>>], moving: Moving<'_>) {
        let mut irises = 0;
        for (place, line) in self.lines.iter().enumerate() {
            let own: Vec<&[[f64; 2]]> =
                frames.iter().map(|frame| frame[place].as_slice()).collect();
            let class = match line.part {
                FaceLinePart::Brow => "brow",
                FaceLinePart::Eye | FaceLinePart::Mouth => "opening",
                FaceLinePart::Outline | FaceLinePart::Nose | FaceLinePart::Fold => "feature",
                FaceLinePart::Lips => "lips",
            };
            svg.moving_path(&own, line.closed, class, moving);
            if line.part == FaceLinePart::Eye {
                irises += 1;
                svg.iris(&own, irises, moving);
            }
        }
    }
}

/// How far a unit is activated at a moment, a share of the clip; it begins and ends at rest.
fn activation(course: &UnitCourse, moment: f64) -> f64 {
    let bins = course.activation.len() as f64;
    let place = moment * bins - 0.5;
    let at = |bin: f64| {
        let inside = bin >= 0.0 && bin < bins;
        if inside { course.activation.get(bin as usize).copied().unwrap_or_default() } else { 0.0 }
    };
    let (before, share) = (place.floor(), place - place.floor());
    at(before) + share * (at(before + 1.0) - at(before))
}
