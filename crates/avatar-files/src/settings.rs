//! What a small JSON beside an avatar says of it: parts, unit, names of shapes, locked shapes.
//!
//! `head.avatar.json` beside `head.glb`, or `avatar.json` in a folder or archive of OBJ poses. All
//! keys may be left out:
//!
//! ```json
//! {
//!   "unit": "cm",
//!   "neutral": "generic_neutral_mesh",
//!   "parts": { "M_BackHead": "skin", "Glasses": null },
//!   "vertexParts": [{ "first": 11248, "end": 14062, "part": "socket" }],
//!   "shapes": { "lidsClosed_L": "eyeBlinkLeft" },
//!   "leaveOut": ["identity*"],
//!   "locked": ["eyeLook*"],
//!   "driven": { "teeth": { "teethDown": ["jawOpen"] } }
//! }
//! ```
//!
//! Names of meshes, nodes, materials and groups (`parts`) and of shapes may hold `*` for any
//! letters; of several that fit, the one with the most letters counts. A part that is `null` is left out. `vertexParts` counts an OBJ file's vertices
//! from 0. `driven` is [`Driven`]'s: mesh -> posture -> the face's shapes that drive it.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde_json::{Map, Value};

use crate::{Driven, ReadError};
use mimique_avatar::Part;
use wildmatch::WildMatchPattern;

/// What the user says of an avatar; everything empty when there is no such file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct AvatarSettings {
    /// Length of the file's unit, metres.
    pub unit_metres: Option<f64>,
    /// File of the neutral pose among OBJ poses, without its ending.
    pub neutral: Option<String>,
    /// Pattern of a name and the part, or nothing for what is left out.
    pub parts: Vec<(String, Option<Part>)>,
    /// Vertices of an OBJ file and the part that they are.
    pub vertex_parts: Vec<(Range<usize>, Part)>,
    /// The file's name of a shape, and the name that it gets.
    pub shapes: Vec<(String, String)>,
    /// Patterns of shapes that are not read.
    pub leave_out: Vec<String>,
    /// Patterns of shapes that stay at 0 when weights are solved.
    pub locked: Vec<String>,
    /// Postures of teeth, tongue and accessories, and the shapes that drive them.
    pub driven: Driven,
}

const KEYS: [&str; 8] =
    ["unit", "neutral", "parts", "vertexParts", "shapes", "leaveOut", "locked", "driven"];

impl AvatarSettings {
    /// Where the JSON beside an avatar's file or folder lies: `head.avatar.json` beside `head.glb`,
    /// `bank.avatar.json` beside `bank.tar.xz`.
    pub fn path_beside(avatar: &Path) -> PathBuf {
        avatar.with_file_name(format!("{}.avatar.json", avatar_name(avatar)))
    }

    /// Reads the JSON; `file` names it in errors.
    ///
    /// # Errors
    /// [`ReadError`] with the JSON pointer, the value and what to write instead.
    pub fn from_json(file: &str, bytes: &[u8]) -> Result<Self, ReadError> {
        let value: Value = serde_json::from_slice(bytes).map_err(|e| {
            ReadError::broken(file, format!("no JSON: {e}"), "correct it in an editor")
        })?;
        let at = Place { file, pointer: String::new() };
        let object = at.object(&value)?;
        let mut out = Self::default();
        for (key, value) in object {
            let at = at.below(key);
            match key.as_str() {
                "unit" => out.unit_metres = Some(unit(&at, value)?),
                "neutral" => out.neutral = Some(at.text(value)?.to_owned()),
                "parts" => {
                    for (name, value) in at.object(value)? {
                        let part = match value {
                            Value::Null => None,
                            value => Some(part(&at.below(name), value)?),
                        };
                        out.parts.push((name.clone(), part));
                    }
                }
                "vertexParts" => {
                    for (i, value) in at.list(value)?.iter().enumerate() {
                        out.vertex_parts.push(vertex_part(&at.below(&i.to_string()), value)?);
                    }
                }
                "shapes" => {
                    for (name, value) in at.object(value)? {
                        let new = at.below(name).text(value)?.to_owned();
                        if out.shapes.iter().any(|(_, other)| *other == new) {
                            let what = format!("{new:?} is the name of two shapes");
                            return Err(at.below(name).refuse(what, "give each its own name"));
                        }
                        out.shapes.push((name.clone(), new));
                    }
                }
                "leaveOut" => out.leave_out = at.texts(value)?,
                "locked" => out.locked = at.texts(value)?,
                "driven" => {
                    for (mesh, value) in at.object(value)? {
                        let at = at.below(mesh);
                        let mut postures = BTreeMap::new();
                        for (posture, shapes) in at.object(value)? {
                            postures.insert(posture.clone(), at.below(posture).texts(shapes)?);
                        }
                        out.driven.parts.insert(mesh.clone(), postures);
                    }
                }
                _ => {
                    let remedy = format!("the keys are {}", KEYS.join(", "));
                    return Err(at.refuse("unknown key".to_owned(), remedy));
                }
            }
        }
        Ok(out)
    }
}

/// The name of an avatar: its file's without the ending, of which `.tar.xz` and `.tar.gz` are one.
pub(crate) fn avatar_name(path: &Path) -> String {
    let file = path.file_name().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    match file.strip_suffix(".tar.xz").or(file.strip_suffix(".tar.gz")) {
        Some(name) => name.to_owned(),
        None => path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
    }
}

/// Whether a name fits a pattern, in which `*` stands for any letters.
pub(crate) fn fits(pattern: &str, name: &str) -> bool {
    // A question mark is a letter like others.
    WildMatchPattern::<'*', '\0'>::new(pattern).matches(name)
}

fn unit(at: &Place<'_>, value: &Value) -> Result<f64, ReadError> {
    match at.text(value)? {
        "m" => Ok(1.0),
        "cm" => Ok(0.01),
        "mm" => Ok(0.001),
        other => Err(at.refuse(format!("{other:?} is no unit"), "write m, cm or mm")),
    }
}

fn part(at: &Place<'_>, value: &Value) -> Result<Part, ReadError> {
    let text = at.text(value)?;
    Part::ALL.into_iter().find(|part| part.name() == text).ok_or_else(|| {
        let names = Part::ALL.map(Part::name).join(", ");
        at.refuse(format!("{text:?} is no part"), format!("write one of {names}, or null"))
    })
}

fn vertex_part(at: &Place<'_>, value: &Value) -> Result<(Range<usize>, Part), ReadError> {
    let object = at.object(value)?;
    let number = |key: &str| {
        let value = object.get(key).unwrap_or(&Value::Null);
        value.as_u64().and_then(|n| usize::try_from(n).ok()).ok_or_else(|| {
            at.below(key).refuse(format!("{value} is no vertex"), "write a whole number from 0")
        })
    };
    let range = number("first")?..number("end")?;
    if range.is_empty() {
        let what = format!("vertices {} to {} are none", range.start, range.end);
        return Err(at.refuse(what, "end is one past the last"));
    }
    Ok((range, part(&at.below("part"), object.get("part").unwrap_or(&Value::Null))?))
}

/// A value of the JSON, as errors name it.
struct Place<'a> {
    file: &'a str,
    pointer: String,
}

impl Place<'_> {
    fn below(&self, key: &str) -> Self {
        let key = key.replace('~', "~0").replace('/', "~1");
        Self { file: self.file, pointer: format!("{}/{key}", self.pointer) }
    }

    fn refuse(&self, what: String, remedy: impl Into<String>) -> ReadError {
        ReadError::broken(format!("{}: {}", self.file, self.pointer), what, remedy)
    }

    fn object<'v>(&self, value: &'v Value) -> Result<&'v Map<String, Value>, ReadError> {
        value.as_object().ok_or_else(|| self.refuse(format!("{value} is no object"), "write {...}"))
    }

    fn list<'v>(&self, value: &'v Value) -> Result<&'v [Value], ReadError> {
        let list = value.as_array().map(Vec::as_slice);
        list.ok_or_else(|| self.refuse(format!("{value} is no list"), "write [...]"))
    }

    fn text<'v>(&self, value: &'v Value) -> Result<&'v str, ReadError> {
        let text = value.as_str().filter(|t| !t.is_empty());
        text.ok_or_else(|| self.refuse(format!("{value} is no text"), "write it in quotes"))
    }

    fn texts(&self, value: &Value) -> Result<Vec<String>, ReadError> {
        let list = self.list(value)?;
        (0..).zip(list).map(|(i, v)| Ok(self.below(&format!("{i}")).text(v)?.to_owned())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_lie_beside_files_archives_and_folders() {
        for (avatar, settings) in [
            ("a/head.glb", "a/head.avatar.json"),
            ("bank.zip", "bank.avatar.json"),
            ("a/bank.tar.xz", "a/bank.avatar.json"),
            ("bank.tar.gz", "bank.avatar.json"),
            ("a/my.head.v2.glb", "a/my.head.v2.avatar.json"),
            ("a/folder", "a/folder.avatar.json"),
        ] {
            let beside = AvatarSettings::path_beside(Path::new(avatar));
            assert_eq!(beside, Path::new(settings), "{avatar}");
        }
    }

    #[test]
    fn patterns_fit_as_file_names_do() {
        for (pattern, name, expected) in [
            ("eye", "eye", true),
            ("eye", "eyes", false),
            ("eye*", "eyeLookIn", true),
            ("*_L", "browDown_L", true),
            ("*_L", "browDown_R", false),
            ("a*b*c", "a12b34c", true),
            ("a*b*c", "a12c34b", false),
            ("ab*b", "ab", false),
            ("*", "", true),
        ] {
            assert_eq!(fits(pattern, name), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn everything_is_read_and_what_is_wrong_is_named() {
        let text =
            br#"{"unit": "cm", "parts": {"A": "teeth", "B": null}, "shapes": {"x": "jawOpen"},
            "vertexParts": [{"first": 3, "end": 9, "part": "socket"}], "locked": ["eye*"],
            "leaveOut": ["id*"], "neutral": "base"}"#;
        let read = AvatarSettings::from_json("a.json", text).unwrap();
        assert_eq!(read.unit_metres, Some(0.01));
        assert_eq!(read.parts, [("A".to_owned(), Some(Part::Teeth)), ("B".to_owned(), None)]);
        assert_eq!(read.vertex_parts, [(3..9, Part::Socket)]);
        for (text, says) in [
            ("{", "a.json: no JSON"),
            (r#"{"unit": "inch"}"#, "a.json: /unit: \"inch\" is no unit; write m, cm or mm"),
            (r#"{"units": "m"}"#, "a.json: /units: unknown key; the keys are unit"),
            (
                r#"{"parts": {"x/y": "nose"}}"#,
                "/parts/x~1y: \"nose\" is no part; write one of skin",
            ),
            (r#"{"parts": []}"#, "/parts: [] is no object"),
            (r#"{"locked": ["a", 3]}"#, "/locked/1: 3 is no text"),
            (r#"{"shapes": {"a": "x", "b": "x"}}"#, "/shapes/b: \"x\" is the name of two"),
            (r#"{"vertexParts": [{"first": 3, "end": 3, "part": "skin"}]}"#, "3 to 3 are none"),
            (
                r#"{"driven": {"teeth": {"down": "jawOpen"}}}"#,
                "/driven/teeth/down: \"jawOpen\" is no list",
            ),
            (r#"{"vertexParts": [{"first": -1}]}"#, "/vertexParts/0/first: -1 is no vertex"),
        ] {
            let error = AvatarSettings::from_json("a.json", text.as_bytes()).unwrap_err();
            assert!(error.to_string().contains(says), "{error}");
        }
    }
}
