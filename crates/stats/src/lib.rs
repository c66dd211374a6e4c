//! Statistical tests, tables, figures and the report of a perceptual study.
