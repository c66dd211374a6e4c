//! What layouts of a face are sought on: motion, allowed places, conditions.

use anyhow::anyhow;
use mimique_layout::{
    Candidates, Conditions, DISTANCE_M, Distance, Excluded, Face, FaceMotion, Method, NamedSet,
    Where, mixed, unseen_shapes,
};
use mimique_solver::MarkerSite;

use super::args::Make;
use super::inputs;

/// A face with its motion, where markers may be, and what goes wrong.
pub(super) struct Ground<'a> {
    pub(super) face: &'a Face<'a>,
    /// The hash of the avatar.
    pub(super) key: String,
    pub(super) place: Where,
    pub(super) candidates: Candidates,
    /// The motion without the shapes that no allowed place tells.
    pub(super) motion: FaceMotion,
    /// The motion as it is.
    pub(super) whole: FaceMotion,
    /// The distance that markers keep, metres.
    pub(super) distance: f64,
    pub(super) symmetric: bool,
    /// Vertices that have a marker already.
    pub(super) kept: Vec<usize>,
    /// What `reduce` thins.
    pub(super) thinned: Vec<usize>,
    /// The maps of `--compare`.
    pub(super) compared: Vec<NamedSet>,
    pub(super) conditions: Conditions,
    pub(super) smoothing: f64,
    pub(super) method: Method,
    /// What the files' readers said.
    pub(super) notes: Vec<String>,
}

impl<'a> Ground<'a> {
    /// Of a command line.
    pub(super) fn of(args: &Make, face: &'a Face<'a>, key: &str) -> anyhow::Result<Self> {
        let (takes, notes) = inputs::takes(face.skin, &args.rom, &args.take, args.rate)?;
        let place = places(args, face.skin)?;
        let map = kept(args, face)?;
        let compared = (args.compare.iter())
            .map(|named| inputs::named_set(face.skin, &named.0, &named.1))
            .collect::<anyhow::Result<_>>()?;
        let candidates = Candidates::of(face, &place);
        let unseen = unseen_shapes(face, &candidates.vertices);
        let of = |rested: &[usize]| {
            FaceMotion::of(face, &takes, rested).map_err(|e| anyhow!("--take: {e}"))
        };
        let mut conditions =
            Conditions { noise: args.noise.0, slip: args.slip.0, others: args.slip.0 > 0.0 };
        if args.as_thesis {
            conditions = Conditions { noise: 0.0, slip: 0.0, others: false };
        }
        let thins = args.method == Method::Reduce;
        Ok(Self {
            face,
            key: key.to_owned(),
            place,
            motion: of(&unseen)?,
            whole: of(&[])?,
            candidates,
            distance: distance(args),
            symmetric: !args.free && !args.as_thesis,
            thinned: if map.is_empty() { mixed(face).vertices } else { map.clone() },
            kept: if thins { Vec::new() } else { map },
            compared,
            smoothing: if args.as_thesis { 0.0 } else { args.smoothing },
            conditions,
            method: if args.as_thesis { Method::Kmeans } else { args.method },
            notes,
        })
    }
}

/// Where markers may be.
fn places(args: &Make, skin: &mimique_stimulus::AvatarSkin) -> anyhow::Result<Where> {
    let mut place = Where::default();
    if args.as_thesis {
        place.exclude = vec![Excluded::Ears, Excluded::Neck, Excluded::Hair];
    } else {
        place.exclude = args.exclude.iter().filter_map(|part| part.0).collect();
        place.exclude.sort_unstable();
        place.exclude.dedup();
    }
    if let Some(file) = &args.region {
        inputs::region(skin, file, &mut place)?;
    }
    Ok(place)
}

/// The distance that markers keep, metres.
fn distance(args: &Make) -> f64 {
    if args.as_thesis {
        return 0.0;
    }
    match (args.min_distance, args.diameter) {
        (Some(given), _) => Distance::Given(given.0).metres(),
        (None, Some(diameter)) => {
            let camera = args.camera.map(|camera| camera.0);
            Distance::Seen { diameter: diameter.0, camera }.metres()
        }
        (None, None) => DISTANCE_M,
    }
}

/// The vertices of the map of `--keep`.
fn kept(args: &Make, face: &Face<'_>) -> anyhow::Result<Vec<usize>> {
    let Some(file) = &args.keep else { return Ok(Vec::new()) };
    let sites = inputs::map(face.skin, file)?.sites;
    Ok(sites.iter().map(MarkerSite::vertex).collect())
}
