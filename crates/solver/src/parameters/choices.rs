//! The parameters that are one of a few words.

use serde::{Deserialize, Serialize};

/// An enum whose variants have a word each, in JSON and on the command line.
macro_rules! choice {
    (
        $(#[$about:meta])*
        $name:ident {
            $($(#[$of_variant:meta])* $variant:ident = $word:literal,)+
        }
    ) => {
        $(#[$about])*
        #[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum $name {
            $($(#[$of_variant])* #[serde(rename = $word)] $variant,)+
        }

        impl $name {
            /// Every one of them.
            pub const ALL: &'static [$name] = &[$($name::$variant,)+];
            /// Their words, in the same order.
            pub const WORDS: &'static [&'static str] = &[$($word,)+];

            /// Its word.
            pub fn word(self) -> &'static str {
                match self {
                    $($name::$variant => $word,)+
                }
            }
        }
    };
}

choice! {
    /// The weights of the discrete Laplacian (thesis 5.1.2).
    LaplacianKind {
        /// Every edge weighs 1: the default.
        #[default]
        Uniform = "uniform",
        /// Every edge weighs 1 / (number of neighbours): the mean of the neighbours minus the vertex.
        Umbrella = "umbrella",
        /// Cotangent weights clamped to 0..10, each row divided by its sum.
        CotanClamped = "cotan-clamped",
        /// Cotangent weights over mixed Voronoi areas as printed, in millimetres. Ill-conditioned on
        /// real heads: offered for comparison.
        CotanLiteral = "cotan-literal",
    }
}

choice! {
    /// Which vertices of a surface that moves without shapes stay where they are.
    Hold {
        /// Those that no blendshape moves: skull and neck, as in every other method.
        #[default]
        Unmoved = "unmoved",
        /// None, as in the equation: the whole skin follows the markers.
        Nothing = "nothing",
    }
}

choice! {
    /// What tells the shapes that turn the eyes.
    Gaze {
        /// Nothing: markers on the lids move with the lids, not with the eyes. They rest, but for
        /// those that the bounds name.
        #[default]
        Rest = "rest",
        /// The markers, as every other shape: each eye by itself, also outwards from the other.
        Markers = "markers",
        /// The markers, both eyes brought together to one gaze: the mean of their azimuths and elevations,
        /// their vergence not below 0.
        Together = "together",
    }
}

choice! {
    /// What becomes of shapes that the markers do not tell: noise of 1 mm moves their weights from 0 to 1 and
    /// beyond, even if all other weights are known.
    Untold {
        /// They stay at 0, but for those that the bounds name.
        #[default]
        Hold = "hold",
        /// They are solved as all others: what they get is the method's prior.
        Solve = "solve",
    }
}

choice! {
    /// What becomes of a take with frames that are not solved.
    Unsolved {
        /// It is refused, the first of them named.
        #[default]
        Refuse = "refuse",
        /// Their weights are interpolated between the solved frames around them, and each is marked.
        Hold = "hold",
    }
}

choice! {
    /// How a Gaussian process learns.
    Inference {
        /// On a set of basis vectors, frame by frame (Csató & Opper 2002).
        #[default]
        Sparse = "sparse",
        /// On all frames.
        Exact = "exact",
    }
}

choice! {
    /// The unit in which a literal form of the papers measures.
    Unit {
        /// Metres.
        M = "m",
        /// Centimetres.
        Cm = "cm",
        /// Millimetres.
        #[default]
        Mm = "mm",
    }
}

choice! {
    /// Which points of the face a marker moves (Kouadio 1997, 4.3.1).
    Association {
        /// Its own alone, eq. 4.3.
        Points = "points",
        /// All within sigma, by a Gaussian of their distance, eq. 4.4-4.7.
        #[default]
        Zones = "zones",
        /// Those over the triangles between it and its neighbours, eq. 4.8-4.11.
        Triangles = "triangles",
    }
}

impl Unit {
    /// How many of this unit make a metre.
    pub fn per_metre(self) -> f64 {
        match self {
            Unit::M => 1.0,
            Unit::Cm => 100.0,
            Unit::Mm => 1000.0,
        }
    }
}
