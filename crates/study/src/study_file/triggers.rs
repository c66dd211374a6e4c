//! What another program on the participant's machine is told while a study runs.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A program on the participant's machine (of an EEG, of an eye tracker) is told by a WebSocket on 127.0.0.1 when clips
/// begin and end, and what is answered. `docs/guide/triggers.md` has the messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct Triggers {
    /// Where that program listens, 1024 to 65535.
    pub port: u32,
    /// Whether it is told of every frame, too.
    #[serde(default)]
    pub frames: bool,
}

impl Triggers {
    /// Ports that a program may listen at without being the machine's administrator.
    pub const PORTS: std::ops::RangeInclusive<u32> = 1024..=65535;

    /// Where the page looks for the program, as a policy of the page names it.
    pub fn origin(&self) -> String {
        format!("ws://127.0.0.1:{}", self.port)
    }
}
