//! Pages as PDF at their own size, with the fonts that every reader has.

use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};

use super::page::{A4_MM, Anchor, Item, MARK_MM, Mark, NUMBER_MM, Page};
use super::widths::width;

/// Points of PDF per millimetre.
const POINTS: f64 = 72.0 / 25.4;
/// How far a circle's handles reach, as a share of its radius.
const HANDLE: f64 = 0.552_284_75;

/// Numbers of the objects of a document, in the order in which they are asked for.
struct Numbers(i32);

impl Numbers {
    fn next(&mut self) -> Ref {
        self.0 += 1;
        Ref::new(self.0)
    }
}

/// A document of these pages.
pub(super) fn pdf(pages: &[Page]) -> Vec<u8> {
    let mut numbers = Numbers(0);
    let (catalog, tree) = (numbers.next(), numbers.next());
    let (regular, bold) = (numbers.next(), numbers.next());
    let mut document = Pdf::new();
    document.catalog(catalog).pages(tree);
    let ids: Vec<Ref> = pages.iter().map(|_| numbers.next()).collect();
    document.pages(tree).kids(ids.iter().copied()).count(ids.len() as i32);
    for (id, name) in [(regular, "Helvetica"), (bold, "Helvetica-Bold")] {
        let mut font = document.type1_font(id);
        font.base_font(Name(name.as_bytes()));
        font.encoding_predefined(Name(b"WinAnsiEncoding"));
        font.finish();
    }
    for (page, id) in pages.iter().zip(ids) {
        let content = numbers.next();
        let mut pictures: Vec<(String, Ref)> = Vec::new();
        for item in &page.items {
            if let Item::Picture { points, jpeg, .. } = item {
                let picture = numbers.next();
                let mut object = document.image_xobject(picture, jpeg);
                object.filter(Filter::DctDecode);
                object.width(points[0] as i32).height(points[1] as i32);
                object.color_space().device_gray();
                object.bits_per_component(8);
                object.finish();
                pictures.push((format!("P{}", pictures.len()), picture));
            }
        }
        let drawn = drawn(page);
        document.stream(content, &drawn);
        let mut entry = document.page(id);
        let [width, height] = A4_MM.map(|mm| (mm * POINTS) as f32);
        entry.media_box(Rect::new(0.0, 0.0, width, height)).parent(tree).contents(content);
        let mut resources = entry.resources();
        let mut fonts = resources.fonts();
        fonts.pair(Name(b"R"), regular);
        fonts.pair(Name(b"B"), bold);
        fonts.finish();
        let mut objects = resources.x_objects();
        for (name, picture) in &pictures {
            objects.pair(Name(name.as_bytes()), *picture);
        }
    }
    document.finish()
}

/// A place of a page in PDF's points, whose origin is below.
fn place([x, y]: [f64; 2]) -> [f32; 2] {
    [(x * POINTS) as f32, ((A4_MM[1] - y) * POINTS) as f32]
}

/// The drawing of a page.
fn drawn(page: &Page) -> Vec<u8> {
    let mut content = Content::new();
    let mut pictures = 0;
    for item in &page.items {
        match item {
            Item::Picture { at, size, .. } => {
                let [x, y] = place([at[0], at[1] + size[1]]);
                let [w, h] = size.map(|mm| (mm * POINTS) as f32);
                content.save_state();
                content.transform([w, 0.0, 0.0, h, x, y]);
                content.x_object(Name(format!("P{pictures}").as_bytes()));
                content.restore_state();
                pictures += 1;
            }
            Item::Line { from, to, width } => {
                let ([ax, ay], [bx, by]) = (place(*from), place(*to));
                content.set_line_width((width * POINTS) as f32);
                content.set_stroke_gray(0.0);
                content.move_to(ax, ay).line_to(bx, by).stroke();
            }
            Item::Text { at, anchor, size, bold, text } => {
                let font = if *bold { Name(b"B") } else { Name(b"R") };
                write(&mut content, *at, *anchor, *size, font, 0.0, text);
            }
            Item::Mark { at, mark, head, number } => {
                content.set_fill_gray(if *head { 0.13 } else { 1.0 });
                content.set_stroke_gray(0.0);
                content.set_line_width((0.3 * POINTS) as f32);
                form(&mut content, *at, *mark);
                content.fill_nonzero_and_stroke();
                let ink = if *head { 1.0 } else { 0.0 };
                let at = [at[0], at[1] + 0.36 * NUMBER_MM];
                write(&mut content, at, Anchor::Middle, NUMBER_MM, Name(b"R"), ink, number);
            }
        }
    }
    content.finish().into_vec()
}

/// The outline of a mark.
fn form(content: &mut Content, [x, y]: [f64; 2], mark: Mark) {
    let r = MARK_MM;
    let corners = |content: &mut Content, corners: [[f64; 2]; 4]| {
        for (number, corner) in corners.into_iter().enumerate() {
            let [px, py] = place([x + corner[0], y + corner[1]]);
            if number == 0 {
                content.move_to(px, py);
            } else {
                content.line_to(px, py);
            }
        }
        content.close_path();
    };
    match mark {
        Mark::Square => {
            let s = 0.9 * r;
            corners(content, [[-s, -s], [s, -s], [s, s], [-s, s]]);
        }
        Mark::Diamond => {
            let s = 1.3 * r;
            corners(content, [[0.0, -s], [s, 0.0], [0.0, s], [-s, 0.0]]);
        }
        Mark::Circle => {
            let h = HANDLE * r;
            let at = |dx: f64, dy: f64| place([x + dx, y + dy]);
            let [sx, sy] = at(r, 0.0);
            content.move_to(sx, sy);
            let quarters = [
                [[r, h], [h, r], [0.0, r]],
                [[-h, r], [-r, h], [-r, 0.0]],
                [[-r, -h], [-h, -r], [0.0, -r]],
                [[h, -r], [r, -h], [r, 0.0]],
            ];
            for [a, b, c] in quarters {
                let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(|[dx, dy]| at(dx, dy));
                content.cubic_to(ax, ay, bx, by, cx, cy);
            }
            content.close_path();
        }
    }
}

fn write(
    content: &mut Content,
    at: [f64; 2],
    anchor: Anchor,
    size: f64,
    font: Name<'_>,
    grey: f32,
    text: &str,
) {
    let shift = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * width(text, size),
        Anchor::End => width(text, size),
    };
    let [x, y] = place([at[0] - shift, at[1]]);
    content.set_fill_gray(grey);
    content.begin_text();
    content.set_font(font, (size * POINTS) as f32);
    content.next_line(x, y);
    content.show(Str(&encoded(text)));
    content.end_text();
}

/// A text in WinAnsi: Latin letters are one byte as in Unicode, what it has not is a question mark.
fn encoded(text: &str) -> Vec<u8> {
    let byte = |c: char| match u32::from(c) {
        code @ (0x20..=0x7e | 0xa0..=0xff) => code as u8,
        _ => b'?',
    };
    text.chars().map(byte).collect()
}
