//! What `mimique new` asks where no design is named: a question a line, the answers from any reader; an empty answer
//! takes what stands in brackets.

use std::io::{BufRead, Write};
use std::path::PathBuf;
use std::str::FromStr;

use mimique_new_study::{designs, instruments};

use super::{Args, Cut};
use crate::asker::Asker;
use crate::solve::Span;

/// Asks for what the options leave open.
pub(super) fn ask(
    args: &mut Args,
    input: &mut impl BufRead,
    out: &mut impl Write,
) -> anyhow::Result<()> {
    let mut asker = Asker { input, out, command: "mimique new" };
    let designs = designs()?;
    for (number, (name, about)) in designs.iter().enumerate() {
        writeln!(asker.out, "  {}  {name}: {about}", number + 1)?;
    }
    args.design = Some(asker.until("Design, by number or name", |answer| {
        let by_number = answer.parse::<usize>().ok().and_then(|n| designs.get(n.checked_sub(1)?));
        let found = by_number.or_else(|| designs.iter().find(|(name, _)| *name == answer));
        found.map(|(name, _)| (*name).to_owned()).ok_or_else(|| "none of these".to_owned())
    })?);
    if args.title.is_none() {
        args.title = asker.optional("Title that participants see [the design's]")?;
    }
    if args.languages.is_empty() {
        args.languages = asker.list("Languages, as en,fr [en]")?;
    }
    if args.instruments.is_empty() {
        for own in instruments()? {
            writeln!(asker.out, "  {}: {}", own.id, own.name)?;
        }
        args.instruments = asker.list("Instruments, with commas [none]")?;
    }
    if args.avatar.is_none() {
        args.avatar = asker.optional("File of the avatar [the built-in head]")?.map(PathBuf::from);
    }
    if args.avatar.is_some() {
        capture(args, &mut asker)?;
    }
    Ok(())
}

/// What an avatar of a file needs.
fn capture<R: BufRead, W: Write>(
    args: &mut Args,
    asker: &mut Asker<'_, R, W>,
) -> anyhow::Result<()> {
    if args.capture.is_none() {
        args.capture = Some(asker.until("File of the capture", |answer| match answer {
            "" => Err("an avatar of a file needs a capture".to_owned()),
            path => Ok(PathBuf::from(path)),
        })?);
    }
    if args.map.is_none() {
        args.map = asker.optional("Marker map [suggest one]")?.map(PathBuf::from);
    }
    if args.head.is_empty() {
        args.head = asker.list("Labels of the head's markers, with commas [the map's]")?;
    }
    if args.neutral.is_none() {
        args.neutral = asker.until(
            "Frames of the neutral face, as 0:60 [the map's]",
            |answer| match answer {
                "" => Ok(None),
                frames => Span::from_str(frames).map(Some),
            },
        )?;
    }
    while args.segments.is_none() {
        let answer = asker.until(
            "Clips, one after the other, as 330:570:jaw-open, or a file of segments [no more]",
            |answer| match (answer, answer.matches(':').count()) {
                ("", _) => Ok(None),
                (path, 0) => Ok(Some(Err(PathBuf::from(path)))),
                (cut, _) => Cut::from_str(cut).map(|cut| Some(Ok(cut))),
            },
        )?;
        match answer {
            None => break,
            Some(Ok(cut)) => args.cuts.push(cut),
            Some(Err(path)) => args.segments = Some(path),
        }
    }
    Ok(())
}
