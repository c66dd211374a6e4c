//! What must hold for every picture, whatever the look's details.

use mimique_avatar::Avatar;
use mimique_stage::offscreen::{Offscreen, Picture};
use mimique_stage::{Look, StageError, View};

use crate::support;

const SIZE: [u32; 2] = [160, 200];

fn draw(stage: &Offscreen, avatar: &Avatar, look: Look, weights: &[f32]) -> Picture {
    stage.render(avatar, look, View::FRONT, weights, SIZE).expect("the head is drawn")
}

fn pixel(picture: &Picture, x: u32, y: u32) -> [u8; 3] {
    let at = ((y * picture.width + x) * 4) as usize;
    [picture.rgba[at], picture.rgba[at + 1], picture.rgba[at + 2]]
}

#[test]
fn background_is_the_declared_srgb_colour() {
    let Some(stage) = support::adapter("background_is_the_declared_srgb_colour") else { return };
    let look = Look::STIMULUS.with_background_srgb([58, 63, 71]);
    let picture = draw(&stage, &support::egg(), look, &[0.0; 3]);
    for (x, y) in [(0, 0), (159, 0), (0, 199), (159, 199)] {
        assert_eq!(pixel(&picture, x, y), [58, 63, 71]);
    }
    assert!(picture.rgba.chunks_exact(4).all(|p| p[3] == 255), "every pixel is opaque");
}

#[test]
fn weights_that_are_no_numbers_or_missing_count_as_zero() {
    let Some(stage) = support::adapter("weights_that_are_no_numbers_or_missing_count_as_zero")
    else {
        return;
    };
    let egg = support::egg();
    let neutral = draw(&stage, &egg, Look::STIMULUS, &[0.0; 3]);
    assert_eq!(neutral, draw(&stage, &egg, Look::STIMULUS, &[]));
    assert_eq!(neutral, draw(&stage, &egg, Look::STIMULUS, &[f32::NAN, f32::INFINITY, f32::NAN]));
    assert_eq!(neutral, draw(&stage, &egg, Look::STIMULUS, &[0.0; 9]));
}

#[test]
fn each_blendshape_changes_the_picture_where_it_acts() {
    let Some(stage) = support::adapter("each_blendshape_changes_the_picture_where_it_acts") else {
        return;
    };
    let egg = support::egg();
    let neutral = draw(&stage, &egg, Look::STIMULUS, &[0.0; 3]);
    for (k, name) in egg.shape_names.iter().enumerate() {
        let mut weights = [0.0; 3];
        weights[k] = 1.0;
        let posed = draw(&stage, &egg, Look::STIMULUS, &weights);
        let changed: Vec<u32> = (0..SIZE[1])
            .filter(|&y| {
                (0..SIZE[0]).any(|x| {
                    (0..3).any(|c| pixel(&neutral, x, y)[c].abs_diff(pixel(&posed, x, y)[c]) > 20)
                })
            })
            .collect();
        assert!(!changed.is_empty(), "{name} changes nothing");
        // The eyes stand at 40 % of the height, the chin at 80 %.
        let mean = changed.iter().sum::<u32>() as f32 / changed.len() as f32 / SIZE[1] as f32;
        let expected = match name.as_str() {
            "jawOpen" => 0.6..0.95,
            "puff" => 0.4..0.75,
            _ => 0.3..0.5,
        };
        assert!(expected.contains(&mean), "{name} acts at {mean} of the height");
    }
}

#[test]
fn framing_does_not_move_with_the_jaw() {
    let Some(stage) = support::adapter("framing_does_not_move_with_the_jaw") else { return };
    let egg = support::egg();
    let neutral = draw(&stage, &egg, Look::STIMULUS, &[0.0; 3]);
    let open = draw(&stage, &egg, Look::STIMULUS, &[0.0, 1.0, 0.0]);
    // The upper half of the outline stays where it is, pixel by pixel.
    let outline = |p: &Picture, y: u32| {
        (0..SIZE[0]).map(|x| pixel(p, x, y) == pixel(p, 0, 0)).collect::<Vec<_>>()
    };
    for y in 0..80 {
        assert_eq!(outline(&neutral, y), outline(&open, y), "row {y}");
    }
}

#[test]
fn same_head_drawn_twice_gives_the_same_bytes() {
    let Some(stage) = support::adapter("same_head_drawn_twice_gives_the_same_bytes") else {
        return;
    };
    let egg = support::egg();
    let renderer = stage.renderer(SIZE, Look::STIMULUS);
    let head = renderer.load(&egg).expect("the egg loads");
    let weights = [0.3, 0.6, -0.5];
    let first = stage.picture(&renderer, &head, View::FRONT, &weights).expect("a picture");
    stage.picture(&renderer, &head, View::THREE_QUARTER, &[1.0; 3]).expect("another picture");
    assert_eq!(first, stage.picture(&renderer, &head, View::FRONT, &weights).expect("a picture"));
}

#[test]
fn resized_picture_is_the_picture_of_that_size() {
    let Some(stage) = support::adapter("resized_picture_is_the_picture_of_that_size") else {
        return;
    };
    let egg = support::egg();
    let mut renderer = stage.renderer([64, 64], Look::STIMULUS);
    let head = renderer.load(&egg).expect("the egg loads");
    renderer.resize(SIZE);
    let resized = stage.picture(&renderer, &head, View::FRONT, &[0.2; 3]).expect("a picture");
    assert_eq!(resized, draw(&stage, &egg, Look::STIMULUS, &[0.2; 3]));
}

#[test]
fn picture_is_the_same_where_the_target_does_not_encode() {
    let name = "picture_is_the_same_where_the_target_does_not_encode";
    let Some(stage) = support::adapter(name) else { return };
    let renderer = stage.renderer_as_on_canvas(SIZE, Look::STIMULUS);
    let head = renderer.load(&support::egg()).expect("the egg loads");
    let plain = stage.picture(&renderer, &head, View::FRONT, &[0.4; 3]).expect("a picture");
    let found =
        support::difference(&plain, &draw(&stage, &support::egg(), Look::STIMULUS, &[0.4; 3]));
    // Rounding to bytes twice moves a byte by one at most.
    assert!(found.mean < 0.05 && found.outliers == 0.0, "{found:?}");
}

#[test]
fn malformed_avatars_are_refused_by_name() {
    let Some(stage) = support::adapter("malformed_avatars_are_refused_by_name") else { return };
    let refuse = |spoil: &dyn Fn(&mut Avatar)| {
        let mut egg = support::egg();
        spoil(&mut egg);
        stage.render(&egg, Look::STIMULUS, View::FRONT, &[], [16, 16]).expect_err("it is refused")
    };
    assert_eq!(refuse(&|a| a.meshes.clear()), StageError::NothingToDraw);
    let beyond = refuse(&|a| a.meshes[0].triangles[5][1] = 1_000_000);
    assert!(
        beyond.to_string().contains("a triangle uses vertex 1000000, the mesh has 1617"),
        "{beyond}"
    );
    let moved = refuse(&|a| a.meshes[0].shapes[0].vertices[0] = 70_000);
    assert!(moved.to_string().contains("blendshape 0 moves vertex 70000"), "{moved}");
    let few = refuse(&|a| drop(a.meshes[0].shapes.pop()));
    assert!(few.to_string().contains("2 blendshapes, the avatar has 3"), "{few}");
    let looks = refuse(&|a| a.eyeballs[0].looks[0].shape = 7);
    assert!(looks.to_string().contains("eyeball look of blendshape 7"), "{looks}");
    let run = |triangles, texture| vec![mimique_avatar::Textured { triangles, texture }];
    let beyond = refuse(&|a| a.meshes[0].textured = run(0..1_000_000, 0));
    assert!(beyond.to_string().contains("a picture on triangles 0 to 1000000"), "{beyond}");
    let absent = refuse(&|a| a.meshes[0].textured = run(0..1, 3));
    assert!(absent.to_string().contains("texture 3, the avatar has 0"), "{absent}");
    let damaged = refuse(&|a| a.textures = vec![mimique_avatar::Texture::default()]);
    assert!(damaged.to_string().contains("avatar, texture 0: a JPEG picture"), "{damaged}");
    let many = refuse(&|a| {
        a.shape_names = (0..2049).map(|k| format!("s{k}")).collect();
        a.meshes.iter_mut().for_each(|m| m.shapes.resize(2049, Default::default()));
    });
    assert_eq!(many, StageError::TooManyShapes { found: 2049, most: 2048 });
    let many = refuse(&|a| {
        let eye = a.meshes[1].clone();
        a.meshes.extend(std::iter::repeat_n(eye, 15));
    });
    assert_eq!(many, StageError::TooManyEyeballs { found: 17, most: 16 });
}

#[test]
fn the_last_of_many_shapes_and_eyes_are_drawn_as_the_first_are() {
    let name = "the_last_of_many_shapes_and_eyes_are_drawn_as_the_first_are";
    let Some(stage) = support::adapter(name) else { return };
    let few = support::egg();
    let drawn = draw(&stage, &few, Look::STIMULUS, &[0.8, 0.5, 0.7]);
    let plain = draw(&stage, &few, Look::STIMULUS, &[]);
    assert!(support::difference(&drawn, &plain).outliers > 0.02, "the pose shows");
    // The same three shapes behind 2045 that move nothing, the same eyes behind 14 tiny ones.
    let mut many = few.clone();
    many.shape_names = (0..2048).map(|k| format!("s{k}")).collect();
    for mesh in &mut many.meshes {
        let mut shapes = vec![mimique_avatar::SparseShape::default(); 2045];
        shapes.append(&mut mesh.shapes);
        mesh.shapes = shapes;
    }
    many.eyeballs.iter_mut().flat_map(|e| &mut e.looks).for_each(|look| look.shape += 2045);
    let mut inside = support::ball([0.0, 0.0, 0.0], [0.001; 3], 6, 4);
    inside.part = mimique_avatar::Part::Other;
    inside.shapes = vec![mimique_avatar::SparseShape::default(); 2048];
    let (skin, eyes) = many.meshes.split_at(1);
    let meshes = [skin, &vec![inside; 14], eyes].concat();
    many.eyeballs.iter_mut().for_each(|e| e.mesh += 14);
    let hidden = |mesh| mimique_avatar::Eyeball { mesh, centre: [0.0; 3], looks: vec![] };
    many.eyeballs.extend((1..=14).map(hidden));
    many.meshes = meshes;
    let mut weights = vec![0.0; 2045];
    weights.extend([0.8, 0.5, 0.7]);
    let found = support::difference(&drawn, &draw(&stage, &many, Look::STIMULUS, &weights));
    assert!(found.mean < 0.05 && found.outliers < 0.0005, "{found:?}");
}

/// A head as people will see it: it fills the frame, nothing burns out, the mouth opens dark.
fn reads_as_a_face(stage: &Offscreen, avatar: &Avatar, jaw: &str) {
    let jaw = avatar.shape_index(jaw).expect("the head has a jaw");
    let mut weights = vec![0.0; avatar.shape_names.len()];
    let neutral = draw(stage, avatar, Look::STIMULUS, &weights);
    weights[jaw] = 0.8;
    let open = draw(stage, avatar, Look::STIMULUS, &weights);
    let background = pixel(&neutral, 0, 0);
    let all: Vec<[u8; 3]> = neutral.rgba.chunks_exact(4).map(|p| [p[0], p[1], p[2]]).collect();
    let covered = all.iter().filter(|p| **p != background).count() as f64 / all.len() as f64;
    assert!((0.25..0.85).contains(&covered), "the head covers {covered} of the picture");
    let burnt =
        all.iter().filter(|p| p.iter().all(|&c| c >= 250)).count() as f64 / all.len() as f64;
    assert!(burnt < 0.002, "{burnt} of the picture is blown out");
    // On the midline, mouth and below: the open mouth shows darker pixels than the closed one has.
    let darkest = |p: &Picture| {
        (100..170)
            .map(|y| pixel(p, 80, y).iter().map(|&c| u32::from(c)).sum::<u32>())
            .min()
            .unwrap_or(0)
    };
    assert!(
        darkest(&open) + 40 < darkest(&neutral),
        "closed {}, open {}",
        darkest(&neutral),
        darkest(&open)
    );
}

#[test]
fn real_head_reads_as_a_face() {
    let name = "real_head_reads_as_a_face";
    let Some(path) = mimique_test_support::real_file(name, "ict-facekit/ict-facekit.glb") else {
        return;
    };
    let Some(stage) = support::adapter(name) else { return };
    let avatar = mimique_avatar_files::read_avatar(&path).expect("the head is read").avatar;
    reads_as_a_face(&stage, &avatar, "jawOpen");
}

#[test]
fn builtin_head_reads_as_a_face() {
    let Some(stage) = support::adapter("builtin_head_reads_as_a_face") else { return };
    let avatar = mimique_actor::build_head(&mimique_actor::HeadSpec::default());
    reads_as_a_face(&stage, &avatar, "jawOpen");
}

#[test]
fn eyes_in_one_mesh_of_a_file_are_drawn_as_two() {
    let Some(stage) = support::adapter("eyes_in_one_mesh_of_a_file_are_drawn_as_two") else {
        return;
    };
    let head = mimique_actor::build_head(&mimique_actor::HeadSpec::default());
    let read = |avatar: &Avatar| {
        let glb = mimique_avatar_files::write_glb(avatar, &[], 60.0).expect("a file");
        let read =
            mimique_avatar_files::read_avatar_bytes(glb, "head", None, None).expect("it is read");
        read.avatar
    };
    // The left eye's vertices behind the right eye's.
    let mut joined = head.clone();
    let at = |avatar: &Avatar, part| {
        avatar.meshes.iter().position(|m| m.part == part).expect("the head has eyes")
    };
    let left = joined.meshes.remove(at(&joined, mimique_avatar::Part::EyeLeft));
    let right = at(&joined, mimique_avatar::Part::EyeRight);
    let both = &mut joined.meshes[right];
    let first = both.positions.len() as u32;
    both.name = "Eyes".to_owned();
    both.positions.extend(left.positions);
    both.vertex_colours.extend(left.vertex_colours);
    both.triangles.extend(left.triangles.iter().map(|t| t.map(|v| v + first)));
    let gaze = |avatar: &Avatar| {
        let look = avatar.shape_names.iter().map(|n| if n == "eyeLookInLeft" { 0.8 } else { 0.0 });
        draw(&stage, avatar, Look::STIMULUS, &look.collect::<Vec<f32>>())
    };
    let (apart, joined) = (gaze(&read(&head)), gaze(&read(&joined)));
    let found = support::difference(&apart, &joined);
    assert!(found.mean < 0.05 && found.outliers < 0.0005, "{found:?}");
}
