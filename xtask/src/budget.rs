//! How large the pages may be: a build that outgrows these budgets fails `cargo xtask test`. Raise a
//! budget only with a reason, and never silently.

use anyhow::{Context as _, Result, bail};

use crate::packed;
use crate::process::say;
use crate::web::dist;

/// What is downloaded together.
struct Budget {
    name: &'static str,
    files: &'static [&'static str],
    /// Most kilobytes (1000 bytes), gzipped as the server has it embedded.
    kilobytes: f64,
}

const BUDGETS: [Budget; 4] = [
    Budget {
        name: "the page with its first question",
        files: &[
            "participant/index.html",
            "style/style.css",
            "participant/boot.js",
            "participant/bridge.js",
            "panics.js",
            "app.js",
            "app_bg.wasm",
        ],
        // The goal is 220. serde's readers of the study's projection and of events are what stands between;
        // docs/measured/page-speed.md says what the goal would cost. 12 of them are the reasons of failures in
        // both languages, what happens before the session, and what is said when the first page does not come.
        // 5 are adaptive blocks: the events of their levels, trials whose clips follow from answers, and what asks
        // the module that chooses (not counted here: studies with such a block alone load it).
        // 4 are blocks of pairs (the reader of the dealt pairs, whose turn it is to be shown them, clips in turn) and
        // what is told to another program on the machine. 22 are panels (their pages in the projection, a canvas, a
        // question and a button for each clip, replays of one alone) and what is answered while a clip plays (keys,
        // lines, and who reads and checks them). 10 are active pairs (their batches in events and record), faces that are
        // drawn for one trial, and which levels a judgement of differences shows. 2 are where the measured face of a
        // participant passes: its page, its log, and what asks the scripts (studies that measure faces alone load them). 1 is
        // what static hosts are posted as it comes, and the runs of JATOS. 2 are the solver's features that one compilation for
        // all modules brings along (`web/unified`); brotli at its best quality saves 35 at the same time. 1 is every outcome
        // that a page around the study hears of, and smaller requests for proxies that limit them.
        kilobytes: 384.0,
    },
    Budget {
        name: "the solver and the scripts of the stage",
        files: &[
            "stage/host.js",
            "stage/solver-worker.js",
            "stage/inflated.js",
            "solver.js",
            "solver_bg.wasm",
        ],
        // The goal is 110. The decompositions of nalgebra (29), the words and places of panics, serde's reader
        // of a method and the printing of numbers are what stands between; docs/measured/page-speed.md has
        // the parts. 10 are the baselines of other groups (a2f, sparse, smooth-sparse, greedy),
        // 2 patterns of names, 4 the one gaze of both eyes and the names that other programs give to shapes, 3 the low-pass
        // and the delay of weights, 4 blends of two methods and clips in turn, each by its own clock.
        kilobytes: 205.0,
    },
    Budget {
        name: "the WebGPU canvas",
        files: &["stage_webgpu.js", "stage_webgpu_bg.wasm"],
        kilobytes: 110.0,
    },
    Budget {
        name: "the WebGL2 canvas",
        files: &["stage_webgl.js", "stage_webgl_bg.wasm"],
        // Its shaders are parsed when it is built (`crates/stage/build.rs`): 85 less than with a parser of WGSL.
        kilobytes: 640.0,
    },
];

/// Weighs what was built; an error names every group that is too large, or a file that a page or a script
/// asks for and that is not there.
pub fn check() -> Result<()> {
    for page in ["participant/index.html", "participant/site.html"] {
        let text = std::fs::read_to_string(dist().join(page)).with_context(|| page.to_owned())?;
        for asked in text.split("{{assets}}/").skip(1) {
            let name = asked.split('"').next().unwrap_or_default();
            anyhow::ensure!(
                dist().join(name).is_file(),
                "{page} asks for {name}, which is not built"
            );
        }
    }
    for entry in std::fs::read_dir(dist())? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if !name.ends_with(".js") {
            continue;
        }
        let text = std::fs::read_to_string(dist().join(&name)).with_context(|| name.clone())?;
        for asked in text.split("\"./").skip(1).filter_map(|rest| rest.split('"').next()) {
            // `NAME_bg.js` is what a module calls its imports; there is no such file.
            let is_script = asked.ends_with(".js") && !asked.ends_with("_bg.js");
            anyhow::ensure!(
                !is_script || dist().join(asked).is_file(),
                "{name} asks for {asked}, which is not built"
            );
        }
    }
    let mut over = Vec::new();
    for budget in &BUDGETS {
        let mut bytes = 0;
        for name in budget.files {
            bytes += gzipped(name)?;
        }
        let kilobytes = bytes as f64 / 1000.0;
        let line =
            format!("{}: {kilobytes:.0} KB gzipped (budget {:.0})", budget.name, budget.kilobytes);
        say(&line);
        if kilobytes > budget.kilobytes {
            over.push(line);
        }
    }
    if !over.is_empty() {
        bail!("pages outgrow their budget; make them smaller: {}", over.join("; "));
    }
    Ok(())
}

fn gzipped(name: &str) -> Result<usize> {
    let path = dist().join(name);
    let bytes = std::fs::read(&path).with_context(|| path.display().to_string())?;
    Ok(packed::pack(name, &bytes)?.gzip)
}
