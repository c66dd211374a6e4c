//! A block of panels: several clips of a segment on one page, each rated on the same scale (MUSHRA, ITU-R BS.1534-3;
//! HEMVIP, Jonell et al. 2021).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::compared::{Compared, NoCells, method, segment_and_avatar};
use super::json_block::JsonBlock;
use super::{
    Clip, ClipSelection, ClipShowing, Component, LocalText, Study, TimeLimit, TrialsComponent,
};

/// A block of panels. Its conditions are the levels of a factor of the clips; clips that are alike in what `within`
/// names (a cell) stand on one page, at places that are drawn for each page, each with a slider of its own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct PanelComponent {
    /// The factor whose levels are the conditions; `segment` and `avatar` can be named too.
    #[serde(default = "method")]
    pub compare: String,
    /// The conditions, reference and anchor among them, 3 to 12; all that clips have if not given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<String>,
    /// Factors in which the clips of a page are alike.
    #[serde(default = "segment_and_avatar")]
    pub within: Vec<String>,
    /// Which clips; all of them if not given.
    #[serde(default, skip_serializing_if = "ClipSelection::is_everything")]
    pub clips: ClipSelection,
    /// How the clips of a page are shown.
    #[serde(default)]
    pub show: ClipShowing,
    /// Identifier of one of the study's `questions`, of type `slider` from 0 to 100, asked of each clip.
    pub question: String,
    /// The level that is the reference: it stands on the page as such, and once more hidden among the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<String>,
    /// The level that is the anchor: a condition that everybody should find worse.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub anchor: Option<String>,
    /// The rule by which people are left out of the analysis. The report prints it whether or not it is applied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exclude: Option<PanelExclusion>,
    /// A line above the clips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instruction: Option<LocalText>,
    /// Most replays of each clip after the first whole play; without limit if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_replays: Option<u32>,
    /// How long its answers may take, from the end of the first whole play.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_limit: Option<TimeLimit>,
}

/// A rule by which people are left out of the analysis of panels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum PanelExclusion {
    /// ITU-R BS.1534-3, section 4.1.2: who rates the hidden reference below 90, or the anchor above 90, in over 15 %
    /// of the segments.
    Bs1534,
}

/// The pages that a block's trials show, derived from [`PanelComponent`].
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct PanelPages {
    /// The pages, in the order of the clips.
    pub pages: Vec<PanelPage>,
    /// Place of the reference among the clips of each page.
    pub reference: Option<usize>,
    /// Whether the clips are shown one after the other.
    pub in_turn: bool,
}

/// A page of a block of panels.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct PanelPage {
    /// What its clips are alike in: the levels of `within`, joined by |.
    pub cell: String,
    /// Identifiers of its clips, in the order of the conditions.
    pub clips: Vec<String>,
}

/// The block as pages carry it.
pub type PanelBlock = JsonBlock<PanelComponent>;

impl PanelComponent {
    /// Fewest conditions of a panel.
    pub const FEWEST_CONDITIONS: usize = 3;
    /// Most conditions of a panel, as ITU-R BS.1534-3 advises for its signals.
    pub const MOST_CONDITIONS: usize = 12;

    pub(crate) fn compares(&self) -> Compared<'_> {
        let Self { compare, levels, within, clips, .. } = self;
        Compared { compare, levels, within, clips }
    }

    /// The conditions: those of the file, or those of the clips in their order.
    pub fn conditions(&self, clips: &[Clip]) -> Vec<String> {
        self.compares().levels(clips)
    }

    /// The block as the trials that it makes: one a page.
    ///
    /// # Errors
    /// [`NoCells`]: what the check of a study refuses.
    pub fn trials(&self, clips: &[Clip]) -> Result<TrialsComponent, NoCells> {
        let conditions = self.conditions(clips);
        let cells = self.compares().cells(clips, &conditions)?;
        let pages: Vec<PanelPage> = cells
            .iter()
            .map(|cell| PanelPage {
                cell: cell.alike.iter().flatten().cloned().collect::<Vec<_>>().join("|"),
                clips: cell.clips.iter().map(|clip| clip.id.clone()).collect(),
            })
            .collect();
        let ids = pages.iter().flat_map(|page| page.clips.clone()).collect();
        let place = |level: &String| conditions.iter().position(|own| own == level);
        let reference = self.reference.as_ref().and_then(place);
        let in_turn = self.show == ClipShowing::InTurn;
        Ok(TrialsComponent {
            clips: ClipSelection { ids, ..ClipSelection::default() },
            instruction: self.instruction.clone(),
            questions: vec![self.question.clone()],
            maximum_replays: self.maximum_replays,
            repetitions: 1,
            beside: None,
            time_limit: self.time_limit.clone(),
            pairs: None,
            panel: Some(Box::new(PanelPages { pages, reference, in_turn })),
        })
    }
}

/// The name under which a page of a panel keeps the answer to a question about one of its clips. Both parts come back
/// from the page's own list of clips, not from this text.
pub fn answer_about(question: &str, clip: &str) -> String {
    [question, "/", clip].concat()
}

impl Study {
    /// The blocks of panels, by name. What cannot be read is left out: the check reports it.
    pub fn panel_blocks(&self) -> impl Iterator<Item = (&str, PanelComponent)> {
        self.components.iter().filter_map(|(name, component)| match component {
            Component::Panel(block) => Some((name.as_str(), block.read().ok()?)),
            _ => None,
        })
    }
}
