//! The contact sheet of the built-in head: neutral and six emotions at three intensities, from the
//! front and three-quarter. `emotions OUT.png [CELL]`, with the cell's side in pixels (default 160).

#[path = "../tests/it/support/sheet.rs"]
mod sheet;

use mimique_stage::offscreen::Offscreen;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let out = arguments.first().ok_or("usage: emotions OUT.png [CELL]")?;
    let cell = arguments.get(1).map_or(Ok(160), |text| text.parse())?;
    let stage = Offscreen::new(true)?;
    let picture = sheet::emotions(&stage, cell)?;
    std::fs::write(out, picture.png())?;
    Ok(())
}
