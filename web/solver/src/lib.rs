//! The solver's worker: operators and a take in, weights out.
