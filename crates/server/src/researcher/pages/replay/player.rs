//! What draws clips again: stages, strip of frames, playback. Its script is `static/researcher/replayed.js`.

use maud::{Markup, html};
use mimique_locale::Language;

/// What draws the clips again; the script puts it into the page that is shown.
pub fn player(language: Language) -> Markup {
    let control = |english, french| language.pick(english, french);
    html! {
        section #player aria-label=(control("Clip as it was seen", "Le clip tel qu’il a été vu")) hidden {
            p {
                label #which-label {
                    (control("Play", "Lecture")) " "
                    select #which {}
                }
            }
            div.replay-stages #stages {}
            div #problem .notice.bad role="alert" hidden {}
            div #strip .replay-strip {}
            p.soft #legend {
                (control(
                    "A tick for each frame, when it was shown; tall and orange where it came late: until then the frame before it stood.",
                    "Un trait par image, au moment où elle a été affichée ; haut et orange si elle est venue en retard : jusque-là, la précédente est restée.",
                ))
            }
            div.preview-transport role="group" aria-label=(control("Playback", "Commandes de lecture")) {
                div.preview-scrub {
                    label.visually-hidden for="scrub" { (control("Time since the first frame", "Temps depuis la première image")) }
                    input #scrub type="range" min="0" max="1" step="1" value="0";
                    output #clock .number for="scrub" {}
                }
                div.preview-buttons {
                    button #play .primary type="button" aria-keyshortcuts="Space" { (control("Play", "Lire")) }
                    button #back type="button" aria-keyshortcuts="," aria-label=(control("One shown frame back", "Une image affichée en arrière")) { "◀︎ " (control("frame", "image")) }
                    button #forth type="button" aria-keyshortcuts="." aria-label=(control("One shown frame on", "Une image affichée en avant")) { (control("frame", "image")) " ▶︎" }
                    label.preview-check { input #loop type="checkbox"; (control("Loop", "En boucle")) }
                    label {
                        (control("Speed", "Vitesse")) " "
                        select #speed {
                            option value="1" { "1 ×" }
                            option value="0.5" { "½ ×" }
                            option value="0.25" { "¼ ×" }
                            option value="0.1" { "¹⁄₁₀ ×" }
                        }
                    }
                }
                p.soft.preview-keys {
                    kbd { "Space" } (control(" play or pause, ", " lire ou arrêter, "))
                    kbd { "," } " " kbd { "." } (control(" one frame, ", " une image, "))
                    kbd { "L" } (control(" loop, ", " en boucle, "))
                    kbd { "S" } (control(" speed, ", " vitesse, "))
                    kbd { "P" } " " kbd { "N" } (control(" page", " page"))
                }
            }
            p #same role="status" {}
            p #late .replay-late {}
            p #heard .soft hidden {
                (control(
                    "The clip’s sound is not played here; the preview plays it.",
                    "Le son du clip n’est pas joué ici ; l’aperçu le joue.",
                ))
            }
        }
    }
}
