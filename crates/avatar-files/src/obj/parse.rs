//! One OBJ file in: positions, texture coordinates and polygons with their names out.

use crate::ReadError;

/// An OBJ file, as far as it matters here. Positions are in the file's unit.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Obj {
    pub positions: Vec<[f64; 3]>,
    pub uvs: Vec<[f32; 2]>,
    /// Polygons by object, group and material, in the file's order.
    pub groups: Vec<Group>,
    /// Files that `mtllib` names.
    pub material_files: Vec<String>,
}

/// Polygons of one object, group and material.
#[derive(Debug, Default, Clone, PartialEq)]
pub(super) struct Group {
    pub object: String,
    pub group: String,
    pub material: String,
    /// Each triangle's corners: vertex, texture coordinate. Polygons are fans from their first.
    pub triangles: Vec<[Corner; 3]>,
}

/// Index of a vertex; index of a texture coordinate, if it has one.
pub(super) type Corner = (u32, Option<u32>);

/// More corners than this in one polygon are taken for damage.
const MOST_CORNERS: usize = 1024;

/// Reads a whole file; `file` names it in errors.
pub(super) fn parse(file: &str, bytes: &[u8]) -> Result<Obj, ReadError> {
    let mut out = Obj::default();
    let mut names = Group::default();
    let mut corners: Vec<Corner> = Vec::new();
    for (number, line) in lines(bytes) {
        let mut words = line.split_ascii_whitespace();
        let refuse = |what: String| ReadError::damaged(format!("{file}, line {number}"), what);
        match words.next() {
            Some("v") => out.positions.push(position(&mut words).map_err(refuse)?),
            Some("vt") => out.uvs.push(uv(&mut words).map_err(refuse)?),
            Some("f") => {
                corners.clear();
                for word in words {
                    let corner =
                        corner(word, out.positions.len(), out.uvs.len()).map_err(refuse)?;
                    corners.push(corner);
                }
                if !(3..=MOST_CORNERS).contains(&corners.len()) {
                    return Err(refuse(format!("a polygon of {} corners", corners.len())));
                }
                let same = |g: &&mut Group| {
                    (&g.object, &g.group, &g.material)
                        == (&names.object, &names.group, &names.material)
                };
                if out.groups.last_mut().filter(same).is_none() {
                    out.groups.push(names.clone());
                }
                let fan = corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]);
                let whole =
                    fan.filter(|t| t[0].0 != t[1].0 && t[1].0 != t[2].0 && t[2].0 != t[0].0);
                out.groups.last_mut().into_iter().for_each(|g| g.triangles.extend(whole.clone()));
            }
            Some("o") => names.object = words.collect::<Vec<_>>().join(" "),
            Some("g") => names.group = words.collect::<Vec<_>>().join(" "),
            Some("usemtl") => names.material = words.collect::<Vec<_>>().join(" "),
            Some("mtllib") => out.material_files.extend(words.map(str::to_owned)),
            _ => {}
        }
    }
    Ok(out)
}

/// Reads the positions alone: all that a pose has to tell.
pub(super) fn parse_positions(file: &str, bytes: &[u8]) -> Result<Vec<[f64; 3]>, ReadError> {
    let mut out = Vec::new();
    for (number, line) in lines(bytes) {
        let mut words = line.split_ascii_whitespace();
        if words.next() == Some("v") {
            let refuse = |what: String| ReadError::damaged(format!("{file}, line {number}"), what);
            out.push(position(&mut words).map_err(refuse)?);
        }
    }
    Ok(out)
}

/// Lines with their number from 1; what is not UTF-8 (names, comments) reads as an empty line.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, &str)> {
    bytes
        .split(|b| *b == b'\n')
        .enumerate()
        .map(|(i, line)| (i + 1, std::str::from_utf8(line).unwrap_or_default()))
}

fn position<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<[f64; 3], String> {
    let mut out = [0.0; 3];
    for x in &mut out {
        *x = finite(words.next())?;
    }
    Ok(out)
}

fn uv<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<[f32; 2], String> {
    // OBJ counts v from the picture's foot, Mimique like glTF from its top.
    let u = finite(words.next())?;
    let v = words.next().map_or(Ok(0.0), |word| finite(Some(word)))?;
    Ok([u as f32, (1.0 - v) as f32])
}

fn finite(word: Option<&str>) -> Result<f64, String> {
    let word = word.ok_or("a coordinate is missing")?;
    match word.parse::<f64>() {
        // Beyond single precision no picture and no solver follows.
        Ok(x) if x.is_finite() && (x as f32).is_finite() => Ok(x),
        _ => Err(format!("{word:?} is not a finite number")),
    }
}

/// `7`, `7/3`, `7//2`, `7/3/2`; negative indices count back from the last.
fn corner(word: &str, positions: usize, uvs: usize) -> Result<Corner, String> {
    let mut parts = word.split('/');
    let index = |text: &str, count: usize, what: &str| -> Result<u32, String> {
        let i: i64 = text.parse().map_err(|_| format!("{text:?} is no index of a {what}"))?;
        let from_zero = if i < 0 { i.checked_add(count as i64) } else { i.checked_sub(1) };
        from_zero
            .filter(|i| (0..count as i64).contains(i))
            .map(|i| i as u32)
            .ok_or_else(|| format!("{what} {text} of {count}"))
    };
    let vertex = index(parts.next().unwrap_or_default(), positions, "vertex")?;
    let uv = match parts.next().filter(|t| !t.is_empty()) {
        Some(text) => Some(index(text, uvs, "texture coordinate")?),
        None => None,
    };
    Ok((vertex, uv))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_names_and_indices_are_read() {
        let text = b"# a comment \xff\nmtllib a.mtl\no Head\ng Face\nusemtl skin\nv 0 0 0\nv 1 0 0 1\n\
            v 1 1 0\r\nv 0 1 0\nvt 0.25 0.75\nf 1 2 3 4\nf -4//1 -3//1 -2/1/1\nusemtl lips\nf 1 1 2 3\n";
        let obj = parse("a.obj", text).unwrap();
        assert_eq!(obj.positions.len(), 4);
        assert_eq!(obj.uvs, [[0.25, 0.25]]);
        assert_eq!(obj.material_files, ["a.mtl"]);
        let [skin, lips] = obj.groups.as_slice() else { panic!("{:?}", obj.groups) };
        assert_eq!((skin.object.as_str(), skin.group.as_str()), ("Head", "Face"));
        assert_eq!(skin.triangles[0].map(|c| c.0), [0, 1, 2]);
        assert_eq!(skin.triangles[1].map(|c| c.0), [0, 2, 3]);
        assert_eq!(skin.triangles[2], [(0, None), (1, None), (2, Some(0))]);
        // A corner given twice leaves one triangle of the two.
        assert_eq!(lips.triangles.len(), 1);
        assert_eq!(parse_positions("a.obj", text).unwrap(), obj.positions);
    }

    #[test]
    fn damage_is_named_by_file_and_line() {
        for (line, says) in [
            ("v 1 2", "a coordinate is missing"),
            ("v 1 nan 2", "\"nan\" is not a finite number"),
            ("v 1 1e300 2", "\"1e300\" is not a finite number"),
            ("f 1 2", "a polygon of 2 corners"),
            ("f 1 2 9", "vertex 9 of 3"),
            ("f 1 2 -4", "vertex -4 of 3"),
            ("f 0 1 2", "vertex 0 of 3"),
            ("f 1/1 2/1 3/1", "texture coordinate 1 of 0"),
            ("f 1 2 x", "\"x\" is no index of a vertex"),
            ("f 1 2 -9223372036854775808", "of 3"),
        ] {
            let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{line}\n");
            let error = parse("smile.obj", text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with("smile.obj, line 4: "), "{error}");
            assert!(error.contains(says), "{error}");
        }
    }
}
