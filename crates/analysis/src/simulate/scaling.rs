//! How simulated people judge differences between levels: a perceived value that grows as a power of the level, with
//! normal noise of standard deviation 1 on each judgement.

use std::collections::BTreeMap;

use mimique_study::{ScalingComponent, ScalingRule, Study, component_of};
use serde::{Deserialize, Serialize};

use super::parameters::Parameters;
use super::random::Draws;

/// What people perceive of the levels of a block of difference scaling: ψ = range · ((level - lowest) / (highest -
/// lowest))^exponent, in standard deviations of a judgement.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PerceivedScale {
    /// ψ of the highest level.
    pub range: f64,
    /// 1 for a straight line, below 1 where the first steps are seen most.
    pub exponent: f64,
    /// Share of answers without looking.
    pub lapse: f64,
}

/// What people perceive, if nothing else is said.
pub(super) fn defaults(study: &Study) -> BTreeMap<String, PerceivedScale> {
    let usual = PerceivedScale { range: 5.0, exponent: 1.0, lapse: 0.02 };
    study.scalings().map(|(name, _)| (name.to_owned(), usual)).collect()
}

impl PerceivedScale {
    /// What is wrong with it: the key, the problem, and what to do.
    pub(super) fn fault(&self) -> Option<(&'static str, String, &'static str)> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        if !positive(self.range) {
            return Some(("range", format!("{} is no range", self.range), "give a number above 0"));
        }
        if !positive(self.exponent) {
            let problem = format!("{} is no exponent", self.exponent);
            return Some(("exponent", problem, "give a number above 0"));
        }
        let is_share = (0.0..=1.0).contains(&self.lapse);
        (!is_share).then(|| ("lapse", format!("{} is no share", self.lapse), "give 0 to 1"))
    }

    fn perceived(&self, level: f64, levels: &[f64]) -> f64 {
        let [Some(low), Some(high)] = [levels.first(), levels.last()] else { return 0.0 };
        self.range * libm::pow((level - low) / (high - low), self.exponent)
    }
}

/// How one person judges the differences of each block.
pub(super) struct Judge {
    blocks: BTreeMap<String, (ScalingComponent, PerceivedScale)>,
    /// Level of each clip.
    levels: BTreeMap<String, f64>,
    draws: Draws,
}

impl Judge {
    /// The person of a number.
    pub(super) fn new(study: &Study, parameters: &Parameters, seed: u64, number: u64) -> Self {
        let of = |(name, block): (&str, ScalingComponent)| {
            Some((name.to_owned(), (block, *parameters.scaling.get(name)?)))
        };
        let blocks: BTreeMap<_, _> = study.scalings().filter_map(of).collect();
        let clips = study.level_clips().into_iter().filter(|_| !blocks.is_empty());
        let levels = clips.map(|level| (level.clip.id, level.level)).collect();
        Self { blocks, levels, draws: Draws::new(seed, Some(number), "scaling") }
    }

    /// Whether the second pair of the clips of a step differs more; none of a step that asks for no judgement.
    pub(super) fn second_differs_more(
        &mut self,
        step: &str,
        clips: &[String],
        careless: bool,
    ) -> Option<bool> {
        let (block, scale) = self.blocks.get(component_of(step))?;
        let levels = clips.iter().map(|clip| self.levels.get(clip).copied());
        let levels: Vec<f64> = levels.collect::<Option<_>>()?;
        let pairs = ScalingRule::pairs(&levels)?;
        let [a, b, c, d] = pairs.map(|level| scale.perceived(level, &block.levels));
        let felt = (d - c).abs() - (b - a).abs() + self.draws.normal();
        let lapses = self.draws.happens(scale.lapse) || careless;
        let any = self.draws.happens(0.5);
        Some(if lapses { any } else { felt > 0.0 })
    }
}
