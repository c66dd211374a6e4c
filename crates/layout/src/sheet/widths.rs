//! Widths of Helvetica's characters, thousandths of its size (Adobe's font metrics of the base fonts).

/// From the space to the tilde.
#[rustfmt::skip]
const REGULAR: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278,
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556,
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778,
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556,
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];

/// The width of a text in Helvetica of a size; other characters are as wide as an n.
pub(super) fn width(text: &str, size: f64) -> f64 {
    let of = |c: char| {
        let place = (c as usize).checked_sub(32);
        f64::from(place.and_then(|place| REGULAR.get(place)).copied().unwrap_or(556))
    };
    text.chars().map(of).sum::<f64>() * size / 1000.0
}
