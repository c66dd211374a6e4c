//! The pictures and sign-language videos that questions and their options show.

use std::collections::BTreeMap;

use super::{LocalText, Study};
use crate::question::{Choice, KindOfQuestion as _, Question};

/// What the key of such a file in a study's clips as the page gets them begins with: it is served like a video.
pub const MEDIA_PREFIX: &str = "media:";

/// The media type of a picture or a video, by the ending of its name; `None` for what browsers do not
/// all show.
pub fn media_type(path: &str) -> Option<&'static str> {
    let (_, ending) = path.rsplit_once('.')?;
    Some(match ending.to_ascii_lowercase().as_str() {
        "mp4" | "m4v" => "video/mp4",
        "webm" => "video/webm",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "webp" => "image/webp",
        "svg" => "image/svg+xml",
        _ => return None,
    })
}

impl Study {
    /// The paths of every picture and sign-language video of its questions, each once.
    pub fn media(&self) -> Vec<&str> {
        fn videos(text: &LocalText) -> Vec<&str> {
            match text {
                LocalText::Plain(path) => vec![path],
                LocalText::Languages(paths) => paths.values().map(String::as_str).collect(),
            }
        }
        let mut paths: BTreeMap<&str, ()> = BTreeMap::new();
        let mut found = |path| {
            paths.insert(path, ());
        };
        for question in self.all_questions() {
            question.video.iter().flat_map(videos).for_each(&mut found);
            for choice in question.choices().into_iter().flatten() {
                choice.video.iter().flat_map(videos).for_each(&mut found);
                choice.image.as_deref().into_iter().for_each(&mut found);
            }
        }
        paths.into_keys().collect()
    }
}

impl Question {
    /// All of it that can have a picture or a sign-language video: options, rows, ends.
    fn choices(&self) -> [&[Choice]; 3] {
        [self.kind.options(), self.kind.rows(), &self.signs]
    }

    /// The option of a comparison (`left`, `same`, `right`) as the study has it.
    pub fn sign(&self, value: &str) -> Option<&Choice> {
        self.signs.iter().find(|sign| sign.value == value)
    }

    /// The paths of the pictures and sign-language videos that it shows in a language.
    pub fn media<'a>(&'a self, language: &'a str) -> Vec<&'a str> {
        let mut paths: Vec<&str> = Vec::new();
        paths.extend(self.video.as_ref().map(|video| video.in_language(language)));
        for choices in self.choices() {
            for choice in choices {
                paths.extend(choice.video.as_ref().map(|video| video.in_language(language)));
                paths.extend(choice.image.as_deref());
            }
        }
        paths
    }
}
