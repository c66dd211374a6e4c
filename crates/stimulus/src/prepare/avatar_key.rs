//! What an avatar is known by: a hash of all that it holds, by content, since pictures, buffers and
//! settings may lie in files of their own.

use mimique_avatar::{Avatar, Eyeball, Mesh};
use mimique_clip::sha256_hex;
use serde_json::{Value, json};

use crate::provenance::{Provenance, numbers_of};

/// The hash of an avatar's content.
pub fn avatar_key(avatar: &Avatar) -> String {
    let pictures = avatar.textures.iter();
    Provenance::default()
        .json("name", avatar.name.as_str())
        .json("shapes", avatar.shape_names.clone())
        .json("meshes", avatar.meshes.iter().map(mesh).collect::<Vec<_>>())
        .json("eyeballs", avatar.eyeballs.iter().map(eyeball).collect::<Vec<_>>())
        .json(
            "textures",
            pictures
                .map(|t| json!([sha256_hex(&t.jpeg), sha256_hex(&t.mask_jpeg)]))
                .collect::<Vec<_>>(),
        )
        .hash()
}

fn mesh(mesh: &Mesh) -> Value {
    // The number of vertices that each shape moves, then which and how far.
    let shapes: Vec<f64> = (mesh.shapes.iter())
        .flat_map(|shape| {
            let count = [shape.vertices.len() as f64];
            let vertices = shape.vertices.iter().map(|&v| f64::from(v));
            count.into_iter().chain(vertices).chain(wide(shape.deltas.as_flattened()))
        })
        .collect();
    let triangles: Vec<f64> = mesh.triangles.as_flattened().iter().map(|&v| f64::from(v)).collect();
    let textured = mesh.textured.iter();
    json!({
        "name": mesh.name,
        "part": mesh.part.name(),
        "positions": numbers(mesh.positions.as_flattened()),
        "triangles": numbers_of(&triangles),
        "vertexColours": numbers(mesh.vertex_colours.as_flattened()),
        "baseColour": mesh.base_colour,
        "shapes": numbers_of(&shapes),
        "uvs": numbers(mesh.uvs.as_flattened()),
        "textured": textured
            .map(|t| json!([t.triangles.start, t.triangles.end, t.texture]))
            .collect::<Vec<_>>(),
    })
}

fn eyeball(eye: &Eyeball) -> Value {
    let looks = eye.looks.iter();
    json!({
        "mesh": eye.mesh,
        "centre": eye.centre,
        "looks": looks.map(|l| json!([l.shape, l.axis, l.radians])).collect::<Vec<_>>(),
    })
}

fn wide(numbers: &[f32]) -> impl Iterator<Item = f64> {
    numbers.iter().map(|&x| f64::from(x))
}

fn numbers(numbers: &[f32]) -> Value {
    numbers_of(&wide(numbers).collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use mimique_avatar::{Look, Part, SparseShape, Texture, Textured};

    use super::*;

    fn avatar() -> Avatar {
        Avatar {
            name: "head".to_owned(),
            shape_names: vec!["jawOpen".to_owned()],
            meshes: vec![Mesh {
                name: "skin".to_owned(),
                positions: vec![[0.0, 0.25, 0.5], [1.0, 0.0, 0.0], [0.0, 1.0, 0.125]],
                triangles: vec![[0, 1, 2]],
                base_colour: [0.5, 0.25, 0.125],
                shapes: vec![SparseShape { vertices: vec![2], deltas: vec![[0.0, -0.5, 0.0]] }],
                textured: vec![Textured { triangles: 0..1, texture: 0 }],
                ..Mesh::default()
            }],
            eyeballs: vec![Eyeball {
                mesh: 0,
                centre: [0.0; 3],
                looks: vec![Look { shape: 0, axis: [1.0, 0.0, 0.0], radians: 0.5 }],
            }],
            textures: vec![Texture { jpeg: vec![1, 2], mask_jpeg: vec![] }],
            expressions: Vec::new(),
        }
    }

    #[test]
    fn the_key_is_kept_between_programs() {
        // A key that changes makes every laboratory prepare its stimuli again: change it knowingly.
        assert_eq!(
            avatar_key(&avatar()),
            "03b07903b08498380515dd4430b2b3b878f7ad4f07ca7843bf31fce923b0a30c"
        );
    }

    #[test]
    fn every_part_of_an_avatar_is_in_the_key() {
        let key = avatar_key(&avatar());
        let changes: [&dyn Fn(&mut Avatar); 12] = [
            &|a| a.name.push('2'),
            &|a| a.shape_names[0].push('2'),
            &|a| a.meshes[0].part = Part::Other,
            &|a| a.meshes[0].positions[1][0] = 1.0 + f32::EPSILON,
            &|a| a.meshes[0].triangles[0] = [0, 2, 1],
            &|a| a.meshes[0].vertex_colours = vec![[0.5; 3]; 3],
            &|a| a.meshes[0].base_colour[2] = 0.25,
            &|a| a.meshes[0].shapes[0].vertices[0] = 1,
            &|a| a.meshes[0].shapes[0].deltas[0][2] = 1e-9,
            &|a| a.meshes[0].textured[0].texture = 1,
            &|a| a.eyeballs[0].looks[0].radians = 0.25,
            &|a| a.textures[0].mask_jpeg = vec![0],
        ];
        for (i, change) in changes.iter().enumerate() {
            let mut other = avatar();
            change(&mut other);
            assert_ne!(avatar_key(&other), key, "change {i}");
        }
    }
}
