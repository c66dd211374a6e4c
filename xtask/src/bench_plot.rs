//! Set-up against the number of vertices: measured, and drawn so that light and dark pages show it.

use anyhow::Result;

use crate::bench_partner::number;
use crate::process::say;

/// One size of mesh.
pub struct Point {
    vertices: f64,
    deltas: f64,
    seconds: f64,
    bytes: f64,
}

/// The whole head with its triangles cut into 1, 4, 9, 16, 25 and 36.
pub fn measure(run: impl Fn(usize) -> Result<String>) -> Result<Vec<Point>> {
    (1..=6)
        .map(|parts| {
            let line = run(parts)?;
            let line = line.lines().find(|l| l.starts_with('{')).unwrap_or_default();
            say(line);
            Ok(Point {
                vertices: number(line, "\"vertices\":")?,
                deltas: number(line, "\"deltas\":")?,
                seconds: number(line, "\"seconds\":")?,
                bytes: number(line, "\"bytes\":").unwrap_or(f64::NAN),
            })
        })
        .collect()
}

const WIDTH: f64 = 340.0;
const HEIGHT: f64 = 200.0;

/// Two panels over the same vertices: seconds of processor time, MiB beyond the mesh itself.
pub fn svg(points: &[Point]) -> String {
    let mut out = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 860 300\" role=\"img\" \
         aria-label=\"Set-up time and memory against the number of vertices\">\n<style>\n\
         text{font:13px system-ui,sans-serif;fill:#333}.grid{stroke:#ccc}.line{stroke:#0b6bcb;\
         fill:none;stroke-width:2}.dot{fill:#0b6bcb}.fit{stroke:#999;stroke-dasharray:4 4;fill:none}\n\
         @media (prefers-color-scheme:dark){text{fill:#ddd}.grid{stroke:#444}.line{stroke:#6cb2ff}\
         .dot{fill:#6cb2ff}.fit{stroke:#888}}\n</style>\n",
    );
    let seconds: Vec<f64> = points.iter().map(|p| p.seconds).collect();
    let mebibytes: Vec<f64> = points.iter().map(|p| p.bytes / 1_048_576.0).collect();
    panel(&mut out, 70.0, "set-up, seconds of one core", points, &seconds);
    panel(&mut out, 500.0, "memory beyond the mesh, MiB", points, &mebibytes);
    out.push_str("</svg>\n");
    out
}

fn panel(out: &mut String, left: f64, title: &str, points: &[Point], values: &[f64]) {
    let most = values.iter().copied().filter(|v| v.is_finite()).fold(1e-9, f64::max);
    let step = round_step(most / 4.0);
    let top = (most / step).ceil() * step;
    let place = |vertices: f64, value: f64| {
        (left + WIDTH * vertices / 1e6, 40.0 + HEIGHT * (1.0 - value / top))
    };
    out.push_str(&format!("<text x=\"{left}\" y=\"22\">{title}</text>\n"));
    let mut mark = 0.0;
    while mark <= top * 1.001 {
        let (x, y) = place(0.0, mark);
        let shown = (mark * 1e6).round() / 1e6;
        out.push_str(&format!(
            "<line class=\"grid\" x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{:.1}\" y2=\"{y:.1}\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{shown}</text>\n",
            x + WIDTH,
            x - 8.0,
            y + 4.0
        ));
        mark += step;
    }
    for thousands in [0, 250, 500, 750, 1000] {
        let (x, y) = place(f64::from(thousands) * 1e3, 0.0);
        out.push_str(&format!(
            "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{thousands}</text>\n",
            y + 20.0
        ));
    }
    let (x, y) = place(500_000.0, 0.0);
    let (x, y) = (x, y + 42.0);
    out.push_str(&format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">thousand vertices, 53 shapes</text>\n"));
    // The straight line through 0 and the last point: what growing linearly looks like.
    if let (Some(last), Some(&value)) = (points.last(), values.last()) {
        let ((x0, y0), (x1, y1)) = (place(0.0, 0.0), place(last.vertices, value));
        out.push_str(&format!("<path class=\"fit\" d=\"M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}\"/>\n"));
    }
    let places: Vec<(f64, f64)> =
        points.iter().zip(values).map(|(p, &v)| place(p.vertices, v)).collect();
    let path: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
    out.push_str(&format!("<path class=\"line\" d=\"M{}\"/>\n", path.join("L")));
    for ((x, y), (point, value)) in places.iter().zip(points.iter().zip(values)) {
        out.push_str(&format!(
            "<circle class=\"dot\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.5\"><title>{} vertices, {} \
             deltas: {value:.3}</title></circle>\n",
            point.vertices, point.deltas
        ));
    }
}

/// 1, 2 or 5 times a power of ten, at least `x`.
fn round_step(x: f64) -> f64 {
    let power = 10_f64.powf(x.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|k| k * power).find(|&s| s >= x).unwrap_or(x)
}
