//! `mimique sample --annotated`: takes of several built-in actors with their known labels, for
//! `mimique annotate`.

use anyhow::anyhow;
use mimique_actor::{
    Clip, Emotion, HeadSpec, NOISE_MM, SyntheticTake, build_head, marker_sites, synthetic_take,
};
use mimique_mocap::WeightsTable;
use mimique_solver::{Method, MethodSpec};
use mimique_stimulus::{
    AvatarSkin, MarkerMap, TakeOptions, TakeSegment, built_in_capture, built_in_labels,
    built_in_map, solve_take, write_segments,
};

/// Frames a second that the takes are written at: labels need no more.
const RATE_HZ: f64 = 50.0;
/// Actors, and takes of each.
const ACTORS: u64 = 4;
const TAKES: u64 = 3;

/// A file: its name, its contents, what it is.
pub type SampleFile = (String, Vec<u8>, String);

/// The files: of each take the weights of an LSTS solve onto the avatar and the labels, and `takes.csv`.
pub fn files(avatar: &HeadSpec, first_actor: u64) -> anyhow::Result<Vec<SampleFile>> {
    let skin = AvatarSkin::of(&build_head(avatar)).map_err(|e| anyhow!("the avatar: {e}"))?;
    let map = built_in_map(&marker_sites(avatar));
    let mut files = Vec::new();
    let mut table = String::from(
        "# Built-in actors, no people: what is found of these takes says nothing of real faces.\n\
         weights,labels,person,kind\n",
    );
    for actor in first_actor..first_actor + ACTORS {
        for number in 1..=TAKES {
            let take = performance(actor, number);
            let name = format!("actor{actor}-take{number}");
            let weights = solved(&skin, &map, &take)?.resampled(RATE_HZ);
            let labels = at_rate(&built_in_labels(&take), take.rate_hz, weights.frames.len());
            table += &format!("{name}.csv,{name}.labels.csv,actor {actor},posed\n");
            let what = format!("weights of actor {actor}, solved");
            files.push((format!("{name}.csv"), rounded(weights).to_csv().into_bytes(), what));
            let text = write_segments(&labels, RATE_HZ);
            let what = "what the actor showed, from when to when".to_owned();
            files.push((format!("{name}.labels.csv"), text.into_bytes(), what));
        }
    }
    files.push(("takes.csv".to_owned(), table.into_bytes(), "the table of all takes".to_owned()));
    Ok(files)
}

/// The six emotions, each once, of changing order and intensity.
fn performance(actor: u64, number: u64) -> SyntheticTake {
    let spec = HeadSpec::actor(actor);
    let seed = 1000 * actor + number;
    let mut emotions = Emotion::ALL;
    emotions.rotate_left((2 * number + actor) as usize % Emotion::ALL.len());
    if number.is_multiple_of(2) {
        emotions.reverse();
    }
    let clips: Vec<Clip> = (0u64..)
        .zip(emotions)
        .map(|(place, emotion)| Clip { emotion, intensity: 1 + ((seed + place) % 3) as u8, seed })
        .collect();
    synthetic_take(&build_head(&spec), &marker_sites(&spec), &clips, seed, NOISE_MM)
}

/// The weights that LSTS finds of the actor's markers on the avatar.
fn solved(
    skin: &AvatarSkin,
    map: &MarkerMap,
    take: &SyntheticTake,
) -> anyhow::Result<WeightsTable> {
    let [first, end] = take.neutral;
    let map =
        MarkerMap { head: take.head_labels.clone(), neutral: Some(first..end), ..map.clone() };
    let (spec, options) = (MethodSpec::new(Method::Lsts), TakeOptions::default());
    let solved = solve_take(skin, &built_in_capture(take), &map, &spec, &options, &mut || 0.0);
    Ok(solved.map_err(|e| anyhow!("a built-in take: {e}"))?.table)
}

/// Intervals at the rate of the files, the last of them to the end.
fn at_rate(labels: &[TakeSegment], rate_hz: f64, frames: usize) -> Vec<TakeSegment> {
    let frame = |f: usize| ((f as f64 * RATE_HZ / rate_hz).round() as usize).min(frames);
    let of = |own: &TakeSegment| {
        TakeSegment::new(own.label.as_str(), frame(own.clip.start)..frame(own.clip.end))
    };
    labels.iter().map(of).filter(|own| !own.clip.is_empty()).collect()
}

/// Weights with four decimals: the sensors' noise is larger.
fn rounded(mut table: WeightsTable) -> WeightsTable {
    table.weights.iter_mut().for_each(|w| *w = (*w * 1e4).round() / 1e4);
    table
}
