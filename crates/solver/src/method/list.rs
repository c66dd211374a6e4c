//! The list of the methods, in the order in which they are shown: a line each. From it follow the enum
//! [`super::names::Method`] and what [`super::registry`] finds.

/// Hands the list to another macro: variant, name, and where the method is defined.
macro_rules! every_method {
    ($receiver:ident) => {
        $receiver! {
            Lsts "lsts" lsts::LSTS
            LstsSoft "lsts-soft" lsts_soft::LSTS_SOFT
            LstsNorm "lsts-norm" lsts_norm::LSTS_NORM
            LstsShort "lsts-short" lsts_norm::LSTS_SHORT
            ThesisLiteral "thesis-literal" literal::THESIS_LITERAL
            ShortLiteral "short-literal" literal::SHORT_LITERAL
            BoundsOnly "bounds-only" lsts_soft::BOUNDS_ONLY
            ThinShellOnly "thin-shell-only" lsts::THIN_SHELL_ONLY
            Ridge "ridge" ridge::RIDGE
            A2f "a2f" a2f::A2F
            A2fBalanced "a2f-balanced" a2f::A2F_BALANCED
            Sparse "sparse" sparse::SPARSE
            SmoothSparse "smooth-sparse" smooth_sparse::SMOOTH_SPARSE
            Greedy "greedy" greedy::GREEDY
            Box "box" least_squares::BOX
            Nnls "nnls" least_squares::NNLS
            PseudoInverse "pseudo-inverse" least_squares::PSEUDO_INVERSE
            Kouadio "kouadio" kouadio::KOUADIO
            ThinShellSurface "thin-shell-surface" thin_shell_surface::THIN_SHELL_SURFACE
            Regression "regression" regression::REGRESSION
            Recorded "recorded" recorded::RECORDED
        }
    };
}
