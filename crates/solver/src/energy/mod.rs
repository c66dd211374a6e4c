//! The thin shell, and the operators that a frame needs of a mesh.

pub(crate) mod operators;
pub(crate) mod sensitivity;
pub(crate) mod shell_patch;
pub(crate) mod thin_shell;
