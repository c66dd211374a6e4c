//! Files that never change under their address: the pages' own, and the packs of stimuli.

pub(crate) mod assets;
pub(crate) mod compression;
pub(crate) mod folder;
pub(crate) mod packs;
pub(crate) mod static_file;
