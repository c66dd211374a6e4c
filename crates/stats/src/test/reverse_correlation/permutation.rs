//! The largest |z| of images where answers are dealt anew within each person.

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::ReverseCorrelationOptions;
use super::image::{Images, Intensities};
use crate::numerics::largest::Largest;
use crate::numerics::random::Stream;

/// What the draws found, of units by times and of presence.
pub(super) struct Draws {
    /// Of each category.
    pub(super) groups: Vec<[Largest; 2]>,
    /// Of each person, of each category.
    pub(super) people: Vec<Vec<[Largest; 2]>>,
}

/// Deals the answers of each person anew, as often as is asked for. Each draw has a random stream of its own, so that
/// neither threads nor their number matter.
pub(super) fn draws(images: &Images, options: ReverseCorrelationOptions) -> Draws {
    let (categories, cells) = (images.categories, images.cells());
    let scratch = || (Vec::new(), vec![0.0; categories * cells], vec![0.0; categories * cells]);
    let one = |(labels, sums, group): &mut (Vec<u16>, Vec<f64>, Vec<f64>), draw: usize| {
        let mut stream = Stream::new(options.seed, draw as u64);
        group.fill(0.0);
        let mut found = Vec::with_capacity((images.people.len() + 1) * categories);
        for person in &images.people {
            labels.clone_from(&person.labels);
            let all = labels.len();
            stream.draw_first(labels, all);
            person.sums(labels, images, sums);
            for category in 0..categories {
                let own = &sums[category * cells..][..cells];
                let group = &mut group[category * cells..][..cells];
                let mut largest = [0.0_f64; 2];
                person.each_z(category, own, |cell, z| {
                    group[cell] += z;
                    let kind = usize::from(images.is_presence(cell));
                    largest[kind] = largest[kind].max(z.abs());
                });
                found.push(largest);
            }
        }
        for category in 0..categories {
            let mut largest = [0.0_f64; 2];
            for (cell, sum) in group[category * cells..][..cells].iter().enumerate() {
                let kind = usize::from(images.is_presence(cell));
                largest[kind] = largest[kind].max((sum * images.pooling[category][cell]).abs());
            }
            found.push(largest);
        }
        found
    };
    let drawn: Vec<Vec<[f64; 2]>> =
        (0..options.permutations).into_par_iter().map_init(scratch, one).collect();
    let of = |place: usize| {
        [0, 1].map(|kind| Largest::of(drawn.iter().map(|found| found[place][kind]).collect()))
    };
    let people = images.people.len();
    Draws {
        groups: (0..categories).map(|category| of(people * categories + category)).collect(),
        people: (0..people)
            .map(|person| (0..categories).map(|c| of(person * categories + c)).collect())
            .collect(),
    }
}

/// The same of intensities, which are dealt anew over the trials that a person answered with a category. Of each
/// category.
pub(super) fn intensity_draws(
    found: &Intensities,
    options: ReverseCorrelationOptions,
) -> Vec<Largest> {
    let one = |draw: usize| {
        // Other streams than those of the answers.
        let mut stream = Stream::new(options.seed, (options.permutations + draw) as u64);
        let mut dealt = Vec::new();
        let largest = |category: usize, stream: &mut Stream, dealt: &mut Vec<f64>| {
            let mut group = vec![0.0; found.units];
            for own in &found.of_category[category] {
                dealt.clone_from(&own.values);
                let all = dealt.len();
                stream.draw_first(dealt, all);
                own.each_z(dealt, |unit, z| group[unit] += z);
            }
            let pooled = group.iter().zip(&found.pooling[category]);
            pooled.fold(0.0_f64, |most, (sum, scale)| most.max((sum * scale).abs()))
        };
        (0..found.of_category.len())
            .map(|category| largest(category, &mut stream, &mut dealt))
            .collect::<Vec<f64>>()
    };
    let drawn: Vec<Vec<f64>> = (0..options.permutations).into_par_iter().map(one).collect();
    (0..found.of_category.len())
        .map(|category| Largest::of(drawn.iter().map(|found| found[category]).collect()))
        .collect()
}
