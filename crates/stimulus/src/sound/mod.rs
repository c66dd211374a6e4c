//! Files of sound: bytes in, format, duration and channels out. What a file is, its content says and not its name.

use std::io::Cursor;
use std::time::Duration;

use lofty::config::ParseOptions;
use lofty::file::{AudioFile, FileType};
use lofty::iff::wav::{WavFile, WavFormat};
use lofty::mpeg::{Layer, MpegFile};
use lofty::ogg::OpusFile;
use lofty::probe::Probe;

/// What browsers decode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SoundFormat {
    /// RIFF WAVE, PCM or floating point.
    Wav,
    /// MPEG audio, layer 3.
    Mp3,
    /// Opus in Ogg.
    OggOpus,
}

impl SoundFormat {
    /// The media type.
    pub fn media_type(self) -> &'static str {
        match self {
            Self::Wav => "audio/wav",
            Self::Mp3 => "audio/mpeg",
            Self::OggOpus => "audio/ogg",
        }
    }

    /// Its name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wav => "WAV",
            Self::Mp3 => "MP3",
            Self::OggOpus => "Ogg Opus",
        }
    }
}

/// A packet of Opus, of one byte at least, lasts this long at most, seconds (RFC 6716, section 3.2.5).
const LONGEST_PACKET_S: f64 = 0.12;

/// What a file of sound holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoundFacts {
    /// Its format.
    pub format: SoundFormat,
    /// How long it lasts, seconds. Of an MP3 with a variable rate and no header that says it, an estimate.
    pub duration_s: f64,
    /// Samples per second, Hz.
    pub sample_rate_hz: u32,
    /// Channels.
    pub channels: u8,
}

/// A file of sound cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SoundError {
    /// It is none of the formats.
    #[error("neither WAV, MP3 nor Ogg Opus; export the sound anew as one of them")]
    Unknown,
    /// It is one of them, and damaged or empty.
    #[error("cannot be read ({what}); see that the file is whole, or export the sound anew")]
    Damaged {
        /// What is wrong.
        what: String,
    },
}

impl SoundError {
    fn damaged(what: impl std::fmt::Display) -> Self {
        Self::Damaged { what: what.to_string() }
    }
}

/// Reads what a file of sound holds; its samples are left to browsers.
///
/// ```
/// use mimique_stimulus::{SoundFormat, read_sound};
///
/// // A quarter of a second of silence: 8-bit PCM, one channel, 8000 Hz.
/// let mut wav = b"RIFF\xf4\x07\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0\x40\x1f\0\0\x40\x1f\0\0\x01\0\x08\0data\xd0\x07\0\0".to_vec();
/// wav.resize(wav.len() + 2000, 128);
/// let facts = read_sound(&wav)?;
/// assert_eq!((facts.format, facts.channels), (SoundFormat::Wav, 1));
/// assert!((facts.duration_s - 0.25).abs() < 1e-3);
/// # Ok::<(), mimique_stimulus::SoundError>(())
/// ```
///
/// # Errors
/// [`SoundError`]: another format, a coding that browsers do not decode, a damaged or empty file.
pub fn read_sound(bytes: &[u8]) -> Result<SoundFacts, SoundError> {
    let probe = Probe::new(Cursor::new(bytes)).guess_file_type().map_err(SoundError::damaged)?;
    let options = ParseOptions::new().read_tags(false).read_cover_art(false);
    let mut file = Cursor::new(bytes);
    let (format, duration, sample_rate_hz, channels) = match probe.file_type() {
        Some(FileType::Wav) => {
            let wav = WavFile::read_from(&mut file, options).map_err(SoundError::damaged)?;
            let facts = wav.properties();
            if let WavFormat::Other(code) = facts.format() {
                return Err(SoundError::damaged(format_args!(
                    "coded as WAV format {code}, which browsers do not decode: PCM is needed"
                )));
            }
            (SoundFormat::Wav, facts.duration(), facts.sample_rate(), facts.channels())
        }
        Some(FileType::Mpeg) => {
            let mp3 = MpegFile::read_from(&mut file, options).map_err(SoundError::damaged)?;
            let facts = mp3.properties();
            if *facts.layer() != Layer::Layer3 {
                return Err(SoundError::Unknown);
            }
            (SoundFormat::Mp3, facts.duration(), facts.sample_rate(), facts.channels())
        }
        Some(FileType::Opus) => {
            let opus = OpusFile::read_from(&mut file, options).map_err(SoundError::damaged)?;
            let facts = opus.properties();
            if facts.duration().as_secs_f64() > LONGEST_PACKET_S * bytes.len() as f64 {
                return Err(SoundError::damaged("it would last longer than its bytes can"));
            }
            // Opus is decoded at 48 kHz, whatever it was made of (RFC 7845, section 5.1).
            (SoundFormat::OggOpus, facts.duration(), 48_000, facts.channels())
        }
        _ => return Err(SoundError::Unknown),
    };
    if duration == Duration::ZERO || sample_rate_hz == 0 || channels == 0 {
        return Err(SoundError::damaged("it holds no sound"));
    }
    Ok(SoundFacts { format, duration_s: duration.as_secs_f64(), sample_rate_hz, channels })
}
