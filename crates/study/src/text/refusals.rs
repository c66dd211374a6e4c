//! What the server refuses, in the participant's words: by the refusal's code, in English and French.

use super::Words;
use crate::wire::Refusal;

/// Code, English, French.
const REFUSALS: [(&str, &str, &str); 10] = [
    (
        "unknown-study",
        "There is no such study here. Check the address, or ask whoever gave it to you.",
        "Cette étude n’existe pas ici. Vérifiez l’adresse ou demandez à la personne qui vous l’a donnée.",
    ),
    (
        "unknown-session",
        "This session is not known here any more. Reload the page to begin anew.",
        "Cette session n’est plus connue ici. Rechargez la page pour recommencer.",
    ),
    (
        "withdrawn",
        "You have withdrawn from this study; your answers were deleted.",
        "Vous vous êtes retiré(e) de cette étude ; vos réponses ont été effacées.",
    ),
    (
        "event-conflict",
        "This session went on in another window. Reload the page to go on from there.",
        "Cette session a continué dans une autre fenêtre. Rechargez la page pour la reprendre.",
    ),
    (
        "missing-events",
        "Some answers have not arrived yet. Keep this page open; they are sent again.",
        "Certaines réponses ne sont pas encore arrivées. Gardez cette page ouverte ; elles sont renvoyées.",
    ),
    (
        "wrong-withdrawal-code",
        "This withdrawal code does not belong to the session.",
        "Ce code de retrait n’est pas celui de la session.",
    ),
    (
        "too-large",
        "An answer is too long to be stored. Shorten it and try again.",
        "Une réponse est trop longue pour être enregistrée. Raccourcissez-la et réessayez.",
    ),
    (
        "bad-request",
        "The server does not understand this page. Reload it; if that does not help, write to the investigator.",
        "Le serveur ne comprend pas cette page. Rechargez-la ; si cela ne change rien, écrivez au responsable de l’étude.",
    ),
    (
        "unavailable",
        "The server cannot store answers now. They are kept here and sent again.",
        "Le serveur ne peut pas enregistrer de réponses pour l’instant. Elles sont gardées ici et seront renvoyées.",
    ),
    (
        "internal",
        "Something went wrong on the server. Your answers are kept here. Reload the page in a moment.",
        "Une erreur est survenue sur le serveur. Vos réponses sont gardées ici. Rechargez la page dans un instant.",
    ),
];

impl Words {
    /// What a refusal means for the participant; of a code that is not listed here, the server's own
    /// words (those for people who cannot begin come in their language already).
    pub fn refused(&self, refusal: &Refusal) -> String {
        match REFUSALS.iter().find(|(code, ..)| *code == refusal.code) {
            Some((_, _, french)) if self.language == "fr" => (*french).to_owned(),
            Some((_, english, _)) => (*english).to_owned(),
            None => format!("{} {}", refusal.message, refusal.remedy).trim().to_owned(),
        }
    }
}
