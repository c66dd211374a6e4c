//! Drawing of figures as SVG that stands alone: its own colours for light, dark and print.

use std::fmt::Write;

use crate::document::escape;

/// Width of every figure, so that text has the same size in all of them.
pub const WIDTH: f64 = 440.0;

/// Blues from light to dark, even steps of lightness: readable in grey and by the colour-blind.
const LIGHTEST: [f64; 3] = [227.0, 238.0, 249.0];
const DARKEST: [f64; 3] = [8.0, 48.0, 107.0];

/// A drawing that grows downwards.
pub struct Svg {
    body: String,
    height: f64,
    title: String,
    /// Whether a part of it can be pressed: it is no picture then.
    has_controls: bool,
}

/// Where a mark leads.
#[derive(Debug, Clone)]
pub struct Link {
    /// The address.
    pub address: String,
    /// What is found there.
    pub title: String,
}

/// How the lines of a part of a drawing move.
#[derive(Clone, Copy)]
pub struct Moving<'i> {
    /// Identifier of the part, the only one of a page; where the part is pressed, the lines move.
    pub id: &'i str,
    /// The frame that is drawn where nothing moves.
    pub still: usize,
    /// How long they move, seconds; none of lines that stay still.
    pub lasts_s: Option<f64>,
}

/// Where a text is anchored.
#[derive(Clone, Copy)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

impl Svg {
    /// An empty drawing of a height; its title says what it shows.
    pub fn new(title: &str, height: f64) -> Self {
        Self { body: String::new(), height, title: title.to_owned(), has_controls: false }
    }

    /// A line of text.
    pub fn text(&mut self, x: f64, y: f64, class: &str, anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let _ = writeln!(
            self.body,
            r#"<text x="{}" y="{}" class="{class}" text-anchor="{anchor}">{}</text>"#,
            short(x),
            short(y),
            escape(text)
        );
    }

    /// A text on a filled area, light or dark by what is behind it.
    pub fn text_on(&mut self, x: f64, y: f64, shade: f64, text: &str) {
        let class = if shade > 0.5 { "on-dark" } else { "on-light" };
        self.text(x, y, class, Anchor::Middle, text);
    }

    /// A filled rectangle: left, top, width, height.
    pub fn rect(&mut self, [x, y, width, height]: [f64; 4], fill: &str) {
        let _ = writeln!(
            self.body,
            r#"<rect x="{}" y="{}" width="{}" height="{}" fill="{fill}"/>"#,
            short(x),
            short(y),
            short(width.max(0.0)),
            short(height)
        );
    }

    /// The same in a style of its own.
    pub fn class_rect(&mut self, [x, y, width, height]: [f64; 4], class: &str) {
        let _ = writeln!(
            self.body,
            r#"<rect x="{}" y="{}" width="{}" height="{}" class="{class}"/>"#,
            short(x),
            short(y),
            short(width.max(0.0)),
            short(height)
        );
    }

    /// A straight line.
    pub fn line(&mut self, from: [f64; 2], to: [f64; 2], class: &str) {
        let _ = writeln!(
            self.body,
            r#"<line x1="{}" y1="{}" x2="{}" y2="{}" class="{class}"/>"#,
            short(from[0]),
            short(from[1]),
            short(to[0]),
            short(to[1])
        );
    }

    /// A line through several points.
    pub fn path(&mut self, points: &[[f64; 2]], class: &str) {
        let points: Vec<String> =
            points.iter().map(|[x, y]| format!("{} {}", short(*x), short(*y))).collect();
        let _ = writeln!(self.body, r#"<path d="M{}" class="{class}"/>"#, points.join("L"));
    }

    /// A line of a colour and dashes of its own.
    pub fn coloured_path(&mut self, points: &[[f64; 2]], (colour, dashes): (&str, &str)) {
        let points: Vec<String> =
            points.iter().map(|[x, y]| format!("{} {}", short(*x), short(*y))).collect();
        let _ = writeln!(
            self.body,
            r#"<path d="M{}" fill="none" stroke="{colour}" stroke-width="1.5" stroke-dasharray="{dashes}"/>"#,
            points.join("L")
        );
    }

    /// An area of a colour, see-through.
    pub fn band(&mut self, outline: &[[f64; 2]], colour: &str) {
        let points: Vec<String> =
            outline.iter().map(|[x, y]| format!("{} {}", short(*x), short(*y))).collect();
        let _ = writeln!(
            self.body,
            r#"<path d="M{}Z" fill="{colour}" fill-opacity="0.18" stroke="none"/>"#,
            points.join("L")
        );
    }

    /// Begins a part that is played when it is pressed.
    pub fn begin_playable(&mut self, id: &str, label: &str) {
        self.has_controls = true;
        let label = escape(label);
        let _ = writeln!(self.body, r##"<a href="#{id}" id="{id}" aria-label="{label}">"##);
    }

    /// Ends it.
    pub fn end_playable(&mut self) {
        self.body.push_str("</a>\n");
    }

    /// What is drawn leads somewhere, where there is a link.
    pub fn linked(&mut self, link: Option<&Link>, draw: impl FnOnce(&mut Self)) {
        let Some(Link { address, title }) = link else { return draw(self) };
        self.has_controls = true;
        let (address, title) = (escape(address), escape(title));
        let _ = writeln!(
            self.body,
            r#"<a href="{address}" class="clip" aria-label="{title}"><title>{title}</title>"#
        );
        draw(self);
        self.body.push_str("</a>\n");
    }

    /// A line at each of its frames.
    pub fn moving_path(
        &mut self,
        frames: &[&[[f64; 2]]],
        closed: bool,
        class: &str,
        moving: Moving<'_>,
    ) {
        let path = moving_outline(frames, closed, &format!(r#" class="{class}""#), moving);
        let _ = writeln!(self.body, "{path}");
    }

    /// An iris behind the opening between the lids, whose first frame is at rest: the opening's `number` in the face.
    pub fn iris(&mut self, opening: &[&[[f64; 2]]], number: usize, moving: Moving<'_>) {
        let Some(rest) = opening.first().filter(|rest| !rest.is_empty()) else { return };
        let middle = |axis: usize| rest.iter().map(|p| p[axis]).sum::<f64>() / rest.len() as f64;
        let xs = || rest.iter().map(|point| point[0]);
        let width = xs().fold(f64::MIN, f64::max) - xs().fold(f64::MAX, f64::min);
        let [x, y] = [middle(0), middle(1)];
        let id = format!("{}_iris_{number}", moving.id);
        let clip = moving_outline(opening, true, "", moving);
        let (radius, pupil) = (short(0.21 * width), short(0.1 * width));
        let [x, y] = [short(x), short(y)];
        let _ = writeln!(
            self.body,
            r##"<clipPath id="{id}">{clip}</clipPath><g clip-path="url(#{id})"><circle cx="{x}" cy="{y}" r="{radius}" class="iris"/><circle cx="{x}" cy="{y}" r="{pupil}" class="pupil"/></g>"##
        );
    }

    /// A filled circle.
    pub fn circle(&mut self, x: f64, y: f64, radius: f64, class: &str) {
        let _ = writeln!(
            self.body,
            r#"<circle cx="{}" cy="{}" r="{}" class="{class}"/>"#,
            short(x),
            short(y),
            short(radius)
        );
    }

    /// A filled square that stands on a corner.
    pub fn diamond(&mut self, x: f64, y: f64, radius: f64, class: &str) {
        let _ = writeln!(
            self.body,
            r#"<path d="M{} {}l{r} {r}l-{r} {r}l-{r} -{r}z" class="{class}"/>"#,
            short(x),
            short(y - radius),
            r = short(radius)
        );
    }

    /// The drawing as text.
    pub fn finish(self) -> String {
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" role="{role}" class="mm-figure" aria-label="{title}">
<style>{STYLE}</style>
<rect width="{WIDTH}" height="{height}" class="paper"/>
{body}</svg>
"#,
            height = short(self.height),
            role = if self.has_controls { "group" } else { "img" },
            title = escape(&self.title),
            body = self.body
        )
    }
}

/// The path of a line; where it belongs to something that is pressed, with its frames.
fn moving_outline(
    frames: &[&[[f64; 2]]],
    closed: bool,
    attributes: &str,
    moving: Moving<'_>,
) -> String {
    let outline = |points: &[[f64; 2]]| {
        let points: Vec<String> =
            points.iter().map(|[x, y]| format!("{} {}", short(*x), short(*y))).collect();
        format!("M{}{}", points.join("L"), if closed { "Z" } else { "" })
    };
    let still = frames.get(moving.still).map_or_else(String::new, |points| outline(points));
    let moves = frames.windows(2).any(|pair| pair[0] != pair[1]);
    match moving.lasts_s.filter(|_| moves) {
        None => format!(r#"<path d="{still}"{attributes}/>"#),
        Some(lasts_s) => {
            let values: Vec<String> = frames.iter().map(|points| outline(points)).collect();
            format!(
                r#"<path d="{still}"{attributes}><animate attributeName="d" begin="{}.click" dur="{}s" values="{}"/></path>"#,
                moving.id,
                short(lasts_s),
                values.join(";")
            )
        }
    }
}

const STYLE: &str = "\
.mm-figure .backdrop{fill:#f2f5f8}\
.mm-figure .feature{fill:none;stroke:#555e68;stroke-width:1.2;stroke-linecap:round;stroke-linejoin:round}\
.mm-figure .brow{fill:none;stroke:#1c2126;stroke-width:3;stroke-linecap:round;stroke-linejoin:round}\
.mm-figure .lips{fill:#e7c9c4;stroke:#7a3b32;stroke-width:1}\
.mm-figure .opening{fill:#fff;stroke:#1c2126;stroke-width:1.4;stroke-linejoin:round}\
.mm-figure .iris{fill:#7a8794}.mm-figure .pupil{fill:#10151a}\
.mm-figure a:focus-visible .backdrop{stroke:#0a4f86;stroke-width:2}\
.mm-figure{font:13px system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif}\
.mm-figure text{fill:#1c2126;font-variant-numeric:tabular-nums}\
.mm-figure .soft{fill:#555e68}\
.mm-figure .small{font-size:11px;fill:#555e68}\
.mm-figure .strong{font-weight:600}\
.mm-figure .on-dark{fill:#fff}.mm-figure .on-light{fill:#10151a}\
.mm-figure .on-dark,.mm-figure .on-light{font-size:12px}\
.mm-figure .paper{fill:#fff}\
.mm-figure .rule{stroke:#c9d0d8;stroke-width:1}\
.mm-figure .zero{stroke:#555e68;stroke-width:1;stroke-dasharray:3 3}\
.mm-figure .whisker{stroke:#0a4f86;stroke-width:2}\
.mm-figure .mark{fill:#0a4f86}\
.mm-figure .dot{fill:#0a4f86;fill-opacity:.35}\
.mm-figure .person{fill:none;stroke:#555e68;stroke-width:1;stroke-opacity:.45}\
.mm-figure .faint{stroke-opacity:.08}\
.mm-figure .mean{fill:none;stroke:#0a4f86;stroke-width:3}\
.mm-figure .course{fill:none;stroke:#0a4f86;stroke-width:1.5}\
.mm-figure .thin{stroke:#0a4f86;stroke-width:1}\
.mm-figure .box{fill:#cfe1f2;stroke:#0a4f86;stroke-width:1.5}\
.mm-figure .empty{fill:none;stroke:#c9d0d8;stroke-width:1}\
.mm-figure .clip:hover *,.mm-figure .clip:focus-visible *{fill-opacity:1;stroke:#0a4f86;stroke-width:3}\
.mm-figure .outline{fill:none;stroke:#10151a;stroke-width:1.4}\
@media screen and (prefers-color-scheme:dark){\
.mm-figure text{fill:#e8ebee}.mm-figure .soft,.mm-figure .small{fill:#a9b2bc}\
.mm-figure .on-dark{fill:#fff}.mm-figure .on-light{fill:#10151a}\
.mm-figure .paper{fill:#15191e}.mm-figure .rule{stroke:#3a434d}.mm-figure .empty{stroke:#3a434d}\
.mm-figure .zero{stroke:#a9b2bc}.mm-figure .whisker{stroke:#8cc4f2}.mm-figure .mark{fill:#8cc4f2}\
.mm-figure .dot{fill:#8cc4f2}.mm-figure .clip:hover *,.mm-figure .clip:focus-visible *{stroke:#8cc4f2}.mm-figure .person{stroke:#a9b2bc}.mm-figure .mean{stroke:#8cc4f2}.mm-figure .course,.mm-figure .thin{stroke:#8cc4f2}.mm-figure .box{fill:#1f4468;stroke:#8cc4f2}}";

/// The colour of a shade from 0 (light) to 1 (dark).
pub fn shade(shade: f64) -> String {
    let shade = shade.clamp(0.0, 1.0);
    let channel = |i: usize| (LIGHTEST[i] + (DARKEST[i] - LIGHTEST[i]) * shade).round() as u8;
    format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
}

/// The colour of a value from -1 (orange) over 0 (nearly white) to 1 (blue): both are told apart by the colour-blind
/// (Okabe and Ito).
pub fn diverging(value: f64) -> String {
    const MIDDLE: [f64; 3] = [245.0, 245.0, 245.0];
    let end = if value < 0.0 { [178.0, 72.0, 0.0] } else { [0.0, 88.0, 148.0] };
    let share = value.abs().clamp(0.0, 1.0);
    let channel = |i: usize| (MIDDLE[i] + (end[i] - MIDDLE[i]) * share).round() as u8;
    format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
}

/// Two decimals at most: figures are the same on every machine, and small.
pub fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Cuts a label to so many characters.
pub fn clipped(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let mut cut: String = text.chars().take(most.saturating_sub(1)).collect();
    cut.push('…');
    cut
}

/// An axis over a range of values: round ticks, and the place of a value between two edges.
pub struct Axis {
    low: f64,
    high: f64,
    left: f64,
    right: f64,
    /// Round values from the lowest to the highest.
    pub ticks: Vec<f64>,
    /// Decimals of the ticks.
    pub decimals: usize,
}

impl Axis {
    /// An axis of values from `low` to `high` at least, between the edges `left` and `right`.
    pub fn new(low: f64, high: f64, left: f64, right: f64) -> Self {
        let span = if high > low { high - low } else { 1.0 };
        let raw = span / 5.0;
        let power = 10f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 2.5, 5.0, 10.0]
            .into_iter()
            .map(|factor| factor * power)
            .find(|step| *step >= raw * 0.999)
            .unwrap_or(10.0 * power);
        let first = (low / step).floor();
        let last = ((low + span) / step).ceil();
        let ticks: Vec<f64> =
            (0..=(last - first) as usize).map(|i| (first + i as f64) * step).collect();
        let decimals = (0..6).find(|d| {
            let scaled = step * 10f64.powi(*d);
            (scaled - scaled.round()).abs() < 1e-6
        });
        Self {
            low: first * step,
            high: last * step,
            left,
            right,
            ticks,
            decimals: decimals.unwrap_or(6) as usize,
        }
    }

    /// Where a value lies.
    pub fn place(&self, value: f64) -> f64 {
        self.left + (value - self.low) / (self.high - self.low) * (self.right - self.left)
    }
}
