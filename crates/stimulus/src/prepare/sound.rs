//! What is heard with a clip: the file, kept as a pack, and where in it the clip's first frame is.

use mimique_clip::sha256_hex;
use mimique_study::{Clip, ClipSound, ClipSource, HeardSound, SoundPlace, Study};

use super::cache::Cache;
use super::sources::Sources;
use super::{Places, PrepareError};
use crate::provenance::Provenance;
use crate::sound::{SoundError, SoundFacts, read_sound};

/// A file of sound that a study names.
#[derive(Debug, Clone, PartialEq)]
pub struct StudySound {
    /// JSON pointer of the file in the study file.
    pub pointer: String,
    /// The file as the study names it.
    pub file: String,
    /// Where in the file the first frame of the segment, or of its capture, is, seconds.
    pub from_s: f64,
    /// What it holds.
    pub facts: Result<SoundFacts, SoundError>,
}

/// The files of sound that the clips of a study are played with, each once. Files that cannot be opened are left
/// out: [`super::prepare`] names what is wrong with them.
pub fn study_sounds(study: &Study, places: &Places) -> Vec<StudySound> {
    let sources = Sources::new(study, places);
    let mut found: Vec<StudySound> = Vec::new();
    for heard in study.sounds() {
        let pointer = heard.place.pointer();
        if found.iter().any(|known| known.pointer == format!("{pointer}/file")) {
            continue;
        }
        let HeardSound { file, from_s, .. } = heard;
        if let Ok((_, bytes)) = sources.read(file, &pointer) {
            let (pointer, file) = (format!("{pointer}/file"), file.to_owned());
            found.push(StudySound { pointer, file, from_s, facts: read_sound(&bytes) });
        }
    }
    found
}

/// Adds what is heard to a clip that is prepared. Clips without sound stay as they are.
pub(super) fn with_sound(
    study: &Study,
    clip: &Clip,
    sources: &Sources<'_>,
    cache: &Cache,
    source: ClipSource,
) -> Result<ClipSource, PrepareError> {
    let Some(heard) = study.heard(clip) else { return Ok(source) };
    let pointer = heard.place.pointer();
    let (path, bytes) = sources.read(heard.file, &format!("{pointer}/file"))?;
    let facts = read_sound(&bytes).map_err(|error| {
        PrepareError::new(format!("{pointer}/file"), format!("{}: {error}", path.display()))
    })?;
    // The sound of a capture goes on with the next segment.
    let (first_s, length_s) = match heard.place {
        SoundPlace::Segment(_) => (0.0, None),
        SoundPlace::Capture(_) => {
            let (first_s, length_s) = sources.segment_time(&heard.segment.id, clip)?;
            (first_s, Some(length_s))
        }
    };
    let from_s = heard.from_s + first_s;
    if from_s >= facts.duration_s {
        let message = format!(
            "{}: segment {:?} begins at {from_s:.3} s, and the sound lasts {:.3} s; correct fromS",
            path.display(),
            heard.segment.id,
            facts.duration_s
        );
        return Err(PrepareError::new(format!("{pointer}/fromS"), message));
    }
    let captions = heard.segment.sound.as_ref().map_or_else(Vec::new, |own| own.captions.clone());
    let (file, size) = (sha256_hex(&bytes), bytes.len() as u64);
    cache.store(bytes)?;
    let provenance = Provenance::default()
        .json("clip", source.provenance.as_str())
        .json("sound", file.as_str())
        .json("fromS", from_s)
        .json("lengthS", length_s)
        .json("delayMs", heard.delay_ms);
    let sound = ClipSound {
        file,
        media_type: facts.format.media_type().to_owned(),
        duration_s: facts.duration_s,
        from_s,
        length_s,
        delay_ms: heard.delay_ms,
        captions,
    };
    Ok(ClipSource {
        bytes: source.bytes + size,
        provenance: provenance.hash(),
        sound: Some(sound),
        ..source
    })
}
