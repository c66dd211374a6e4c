//! What the pages say of sound. It goes with the studies that have sound ([`crate::SoundPages`]), so that no other
//! page carries it.

use std::collections::BTreeMap;

use super::primary_language;

/// Name, English, French. The tones' number and the rounds stand for the words in braces.
pub(super) const SOUND: [[&str; 3]; 25] = [
    ["sound_heading", "Sound", "Le son"],
    [
        "sound_text",
        "This study has sound. Put on headphones or switch on your loudspeakers. Play the test sound, and set the volume of your device so that you hear it well and it is pleasant.",
        "Cette étude a du son. Mettez un casque ou allumez vos haut-parleurs. Écoutez le son d’essai et réglez le volume de votre appareil pour bien l’entendre sans gêne.",
    ],
    ["sound_test", "Play the test sound", "Écouter le son d’essai"],
    ["sound_test_again", "Play the test sound again", "Réécouter le son d’essai"],
    ["sound_test_playing", "The test sound is playing.", "Le son d’essai est en cours."],
    ["sound_continue", "I hear it well", "Je l’entends bien"],
    ["sound_round", "Round {round} of {of}", "Écoute {round} sur {of}"],
    [
        "sound_listen",
        "Play the tones and count them. Leave the volume as it is now.",
        "Écoutez les sons et comptez-les. Ne changez plus le volume.",
    ],
    ["sound_tones", "Play the tones", "Écouter les sons"],
    ["sound_tones_again", "Play the tones again", "Réécouter les sons"],
    ["sound_tones_playing", "The tones are playing.", "Les sons sont en cours."],
    [
        "sound_count_now",
        "How many tones were there? Choose a number.",
        "Combien de sons ? Choisissez un nombre.",
    ],
    ["sound_question", "How many tones did you hear?", "Combien de sons avez-vous entendus\u{a0}?"],
    ["sound_next", "Next", "Suivant"],
    ["sound_missing_play", "Please play the tones first.", "Écoutez d’abord les sons."],
    ["sound_missing_answer", "Please choose a number.", "Choisissez un nombre."],
    [
        "sound_again",
        "That was not right. Turn the volume up a little and try once more.",
        "Ce n’était pas le bon compte. Montez un peu le volume et réessayez.",
    ],
    ["sound_none", "I cannot hear the sound", "Je n’entends pas le son"],
    [
        "sound_none_question",
        "Go on without hearing the sound?",
        "Continuer sans entendre le son\u{a0}?",
    ],
    ["sound_none_yes", "Yes, I cannot hear it", "Oui, je ne l’entends pas"],
    ["sound_none_no", "No, back to the test sound", "Non, revenir au son d’essai"],
    [
        "sound_blocked",
        "Your browser did not play the sound. See that the page is not muted, and try again.",
        "Votre navigateur n’a pas joué le son. Vérifiez que la page n’est pas en sourdine et réessayez.",
    ],
    ["sound_captions", "Captions", "Sous-titres"],
    [
        "sound_not_played",
        "The sound of this clip could not be played. See that the page is not muted, and play the clip again.",
        "Le son de cet extrait n’a pas pu être joué. Vérifiez que la page n’est pas en sourdine et relancez l’extrait.",
    ],
    [
        "sound_screened_out",
        "This study is for people who can hear its sound on their device.",
        "Cette étude s’adresse aux personnes qui peuvent en entendre le son sur leur appareil.",
    ],
];

/// What the pages say of sound in a language, by name: the study's own words (`translations`), else French or
/// English.
pub fn sound_words(
    language: &str,
    own: Option<&BTreeMap<String, String>>,
) -> BTreeMap<String, String> {
    row_words(&SOUND, language, own)
}

/// Texts in a language, by name: those of rows of a name, English and French, where the study brings none of its own.
pub(super) fn row_words(
    rows: &[[&str; 3]],
    language: &str,
    own: Option<&BTreeMap<String, String>>,
) -> BTreeMap<String, String> {
    let place = if primary_language(language) == "fr" { 2 } else { 1 };
    let word = |row: &[&str; 3]| {
        let built_in = row[place].to_owned();
        let own = own.and_then(|own| own.get(row[0])).cloned();
        (row[0].to_owned(), own.unwrap_or(built_in))
    };
    rows.iter().map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_languages_have_every_text_and_the_study_may_bring_its_own() {
        let english = sound_words("en", None);
        let french = sound_words("fr-CA", None);
        assert_eq!(english.len(), SOUND.len(), "no name twice");
        for (name, text) in &english {
            assert!(!text.is_empty() && !french[name].is_empty(), "{name}");
        }
        let own = BTreeMap::from([("sound_heading".to_owned(), "Ton".to_owned())]);
        let german = sound_words("de", Some(&own));
        assert_eq!(german["sound_heading"], "Ton");
        assert_eq!(german["sound_next"], "Next");
    }
}
