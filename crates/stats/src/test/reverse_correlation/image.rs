//! Activations of people's trials as they are summed, and the images that the sums make.

use super::permutation::Draws;
use super::trials::ReverseTrials;
use super::{GroupImage, PersonImage, ReverseCorrelationOptions, UnitCourse, UnitImage, UnitTest};
use crate::numerics::largest::Largest;
use crate::summary::describe::moments;

/// Share of a sum of squares below which a spread is rounding.
const NO_SPREAD: f64 = 1e-12;

/// The middles of the time bins, seconds.
pub(super) fn middles(options: ReverseCorrelationOptions) -> impl Iterator<Item = f64> {
    let width = options.duration_s / options.bins as f64;
    (0..options.bins).map(move |bin| (bin as f64 + 0.5) * width)
}

/// A person's trials.
pub(super) struct Person {
    /// Category of each trial.
    pub(super) labels: Vec<u16>,
    /// Units of each trial, each with its activation in every bin and a 1 for its presence.
    shown: Vec<Vec<(usize, Vec<f64>)>>,
    /// Trials of each category.
    counts: Vec<usize>,
    /// Mean activation of each cell.
    means: Vec<f64>,
    /// One over the root of the sum of squares about it; 0 where it does not vary.
    inverse: Vec<f64>,
}

/// Everybody's trials. A cell is a unit in a bin; behind the bins of each unit stands its presence.
pub(super) struct Images {
    pub(super) people: Vec<Person>,
    pub(super) categories: usize,
    units: usize,
    bins: usize,
    /// Of each category and cell: one over the root of the number of people who have a z there.
    pub(super) pooling: Vec<Vec<f64>>,
}

impl Person {
    /// Whether the person answered so in some trials and not in all.
    fn has(&self, category: usize) -> bool {
        let count = self.counts[category];
        count > 0 && count < self.labels.len()
    }

    /// Sums of activations by the labels of the trials, categories x cells.
    pub(super) fn sums(&self, labels: &[u16], images: &Images, sums: &mut [f64]) {
        let (cells, width) = (images.cells(), images.bins + 1);
        sums.fill(0.0);
        for (label, shown) in labels.iter().zip(&self.shown) {
            let own = &mut sums[usize::from(*label) * cells..][..cells];
            for (unit, values) in shown {
                let cells = &mut own[unit * width..][..width];
                cells.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            }
        }
    }

    /// Tells z of each cell of a category from its sums; nothing where the person has none.
    #[inline]
    pub(super) fn each_z(&self, category: usize, sums: &[f64], mut tell: impl FnMut(usize, f64)) {
        if !self.has(category) {
            return;
        }
        let (own, all) = (self.counts[category] as f64, self.labels.len() as f64);
        let scale = (all * (all - 1.0) / (own * (all - own))).sqrt();
        let spread = self.means.iter().zip(&self.inverse);
        for (cell, (sum, (mean, inverse))) in sums.iter().zip(spread).enumerate() {
            tell(cell, (sum - own * mean) * scale * inverse);
        }
    }
}

impl Images {
    pub(super) fn of(trials: &ReverseTrials, options: ReverseCorrelationOptions) -> Self {
        let (units, bins) = (trials.units.len(), options.bins);
        let cells = units * (bins + 1);
        let people: Vec<Person> = (0..trials.people.len())
            .map(|place| {
                let own = || trials.trials.iter().filter(move |trial| trial.person == place);
                let shown: Vec<Vec<(usize, Vec<f64>)>> = own()
                    .map(|trial| {
                        let courses = trial.courses.iter();
                        courses
                            .map(|course| {
                                let heights = middles(options).map(|time| course.at(time));
                                (course.unit, heights.chain([1.0]).collect())
                            })
                            .collect()
                    })
                    .collect();
                let mut counts = vec![0; trials.categories.len()];
                own().for_each(|trial| counts[trial.answer] += 1);
                let (means, inverse) = spread(&shown, cells, bins + 1);
                let labels = own().map(|trial| trial.answer as u16).collect();
                Person { labels, shown, counts, means, inverse }
            })
            .collect();
        let categories = trials.categories.len();
        let pooling = (0..categories)
            .map(|category| {
                let with = |cell: usize| {
                    let has = |each: &&Person| each.has(category) && each.inverse[cell] > 0.0;
                    people.iter().filter(has).count()
                };
                (0..cells).map(|cell| 1.0 / (with(cell).max(1) as f64).sqrt()).collect()
            })
            .collect();
        Self { people, categories, units, bins, pooling }
    }

    pub(super) fn cells(&self) -> usize {
        self.units * (self.bins + 1)
    }

    pub(super) fn is_presence(&self, cell: usize) -> bool {
        cell % (self.bins + 1) == self.bins
    }

    /// Places of the people who have an image of a category.
    pub(super) fn people_of(&self, category: usize) -> impl Iterator<Item = usize> {
        (0..self.people.len()).filter(move |&place| self.people[place].has(category))
    }

    /// Differences and z of a person's cells.
    fn cells_of(&self, person: &Person, category: usize) -> (Vec<f64>, Vec<f64>) {
        let cells = self.cells();
        let mut sums = vec![0.0; self.categories * cells];
        person.sums(&person.labels, self, &mut sums);
        let sums = &sums[category * cells..][..cells];
        let mut z = vec![0.0; cells];
        person.each_z(category, sums, |cell, value| z[cell] = value);
        let (own, all) = (person.counts[category] as f64, person.labels.len() as f64);
        let difference = |(sum, mean): (&f64, &f64)| (sum - own * mean) * all / (own * (all - own));
        (sums.iter().zip(&person.means).map(difference).collect(), z)
    }

    /// Without the cells of presence.
    fn of_times(&self, cells: &[f64]) -> Vec<f64> {
        cells.chunks_exact(self.bins + 1).flat_map(|unit| &unit[..self.bins]).copied().collect()
    }

    /// The image of each person who has one.
    pub(super) fn each(
        &self,
        trials: &ReverseTrials,
        draws: &Draws,
        category: usize,
    ) -> Vec<PersonImage> {
        let image = |place: usize| {
            let person = &self.people[place];
            let (difference, z) = self.cells_of(person, category);
            let [times, presence] = &draws.people[place][category];
            let critical = presence.critical();
            let more = |unit: &usize| z[unit * (self.bins + 1) + self.bins] > critical;
            PersonImage {
                participant: trials.people[place].clone(),
                n: person.labels.len(),
                answers: person.counts[category],
                critical_z: times.critical(),
                units: (0..self.units).filter(more).map(|k| trials.units[k].clone()).collect(),
                difference: self.of_times(&difference),
                z: self.of_times(&z),
            }
        };
        self.people_of(category).map(image).collect()
    }

    /// The image of all of them together.
    pub(super) fn group(
        &self,
        trials: &ReverseTrials,
        draws: &Draws,
        intensity: Option<(&Intensities, &Vec<Largest>)>,
        category: usize,
    ) -> GroupImage {
        let people: Vec<&Person> = self.people_of(category).map(|k| &self.people[k]).collect();
        let found: Vec<(Vec<f64>, Vec<f64>)> =
            people.iter().map(|person| self.cells_of(person, category)).collect();
        let [times, presence] = &draws.groups[category];
        let cell = |cell: usize, largest: &Largest| {
            let differences: Vec<f64> = found.iter().map(|(d, _)| d[cell]).collect();
            let correlations = people.iter().zip(&found);
            let correlations =
                correlations.map(|(own, (_, z))| z[cell] / (own.labels.len() as f64 - 1.0).sqrt());
            let (effect, t) = mean_and_t(&differences);
            let sum: f64 = found.iter().map(|(_, z)| z[cell]).sum();
            let z = sum * self.pooling[category][cell];
            let r = correlations.sum::<f64>() / people.len() as f64;
            UnitTest { effect, r, t, z, p: largest.p(z) }
        };
        let critical: Vec<f64> = self
            .people_of(category)
            .map(|place| draws.people[place][category][1].critical())
            .collect();
        let unit = |unit: usize| {
            let first = unit * (self.bins + 1);
            let cells: Vec<UnitTest> =
                (first..first + self.bins).map(|place| cell(place, times)).collect();
            let place = first + self.bins;
            let significant =
                found.iter().zip(&critical).filter(|((_, z), c)| z[place].abs() > **c);
            let bits: f64 =
                people.iter().map(|person| person.information(unit, category as u16)).sum();
            UnitImage {
                unit: trials.units[unit].clone(),
                difference: cells.iter().map(|each| each.effect).collect(),
                r: cells.iter().map(|each| each.r).collect(),
                t: cells.iter().map(|each| each.t).collect(),
                z: cells.iter().map(|each| each.z).collect(),
                p: cells.iter().map(|each| each.p).collect(),
                presence: cell(place, presence),
                information_bits: bits / people.len() as f64,
                people: significant.count(),
                intensity: intensity
                    .and_then(|(found, largest)| found.test(category, unit, &largest[category])),
            }
        };
        let units: Vec<UnitImage> = (0..self.units).map(unit).collect();
        let critical_z_presence = presence.critical();
        let in_mind = (0..self.units).filter(|&k| units[k].presence.z > critical_z_presence);
        let face = in_mind
            .map(|k| UnitCourse {
                unit: trials.units[k].clone(),
                activation: self.mean_course(k, category as u16),
            })
            .collect();
        GroupImage {
            critical_z: times.critical(),
            critical_z_presence,
            critical_z_intensity: intensity.map(|(_, largest)| largest[category].critical()),
            face,
            units,
        }
    }

    /// Mean activation of a unit over all trials that show it and were answered with a category.
    fn mean_course(&self, unit: usize, category: u16) -> Vec<f64> {
        let (mut sum, mut count) = (vec![0.0; self.bins], 0.0_f64);
        for person in &self.people {
            let answered = person.labels.iter().zip(&person.shown);
            let answered = answered.filter(|(label, _)| **label == category);
            for (_, values) in answered.flat_map(|(_, shown)| shown).filter(|(k, _)| *k == unit) {
                count += 1.0;
                sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            }
        }
        sum.iter().map(|sum| sum / count.max(1.0)).collect()
    }
}

impl Person {
    /// Mutual information of a unit's presence and an answer, bits, less 1 / (2 N ln 2): its bias for a table of two
    /// by two.
    fn information(&self, unit: usize, category: u16) -> f64 {
        let all = self.labels.len() as f64;
        let mut table = [[0.0_f64; 2]; 2];
        for (label, shown) in self.labels.iter().zip(&self.shown) {
            let there = shown.iter().any(|(k, _)| *k == unit);
            table[usize::from(there)][usize::from(*label == category)] += 1.0;
        }
        let rows = table.map(|row| row[0] + row[1]);
        let columns = [0, 1].map(|k| table[0][k] + table[1][k]);
        let mut bits = 0.0;
        for (row, of_row) in table.iter().zip(rows) {
            for (count, of_column) in row.iter().zip(columns) {
                if *count > 0.0 {
                    bits += count / all * libm::log2(count * all / (of_row * of_column));
                }
            }
        }
        let varies = rows.iter().chain(&columns).all(|count| *count > 0.0);
        if varies { bits - 1.0 / (2.0 * all * std::f64::consts::LN_2) } else { 0.0 }
    }
}

/// Means of cells over trials, and one over the root of the sum of squares about them.
fn spread(shown: &[Vec<(usize, Vec<f64>)>], cells: usize, width: usize) -> (Vec<f64>, Vec<f64>) {
    let trials = shown.len().max(1) as f64;
    let (mut means, mut squares, mut present) =
        (vec![0.0; cells], vec![0.0; cells], vec![0.0; cells]);
    let each = |tell: &mut dyn FnMut(usize, f64)| {
        for (unit, values) in shown.iter().flatten() {
            values.iter().enumerate().for_each(|(k, value)| tell(unit * width + k, *value));
        }
    };
    each(&mut |cell, value| means[cell] += value / trials);
    each(&mut |cell, value| {
        squares[cell] += (value - means[cell]) * (value - means[cell]);
        present[cell] += 1.0;
    });
    let inverse = (0..cells).map(|cell| {
        // In all other trials the unit rests.
        let mean: f64 = means[cell];
        let rest = trials - present[cell];
        let about = squares[cell] + rest * mean * mean;
        let raw = about + trials * mean * mean;
        if about > NO_SPREAD * raw { 1.0 / about.sqrt() } else { 0.0 }
    });
    let inverse = inverse.collect();
    (means, inverse)
}

/// Mean, and the mean over its standard error.
fn mean_and_t(values: &[f64]) -> (f64, Option<f64>) {
    let (mean, variance) = moments(values);
    let error = variance.map(|variance| (variance / values.len() as f64).sqrt());
    (mean, error.filter(|error| *error > 0.0).map(|error| mean / error))
}

/// Intensities of the trials that one person answered with one category.
pub(super) struct OwnIntensities {
    pub(super) values: Vec<f64>,
    units: Vec<OwnAmplitudes>,
}

/// A unit in these trials.
struct OwnAmplitudes {
    unit: usize,
    /// The trials that show it.
    trials: Vec<usize>,
    /// Its amplitudes there, less their mean.
    amplitudes: Vec<f64>,
    /// The sum of their squares.
    squares: f64,
}

/// Intensities of everybody.
pub(super) struct Intensities {
    pub(super) units: usize,
    /// Of each category: the people of whom it has some.
    pub(super) of_category: Vec<Vec<OwnIntensities>>,
    /// Of each category and unit: one over the root of the number of people who have a z there.
    pub(super) pooling: Vec<Vec<f64>>,
}

impl OwnAmplitudes {
    /// Slope of the intensities of these trials on the amplitudes, and z; none where they do not vary.
    fn slope(&self, values: &[f64]) -> Option<[f64; 2]> {
        let own: Vec<f64> = self.trials.iter().map(|trial| values[*trial]).collect();
        let (mean, squares) = about(&own)?;
        let products = own.iter().zip(&self.amplitudes).map(|(value, a)| (value - mean) * a);
        let product: f64 = products.sum();
        let all = own.len() as f64;
        Some([product / self.squares, product * ((all - 1.0) / (self.squares * squares)).sqrt()])
    }
}

impl OwnIntensities {
    /// Tells z of each unit, of intensities in some order.
    pub(super) fn each_z(&self, values: &[f64], mut tell: impl FnMut(usize, f64)) {
        for own in &self.units {
            if let Some([_, z]) = own.slope(values) {
                tell(own.unit, z);
            }
        }
    }
}

impl Intensities {
    /// None where there is no intensity at all.
    pub(super) fn of(trials: &ReverseTrials) -> Option<Self> {
        trials.trials.iter().any(|trial| trial.intensity.is_some()).then(|| {
            let units = trials.units.len();
            let people = 0..trials.people.len();
            let of_category: Vec<Vec<OwnIntensities>> = (0..trials.categories.len())
                .map(|category| {
                    people.clone().map(|person| own_intensities(trials, person, category)).collect()
                })
                .collect();
            let pooling = of_category.iter().map(|people| {
                let with = |unit: usize| {
                    people
                        .iter()
                        .filter(|own| own.units.iter().any(|each| each.unit == unit))
                        .count()
                };
                (0..units).map(|unit| 1.0 / (with(unit).max(1) as f64).sqrt()).collect()
            });
            let pooling = pooling.collect();
            Self { units, of_category, pooling }
        })
    }

    /// None where nobody has a slope.
    fn test(&self, category: usize, unit: usize, largest: &Largest) -> Option<UnitTest> {
        let people = &self.of_category[category];
        let of_unit = |own: &OwnIntensities| {
            let amplitudes = own.units.iter().find(|each| each.unit == unit)?;
            let [slope, z] = amplitudes.slope(&own.values)?;
            Some((slope, z, z / (amplitudes.trials.len() as f64 - 1.0).sqrt()))
        };
        let found: Vec<(f64, f64, f64)> = people.iter().filter_map(of_unit).collect();
        let slopes: Vec<f64> = found.iter().map(|(slope, ..)| *slope).collect();
        if slopes.is_empty() {
            return None;
        }
        let (effect, t) = mean_and_t(&slopes);
        let z = found.iter().map(|(_, z, _)| z).sum::<f64>() * self.pooling[category][unit];
        let r = found.iter().map(|(.., r)| r).sum::<f64>() / found.len() as f64;
        Some(UnitTest { effect, r, t, z, p: largest.p(z) })
    }
}

fn own_intensities(trials: &ReverseTrials, person: usize, category: usize) -> OwnIntensities {
    let own = trials.trials.iter();
    let own = own.filter(|trial| trial.person == person && trial.answer == category);
    let rated: Vec<_> = own.filter_map(|trial| Some((trial, trial.intensity?))).collect();
    let values: Vec<f64> = rated.iter().map(|(_, value)| *value).collect();
    let of_unit = |unit: usize| {
        let shown = rated.iter().enumerate().filter_map(|(place, (trial, _))| {
            let course = trial.courses.iter().find(|each| each.unit == unit)?;
            Some((place, course.amplitude))
        });
        let (trials, heights): (Vec<usize>, Vec<f64>) = shown.unzip();
        let (mean, squares) = about(&heights)?;
        let amplitudes: Vec<f64> = heights.into_iter().map(|height| height - mean).collect();
        let own = OwnAmplitudes { unit, trials, amplitudes, squares };
        // Two trials always lie on a line.
        (own.trials.len() >= 3 && own.slope(&values).is_some()).then_some(own)
    };
    let units = (0..trials.units.len()).filter_map(of_unit).collect();
    OwnIntensities { values, units }
}

/// Mean and sum of squares about it; none where values do not vary.
fn about(values: &[f64]) -> Option<(f64, f64)> {
    let (mean, variance) = moments(values);
    let squares = variance? * (values.len() as f64 - 1.0);
    let raw: f64 = values.iter().map(|value| value * value).sum();
    (squares > NO_SPREAD * raw).then_some((mean, squares))
}
