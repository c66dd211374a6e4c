//! Curves of the group where there is no coupling.

use std::collections::BTreeMap;

use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::curves::{Curve, curve, mean_curve};
use super::{CoupledPlay, Couplings, Courses, LaggedCorrelationOptions, PersonPlays, Surrogates};
use crate::numerics::random::Stream;

/// Offsets that a course is turned round by are as many as this at most, evenly spaced.
const MOST_OFFSETS: usize = 48;

/// The group's curve in each surrogate. People have random streams of their own, so that neither threads nor their
/// number matter.
pub(super) fn surrogate_curves(
    given: &Couplings,
    people: &[PersonPlays],
    options: &LaggedCorrelationOptions,
) -> Vec<Curve> {
    let lags = options.window.lags();
    let of_person = |own: &PersonPlays| -> Vec<Curve> {
        let mut stream = Stream::new(options.seed, own.person as u64);
        match options.kind {
            Surrogates::OtherClips => dealt(given, own, options, &mut stream),
            Surrogates::Shifted => shifted(given, own, options, &mut stream),
        }
    };
    let by_person: Vec<Vec<Curve>> = people.par_iter().map(of_person).collect();
    let group = |draw: usize| mean_curve(by_person.iter().map(|own| &own[draw]), lags);
    (0..options.surrogates).map(group).collect()
}

/// A person's plays, held against the person's clips in another deal in each surrogate.
fn dealt(
    given: &Couplings,
    own: &PersonPlays,
    options: &LaggedCorrelationOptions,
    stream: &mut Stream,
) -> Vec<Curve> {
    let window = &options.window;
    let plays: Vec<&CoupledPlay> = own.plays.iter().map(|play| &given.plays[*play]).collect();
    // Of each play against each of the person's clips.
    let mut places: BTreeMap<usize, usize> = BTreeMap::new();
    for play in &plays {
        let next = places.len();
        places.entry(play.clip).or_insert(next);
    }
    let mut clips: Vec<usize> = vec![0; places.len()];
    places.iter().for_each(|(clip, place)| clips[*place] = *clip);
    let against =
        |play: &CoupledPlay, clip: &usize| curve(&given.clips[*clip], &play.track, window);
    let curves: Vec<Vec<Option<Curve>>> =
        plays.iter().map(|play| clips.iter().map(|clip| against(play, clip)).collect()).collect();
    let mut deal: Vec<usize> = plays.iter().map(|play| places[&play.clip]).collect();
    let count = deal.len();
    let draw = |_| {
        stream.draw_first(&mut deal, count);
        let found = deal.iter().enumerate().filter_map(|(play, clip)| curves[play][*clip].as_ref());
        mean_curve(found, window.lags())
    };
    (0..options.surrogates).map(draw).collect()
}

/// A person's plays, each turned round by an offset of its own in each surrogate.
fn shifted(
    given: &Couplings,
    own: &PersonPlays,
    options: &LaggedCorrelationOptions,
    stream: &mut Stream,
) -> Vec<Curve> {
    let window = &options.window;
    let turned = |play: &usize| -> Vec<Option<Curve>> {
        let play = &given.plays[*play];
        let length = play.track.iter().map(Vec::len).max().unwrap_or_default();
        let offsets = offsets(length);
        offsets.map(|by| curve(given.shown(play), &round(&play.track, by), window)).collect()
    };
    let curves: Vec<Vec<Option<Curve>>> = own.plays.iter().map(turned).collect();
    let draw = |_| {
        let found: Vec<&Curve> = curves
            .iter()
            .filter_map(|offsets| offsets.get(stream.below(offsets.len()))?.as_ref())
            .collect();
        mean_curve(found.into_iter(), window.lags())
    };
    (0..options.surrogates).map(draw).collect()
}

/// Offsets between which courses are turned round, evenly over the course: all of them count alike.
fn offsets(length: usize) -> impl Iterator<Item = usize> {
    let count = length.min(MOST_OFFSETS);
    (0..count).map(move |place| place * length / count.max(1))
}

/// Courses turned round by so many instants.
fn round(track: &[Vec<f64>], by: usize) -> Courses {
    let turned = |course: &Vec<f64>| {
        let mut course = course.clone();
        if !course.is_empty() {
            let by = by % course.len();
            course.rotate_right(by);
        }
        course
    };
    track.iter().map(turned).collect()
}
