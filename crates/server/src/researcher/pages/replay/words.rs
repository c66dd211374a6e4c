//! What the script of a replay says, in the reader's language; `{…}` stand for values.

use mimique_locale::Language;
use serde_json::json;

/// The words as JSON.
pub fn script_words(language: Language) -> String {
    let say = |english: &'static str, french: &'static str| language.pick(english, french);
    json!({
        "play": say("Play", "Lire"),
        "pause": say("Pause", "Pause"),
        "loading": say("Loading and solving", "Chargement et résolution"),
        "face": say("Animated face, clip {clip}", "Visage animé, clip {clip}"),
        "whole": say("{number}: to its end", "{number} : jusqu’à la fin"),
        "cut": say("{number}: cut short", "{number} : interrompue"),
        "strip": say(
            "{frames} frames in {seconds} s, {late} late, longest {longest} ms",
            "{frames} images en {seconds} s, {late} en retard, la plus longue {longest} ms",
        ),
        "nothing": say("No frame was shown.", "Aucune image n’a été affichée."),
        "late": say("Late frames:", "Images en retard :"),
        "lateFrame": say("{seconds} s ({ms} ms)", "{seconds} s ({ms} ms)"),
        "same": say(
            "{clip}: the weights are those that were shown then (SHA-256 {hash}), and so is the renderer: what is drawn now equals what was shown.",
            "{clip} : les poids sont ceux affichés alors (SHA-256 {hash}), le moteur de rendu aussi : ce qui est dessiné est ce qui a été montré.",
        ),
        "otherRenderer": say(
            "{clip}: the weights are those that were shown then (SHA-256 {hash}); another version of the renderer drew them.",
            "{clip} : les poids sont ceux affichés alors (SHA-256 {hash}) ; une autre version du moteur de rendu les a dessinés.",
        ),
        "different": say(
            "{clip}: the weights differ, {then} then and {hash} now (SHA-256): what is drawn now is not what was shown.",
            "{clip} : les poids diffèrent, {then} alors et {hash} maintenant (SHA-256) : ce qui est dessiné n’est pas ce qui a été montré.",
        ),
        "prepared": say(
            "{clip}: the log holds no weights of it; the clip was prepared alike, by its provenance.",
            "{clip} : le relevé n’en contient pas les poids ; d’après sa provenance, le clip a été préparé de même.",
        ),
        "unknown": say(
            "{clip}: the log holds no weights of it: whether what is drawn now was shown is not known.",
            "{clip} : le relevé n’en contient pas les poids : on ne sait pas si ce qui est dessiné a été montré.",
        ),
    })
    .to_string()
}
