//! The cases with answers in `annotation` of the real data (SciPy, scikit-learn, enumeration), at
//! the tolerances that they state.

mod cases;
mod classify;
mod markov;
mod motion;
mod scores;
