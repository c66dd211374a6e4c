//! The integration tests of `mimique-study`, in one binary.

mod answers;
mod between;
mod check_at_once;
mod check_codes;
mod check_report;
mod golden_orders;
mod method_levels;
mod order_balance;
mod order_decided;
mod order_draws;
mod pair_blocks;
mod pairs;
mod panel_blocks;
mod support;
