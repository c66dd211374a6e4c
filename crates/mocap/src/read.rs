//! From a file of any known format to a capture.

use crate::source::{self, Source};
use crate::text::{self, Lines, TextForm};
use crate::{Capture, Format, LengthUnit, ReadError, Recording, WeightTake, c3d, format};
use std::io::{BufRead, Cursor, Seek};
use std::path::Path;

/// What the caller knows better than the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ReadOptions {
    /// Unit of the coordinates. `None`: what the file says, else guessed by magnitude and noted.
    pub unit: Option<LengthUnit>,
    /// Frames a second. `None`: what the file says.
    pub rate_hz: Option<f64>,
}

/// A file of motion capture, opened and its format recognised.
///
/// It is read as a stream: beside what comes out, a buffer of a quarter of a megabyte (or a frame,
/// or a line, where they are longer) is in memory, whatever the file's size.
pub struct CaptureFile<'a> {
    source: Box<dyn Source + 'a>,
    format: Option<Format>,
    /// Encoding and line ends, where it is not C3D.
    form: TextForm,
}

impl CaptureFile<'static> {
    /// Open a file.
    ///
    /// # Errors
    /// [`ReadError::Open`], [`ReadError::Read`].
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        Self::of(source::open(path)?)
    }
}

impl<'a> CaptureFile<'a> {
    /// The bytes of a file.
    ///
    /// # Errors
    /// As [`CaptureFile::of_stream`]; bytes in memory give none.
    pub fn of_bytes(bytes: &'a [u8]) -> Result<Self, ReadError> {
        Self::of_stream(Cursor::new(bytes))
    }

    /// A file behind anything that reads and seeks.
    ///
    /// # Errors
    /// [`ReadError::Read`].
    pub fn of_stream(stream: impl BufRead + Seek + 'a) -> Result<Self, ReadError> {
        Self::of(Box::new(stream))
    }

    fn of(mut source: Box<dyn Source + 'a>) -> Result<Self, ReadError> {
        let c3d = format::is_c3d(&source::beginning(&mut *source, 512)?);
        let form = if c3d { TextForm::default() } else { TextForm::of(&mut *source)? };
        let format = match c3d {
            true => Some(Format::C3d),
            false => format::recognise_text(Lines::new(&mut *source, form)?)?,
        };
        Ok(Self { source, format, form })
    }

    /// Its format; `None` when no reader knows it.
    pub fn format(&self) -> Option<Format> {
        self.format
    }

    /// The capture with everything else that the file says; `options` override the file.
    ///
    /// # Errors
    /// [`ReadError`] with place, value and remedy.
    pub fn recording(&mut self, options: &ReadOptions) -> Result<Recording, ReadError> {
        match self.format {
            Some(Format::C3d) => c3d::read(&mut *self.source, options),
            Some(Format::WideCsv) => text::wide_csv::read(&mut self.lines()?, options),
            Some(Format::LongCsv) => text::long_csv::read(&mut self.lines()?, options),
            Some(Format::Trc) => text::trc::read(&mut self.lines()?, options),
            Some(Format::QtmTsv) => text::qtm_tsv::read(&mut self.lines()?, options),
            Some(Format::MotiveCsv) => text::motive_csv::read(&mut self.lines()?, options),
            Some(Format::ViconCsv) => text::vicon_csv::read(&mut self.lines()?, options),
            Some(Format::Bvh) => text::bvh::read(&mut self.lines()?, options),
            Some(Format::LiveLinkCsv) => {
                let take = text::live_link::read(&mut self.lines()?)?;
                Err(ReadError::WeightsNotMarkers { columns: take.names.len() })
            }
            None => Err(ReadError::Unrecognised { found: self.beginning()? }),
        }
    }

    /// The weights of a performance recorded as such (Live Link Face CSV).
    ///
    /// # Errors
    /// [`ReadError`] with place, value and remedy.
    pub fn weights(&mut self) -> Result<WeightTake, ReadError> {
        match self.format {
            Some(Format::LiveLinkCsv) => text::live_link::read(&mut self.lines()?),
            _ => Err(ReadError::NotWeights { found: self.beginning()? }),
        }
    }

    /// The lines of a text format, from the first on.
    fn lines(&mut self) -> Result<Lines<'_>, ReadError> {
        Lines::new(&mut *self.source, self.form)
    }

    /// The first bytes of the file, fit to print.
    fn beginning(&mut self) -> Result<String, ReadError> {
        let bytes = source::beginning(&mut *self.source, 24)?;
        if bytes.is_empty() {
            return Ok("the file is empty".to_owned());
        }
        let head: String = bytes.iter().flat_map(|b| b.escape_ascii()).map(char::from).collect();
        Ok(format!("it starts with \"{head}\""))
    }
}

impl std::fmt::Debug for CaptureFile<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CaptureFile").field("format", &self.format).finish_non_exhaustive()
    }
}

/// Read a capture file, its format recognised by content.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read(path: &Path) -> Result<Capture, ReadError> {
    CaptureFile::open(path)?.recording(&ReadOptions::default()).map(|recording| recording.capture)
}

/// Read a capture from bytes.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_bytes(bytes: &[u8]) -> Result<Capture, ReadError> {
    read_recording(bytes, &ReadOptions::default()).map(|recording| recording.capture)
}

/// Read a capture from bytes with everything else they say; `options` override them.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_recording(bytes: &[u8], options: &ReadOptions) -> Result<Recording, ReadError> {
    CaptureFile::of_bytes(bytes)?.recording(options)
}

/// Read a performance recorded as weights (Live Link Face CSV) from bytes.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_weights(bytes: &[u8]) -> Result<WeightTake, ReadError> {
    CaptureFile::of_bytes(bytes)?.weights()
}

/// Recognise the format of bytes; `None` when no reader knows it.
pub fn recognise(bytes: &[u8]) -> Option<Format> {
    CaptureFile::of_bytes(bytes).ok()?.format()
}
