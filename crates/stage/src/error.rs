//! What can go wrong between an avatar and a picture of it.

/// An avatar that the stage cannot draw, or a machine that cannot draw at all.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StageError {
    /// No mesh has a triangle.
    #[error("avatar, meshes: no triangle to draw; export at least one mesh with faces")]
    NothingToDraw,
    /// More blendshapes than the weights' uniform array holds.
    #[error(
        "avatar, blendshapes: {found} of them, at most {most} can be drawn; remove unused shapes"
    )]
    TooManyShapes {
        /// Blendshapes of the avatar.
        found: usize,
        /// What the stage can hold.
        most: usize,
    },
    /// A texture that is damaged.
    #[error("avatar, texture {index}: {what}")]
    Texture {
        /// Index in the avatar.
        index: usize,
        /// Why it cannot be decoded, and what to do.
        what: String,
    },
    /// More eyeballs than the pose's uniform array holds.
    #[error(
        "avatar, eyeballs: {found} of them, at most {most} can be drawn; join the others to the skin"
    )]
    TooManyEyeballs {
        /// Eyeballs of the avatar.
        found: usize,
        /// What the stage can hold.
        most: usize,
    },
    /// A table would not fit into a texture of this machine.
    #[error(
        "avatar, {table}: {found} entries, at most {most} fit on this machine; reduce the mesh"
    )]
    TooLarge {
        /// Which table.
        table: &'static str,
        /// Entries of the avatar.
        found: usize,
        /// What fits.
        most: usize,
    },
    /// An index points outside its mesh, or a list has the wrong length.
    #[error("avatar, mesh {mesh}: {what}; re-export the file")]
    Malformed {
        /// Name of the mesh.
        mesh: String,
        /// What is wrong, with the value.
        what: String,
    },
    /// No graphics adapter, or it refused a device.
    #[error(
        "graphics adapter: {what}; install a Vulkan driver (mesa-vulkan-drivers draws without a graphics card)"
    )]
    NoAdapter {
        /// The driver's words.
        what: String,
    },
    /// The device stopped answering while a picture was read back.
    #[error("graphics adapter: {what}; try again with a smaller picture")]
    Readback {
        /// The driver's words.
        what: String,
    },
}
