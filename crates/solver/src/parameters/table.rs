//! The table of the methods' parameters, and the method with its parameters that follows from it.
//!
//! A row says: help text, field, type, key in JSON, default, and in braces what else is known of it
//! ([`About`]). What is absent takes the default; what the method does not use is refused, so that a
//! study never claims a parameter that had no effect.

use serde_json::Value;

use crate::kouadio::associated_rows::VertexAssociation;
use crate::method::definition::Defaults;
use crate::method::names::Method;
use crate::parameters::choices::{
    Association, Gaze, Hold, Inference, LaplacianKind, Unit, Unsolved, Untold,
};
use crate::parameters::group::Group;
use crate::parameters::kind::{Kind, NamesOf, Quantity, Range};
use crate::parameters::value::{ByName, Field, Limits, Note, Scalar, Stored};

/// A row of the table of parameters.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// Its key in JSON.
    pub key: &'static str,
    /// What it does, in a sentence or two.
    pub help: &'static str,
    /// What its value is in JSON.
    pub kind: Kind,
    /// What else is known of it.
    pub about: About,
    default: fn(&MethodSpec) -> Option<Value>,
}

/// What a row says beside key, type and default.
#[derive(Debug, Clone, Copy)]
pub struct About {
    /// Which methods use it: those that use the group.
    pub group: Group,
    /// Its name in a form, a few words.
    pub label: &'static str,
    /// The numbers that it may be.
    pub range: Range,
    /// In what they are measured.
    pub quantity: Quantity,
    /// What 0 stands for, where that needs to be said.
    pub zero: Option<&'static str>,
    /// A word that may be written for 0 on the command line.
    pub zero_word: Option<&'static str>,
    /// A step of a form's field that suits it.
    pub step: Option<f64>,
    /// Whether both ends of an interval may be the same number.
    pub may_be_a_point: bool,
    /// Whose names it has, if it has values by name.
    pub names_of: Option<NamesOf>,
    /// What its value is found by where there is no default.
    pub found_by: Option<&'static str>,
    /// Its option on the command line, where that is not the key with dashes.
    pub option: Option<&'static str>,
    /// The other parameter that it depends on: whether it has an effect, and why it has none.
    pub effect: Option<Effect>,
}

/// When a parameter has an effect.
#[derive(Debug, Clone, Copy)]
pub struct Effect {
    /// Whether it has one beside the other parameters.
    pub when: fn(&MethodSpec) -> bool,
    /// Why it has none otherwise, as a clause.
    pub because: &'static str,
}

impl About {
    /// A ratio of any size without particulars; every row says its group and label.
    const PLAIN: About = About {
        group: Group::Shapes,
        label: "",
        range: Range::ANY,
        quantity: Quantity::Ratio,
        zero: None,
        zero_word: None,
        step: None,
        may_be_a_point: false,
        names_of: None,
        found_by: None,
        option: None,
        effect: None,
    };
}

macro_rules! parameters {
    ($(
        $(#[doc = $help:literal])+
        $field:ident: $form:ident<$type:ty> as $key:literal $(= $default:expr)?,
        { $($about:tt)* }
    )+) => {
        /// A method with its parameters; what is absent takes the method's default.
        #[derive(Debug, Clone, PartialEq)]
        pub struct MethodSpec {
            /// Which method.
            pub method: Method,
            $($(#[doc = $help])+ pub $field: $form<$type>,)+
        }

        /// Every parameter, in the order in which they are written and listed.
        pub const PARAMETERS: &[Parameter] = &[$(Parameter {
            key: $key,
            help: concat!($($help),+).trim_ascii(),
            kind: <$form<$type> as Stored>::KIND,
            about: About { $($about)* ..About::PLAIN },
            default: parameters!(@default $field $($default)?),
        },)+];

        impl MethodSpec {
            /// The method with every parameter at its default.
            pub fn new(method: Method) -> MethodSpec {
                MethodSpec { method, $($field: Stored::ABSENT,)+ }
            }

            $($(
                #[doc = concat!("`", $key, "`, or its default.")]
                pub fn $field(&self) -> $type {
                    let default: fn(&MethodSpec) -> $type = $default;
                    self.$field.unwrap_or_else(|| default(self))
                }
            )?)+

            /// The same with every absent parameter that has a default and an effect written out: what
            /// the provenance of a stimulus is computed from, after [`MethodSpec::at_rate`].
            pub fn resolved(&self) -> MethodSpec {
                let mut spec = self.clone();
                $(parameters!(@resolve self spec $field $key $($default)?);)+
                spec
            }

            /// Reads the parameter of a key; false where there is none of that name.
            pub(crate) fn read_field(&mut self, key: &str, value: &Value, note: Note<'_>) -> bool {
                match key {
                    $($key => self.$field = Stored::read(value, note),)+
                    _ => return false,
                }
                true
            }

            /// Every parameter with its value.
            pub(crate) fn fields(&self) -> impl Iterator<Item = (&'static Parameter, &dyn Field)> {
                PARAMETERS.iter().zip([$(&self.$field as &dyn Field),+])
            }
        }
    };
    (@default $field:ident) => { |_| None };
    (@default $field:ident $default:expr) => { |spec| Some(Scalar::json(spec.$field())) };
    (@resolve $given:ident $spec:ident $field:ident $key:literal) => {};
    (@resolve $given:ident $spec:ident $field:ident $key:literal $default:expr) => {
        if $given.has_effect($key) {
            $spec.$field = Some($given.$field());
        }
    };
}

parameters! {
    /// Weight of the thin shell against the bounds: at 0 there is no shell, at 1 there are no soft
    /// bounds.
    alpha: Option<f64> as "alpha" = |spec| spec.defaults(Group::Balance).alpha,
    { group: Group::Balance, label: "α, thin shell against bounds", range: Range::between(0.0, 1.0), step: Some(0.05), }

    /// Weight of the priors against the data.
    kappa: Option<f64> as "kappa" = |_| 0.1,
    { group: Group::PriorWeight, label: "κ, priors against data", range: Range::above(0.0), step: Some(0.01), }

    /// Resistance to stretching, k_s of eq. 5.16.
    k_s: Option<f64> as "kS" = |_| 1.0,
    { group: Group::ThinShell, label: "k_s, stretching", range: Range::at_least(0.0), step: Some(0.1), }

    /// Resistance to bending, k_b of eq. 5.16.
    k_b: Option<f64> as "kB" = |_| 1.0,
    { group: Group::ThinShell, label: "k_b, bending", range: Range::at_least(0.0), step: Some(0.1), }

    /// Weights of the discrete Laplacian.
    laplacian: Option<LaplacianKind> as "laplacian" = |_| LaplacianKind::default(),
    { group: Group::ThinShell, label: "Laplacian", }

    /// Where the soft bounds begin, l_inf and l_sup of eq. 5.24.
    soft_bounds: Option<[f64; 2]> as "softBounds" = |_| [-0.1, 1.1],
    { group: Group::SoftBounds, label: "Soft bounds begin", step: Some(0.05), }

    /// Smoothing of the soft bounds, s of eq. 5.24.
    s: Option<f64> as "s" = |_| 0.1,
    { group: Group::SoftBounds, label: "s, softness of the bounds", range: Range::between(1e-3, 10.0), step: Some(0.01), }

    /// Smoothing of the norms, sqrt(x^2 + eps^2): in units of l, for the literal forms in their unit.
    eps: Option<f64> as "eps" = |spec| {
        let eps = spec.defaults(Group::Norms).eps;
        if spec.uses(Group::LiteralUnit) { eps * spec.unit().per_metre() } else { eps }
    },
    { group: Group::Norms, label: "ε, smoothing of the norms", range: Range::at_least(0.0), }

    /// Which points of the face a marker moves.
    association: Option<Association> as "association" = |_| Association::default(),
    { group: Group::Association, label: "Association", }

    /// Radius of a marker's Gaussian zone.
    sigma: Option<f64> as "sigma" = |_| 0.012,
    {
        group: Group::Association, label: "σ, zones",
        range: Range::above_up_to(0.0, 1.0), quantity: Quantity::Metres, step: Some(0.001),
        effect: Some(Effect {
            when: |spec| spec.association() == Association::Zones,
            because: "only zones have a radius",
        }),
    }

    /// Weight of the soft bounds where they are the only prior.
    bounds_weight: Option<f64> as "boundsWeight" = |_| 1e-3,
    { group: Group::BoundsWeight, label: "Weight of the bounds", range: Range::above(0.0), }

    /// Weight of the sum of the weights against the data: the more, the fewer shapes are used.
    lambda: Option<f64> as "lambda" = |_| 0.002,
    { group: Group::Sparsity, label: "λ, sum of the weights", range: Range::at_least(0.0), step: Some(0.001), }

    /// Weight of the squared second differences of the weights from frame to frame.
    mu: Option<f64> as "mu" = |_| 0.1,
    {
        group: Group::Smoothness, label: "μ, second differences", range: Range::at_least(0.0),
        zero: Some("every frame by itself"), step: Some(0.05),
    }

    /// Strength of the squared sum of the weights (L1 of Audio2Face-3D, which squares it).
    l1: Option<f64> as "l1" = |_| 1.0,
    { group: Group::Audio2Face, label: "L1, squared sum of the weights", range: Range::at_least(0.0), step: Some(0.1), }

    /// Strength of the squared weights (L2 of Audio2Face-3D).
    l2: Option<f64> as "l2" = |_| 3.5,
    { group: Group::Audio2Face, label: "L2, squared weights", range: Range::at_least(0.0), step: Some(0.1), }

    /// Strength of the squared differences between the two sides of a movement.
    symmetry: Option<f64> as "symmetry" = |_| 100.0,
    { group: Group::Audio2Face, label: "Y, symmetry", range: Range::at_least(0.0), step: Some(5.0), }

    /// Strength of the temporal term, towards the weights of the frame before.
    temporal: Option<f64> as "temporal" = |_| 0.15,
    {
        group: Group::Audio2Face, label: "T, last frame", range: Range::at_least(0.0),
        zero: Some("every frame by itself"), step: Some(0.05),
    }

    /// Unit in which the equation of the paper is taken literally.
    unit: Option<Unit> as "unit" = |_| Unit::default(),
    { group: Group::LiteralUnit, label: "Unit", }

    /// How far the surface may leave its markers to be smoother: weight of its energy, normalised,
    /// against the squared distances.
    stiffness: Option<f64> as "stiffness" = |_| 0.0,
    {
        group: Group::Surface, label: "Stiffness", range: Range::at_least(0.0),
        zero: Some("markers are met exactly"), step: Some(0.01),
    }

    /// Which vertices rest: those that no shape moves, or none.
    hold: Option<Hold> as "hold" = |_| Hold::default(),
    { group: Group::Surface, label: "At rest", }

    /// How the Gaussian process learns: on basis vectors, or on all frames.
    inference: Option<Inference> as "inference" = |_| Inference::default(),
    { group: Group::GaussianProcess, label: "Learns", }

    /// Most basis vectors of the sparse process.
    basis_vectors: Option<u32> as "basisVectors" = |_| 200,
    {
        group: Group::GaussianProcess, label: "Basis vectors, at most",
        range: Range::between(10.0, 2000.0), step: Some(10.0),
        effect: Some(Effect {
            when: |spec| spec.inference() == Inference::Sparse,
            because: "the exact process has every frame for a basis vector",
        }),
    }

    /// Length scale of the kernel over standardised displacements.
    length_scale: Option<f64> as "lengthScale",
    {
        group: Group::GaussianProcess, label: "Length scale", range: Range::above(0.0),
        found_by: Some("by the marginal likelihood"),
    }

    /// Standard deviation of the process, in weights.
    signal: Option<f64> as "signal",
    {
        group: Group::GaussianProcess, label: "Signal", range: Range::above(0.0),
        found_by: Some("by the marginal likelihood"),
    }

    /// Standard deviation of the noise on the training weights.
    noise: Option<f64> as "noise",
    {
        group: Group::GaussianProcess, label: "Noise", range: Range::above(0.0),
        found_by: Some("by the marginal likelihood"),
    }

    /// Bounds of single shapes, in place of those of all the others.
    bounds: ByName<[f64; 2]> as "bounds",
    {
        group: Group::Bounds, label: "Bounds", may_be_a_point: true,
        names_of: Some(NamesOf::Shapes), step: Some(0.05),
    }

    /// Shapes held at 0.
    locked: Vec<String> as "locked",
    { group: Group::Shapes, label: "Locked", names_of: Some(NamesOf::Shapes), option: Some("lock"), }

    /// What tells the shapes that turn the eyes: nothing, so that they rest but where the bounds name
    /// them, or the markers.
    gaze: Option<Gaze> as "gaze" = |_| Gaze::default(),
    { group: Group::Shapes, label: "Gaze", }

    /// What becomes of shapes that the markers do not tell ([`crate::shape_sensitivities`]): they stay at 0, but
    /// for those that the bounds name, or are solved as all others.
    untold: Option<Untold> as "untold" = |_| Untold::default(),
    { group: Group::Shapes, label: "Shapes that no marker tells", }

    /// Factor of the solved weights, within their bounds: above 1 exaggerates, below 1 attenuates.
    gain: Option<f64> as "gain" = |_| 1.0,
    {
        group: Group::Shapes, label: "Gain of the weights", range: Range::above_up_to(0.0, 3.0),
        step: Some(0.05),
    }

    /// Importance of single markers; 1 if not given, 0 leaves the marker out.
    importance: ByName<f64> as "importance",
    {
        group: Group::Markers, label: "Importance", range: Range::at_least(0.0),
        names_of: Some(NamesOf::Markers), step: Some(0.1),
    }

    /// Cut-off of the zero-phase low-pass of the head's pose.
    head_lowpass_hz: Option<f64> as "headLowpassHz",
    {
        group: Group::FrontEnd, label: "Head low-pass", range: Range::at_least(0.0),
        quantity: Quantity::Hertz, zero: Some("no filter"), zero_word: Some("none"),
        step: Some(0.1), option: Some("head-lowpass"), found_by: Some("10 from 25 frames per second on, else none"),
    }

    /// Smoothing of the adaptation of shape (eq. 5.18), on the diagonal of its system, for neutral markers
    /// centred and scaled to a root mean square radius of 1. Markers that sit 1 to 2 mm beside their
    /// places want 0.1.
    rbf_smoothing: Option<f64> as "rbfSmoothing" = |_| 0.0,
    {
        group: Group::FrontEnd, label: "Smoothing of the adaptation", range: Range::between(0.0, 100.0),
        zero: Some("every marker is met, as in the thesis"), step: Some(0.05),
    }

    /// What becomes of a take with frames that are not solved: it is refused, or their weights are
    /// interpolated between the solved frames around them and marked in the report.
    unsolved: Option<Unsolved> as "unsolved",
    { group: Group::Frames, label: "Frames not solved", found_by: Some("refuse"), }

    /// Cut-off of the zero-phase low-pass of all weights: slow movements are left. Of a gentle movement 2 Hz leave
    /// little, as an anchor should.
    lowpass_hz: Option<f64> as "lowpassHz",
    {
        group: Group::Timing, label: "Low-pass of the weights", range: Range::at_least(0.0),
        quantity: Quantity::Hertz, zero: Some("no filter"), zero_word: Some("none"),
        step: Some(0.5), found_by: Some("none"),
    }

    /// How much later than its markers the face moves; below 0 it is early.
    delay_ms: Option<f64> as "delayMs",
    {
        group: Group::Timing, label: "Delay of the face", range: Range::between(-1000.0, 1000.0),
        quantity: Quantity::Milliseconds, step: Some(10.0), found_by: Some("0"),
    }

    /// A second method that solves the same markers; parameters that it alone uses are its own.
    blend_with: Option<Method> as "blendWith",
    { group: Group::Blend, label: "Blended with", found_by: Some("no second method"), }

    /// The second method's share of the weights: 0 is the first method, 1 the second.
    blend: Option<f64> as "blend",
    {
        group: Group::Blend, label: "Share of the second method", range: Range::between(0.0, 1.0),
        step: Some(0.05), found_by: Some("0"),
        effect: Some(Effect {
            when: |spec| spec.blend_with.is_some(),
            because: "no second method is named (blendWith)",
        }),
    }
}

impl MethodSpec {
    /// The association with its radius, for [`crate::OperatorOptions`].
    pub fn vertex_association(&self) -> VertexAssociation {
        match self.association() {
            Association::Points => VertexAssociation::Points,
            Association::Zones => VertexAssociation::Zones { sigma: self.sigma() },
            Association::Triangles => VertexAssociation::Triangles,
        }
    }

    /// Whether the method, or the second one of a blend, uses the parameters of a group.
    pub(crate) fn uses(&self, group: Group) -> bool {
        let blends = group != Group::Blend && self.method.uses(Group::Blend);
        let second = self.blend_with.filter(|_| blends);
        self.method.uses(group) || second.is_some_and(|second| second.uses(group))
    }

    /// The method of a blend that uses a group, the first one before the second, and its defaults.
    fn defaults(&self, group: Group) -> &'static Defaults {
        let second = self.blend_with.filter(|_| !self.method.uses(group));
        &second.unwrap_or(self.method).definition().defaults
    }

    /// The second method of a blend, with those of the parameters that it uses: where both use one, they share its
    /// value.
    pub fn second(&self) -> Option<MethodSpec> {
        let method = self.blend_with?;
        let mut spec = MethodSpec::new(method);
        let shared = self.resolved();
        let fields = shared
            .fields()
            .filter(|(row, _)| row.about.group != Group::Blend && method.uses(row.about.group));
        for (row, field) in fields {
            if let Some(value) = field.json() {
                spec.read_field(row.key, &value, &mut |_, _| ());
            }
        }
        Some(spec)
    }

    /// Whether the method uses the parameter of a key, and the others leave it an effect.
    pub(crate) fn has_effect(&self, key: &str) -> bool {
        PARAMETERS.iter().any(|row| {
            row.key == key
                && self.uses(row.about.group)
                && row.about.effect.is_none_or(|effect| (effect.when)(self))
        })
    }
}

impl Parameter {
    /// The parameter of a key.
    pub fn of(key: &str) -> Option<&'static Parameter> {
        PARAMETERS.iter().find(|row| row.key == key)
    }

    /// The value that is taken where a method does not say one; `None` where there is none.
    pub fn default_of(&self, method: Method) -> Option<Value> {
        (self.default)(&MethodSpec::new(method))
    }

    /// The methods that use it.
    pub fn methods(&self) -> impl Iterator<Item = Method> {
        let group = self.about.group;
        Method::ALL.into_iter().filter(move |method| method.uses(group))
    }

    /// Its option on the command line, without dashes in front: `soft-bounds`.
    pub fn option(&self) -> String {
        if let Some(option) = self.about.option {
            return option.to_owned();
        }
        let mut option = String::new();
        for letter in self.key.chars() {
            if letter.is_ascii_uppercase() {
                option.push('-');
            }
            option.push(letter.to_ascii_lowercase());
        }
        option
    }

    pub(crate) fn limits(&self) -> Limits {
        let About { range, zero, may_be_a_point, .. } = self.about;
        Limits { range, zero, may_be_a_point }
    }
}
