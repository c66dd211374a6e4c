//! What the pages say where the participant's own face is measured. It goes with the studies that do so
//! ([`crate::MimicryPages`]), so that no other page carries it.

use std::collections::BTreeMap;

use super::sound::row_words;

/// Name, English, French. The pictures per second stand for the word in braces.
pub(super) const MIMICRY: [[&str; 3]; 24] = [
    [
        "mimicry_sent_heading",
        "What is sent, and what is not",
        "Ce qui est envoyé, et ce qui ne l’est pas",
    ],
    [
        "mimicry_sent",
        "While a clip plays, this page measures your face in your own browser, up to {rate} times per second: 52 numbers, which say how far movements such as opening the jaw or raising a brow are made, and when. These numbers are sent to the researchers and kept with your answers.",
        "Pendant un extrait, cette page mesure votre visage dans votre propre navigateur, jusqu’à {rate} fois par seconde : 52 nombres, qui disent à quel point des mouvements comme ouvrir la mâchoire ou lever un sourcil sont faits, et quand. Ces nombres sont envoyés aux chercheurs et conservés avec vos réponses.",
    ],
    [
        "mimicry_not_sent",
        "No picture, no video and no sound leaves your device, and none is kept. Between the clips nothing is measured.",
        "Aucune image, aucune vidéo et aucun son ne quitte votre appareil, et rien n’en est conservé. Entre les extraits, rien n’est mesuré.",
    ],
    [
        "mimicry_free",
        "You can decline and take part all the same. If you agree, you can switch the camera off at any time by the button at the foot of the page; it is switched off at the end by itself.",
        "Vous pouvez refuser et participer tout de même. Si vous acceptez, vous pouvez éteindre la caméra à tout moment par le bouton au bas de la page ; elle s’éteint d’elle-même à la fin.",
    ],
    ["mimicry_agree", "I agree: switch the camera on", "J’accepte : allumer la caméra"],
    ["mimicry_decline", "I do not agree: go on without", "Je refuse : continuer sans"],
    [
        "mimicry_asking",
        "Your browser asks whether this page may use the camera.",
        "Votre navigateur demande si cette page peut utiliser la caméra.",
    ],
    [
        "mimicry_loading",
        "What measures the face is being loaded.",
        "Ce qui mesure le visage est en cours de chargement.",
    ],
    [
        "mimicry_looking",
        "No face is seen yet. Sit in front of the camera, with light on your face.",
        "Aucun visage n’est encore vu. Placez-vous devant la caméra, le visage éclairé.",
    ],
    [
        "mimicry_seen",
        "Your face is seen. You can go on.",
        "Votre visage est vu. Vous pouvez continuer.",
    ],
    [
        "mimicry_own",
        "Your camera. This picture stays on your device.",
        "Votre caméra. Cette image reste sur votre appareil.",
    ],
    ["mimicry_next", "Go on", "Continuer"],
    ["mimicry_without", "Go on without the camera", "Continuer sans la caméra"],
    ["mimicry_again", "Try again", "Réessayer"],
    [
        "mimicry_refused",
        "The camera may not be used. Allow it in your browser, or go on without.",
        "La caméra ne peut pas être utilisée. Autorisez-la dans votre navigateur, ou continuez sans.",
    ],
    [
        "mimicry_no_camera",
        "No camera was found. Connect one, or go on without.",
        "Aucune caméra n’a été trouvée. Branchez-en une, ou continuez sans.",
    ],
    [
        "mimicry_failed",
        "What measures the face does not work in this browser. You can try again, or go on without.",
        "Ce qui mesure le visage ne fonctionne pas dans ce navigateur. Vous pouvez réessayer, ou continuer sans.",
    ],
    [
        "mimicry_insecure",
        "This browser lets only secure pages (https) use the camera. You can go on without.",
        "Ce navigateur n’autorise la caméra qu’aux pages sécurisées (https). Vous pouvez continuer sans.",
    ],
    [
        "mimicry_bar",
        "The camera is on. While a clip plays, movements of your face are measured; no picture is sent.",
        "La caméra est allumée. Pendant un extrait, les mouvements de votre visage sont mesurés ; aucune image n’est envoyée.",
    ],
    ["mimicry_stop", "Switch the camera off", "Éteindre la caméra"],
    [
        "mimicry_stopped",
        "The camera is off. Nothing more of your face is measured. What was measured stays with your answers; if you withdraw from the study it is deleted.",
        "La caméra est éteinte. Plus rien de votre visage n’est mesuré. Ce qui l’a été reste avec vos réponses ; si vous vous retirez de l’étude, c’est supprimé.",
    ],
    ["mimicry_close", "Close", "Fermer"],
    [
        "mimicry_resuming",
        "The camera is being switched on again.",
        "La caméra est en train de se rallumer.",
    ],
    [
        "mimicry_lost",
        "The camera is off: it is not found, or may not be used any more. The study goes on without.",
        "La caméra est éteinte : elle est introuvable, ou ne peut plus être utilisée. L’étude continue sans.",
    ],
];

/// What the pages say of it in a language, by name: the study's own words (`translations`), else French or English.
pub fn mimicry_words(
    language: &str,
    own: Option<&BTreeMap<String, String>>,
) -> BTreeMap<String, String> {
    row_words(&MIMICRY, language, own)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_languages_have_every_text_and_the_study_may_bring_its_own() {
        let english = mimicry_words("en", None);
        let french = mimicry_words("fr-CA", None);
        assert_eq!(english.len(), MIMICRY.len(), "no name twice");
        for (name, text) in &english {
            assert!(!text.is_empty() && !french[name].is_empty(), "{name}");
            assert_eq!(text.contains("{rate}"), french[name].contains("{rate}"), "{name}");
        }
        let own = BTreeMap::from([("mimicry_stop".to_owned(), "Kamera aus".to_owned())]);
        let german = mimicry_words("de", Some(&own));
        assert_eq!(german["mimicry_stop"], "Kamera aus");
        assert_eq!(german["mimicry_next"], "Go on");
    }
}
