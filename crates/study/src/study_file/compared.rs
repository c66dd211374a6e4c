//! What blocks of pairs and panels compare: the levels of a factor, in every cell of clips that are otherwise alike.

use super::{Clip, ClipSelection};

/// The clips that a block compares. Its items are the levels of the factor `compare`; clips that are alike in what
/// `within` names make a cell, which has a clip of every level.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Compared<'b> {
    /// The factor.
    pub compare: &'b str,
    /// Its levels; empty: all that clips have.
    pub levels: &'b [String],
    /// In what the clips of a cell are alike.
    pub within: &'b [String],
    /// Which clips.
    pub clips: &'b ClipSelection,
}

/// Clips that are alike in what `within` names.
#[derive(Debug, Clone)]
pub(super) struct Cell<'c> {
    /// Levels of `within`.
    pub alike: Vec<Option<String>>,
    /// The clip of each level, in the order of the levels.
    pub clips: Vec<&'c Clip>,
}

/// Why clips make no cells.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NoCells {
    /// Of a cell: no clip has a level.
    #[error("no clip of {cell} has the level {level:?}")]
    LevelMissing {
        /// The cell in words: `segment joy2, avatar head`.
        cell: String,
        /// The level.
        level: String,
    },
    /// Of a cell: two clips have a level.
    #[error("two clips of {cell} have the level {level:?}: {clips:?}")]
    LevelTwice {
        /// The cell in words.
        cell: String,
        /// The level.
        level: String,
        /// Both clips.
        clips: [String; 2],
    },
}

/// A cell in the making.
struct Gathered<'c> {
    alike: Vec<Option<String>>,
    clips: Vec<Option<&'c Clip>>,
}

impl Compared<'_> {
    /// The levels: those of the file, or those of the clips in their order.
    pub fn levels(&self, clips: &[Clip]) -> Vec<String> {
        if !self.levels.is_empty() {
            return self.levels.to_vec();
        }
        let mut levels: Vec<String> = Vec::new();
        let taken = clips.iter().filter(|clip| self.clips.takes(clip));
        for level in taken.filter_map(|clip| clip.factor_text(self.compare)) {
            if !levels.contains(&level) {
                levels.push(level);
            }
        }
        levels
    }

    /// The cells, in the order of the clips; each has a clip of every one of the `levels`.
    ///
    /// # Errors
    /// [`NoCells`].
    pub(super) fn cells<'c>(
        &self,
        clips: &'c [Clip],
        levels: &[String],
    ) -> Result<Vec<Cell<'c>>, NoCells> {
        let mut cells: Vec<Gathered<'c>> = Vec::new();
        for clip in clips.iter().filter(|clip| self.clips.takes(clip)) {
            let Some(item) = clip
                .factor_text(self.compare)
                .and_then(|level| levels.iter().position(|own| *own == level))
            else {
                continue;
            };
            let alike: Vec<_> = self.within.iter().map(|name| clip.factor_text(name)).collect();
            let found = cells.iter().position(|cell| cell.alike == alike);
            let at = found.unwrap_or_else(|| {
                cells.push(Gathered { alike, clips: vec![None; levels.len()] });
                cells.len() - 1
            });
            if let Some(first) = cells[at].clips[item].replace(clip) {
                return Err(NoCells::LevelTwice {
                    cell: self.in_words(&cells[at].alike),
                    level: levels[item].clone(),
                    clips: [first.id.clone(), clip.id.clone()],
                });
            }
        }
        let whole = |cell: Gathered<'c>| {
            let missing = cell.clips.iter().position(Option::is_none);
            match missing {
                Some(item) => Err(NoCells::LevelMissing {
                    cell: self.in_words(&cell.alike),
                    level: levels[item].clone(),
                }),
                None => Ok(Cell {
                    alike: cell.alike,
                    clips: cell.clips.into_iter().flatten().collect(),
                }),
            }
        };
        cells.into_iter().map(whole).collect()
    }

    /// `segment joy2, avatar head`.
    fn in_words(&self, alike: &[Option<String>]) -> String {
        let parts = self.within.iter().zip(alike);
        let parts: Vec<String> =
            parts.filter_map(|(name, level)| Some(format!("{name} {}", level.as_ref()?))).collect();
        if parts.is_empty() { "the block".to_owned() } else { parts.join(", ") }
    }
}

/// The factor that is compared where a block names none.
pub(super) fn method() -> String {
    "method".to_owned()
}

/// In what the clips of a cell are alike where a block says nothing.
pub(super) fn segment_and_avatar() -> Vec<String> {
    vec!["segment".to_owned(), "avatar".to_owned()]
}
