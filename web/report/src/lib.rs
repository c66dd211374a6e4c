//! The report of a study in the browser, for the pages of a capsule (`mimique capsule`): the tidy export, the study file
//! and the table of stimuli in, every table, figure and sentence out. It is the function that `mimique analyze` calls. Every file is the same
//! byte for byte, but for the unrounded numbers of `results.json` and `data/numbers.csv`: exponentials and logarithms are those of
//! the module here and those of the machine's library there, and differ in the last bit.
//!
//! ```js
//! const report = analyze(csv, study, "", stimuli, "index.html", "en");
//! report.file("report.html"); // one of report.files()
//! report.summary();           // {"people": [used, all], "trials": 480, "readings": [["H1", "..."]]}
//! ```

use mimique_analysis::{Report, ReportOptions, ServedVersion, StudyVersions, analyze_with};
use mimique_locale::Language;
use mimique_stats::Table;
use serde_json::json;
use wasm_bindgen::prelude::*;

#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();

/// The module's entry.
#[wasm_bindgen(start)]
pub fn start() {
    mimique_web_panics::report_panics("report", "");
}

/// A report with its files.
#[wasm_bindgen]
#[derive(Debug)]
pub struct WebReport {
    report: Report,
}

/// Computes the report. `published` is the study file that was published, where `study` has other rules, else empty:
/// the report then says what differs. `stimuli` is the table of stimuli, empty where there is none; `preview` the address to which
/// figures lead, empty for none; `language` is `en` or `fr`.
///
/// # Errors
/// Throws an `Error` whose message says what is wrong with export, study or table.
#[wasm_bindgen]
pub fn analyze(
    export: &str,
    study: &str,
    published: &str,
    stimuli: &str,
    preview: &str,
    language: &str,
) -> Result<WebReport, JsError> {
    let ServedVersion { config_hashes, study } = ServedVersion::from_text(study)?;
    let served = match published {
        "" => Vec::new(),
        text => vec![ServedVersion::from_text(text)?],
    };
    let versions = StudyVersions { config_hashes: &config_hashes, served: &served };
    let table = Table::parse(export)?;
    let stimuli = match stimuli {
        "" => None,
        text => Some(Table::parse(text)?),
    };
    let preview = (!preview.is_empty()).then_some(preview);
    let stimuli = stimuli.as_ref();
    let options = ReportOptions { stimuli, preview, versions, ..ReportOptions::default() };
    let language = Language::from_code(language)
        .ok_or_else(|| JsError::new(&format!("{language}: reports are written in en or fr")))?;
    let report = analyze_with(&table, &study, language, options)?;
    Ok(WebReport { report })
}

#[wasm_bindgen]
impl WebReport {
    /// The paths of its files.
    pub fn files(&self) -> Vec<String> {
        self.report.files.iter().map(|file| file.path.clone()).collect()
    }

    /// The text of a file; none where there is no such file.
    pub fn file(&self, path: &str) -> Option<String> {
        self.report.files.iter().find(|file| file.path == path).map(|file| file.text.clone())
    }

    /// JSON: people used and all, trials used, the reading of each hypothesis.
    pub fn summary(&self) -> String {
        let Report { people, trials, readings, .. } = &self.report;
        json!({ "people": [people.0, people.1], "trials": trials, "readings": readings })
            .to_string()
    }
}
