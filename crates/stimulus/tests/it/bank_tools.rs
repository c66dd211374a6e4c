//! Kouadio's tools end to end: associations, scale factors, depth, halves, the five rules; and that
//! packs, threads and the browser's function give the bits of the whole.

use mimique_actor::{
    Clip, Density, Emotion, HeadSpec, Identity, build_head, marker_sites, synthetic_take,
};
use mimique_avatar::Avatar;
use mimique_clip::{encode_operators, encode_take, solve_packs, solve_segment};
use mimique_geometry::{Point, coordinates};
use mimique_mocap::{Capture, LengthUnit};
use mimique_solver::{Association, Method, MethodSpec};
use mimique_stimulus::{
    AvatarSkin, BankDiagnosis, Depth, JoinedTake, MappedMarker, MarkerAssociation, MarkerMap,
    MarkerPlace, ScaleRule, SolvedCapture, TakeOptions, solve_take, split_shapes,
};

struct Scene {
    avatar: Avatar,
    skin: AvatarSkin,
    map: MarkerMap,
    capture: Capture,
}

/// The built-in head, performed by another person, at 0 noise.
fn scene() -> Scene {
    let head =
        |seed| HeadSpec { identity: Identity::from_seed(seed), density: Density::nearest(2000) };
    let (own, actor) = (head(3), head(41));
    let sites = marker_sites(&own);
    let face = sites.face_labels().iter().zip(&sites.vertices).map(|(label, &vertex)| {
        MappedMarker { label: label.clone(), place: MarkerPlace::Vertex(vertex) }
    });
    let clips =
        [Emotion::Joy, Emotion::Fear].map(|emotion| Clip { emotion, intensity: 3, seed: 2 });
    let take = synthetic_take(&build_head(&actor), &marker_sites(&actor), &clips, 4, 0.0);
    let map = MarkerMap {
        face: face.collect(),
        head: take.head_labels.clone(),
        neutral: Some(take.neutral[0]..take.neutral[1]),
        ..MarkerMap::default()
    };
    let avatar = build_head(&own);
    Scene {
        skin: AvatarSkin::of(&avatar).unwrap(),
        avatar,
        map,
        capture: Capture::new(take.labels, take.rate_hz, LengthUnit::Millimetre, take.positions),
    }
}

fn kouadio(association: Association) -> MethodSpec {
    MethodSpec { association: Some(association), ..MethodSpec::new(Method::Kouadio) }
}

impl Scene {
    fn solve(&self, spec: &MethodSpec, options: &TakeOptions) -> SolvedCapture {
        let Scene { skin, map, capture, .. } = self;
        solve_take(skin, capture, map, spec, options, &mut || 0.0).unwrap()
    }
}

fn rms(a: &[f64], b: &[f64]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
    (squares / a.len() as f64).sqrt()
}

#[test]
fn points_are_the_box_and_the_other_associations_hold_more_of_the_face() {
    let scene = scene();
    let options = TakeOptions::default();
    let boxed = scene.solve(&MethodSpec::new(Method::Box), &options).table.weights;
    let points = scene.solve(&kouadio(Association::Points), &options).table.weights;
    assert!(rms(&boxed, &points) < 1e-6, "{}", rms(&boxed, &points));
    for association in [Association::Zones, Association::Triangles] {
        let solved = scene.solve(&kouadio(association), &options);
        assert!(solved.report.summary.held.is_none());
        let difference = rms(&boxed, &solved.table.weights);
        assert!((1e-3..0.5).contains(&difference), "{association:?} {difference}");
    }
}

#[test]
fn positions_are_tied_to_vertices_or_triangles() {
    let scene = scene();
    let sites = scene.map.resolve(&scene.skin).unwrap();
    // Half way along an edge from each marker's vertex: on the skin, at no vertex.
    let mesh = &scene.skin.mesh;
    let between = |v: usize| {
        let t = mesh.triangles.iter().find(|t| t.contains(&(v as u32))).unwrap();
        let w = t.iter().find(|w| **w as usize != v).unwrap();
        let (p, q) = (mesh.positions[v], mesh.positions[*w as usize]);
        p + (q - p) * 0.4
    };
    let mut map = scene.map.clone();
    for (marker, site) in map.face.iter_mut().zip(&sites) {
        marker.place = MarkerPlace::Position(between(site.vertex()));
    }
    let refused = map.resolve(&scene.skin).unwrap_err().to_string();
    assert!(refused.contains("within 0.1 mm of a vertex"), "{refused}");
    map.association = MarkerAssociation::Triangle;
    for (site, marker) in map.resolve(&scene.skin).unwrap().iter().zip(&map.face) {
        let MarkerPlace::Position(p) = marker.place else { panic!("a vertex") };
        let d = site.position(mesh);
        assert!((0..3).all(|a| (d[a] - p[a]).abs() < 1e-12), "{site:?}");
        assert!((site.weights.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
    map.association = MarkerAssociation::Nearest;
    let nearest = map.resolve(&scene.skin).unwrap();
    for (site, marker) in nearest.iter().zip(&map.face).take(1) {
        let MarkerPlace::Position(p) = marker.place else { panic!("a vertex") };
        assert_eq!(Some(site.vertex()), scene.skin.nearest(p).map(|(v, _)| v));
    }
    let mut vertices: Vec<usize> = nearest.iter().map(|s| s.vertex()).collect();
    vertices.sort_unstable();
    vertices.dedup();
    assert_eq!(vertices.len(), nearest.len());
    // Two markers at one position: the second gets the next vertex.
    let first = map.face[0].place;
    map.face[1].place = first;
    let two = map.resolve(&scene.skin).unwrap();
    assert_eq!(two[0].vertex(), nearest[0].vertex());
    assert_ne!(two[1].vertex(), two[0].vertex());
    // Far off the skin nothing is tied.
    map.face[2].place = MarkerPlace::Position(Point::new(0.5, 0.5, 0.5));
    assert!(map.resolve(&scene.skin).unwrap_err().to_string().contains("within 10 mm of it"));
}

#[test]
fn automatic_factors_take_each_marker_to_the_bank_s_range() {
    let scene = scene();
    let options = |global: Option<f64>, automatic| TakeOptions {
        scale: ScaleRule { automatic, global: global.map(|g| [g; 3]), ..ScaleRule::default() },
        ..TakeOptions::default()
    };
    let spec = MethodSpec::new(Method::ThinShellOnly);
    let frames = scene.capture.frames();
    // Linear in d: twice the displacement, twice the weights.
    let plain = scene.solve(&spec, &options(None, None)).table.weights;
    let double = scene.solve(&spec, &options(Some(2.0), None)).table.weights;
    let twice: Vec<f64> = plain.iter().map(|x| 2.0 * x).collect();
    assert!(rms(&twice, &double) < 1e-9);
    // Automatic factors: the pack's are those of face over mask, marker by marker.
    let options = options(None, Some(0..frames));
    let joined = JoinedTake::new(&scene.skin, &scene.capture, &scene.map, &options).unwrap();
    let operators = joined.operators(&spec).unwrap();
    let take = joined.segment(&operators, &spec, 0..frames).unwrap();
    let mimique_clip::TakeContent::Markers(markers) = &take.content else { panic!("weights") };
    let scales = markers.scales.as_ref().unwrap();
    let all = coordinates(&scales.positive).iter().chain(coordinates(&scales.negative));
    assert!(all.clone().any(|x| *x != 1.0) && all.clone().all(|x| x.is_finite() && *x >= 0.0));
    let automatic = scene.solve(&spec, &options);
    assert!(rms(&plain, &automatic.table.weights) > 1e-3);
    // What has a say is in the provenance.
    let other = scene.solve(&spec, &TakeOptions::default()).report.provenance;
    assert_ne!(automatic.report.provenance, other);
    // Wrong frames and labels are refused.
    let refused = |scale| {
        let options = TakeOptions { scale, ..TakeOptions::default() };
        JoinedTake::new(&scene.skin, &scene.capture, &scene.map, &options).unwrap_err().to_string()
    };
    let beyond = ScaleRule { automatic: Some(0..frames + 1), ..ScaleRule::default() };
    assert!(refused(beyond).contains(&format!("0:{} of {frames}", frames + 1)));
    let markers = [("Nowhere".to_owned(), [1.0; 3])].into();
    assert!(refused(ScaleRule { markers, ..ScaleRule::default() }).contains("Nowhere"));
}

#[test]
fn a_flat_capture_gets_its_depth_from_the_surface() {
    let mut scene = scene();
    let spec = MethodSpec::new(Method::Lsts);
    // One camera sees no head turn: the take is stabilised first, as a helmet does.
    let whole = scene.solve(&spec, &TakeOptions::default());
    let joined =
        JoinedTake::new(&scene.skin, &scene.capture, &scene.map, &TakeOptions::default()).unwrap();
    let operators = joined.operators(&spec).unwrap();
    let (rest, deltas) = (&operators.parts().marker_positions, &operators.parts().marker_deltas);
    let n = operators.shape_count();
    let labels: Vec<String> = scene.map.face_labels().map(str::to_owned).collect();
    let mut positions = Vec::new();
    for frame in 0..whole.table.frames.len() {
        let c = whole.table.row(frame);
        for (m, p) in rest.iter().enumerate() {
            let at = |a: usize| {
                let row = &deltas[(3 * m + a) * n..(3 * m + a + 1) * n];
                1e3 * (p[a] + row.iter().zip(c).map(|(d, c)| d * c).sum::<f64>())
            };
            positions.push(Point::new(at(0), at(1), 0.0));
        }
    }
    drop(joined);
    scene.map.head.clear();
    scene.capture = Capture { labels, positions, ..scene.capture };
    let refused = JoinedTake::new(&scene.skin, &scene.capture, &scene.map, &TakeOptions::default())
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains("two-dimensional") && refused.contains("--depth surface"),
        "{refused}"
    );
    scene.map.depth = Depth::Surface;
    let flat = scene.solve(&spec, &TakeOptions::default());
    // Where the weights put the markers: in the image as measured, in depth mostly.
    let axis = |table: &mimique_mocap::WeightsTable, a: usize| -> Vec<f64> {
        (60..table.frames.len())
            .flat_map(|frame| {
                (deltas.chunks_exact(3 * n)).map(move |rows| {
                    let row = &rows[a * n..(a + 1) * n];
                    row.iter().zip(table.row(frame)).map(|(d, c)| d * c).sum::<f64>()
                })
            })
            .collect()
    };
    for (a, share) in [(0, 0.15), (1, 0.25), (2, 0.6)] {
        let (true_, found) = (axis(&whole.table, a), axis(&flat.table, a));
        let size = rms(&true_, &vec![0.0; true_.len()]);
        let error = rms(&true_, &found);
        eprintln!(
            "weights from two dimensions, axis {a}: {:.3} of {:.3} mm",
            1e3 * error,
            1e3 * size
        );
        assert!(error < share * size, "axis {a}: {error} of {size}");
    }
}

#[test]
fn packs_carry_associations_factors_and_depth_bit_for_bit() {
    let mut scene = scene();
    scene.map.association = MarkerAssociation::Triangle;
    scene.map.scale = ScaleRule {
        automatic: Some(0..400),
        global: Some([1.1, 1.0, 0.9]),
        markers: [(scene.map.face[3].label.clone(), [0.5; 3])].into(),
    };
    for (depth, association) in [
        (Depth::Measured, Association::Triangles),
        (Depth::Surface, Association::Zones),
        (Depth::Measured, Association::Points),
    ] {
        scene.map.depth = depth;
        let spec = kouadio(association);
        let options = TakeOptions::default();
        let joined = JoinedTake::new(&scene.skin, &scene.capture, &scene.map, &options).unwrap();
        let operators = joined.operators(&spec).unwrap();
        let mut take = joined.segment(&operators, &spec, 100..260).unwrap();
        // The pack rounds positions: with rounded ones nothing is lost.
        let packed = encode_take(&take);
        take = mimique_clip::decode_take(&packed).unwrap();
        let direct = solve_segment(&operators, &take, &spec).unwrap();
        let from_packs = solve_packs(&encode_operators(&operators), &packed, &spec).unwrap();
        assert_eq!(direct.weights_hash, from_packs.weights_hash);
        assert!(direct.weights.iter().any(|w| *w > 0.1));
    }
}

#[test]
fn halves_add_up_to_the_shape_on_every_mesh() {
    let scene = scene();
    // A bilateral shape of the head's own: both brows down.
    let name = ["jawOpen", "mouthPucker", "browInnerUp"]
        .into_iter()
        .find(|n| scene.avatar.shape_index(n).is_some())
        .unwrap();
    let split = split_shapes(&scene.avatar, &[name.to_owned()]).unwrap();
    let k = scene.avatar.shape_index(name).unwrap();
    assert_eq!(split.shape_names.len(), scene.avatar.shape_names.len() + 1);
    assert_eq!(split.shape_names[k], format!("{name}_L"));
    assert_eq!(split.shape_names[k + 1], format!("{name}_R"));
    for (whole, cut) in scene.avatar.meshes.iter().zip(&split.meshes) {
        let dense = |shape: &mimique_avatar::SparseShape| {
            let mut out = vec![[0.0f32; 3]; whole.positions.len()];
            for (&v, d) in shape.vertices.iter().zip(&shape.deltas) {
                out[v as usize] = *d;
            }
            out
        };
        let [left, right] = [dense(&cut.shapes[k]), dense(&cut.shapes[k + 1])];
        for (v, d) in dense(&whole.shapes[k]).iter().enumerate() {
            assert!((0..3).all(|a| left[v][a] + right[v][a] == d[a]), "vertex {v}");
            // The person's left is +X.
            let x = whole.positions[v][0];
            assert!(x > -0.015 || left[v] == [0.0; 3]);
            assert!(x < 0.015 || right[v] == [0.0; 3]);
        }
        assert_eq!(cut.shapes.len(), split.shape_names.len());
    }
    // Both halves at one weight are the shape; solving finds them together.
    let skin = AvatarSkin::of(&split).unwrap();
    let spec = MethodSpec::new(Method::Lsts);
    let map = &scene.map;
    let solved =
        solve_take(&skin, &scene.capture, map, &spec, &TakeOptions::default(), &mut || 0.0)
            .unwrap();
    assert_eq!(solved.table.shape_names, split.face_shapes());
    for (shapes, says) in [
        (vec!["noSuchShape".to_owned()], "no shape"),
        (vec![scene.avatar.shape_names[0].clone(); 1], ""),
    ] {
        if let Err(error) = split_shapes(&scene.avatar, &shapes) {
            assert!(error.to_string().contains(says), "{error}");
        } else {
            assert!(says.is_empty());
        }
    }
}

#[test]
fn diagnosis_names_what_was_planted() {
    let mut scene = scene();
    let sites = scene.map.resolve(&scene.skin).unwrap();
    let before = BankDiagnosis::of(&scene.skin, Some(&sites));
    // A neutral, a copy at half strength, and a shape far from any marker.
    let mesh = &mut scene.skin.mesh;
    let mut half = mesh.shapes[4].clone();
    half.deltas.iter_mut().for_each(|d| *d = d.map(|x| 0.5 * x));
    let place = |v: usize| mesh.positions[v];
    let far = (0..mesh.positions.len())
        .max_by(|&a, &b| {
            let off = |v: usize| {
                sites
                    .iter()
                    .map(|s| {
                        let q = place(s.vertex());
                        (0..3).map(|k| (place(v)[k] - q[k]).powi(2)).sum::<f64>()
                    })
                    .fold(f64::INFINITY, f64::min)
            };
            off(a).total_cmp(&off(b))
        })
        .unwrap();
    let away = mimique_solver::SparseDeltas {
        vertices: vec![far as u32],
        deltas: vec![[0.0, 0.01, 0.0].into()],
    };
    mesh.shapes.extend([mimique_solver::SparseDeltas::default(), half, away]);
    let names = ["neutralFace", "halfOfFive", "ponytail"].map(str::to_owned);
    scene.skin.shape_names.extend(names);
    let found = BankDiagnosis::of(&scene.skin, Some(&sites));
    assert_eq!(found.shapes, before.shapes + 3);
    assert_eq!(found.rank, before.rank + 1);
    assert!(found.neutral.contains(&"neutralFace".to_owned()));
    let five = &scene.skin.shape_names[4];
    let half = |d: &&mimique_stimulus::DependentShape| {
        d.shape == "halfOfFive" || d.of.iter().any(|(k, _)| k == "halfOfFive")
    };
    let new = found.dependent.iter().find(half).unwrap();
    assert!(new.of.len() == 1 && new.left_percent < 1e-6, "{new:?}");
    assert!([&new.shape, &new.of[0].0].contains(&five) && new.within_bounds, "{new:?}");
    // Left and right of one motion are dependent, and yet no face between 0 and 1 has both.
    for opposite in before.dependent.iter().filter(|d| d.of.iter().any(|(_, x)| *x < 0.0)) {
        assert!(!opposite.within_bounds);
    }
    let markers = found.at_markers.as_ref().unwrap();
    assert!(markers.unseen.contains(&"ponytail".to_owned()), "{:?}", markers.unseen);
    assert!(!markers.unseen.contains(&"neutralFace".to_owned()));
    assert!(!found.is_clean());
    let text = found.text();
    for says in ["rule 1", "halfOfFive", "neutralFace", "ponytail", "rule 5: kept"] {
        assert!(text.contains(says), "{says}: {text}");
    }
    // Three markers cannot tell as many shapes.
    let few = BankDiagnosis::of(&scene.skin, Some(&sites[..3])).at_markers.unwrap();
    assert!(few.unknowns > few.equations && few.rank <= 9);
    assert!(BankDiagnosis::of(&scene.skin, None).text().contains("give --markers MAP"));
}

#[test]
fn weights_do_not_depend_on_the_number_of_threads() {
    let scene = scene();
    for method in [Method::Lsts, Method::LstsNorm, Method::Kouadio] {
        let hash = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                scene.solve(&MethodSpec::new(method), &TakeOptions::default()).report.weights_hash
            })
        };
        let one = hash(1);
        assert_eq!((hash(2), hash(3)), (one.clone(), one), "{method}");
    }
}

#[test]
fn the_seconds_of_each_stage_are_those_of_the_clock() {
    let scene = scene();
    // A clock that goes on by one, two, three… seconds each time it is asked.
    let (mut now, mut step) = (0.0, 0.0);
    let mut clock = || {
        step += 1.0;
        now += step;
        now
    };
    let spec = MethodSpec::new(Method::Lsts);
    let options = TakeOptions::default();
    let solved =
        solve_take(&scene.skin, &scene.capture, &scene.map, &spec, &options, &mut clock).unwrap();
    let s = solved.report.seconds;
    // Steps 2 and 3 are of the take's set-up and of its front end, 5, 6 and 7 of the pipeline, 9 of the
    // checks; 4 and 8 lie between them.
    assert_eq!((s.set_up, s.front_end, s.solve, s.check), (2.0 + 5.0, 3.0 + 6.0, 7.0, 9.0));
}
