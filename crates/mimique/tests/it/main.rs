//! The integration tests of `mimique`, in one binary.

mod annotate;
mod arena;
mod capsule;
mod captures;
mod check_files;
mod commands;
mod deployment;
mod deposit;
mod deposit_upload;
mod doors;
mod exertion;
mod exertion_refusals;
mod exertion_study;
mod guide;
mod keeping;
mod layout;
mod new;
mod report;
mod simulate_power;
mod statistics_refusals;
mod support;
mod verify;
mod words;
