//! Parameters that belong together: a method uses all of a group or none.

/// Parameters that a method uses together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Group {
    /// The thin shell's share against the bounds.
    Balance,
    /// The weight of the priors against the data.
    PriorWeight,
    /// The weight of the soft bounds where nothing else stands beside the data.
    BoundsWeight,
    /// The smoothing of norms.
    Norms,
    /// The sum of the weights beside the data.
    Sparsity,
    /// The second differences of the weights in time.
    Smoothness,
    /// The strengths of Audio2Face-3D.
    Audio2Face,
    /// The unit in which an equation is taken literally.
    LiteralUnit,
    /// The thin shell itself.
    ThinShell,
    /// Where soft bounds begin, and how softly.
    SoftBounds,
    /// Bounds of single shapes.
    Bounds,
    /// The points of the face that a marker moves.
    Association,
    /// A surface that moves without shapes.
    Surface,
    /// A Gaussian process.
    GaussianProcess,
    /// The shapes.
    Shapes,
    /// The markers.
    Markers,
    /// What happens before the solve: the head's pose, and the adaptation of shape.
    FrontEnd,
    /// The frames of a take.
    Frames,
    /// What becomes of the weights over time: every method uses it.
    Timing,
    /// A second method whose weights are mixed in: every method that solves an avatar's shapes with the same
    /// operators uses it.
    Blend,
}

impl Group {
    /// The heading under which its parameters are listed.
    pub fn heading(self) -> &'static str {
        match self {
            Group::Balance
            | Group::PriorWeight
            | Group::BoundsWeight
            | Group::Norms
            | Group::Sparsity
            | Group::Smoothness
            | Group::LiteralUnit => "Energies",
            Group::Audio2Face => "Strengths (a2f)",
            Group::ThinShell => "Thin shell",
            Group::SoftBounds | Group::Bounds => "Bounds",
            Group::Association => "Association of markers (kouadio)",
            Group::Surface => "Surface (thin-shell-surface)",
            Group::GaussianProcess => "Gaussian process (regression)",
            Group::Shapes | Group::Markers => "Shapes and markers",
            Group::FrontEnd => "Front end",
            Group::Frames => "Frames",
            Group::Timing => "Timing",
            Group::Blend => "Blend of two methods",
        }
    }
}
