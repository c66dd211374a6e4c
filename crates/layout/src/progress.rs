//! What a long computation tells of itself.

/// Told of stages and steps, perhaps from several threads.
pub trait Progress: Sync {
    /// A stage of so many steps begins; the name is a code.
    fn stage(&self, name: &'static str, steps: u64);

    /// A step is done.
    fn step(&self);
}

/// Tells nobody.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _: &'static str, _: u64) {}

    fn step(&self) {}
}
