//! The placement sheet: its own size, a bar to measure, every marker with its number.

use mimique_layout::{
    Choice, Face, Layout, Method, Sheet, SheetOptions, Side, choose_heads, face_height, face_width,
};

use crate::support::{self, Ground};

fn layout(face: &Face<'_>) -> Layout {
    let ground = Ground::of(face);
    let units = ground.units(true, &[], 0.008);
    let chosen = Method::Farthest.choose(&ground.task(&units), 23, &Choice::default()).unwrap();
    let heads = choose_heads(face, &units.spacing, &chosen.vertices(), 6, 3e-4).unwrap();
    Layout::named(face, &chosen.units, &heads.vertices)
}

/// Numbers of an attribute of all elements that begin so.
fn numbers(svg: &str, element: &str, attribute: &str) -> Vec<f64> {
    svg.lines()
        .filter(|line| line.starts_with(element))
        .filter_map(|line| {
            line.split(&format!(" {attribute}=\"")).nth(1)?.split('"').next()?.parse().ok()
        })
        .collect()
}

#[test]
fn svg_pages_are_a4_with_a_bar_of_50_mm_and_every_number() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let layout = layout(&face);
    let sheet = Sheet::of(&face, &layout, &SheetOptions::default());
    let svg = sheet.to_svg();
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    // Five views and a page of the table.
    assert!(
        svg.contains("width=\"210mm\" height=\"1782mm\" viewBox=\"0 0 210 1782\""),
        "{}",
        &svg[..200]
    );
    let (x1, x2) = (numbers(&svg, "<line", "x1"), numbers(&svg, "<line", "x2"));
    let bars = x1.iter().zip(&x2).filter(|(a, b)| (*b - *a - 50.0).abs() < 1e-9).count();
    assert_eq!(bars, 5, "one below each view");
    for number in 1..=layout.markers.len() + layout.head.len() {
        assert!(svg.contains(&format!(">{number}</text>")), "{number} is on no view");
    }
    for marker in layout.markers.iter().chain(&layout.head) {
        assert!(svg.contains(&format!(">{}</text>", marker.label)), "{}", marker.label);
    }
}

#[test]
fn the_front_view_is_at_the_head_s_own_size() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let layout = layout(&face);
    let sheet = Sheet::of(&face, &layout, &SheetOptions::default());
    let svg = sheet.to_svg();
    let front = svg.split("</g>").next().unwrap();
    // The squares (right) and circles (left) of a pair lie as far apart as on the head.
    let centre = |number: usize| -> Option<[f64; 2]> {
        let line = front.lines().find(|line| line.ends_with(&format!(">{number}</text>")))?;
        let text = line.split("<text x=\"").nth(1)?;
        let x = text.split('"').next()?.parse().ok()?;
        let y: f64 = text.split("y=\"").nth(1)?.split('"').next()?.parse().ok()?;
        Some([x, y])
    };
    let mut compared = 0;
    for (i, a) in layout.markers.iter().enumerate() {
        for (j, b) in layout.markers.iter().enumerate().skip(i + 1) {
            let (Some(p), Some(q)) = (centre(i + 1), centre(j + 1)) else { continue };
            let (from, to) = (face.place(a.vertex), face.place(b.vertex));
            let drawn = [q[0] - p[0], p[1] - q[1]];
            let own = [1e3 * (to.x - from.x), 1e3 * (to.y - from.y)];
            // Seen from the front the person's left is on the right.
            assert!(
                (drawn[0] - own[0]).abs() < 0.01 && (drawn[1] - own[1]).abs() < 0.01,
                "{drawn:?} {own:?}"
            );
            compared += 1;
        }
    }
    assert!(compared > 50, "{compared} pairs in front");
    assert!(layout.markers.iter().any(|m| m.side == Side::Middle));
}

#[test]
fn a_larger_actor_has_a_larger_sheet() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let layout = layout(&face);
    let (width, height) = (face_width(&face), face_height(&face));
    assert!((0.10..0.18).contains(&width) && (0.09..0.15).contains(&height), "{width} {height}");
    let own = Sheet::of(&face, &layout, &SheetOptions::default());
    let options = SheetOptions { face_width: Some(1.1 * width), face_height: Some(0.9 * height) };
    let other = Sheet::of(&face, &layout, &options);
    for (a, b) in own.measures.iter().zip(&other.measures) {
        assert!((b.left_mm - 1.1 * a.left_mm).abs() < 1e-6, "{}", a.label);
        assert!((b.above_nasion_mm - 0.9 * a.above_nasion_mm).abs() < 1e-6, "{}", a.label);
    }
}

#[test]
fn measures_say_where_a_marker_is() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let layout = layout(&face);
    let sheet = Sheet::of(&face, &layout, &SheetOptions::default());
    assert_eq!(sheet.measures.len(), layout.markers.len() + layout.head.len());
    for (m, marker) in sheet.measures.iter().zip(layout.markers.iter().chain(&layout.head)) {
        let p = face.place(marker.vertex);
        let straight = 1e3 * (p - face.landmarks.nasion).length();
        assert!((m.from_nasion_mm - straight).abs() < 1e-9);
        for along in &m.along_skin {
            let landmarks = face.landmarks.measured();
            let (_, at) = landmarks.iter().find(|(name, _)| *name == along.landmark).unwrap();
            // Along the skin it is no shorter than through the air.
            assert!(along.mm > 1e3 * (p - *at).length() - 0.01, "{}: {along:?}", m.label);
            assert!(along.mm < 4.0 * 1e3 * (p - *at).length() + 10.0, "{}: {along:?}", m.label);
        }
        assert!(m.along_skin[0].mm <= m.along_skin[1].mm);
    }
    let mirrored = |label: &str| label.replace("_L", "_R");
    for m in
        sheet.measures.iter().filter(|m| m.label.contains("_L") && !m.label.starts_with("Head"))
    {
        let other = sheet.measures.iter().find(|o| o.label == mirrored(&m.label)).unwrap();
        assert!((m.left_mm + other.left_mm).abs() < 0.2, "{}", m.label);
        assert!((m.above_nasion_mm - other.above_nasion_mm).abs() < 0.2, "{}", m.label);
    }
}

#[test]
fn pdf_pages_are_a4_with_the_pictures() {
    let skin = support::skin();
    let face = Face::of(&skin).unwrap();
    let layout = layout(&face);
    let pdf = Sheet::of(&face, &layout, &SheetOptions::default()).to_pdf();
    let text = String::from_utf8_lossy(&pdf);
    assert!(text.starts_with("%PDF-1.") && text.trim_end().ends_with("%%EOF"));
    assert_eq!(text.matches("/Type /Page\n").count() + text.matches("/Type /Page ").count(), 6);
    assert!(text.contains("/Count 6"));
    assert_eq!(text.matches("/Subtype /Image").count(), 5);
    // A4 in points, and the bar: 10 mm from the left, 50 mm long.
    assert!(text.contains("595.27"), "the width of a page");
    let points = |mm: f64| mm * 72.0 / 25.4;
    let starts = |line: &str, verb: &str| -> Option<f64> {
        line.ends_with(verb).then(|| line.split(' ').next()?.parse().ok()).flatten()
    };
    let lines: Vec<&str> = text.lines().collect();
    let bars = lines.windows(2).filter(|pair| {
        let (from, to) = (starts(pair[0], " m"), starts(pair[1], " l"));
        from.zip(to).is_some_and(|(a, b)| {
            (a - points(10.0)).abs() < 0.01 && (b - points(60.0)).abs() < 0.01
        })
    });
    assert_eq!(bars.count(), 5);
    // The same layout gives the same bytes.
    assert!(pdf == Sheet::of(&face, &layout, &SheetOptions::default()).to_pdf());
}
