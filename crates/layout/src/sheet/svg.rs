//! Pages as SVG at their own size in millimetres.

use std::fmt::Write as _;

use base64::Engine as _;

use super::page::{A4_MM, Anchor, Item, MARK_MM, Mark, NUMBER_MM, Page};

/// Pages below each other.
pub(super) fn svg(pages: &[Page]) -> String {
    let [width, height] = A4_MM;
    let all = height * pages.len() as f64;
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}mm\" height=\"{all}mm\" viewBox=\"0 0 {width} \
         {all}\" font-family=\"Helvetica, Arial, sans-serif\" role=\"img\" aria-label=\"Placement sheet\">\n\
         <rect width=\"{width}\" height=\"{all}\" fill=\"#fff\"/>\n"
    );
    for (number, page) in pages.iter().enumerate() {
        let _ = writeln!(out, "<g transform=\"translate(0 {})\">", height * number as f64);
        for item in &page.items {
            draw(&mut out, item);
        }
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    out
}

fn draw(out: &mut String, item: &Item) {
    match item {
        Item::Picture { at, size, jpeg, .. } => {
            let data = base64::engine::general_purpose::STANDARD.encode(jpeg);
            let _ = writeln!(
                out,
                "<image x=\"{:.3}\" y=\"{:.3}\" width=\"{:.3}\" height=\"{:.3}\" href=\"data:image/jpeg;base64,{data}\"/>",
                at[0], at[1], size[0], size[1]
            );
        }
        Item::Line { from, to, width } => {
            let _ = writeln!(
                out,
                "<line x1=\"{:.3}\" y1=\"{:.3}\" x2=\"{:.3}\" y2=\"{:.3}\" stroke=\"#000\" stroke-width=\"{width}\"/>",
                from[0], from[1], to[0], to[1]
            );
        }
        Item::Text { at, anchor, size, bold, text } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let weight = if *bold { " font-weight=\"bold\"" } else { "" };
            let _ = writeln!(
                out,
                "<text x=\"{:.3}\" y=\"{:.3}\" font-size=\"{size}\" text-anchor=\"{anchor}\"{weight}>{}</text>",
                at[0],
                at[1],
                escaped(text)
            );
        }
        Item::Mark { at: [x, y], mark, head, number } => {
            let (fill, ink) = if *head { ("#222", "#fff") } else { ("#fff", "#000") };
            let r = MARK_MM;
            let form = match mark {
                Mark::Circle => format!("<circle cx=\"{x:.3}\" cy=\"{y:.3}\" r=\"{r}\""),
                Mark::Square => format!(
                    "<rect x=\"{:.3}\" y=\"{:.3}\" width=\"{:.3}\" height=\"{:.3}\"",
                    x - 0.9 * r,
                    y - 0.9 * r,
                    1.8 * r,
                    1.8 * r
                ),
                Mark::Diamond => format!(
                    "<path d=\"M{x:.3} {:.3}L{:.3} {y:.3}L{x:.3} {:.3}L{:.3} {y:.3}Z\"",
                    y - 1.3 * r,
                    x + 1.3 * r,
                    y + 1.3 * r,
                    x - 1.3 * r
                ),
            };
            let _ = writeln!(
                out,
                "{form} fill=\"{fill}\" stroke=\"#000\" stroke-width=\"0.3\"/><text x=\"{x:.3}\" y=\"{:.3}\" \
                 font-size=\"{NUMBER_MM}\" text-anchor=\"middle\" fill=\"{ink}\">{}</text>",
                y + 0.36 * NUMBER_MM,
                escaped(number)
            );
        }
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
