//! A bar for what takes some seconds.

use std::io::IsTerminal as _;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use mimique_layout::Progress;

/// A bar on stderr, where somebody looks at it.
pub(super) struct Bar(ProgressBar);

impl Bar {
    pub(super) fn new() -> Self {
        if !std::io::stderr().is_terminal() {
            return Self(ProgressBar::hidden());
        }
        let bar = ProgressBar::new(1);
        let style = "{msg:>22} {bar:40} {human_pos} of {human_len}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    pub(super) fn done(&self) {
        self.0.finish_and_clear();
    }
}

impl Progress for Bar {
    fn stage(&self, name: &'static str, steps: u64) {
        let words = match name {
            "begin" => "layouts to begin with",
            "rehearse" => "rehearsing",
            "reduce" => "thinning",
            "layouts" => "layouts of the curves",
            "layouts-as-thesis" => "layouts as in the thesis",
            "judge" => "judging",
            "judge-as-thesis" => "judging as in the thesis",
            other => other,
        };
        self.0.reset();
        self.0.set_length(steps);
        self.0.set_message(words);
    }

    fn step(&self) {
        self.0.inc(1);
    }
}
