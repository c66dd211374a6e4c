//! `--method`, `--as-in` and what they decide.

use anyhow::{anyhow, bail};
use mimique_annotate::{
    BaumWelch, ClassWeight, ForestOptions, HmmOptions, Isolation, Kernel, LogisticOptions, Method,
    SvmOptions, Topology,
};

/// Whose way is gone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum AsIn {
    /// Chapter 4 of the thesis: all labelled frames, segments of the energy, each by its mean
    Thesis,
    /// Section 2.3 of the short paper: a hidden Markov model a label, joined
    ShortPaper,
}

/// The methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Name {
    /// Random forest
    Forest,
    /// Nearest neighbours
    Knn,
    /// Support vector machines, one against one
    Svm,
    /// Logistic regression
    Logistic,
    /// Hidden Markov models with mixtures of Gaussians
    Hmm,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum KernelName {
    Linear,
    Rbf,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum TopologyName {
    Ergodic,
    LeftRight,
}

/// Frames a second, or `all`.
#[derive(Debug, Clone, Copy)]
struct Thin(Option<f64>);

impl std::str::FromStr for Thin {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "all" {
            return Ok(Self(None));
        }
        let rate = text.parse().ok().filter(|rate: &f64| *rate > 0.0 && rate.is_finite());
        rate.map(|rate| Self(Some(rate))).ok_or_else(|| "give frames a second, or all".to_owned())
    }
}

/// The heading of what a method decides.
const HEADING: &str = "Method";
/// Training frames a second where nothing else is asked for: more say the same again.
const THINNED_HZ: f64 = 10.0;

/// Options.
#[derive(clap::Args)]
pub struct MethodOptions {
    /// Set everything as the thesis or the short paper has it; what is given beside it is as given
    #[arg(long, value_name = "DOCUMENT", help_heading = HEADING)]
    pub as_in: Option<AsIn>,
    /// The method [default: forest]
    #[arg(long, value_name = "NAME", help_heading = HEADING)]
    method: Option<Name>,
    /// Training frames a second, or all; hidden Markov models learn all [default: 10]
    #[arg(long, value_name = "HZ", help_heading = HEADING)]
    thin: Option<Thin>,
    /// How many neighbours vote (knn) [default: 3]
    #[arg(long, value_name = "K", help_heading = HEADING)]
    neighbours: Option<usize>,
    /// Kernel (svm) [default: rbf]
    #[arg(long, value_name = "NAME", help_heading = HEADING)]
    kernel: Option<KernelName>,
    /// Price of a frame on the wrong side (svm), weight of the losses (logistic) [default: 1]
    #[arg(long, value_name = "C", help_heading = HEADING)]
    c: Option<f64>,
    /// Gamma in exp(-gamma d^2) (svm) [default: 0.2]
    #[arg(long, value_name = "GAMMA", help_heading = HEADING)]
    gamma: Option<f64>,
    /// Let each label count as much as another (svm, logistic)
    #[arg(long, help_heading = HEADING)]
    balanced: bool,
    /// Trees (forest) [default: 200]
    #[arg(long, value_name = "N", help_heading = HEADING)]
    trees: Option<usize>,
    /// Seed of all drawing (forest, folds, resamples)
    #[arg(long, value_name = "N", default_value_t = 1, help_heading = HEADING)]
    pub seed: u64,
    /// States a label (hmm) [default: 5]
    #[arg(long, value_name = "N", help_heading = HEADING)]
    states: Option<usize>,
    /// Gaussians a state (hmm) [default: 20]
    #[arg(long, value_name = "N", help_heading = HEADING)]
    components: Option<usize>,
    /// Which states follow which (hmm) [default: ergodic]
    #[arg(long, value_name = "NAME", help_heading = HEADING)]
    topology: Option<TopologyName>,
    /// Least variance of a Gaussian (hmm) [default: 0.0009]
    #[arg(long, value_name = "VARIANCE", help_heading = HEADING)]
    variance_floor: Option<f64>,
    /// Steps of learning at most (hmm) [default: 50]
    #[arg(long, value_name = "N", help_heading = HEADING)]
    steps: Option<usize>,
    /// Factor of the emissions' logarithms (hmm): below 1 makes fewer segments [default: 1]
    #[arg(long, value_name = "FACTOR", help_heading = HEADING)]
    temper: Option<f64>,
    /// Label of the face at rest (as in the short paper) [default: neutral or N]
    #[arg(long, value_name = "LABEL", help_heading = HEADING)]
    neutral: Option<String>,
}

impl MethodOptions {
    /// Training frames a second; all where there is none.
    pub fn thinned_to_hz(&self) -> Option<f64> {
        match (self.thin, self.as_in) {
            (Some(Thin(rate)), _) => rate,
            (None, Some(AsIn::Thesis)) => None,
            (None, _) => Some(THINNED_HZ),
        }
    }

    /// The method, for these labels; `stay_s` is the mean time that a label stays, where it is given.
    pub fn method(&self, labels: &[String], stay_s: Option<f64>) -> anyhow::Result<Method> {
        let by_document = match self.as_in {
            Some(AsIn::ShortPaper) => Name::Hmm,
            Some(AsIn::Thesis) | None => Name::Forest,
        };
        let name = self.method.unwrap_or(by_document);
        self.refuse_of_others(name)?;
        let class_weight =
            if self.balanced { ClassWeight::Balanced } else { ClassWeight::default() };
        let c = self.c.unwrap_or(1.0);
        Ok(match name {
            Name::Forest => {
                let default = ForestOptions::default();
                let trees = self.trees.unwrap_or(default.trees);
                Method::Forest(ForestOptions { trees, seed: self.seed, ..default })
            }
            Name::Knn => Method::Knn { k: self.neighbours.unwrap_or(3) },
            Name::Svm => {
                let kernel = match self.kernel.unwrap_or(KernelName::Rbf) {
                    KernelName::Linear => Kernel::Linear,
                    KernelName::Rbf => Kernel::Rbf { gamma: self.gamma.unwrap_or(0.2) },
                };
                Method::Svm(SvmOptions { kernel, c, class_weight, ..SvmOptions::default() })
            }
            Name::Logistic => Method::Logistic(LogisticOptions { c, class_weight }),
            Name::Hmm => Method::Hmm(self.hmm(labels, stay_s)?),
        })
    }

    fn hmm(&self, labels: &[String], stay_s: Option<f64>) -> anyhow::Result<HmmOptions> {
        let default = match self.as_in {
            Some(AsIn::ShortPaper) => HmmOptions::as_in_the_short_paper(self.neutral(labels)?),
            _ => HmmOptions::default(),
        };
        let components = self.components.unwrap_or(default.components);
        let isolation = default.isolation.map(|own| Isolation { components, ..own });
        Ok(HmmOptions {
            topology: match self.topology {
                Some(TopologyName::LeftRight) => Topology::LeftRight,
                Some(TopologyName::Ergodic) => Topology::Ergodic,
                None => default.topology,
            },
            states: self.states.unwrap_or(default.states),
            components,
            learning: BaumWelch {
                steps: self.steps.unwrap_or(default.learning.steps),
                variance_floor: self.variance_floor.unwrap_or(default.learning.variance_floor),
                ..default.learning
            },
            mean_stay_s: stay_s.unwrap_or(default.mean_stay_s),
            temper: self.temper.unwrap_or(default.temper),
            isolation,
        })
    }

    /// The index of the label of the face at rest.
    fn neutral(&self, labels: &[String]) -> anyhow::Result<usize> {
        let named = |name: &str| labels.iter().position(|own| own.eq_ignore_ascii_case(name));
        let all = || labels.join(", ");
        match &self.neutral {
            Some(name) => labels
                .iter()
                .position(|own| own == name)
                .ok_or_else(|| anyhow!("--neutral: {name:?} is none of the labels {}", all())),
            None => named("neutral").or_else(|| named("N")).ok_or_else(|| {
                anyhow!("--as-in short-paper: no label is called neutral or N of {}; name it with --neutral", all())
            }),
        }
    }

    /// Refuses what only another method listens to.
    fn refuse_of_others(&self, name: Name) -> anyhow::Result<()> {
        use Name::{Forest, Hmm, Knn, Logistic, Svm};
        let options: [(&str, bool, &[Name]); 12] = [
            ("--neighbours", self.neighbours.is_some(), &[Knn]),
            ("--kernel", self.kernel.is_some(), &[Svm]),
            ("--c", self.c.is_some(), &[Svm, Logistic]),
            ("--gamma", self.gamma.is_some(), &[Svm]),
            ("--balanced", self.balanced, &[Svm, Logistic]),
            ("--trees", self.trees.is_some(), &[Forest]),
            ("--states", self.states.is_some(), &[Hmm]),
            ("--components", self.components.is_some(), &[Hmm]),
            ("--topology", self.topology.is_some(), &[Hmm]),
            ("--variance-floor", self.variance_floor.is_some(), &[Hmm]),
            ("--steps", self.steps.is_some(), &[Hmm]),
            ("--temper", self.temper.is_some(), &[Hmm]),
        ];
        match options.into_iter().find(|(_, given, by)| *given && !by.contains(&name)) {
            Some((option, ..)) => bail!(
                "{option}: {} does not listen to it; leave it out, or choose another --method",
                format!("{name:?}").to_lowercase()
            ),
            None => Ok(()),
        }
    }
}
