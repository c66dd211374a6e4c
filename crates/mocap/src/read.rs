//! From a file of any known format to a capture.

use crate::formats::source::{self, Source};
use crate::formats::text::{Lines, TextForm};
use crate::formats::{Format, Read, Recognise, formats};
use crate::{Capture, LengthUnit, ReadError, Recording, WeightOptions, WeightsTable};
use std::io::{BufRead, Cursor, Seek};
use std::path::{Path, PathBuf};

/// What the caller knows better than the file.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ReadOptions {
    /// Unit of the coordinates. `None`: what the file says, else guessed by magnitude and noted.
    pub unit: Option<LengthUnit>,
    /// Frames per second. `None`: what the file says.
    pub rate_hz: Option<f64>,
}

/// A file of motion capture, opened and its format recognised.
///
/// It is read as a stream: beside what comes out, a buffer of a quarter of a megabyte (or a frame,
/// or a line, where they are longer) is in memory, whatever the file's size.
pub struct CaptureFile<'a> {
    source: Box<dyn Source + 'a>,
    /// Where it was opened; `None` for bytes and streams.
    path: Option<PathBuf>,
    format: Option<&'static Format>,
    /// Encoding and line ends, where it is a text.
    form: TextForm,
}

impl CaptureFile<'static> {
    /// Open a file.
    ///
    /// # Errors
    /// [`ReadError::Open`], [`ReadError::Read`].
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        Ok(Self { path: Some(path.to_owned()), ..Self::of(source::open(path)?)? })
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
        let beginning = source::beginning(&mut *source, 512)?;
        let binary = formats()
            .iter()
            .copied()
            .find(|format| matches!(format.recognise, Recognise::Beginning(is) if is(&beginning)));
        let mut file = Self { source, path: None, format: binary, form: TextForm::default() };
        if binary.is_none() {
            file.form = TextForm::of(&mut *file.source)?;
            file.format = file.recognised_text(|_| true)?;
        }
        Ok(file)
    }

    /// The first text format of those `among` that knows the first line that is neither blank nor
    /// a comment.
    fn recognised_text(
        &mut self,
        among: impl Fn(&Format) -> bool,
    ) -> Result<Option<&'static Format>, ReadError> {
        let mut lines = self.lines()?;
        loop {
            match lines.next_filled() {
                Ok(Some((_, line))) if line.starts_with('#') => {}
                Ok(Some((_, line))) => {
                    return Ok(formats().iter().copied().find(|format| {
                        matches!(format.recognise, Recognise::FirstLine(is) if is(line))
                            && among(format)
                    }));
                }
                // What has no end of a line for megabytes is no text.
                Ok(None) | Err(ReadError::Text { .. }) => return Ok(None),
                Err(error) => return Err(error),
            }
        }
    }

    /// What it is taken for; `None` when no reader knows it.
    pub fn format(&self) -> Option<&'static Format> {
        self.format
    }

    /// The capture with everything else that the file says; `options` override the file.
    ///
    /// # Errors
    /// [`ReadError`] with place, value and remedy.
    pub fn recording(&mut self, options: &ReadOptions) -> Result<Recording, ReadError> {
        match self.format.map(|format| (format, &format.read)) {
            Some((_, Read::Binary(read))) => read(&mut *self.source, options),
            Some((_, Read::Text(read))) => read(&mut self.lines()?, options),
            Some((format, _)) => Err(ReadError::WeightsNotMarkers { format: format.name }),
            None => {
                let (found, readable) = (self.beginning()?, names(|f| !f.holds_weights()));
                Err(ReadError::Unrecognised { found, readable })
            }
        }
    }

    /// The weights of a performance recorded as such. A table whose columns look like coordinates
    /// is read as weights here, too; [`Self::format`] then says so.
    ///
    /// # Errors
    /// [`ReadError`] with place, value and remedy.
    pub fn weights(&mut self, options: &WeightOptions<'_>) -> Result<WeightsTable, ReadError> {
        let format = match self.format {
            Some(Format { read: Read::Text(_), .. }) => {
                self.recognised_text(Format::holds_weights)?
            }
            format => format,
        };
        self.format = format.or(self.format);
        match format.map(|format| &format.read) {
            Some(Read::TextWeights(read)) => read(&mut self.lines()?, options),
            Some(Read::BinaryWeights(read)) => {
                read(&mut *self.source, self.path.as_deref(), options)
            }
            Some(Read::Binary(_) | Read::Text(_)) | None => {
                let (found, readable) = (self.beginning()?, names(Format::holds_weights));
                Err(ReadError::NotWeights { found, readable })
            }
        }
    }

    /// The lines of a text format, from the first on.
    fn lines(&mut self) -> Result<Lines<'_>, ReadError> {
        Lines::new(&mut *self.source, self.form)
    }

    /// The first bytes of the file, fit to print.
    fn beginning(&mut self) -> Result<String, ReadError> {
        source::shown_beginning(&mut *self.source)
    }
}

/// The names of some of the formats.
fn names(among: impl Fn(&Format) -> bool) -> Vec<&'static str> {
    formats().iter().filter(|format| among(format)).map(|format| format.name).collect()
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

/// Read a performance recorded as weights from bytes.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_weights(bytes: &[u8], options: &WeightOptions<'_>) -> Result<WeightsTable, ReadError> {
    CaptureFile::of_bytes(bytes)?.weights(options)
}

/// Read a performance recorded as weights from a file.
///
/// # Errors
/// [`ReadError`] with place, value and remedy.
pub fn read_weights_file(
    path: &Path,
    options: &WeightOptions<'_>,
) -> Result<WeightsTable, ReadError> {
    CaptureFile::open(path)?.weights(options)
}

/// Recognise the format of bytes; `None` when no reader knows it.
pub fn recognise(bytes: &[u8]) -> Option<&'static Format> {
    CaptureFile::of_bytes(bytes).ok()?.format()
}
