//! `FORMATS.md` of a capsule: what each file is and how it is read without the program.

use std::fmt::Write as _;

use mimique_session::rows::{Column, TidyForm};
use mimique_study::columns::EXCLUSION_COLUMNS;

/// The code that writes and reads the packs: the exact description of their bytes.
pub const SOURCES: [(&str, &str); 16] = [
    ("avatar/bytes.rs", include_str!("../../../avatar/src/pack/bytes.rs")),
    ("avatar/connectivity.rs", include_str!("../../../avatar/src/pack/connectivity.rs")),
    ("avatar/entropy.rs", include_str!("../../../avatar/src/pack/entropy.rs")),
    ("avatar/envelope.rs", include_str!("../../../avatar/src/pack/envelope.rs")),
    ("avatar/mirror.rs", include_str!("../../../avatar/src/pack/mirror.rs")),
    ("avatar/mod.rs", include_str!("../../../avatar/src/pack/mod.rs")),
    ("avatar/predict.rs", include_str!("../../../avatar/src/pack/predict.rs")),
    ("avatar/shapes.rs", include_str!("../../../avatar/src/pack/shapes.rs")),
    ("avatar/steps.rs", include_str!("../../../avatar/src/pack/steps.rs")),
    ("avatar/surface.rs", include_str!("../../../avatar/src/pack/surface.rs")),
    ("avatar/values.rs", include_str!("../../../avatar/src/pack/values.rs")),
    ("clip/mod.rs", include_str!("../../../clip/src/packs/mod.rs")),
    ("clip/operators.rs", include_str!("../../../clip/src/packs/operators.rs")),
    ("clip/take.rs", include_str!("../../../clip/src/packs/take.rs")),
    ("clip/tracks.rs", include_str!("../../../clip/src/packs/tracks.rs")),
    ("solver/weights_hash.rs", include_str!("../../../solver/src/weights_hash.rs")),
];

/// The page; `columns` are those that `responses.csv` has.
pub fn page(form: &TidyForm, columns: &[String]) -> String {
    let mut text = format!("{}\n## Columns of data/responses.csv\n\n", PAGE.trim_start());
    text.push_str("| column | kind | unit | what |\n|---|---|---|---|\n");
    for name in columns {
        let known = form.columns().iter().find(|column| column.name == *name);
        let (kind, unit, what) = match known {
            Some(Column { kind, unit, description, .. }) => {
                let kind = serde_json::json!(kind);
                (
                    kind.as_str().unwrap_or_default().to_owned(),
                    unit.clone().unwrap_or_default(),
                    description.clone(),
                )
            }
            None => {
                let of_exclusion = EXCLUSION_COLUMNS.iter().position(|own| own == name);
                let what = match of_exclusion {
                    Some(0) => {
                        "Whether the researcher excluded the participant; every answer is kept"
                    }
                    Some(_) => "Why the researcher excluded the participant",
                    None => "Of another version of the study",
                };
                (String::new(), String::new(), what.to_owned())
            }
        };
        // Writing to a String cannot fail.
        let _ = writeln!(text, "| `{name}` | {kind} | {unit} | {} |", what.replace('|', "\\|"));
    }
    text
}

const PAGE: &str = r#"
# The files of this capsule

Every text is UTF-8. CSV files are those of RFC 4180: commas, the first line has the names of the columns. JSON is that
of RFC 8259. Numbers are decimal with a point. Nothing here needs a network.

| file | what |
|---|---|
| `index.html` | the reader: report, trials, clips drawn again, statistics under other rules; open it in a browser |
| `take-part.html` | the study's page as participants had it; keeps and sends nothing |
| `FORMATS.md` | this page |
| `study.json` | the study file: clips, questions, order, hypotheses, rules of exclusion; without its `recruitment`, whose codes are secret |
| `data/responses.csv` | the answers: one row per participant, trial and response; its columns are below |
| `data/stimuli.csv` | a row per clip: its factors, and what was measured of it |
| `data/weights/CLIP.csv` | the weights of a clip: a row per frame, its time in seconds, the weight of each shape of the avatar, every digit of a double |
| `report/` | the report as it was published: `report.html`, `report.md`, tables as CSV and LaTeX, figures as SVG, `results.json`, scripts for R and Python |
| `files/NAME.js` | what the pages' scripts read, see below |
| `assets/HASH/` | styles, and the scripts that pages load as they are |
| `formats/` | the code (Rust) that writes and reads packs |

## files/NAME.js

A browser lets no page on the disk read a file, so each file that the pages need stands in a script that holds one call:

    capsule.text("NAME", "MEDIA TYPE", "TEXT");     the text as a JSON string
    capsule.bytes("NAME", "MEDIA TYPE", "BASE64");  the bytes: gzip (RFC 1952), then base64 (RFC 4648)

To have a file back, take the third argument as JSON; of `capsule.bytes` decode base64 and gunzip.

| name | what |
|---|---|
| `site.json` | study and clips as the page has them: `bundle.clips.CLIP` has the hashes of its packs, its method, `weights_hash` |
| `packs/SHA256` | a pack, or a file of sound, picture or video; its name is the SHA-256 of its bytes |
| `plays/PARTICIPANT.json` | what that person was shown: `pages.STEP.plays` has each play of a trial |
| `trials.json`, `summary.json`, `report.html`, `responses.csv`, `stimuli.csv`, `study.json` | what the reader lists; the last four are the same as the files of that name |
| `assets/HASH/...` | modules of the pages: JavaScript, and WebAssembly (`*_bg.wasm`) |

## A play

`clips`: what was shown, each with `weightsHash`, the SHA-256 of its weights (all weights of a frame, frame after frame, as
little-endian doubles) as that person's browser solved them. `frames`: a list of `[shown, clip, late]`: when the frame was
presented (ms after the first), at which time of the clip it was drawn (ms; weights between two frames are interpolated
linearly), and 1 if it came late: until then the frame before it stood. `late`: how many; `longestMs`: the longest time
between two frames; `refreshHz`: the display's rate; `size`: width and height of the canvas, CSS pixels; `renderer`: hash of
the program's files that drew it; `aborted`: why the play ended early, else null; `inTurn`: whether several clips were played
one after the other.

## Packs

Little-endian. Each opens with four letters, a version (u32) and the length of its body (u32).

| pack | letters | holds |
|---|---|---|
| avatar | `MMAV` | meshes, parts, colours, displacements of each shape, eyeballs, names of shapes; integers range-coded against a prediction; behind the body JPEG textures, their lengths (u32 each), their number (u32) |
| operators | `MMOP` | what the solver needs of avatar and marker map: options, names, D, H as doubles; the body is deflated (zlib, RFC 1950) |
| take | `MMTK` | the markers of a segment in steps of 0.01 to 0.05 mm, or recorded weights |

`formats/` has the code that writes and reads them, which is their exact description. Who only wants to know what was shown
needs none of it: `data/weights` has the weights as numbers.
"#;
