//! The CSV form: `marker,role,vertex`.

use super::{MapFileError, MappedMarker, MarkerMap, MarkerPlace};

/// Letters of a wrong header that a message shows.
const MOST_SHOWN: usize = 60;

pub(super) fn read(text: &str) -> Result<MarkerMap, MapFileError> {
    let wrong = |line: usize, what: String, remedy: &'static str| MapFileError {
        place: format!("line {}", line + 1),
        what,
        remedy,
    };
    let mut lines = text.lines().enumerate();
    let header = lines.next().map_or("", |(_, line)| line).trim();
    if header.split(',').map(str::trim).collect::<Vec<_>>() != ["marker", "role", "vertex"] {
        let shown: String = header.chars().take(MOST_SHOWN).collect();
        let more = if shown.len() < header.len() { " …" } else { "" };
        let what = format!("header {shown:?}{more}");
        return Err(wrong(0, what, "open with marker,role,vertex"));
    }
    let mut map = MarkerMap::default();
    for (number, line) in lines {
        if line.trim().is_empty() {
            continue;
        }
        let fields: Vec<&str> = line.split(',').map(str::trim).collect();
        let [label, role, vertex] = fields[..] else {
            return Err(wrong(
                number,
                format!("{} fields", fields.len()),
                "write marker,role,vertex",
            ));
        };
        let twice = match role {
            "face" => map.face_labels().any(|l| l == label),
            "head" => map.head.iter().any(|l| l == label),
            _ => return Err(wrong(number, format!("role {role:?}"), "write face or head")),
        };
        if twice {
            return Err(wrong(number, format!("marker {label:?} twice"), "keep one of the two"));
        }
        if role == "head" {
            map.head.push(label.to_owned());
            continue;
        }
        let vertex = vertex.parse().map_err(|_| {
            wrong(number, format!("vertex {vertex:?}"), "write the vertex's index, counted from 0")
        })?;
        map.face.push(MappedMarker { label: label.to_owned(), place: MarkerPlace::Vertex(vertex) });
    }
    Ok(map)
}
