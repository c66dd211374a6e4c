//! A page of a sheet: a picture, marks and words at places in millimetres, whatever they are written as.

/// Where a text is anchored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// At its beginning.
    Start,
    /// In its middle.
    Middle,
    /// At its end.
    End,
}

/// How a marker is drawn, so that sides are told apart without colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// On the person's left.
    Circle,
    /// On the person's right.
    Square,
    /// In the middle.
    Diamond,
}

/// Something on a page, millimetres from its upper left corner.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A grey picture as JPEG.
    Picture {
        /// Left and upper edge.
        at: [f64; 2],
        /// Width and height.
        size: [f64; 2],
        /// Points across and down.
        points: [usize; 2],
        /// The JPEG.
        jpeg: Vec<u8>,
    },
    /// A mark with its number.
    Mark {
        /// Its middle.
        at: [f64; 2],
        /// Its form.
        mark: Mark,
        /// Whether it is a head marker, drawn dark.
        head: bool,
        /// Its number.
        number: String,
    },
    /// A line.
    Line {
        /// From here.
        from: [f64; 2],
        /// To there.
        to: [f64; 2],
        /// Its width, millimetres.
        width: f64,
    },
    /// A text.
    Text {
        /// Where its baseline is anchored.
        at: [f64; 2],
        /// How.
        anchor: Anchor,
        /// Its size, millimetres.
        size: f64,
        /// Whether it is bold.
        bold: bool,
        /// The words.
        text: String,
    },
}

/// A page of A4.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Page {
    /// What is on it, from back to front.
    pub items: Vec<Item>,
}

/// Width and height of a page, millimetres.
pub const A4_MM: [f64; 2] = [210.0, 297.0];
/// Half the width of a mark, millimetres.
pub const MARK_MM: f64 = 2.3;
/// Size of a mark's number, millimetres.
pub const NUMBER_MM: f64 = 2.5;

impl Page {
    /// Adds a text.
    pub fn text(&mut self, at: [f64; 2], anchor: Anchor, size: f64, text: impl Into<String>) {
        self.items.push(Item::Text { at, anchor, size, bold: false, text: text.into() });
    }

    /// Adds a bold text.
    pub fn bold(&mut self, at: [f64; 2], anchor: Anchor, size: f64, text: impl Into<String>) {
        self.items.push(Item::Text { at, anchor, size, bold: true, text: text.into() });
    }

    /// Adds a line.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], width: f64) {
        self.items.push(Item::Line { from, to, width });
    }

    /// Adds a bar of 50 mm from a point to the right, to see whether the sheet was printed at its own size.
    pub fn bar(&mut self, [x, y]: [f64; 2]) {
        self.line([x, y], [x + 50.0, y], 0.5);
        for step in 0..=5 {
            let at = x + 10.0 * f64::from(step);
            let height = if step % 5 == 0 { 2.5 } else { 1.5 };
            self.line([at, y - height], [at, y], 0.3);
        }
        self.text([x + 53.0, y], Anchor::Start, 3.2, "50 mm: measure it after printing at 100 %");
    }
}
