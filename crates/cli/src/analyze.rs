//! `mimique analyze`.

/// Options.
#[derive(clap::Args)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args, _json: bool) -> anyhow::Result<()> {
    anyhow::bail!("this command is being written")
}
