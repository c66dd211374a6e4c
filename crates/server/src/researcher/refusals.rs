//! Refusals in the reader's language: programs read English, people read theirs.

use mimique_study::wire::Refusal;

use crate::accounts::Tongue;

/// By code, where one code has one text.
const BY_CODE: &[(&str, &str)] = &[
    ("not-allowed", "Votre rôle ne le permet pas ; demandez à une personne responsable."),
    (
        "foreign-form",
        "Le formulaire ne vient pas de cette page, ou la page est trop ancienne ; rechargez-la.",
    ),
    ("wrong-password", "L’adresse ou le mot de passe est faux ; saisissez-les à nouveau."),
    ("too-many-attempts", "Trop d’essais ; attendez un quart d’heure."),
    ("too-many-streams", "Ce compte a trop de tableaux de bord ouverts ; fermez-en un."),
    ("dead-link", "Le lien a servi, a expiré ou n’a jamais existé ; demandez-en un autre."),
    ("unknown-study", "Aucune étude ne porte ce nom sur ce serveur."),
    ("unknown-session", "Aucune session ne porte ce numéro."),
    ("not-found", "Il n’y a rien à cette adresse."),
    ("method-not-allowed", "Cette adresse ne s’emploie pas ainsi ; passez par les pages."),
    ("last-owner", "Il resterait un serveur sans responsable."),
    ("log-in-first", "Personne n’est connecté ; connectez-vous."),
    ("timeout", "La demande a mis trop de temps à arriver ; envoyez-la à nouveau."),
    ("too-often", "Trop de demandes ; attendez un instant."),
    (
        "unavailable",
        "Le serveur ne peut rien écrire pour l’instant ; rien de ce qu’il a confirmé n’est perdu. Réessayez.",
    ),
    (
        "internal",
        "Le serveur n’y est pas parvenu ; rien de ce qu’il a confirmé n’est perdu. Réessayez.",
    ),
];

/// By message, where a code has several; `{}` stands for what differs.
const BY_MESSAGE: &[(&str, &str)] = &[
    ("this is no form", "Ce n’est pas un formulaire ; envoyez celui de la page."),
    ("the form: {}", "Le formulaire est incomplet ({}) ; remplissez tous les champs."),
    ("the query: {}", "La demande n’est pas comprise ({})."),
    ("this is no e-mail address", "Ce n’est pas une adresse de courriel ; écrivez nom@hôte."),
    (
        "somebody has an account by this address",
        "Quelqu’un a déjà un compte à cette adresse ; donnez-lui plutôt un lien pour un nouveau mot de passe.",
    ),
    (
        "the password has fewer than {} characters",
        "Le mot de passe a moins de {} caractères ; choisissez-en un plus long, par exemple quatre mots.",
    ),
    ("the password is too long", "Le mot de passe est trop long ; choisissez-en un plus court."),
    ("the old password is wrong", "L’ancien mot de passe est faux ; saisissez-le à nouveau."),
    ("the token has no name", "Le jeton n’a pas de nom ; dites à quoi il sert."),
    ("unknown action", "Action inconnue ; employez le formulaire de la page."),
    ("there is no such role", "Ce rôle n’existe pas ; choisissez-en un de la page."),
    ("there is no reason", "Il manque la raison ; dites pourquoi la personne est exclue."),
    ("there is no such stage", "Cette phase n’existe pas ; choisissez pilote ou réelle."),
    ("this is no upload", "Ce n’est pas un dépôt de fichier ; employez le formulaire de la page."),
    ("the upload broke off", "Le dépôt s’est interrompu ; recommencez."),
    ("there is no file", "Il n’y a pas de fichier ; choisissez-en un."),
    (
        "study {} is hosted from the server's own files",
        "L’étude {} est servie depuis les fichiers du serveur ; donnez à la vôtre un autre identifiant.",
    ),
    ("study {} is being prepared", "L’étude {} est en préparation ; attendez la fin."),
    (
        "this study is hosted from the server's own files",
        "Cette étude est servie depuis les fichiers du serveur ; changez-la là où le serveur est lancé.",
    ),
    (
        "this server has no data folder",
        "Ce serveur n’a pas de dossier de données ; lancez-le avec --data-dir.",
    ),
    (
        "the name typed is not the participant’s",
        "Le nom saisi n’est pas celui de la personne ; rien n’est supprimé. Recommencez.",
    ),
    ("the upload is too large", "Le fichier est trop grand ; 512 Mio sont acceptés au plus."),
    ("the request is too large", "La demande est trop grande."),
    (
        "this is neither a ZIP archive nor a study file: {}",
        "Ce n’est ni une archive ZIP ni un fichier d’étude ({}) ; déposez un .zip ou un .json.",
    ),
    ("the archive has {} entries", "L’archive a {} entrées : c’est trop."),
    (
        "entry {}: the name leads out of the archive",
        "Entrée {} : le nom mène hors de l’archive ; refaites l’archive du dossier.",
    ),
    (
        "entry {}: it is a link",
        "Entrée {} : c’est un lien ; mettez le fichier lui-même dans l’archive.",
    ),
    (
        "entry {}: another entry has this name, or one like it",
        "Entrée {} : une autre entrée a ce nom ou un nom semblable ; renommez l’une des deux.",
    ),
    (
        "entry {}: it is damaged or encrypted ({})",
        "Entrée {} : elle est endommagée ou chiffrée ({}) ; refaites l’archive du dossier.",
    ),
    (
        "entry {}: the archive holds more than 2 GiB unpacked",
        "Entrée {} : l’archive dépasse 2 Gio une fois décompressée ; laissez de côté ce que l’étude ne nomme pas.",
    ),
    (
        "there is no study file at the top of the archive",
        "Il n’y a pas de fichier d’étude au premier niveau de l’archive ; nommez-le study.json, ou n’y mettez qu’un seul .json.",
    ),
    ("there is no report: {}", "Il n’y a pas de rapport : {}."),
];

/// The refusal's words in the reader's language; in English where there are none in French.
pub(crate) fn in_french(tongue: Tongue, refusal: &Refusal) -> String {
    let french = || {
        let by_code = BY_CODE.iter().find(|(code, _)| *code == refusal.code);
        by_code.map(|(_, text)| (*text).to_owned()).or_else(|| by_message(&refusal.message))
    };
    let translated = (tongue == Tongue::French).then(french).flatten();
    translated.unwrap_or_else(|| {
        let remedy = if refusal.remedy.is_empty() { "" } else { "; " };
        sentence(&format!("{}{remedy}{}.", refusal.message, refusal.remedy))
    })
}

fn by_message(message: &str) -> Option<String> {
    BY_MESSAGE.iter().find_map(|(pattern, french)| {
        let found = differing(pattern, message)?;
        let filled =
            found.iter().fold((*french).to_owned(), |text, part| text.replacen("{}", part, 1));
        Some(filled)
    })
}

/// What stands at each `{}` of the pattern, if the message follows it.
fn differing<'a>(pattern: &str, message: &'a str) -> Option<Vec<&'a str>> {
    let mut parts = pattern.split("{}");
    let mut rest = message.strip_prefix(parts.next()?)?;
    let mut found = Vec::new();
    for part in parts {
        let end = if part.is_empty() { rest.len() } else { rest.find(part)? };
        found.push(&rest[..end]);
        rest = &rest[end + part.len()..];
    }
    rest.is_empty().then_some(found)
}

fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(code: &str, message: &str, remedy: &str) -> Refusal {
        let (code, message, remedy) = (code.into(), message.into(), remedy.into());
        Refusal { code, message, remedy, sequences: Vec::new() }
    }

    #[test]
    fn what_differs_is_taken_over() {
        let damaged =
            refusal("bad-upload", "entry \"a\": it is damaged or encrypted (CRC)", "pack it");
        assert_eq!(
            in_french(Tongue::French, &damaged),
            "Entrée \"a\" : elle est endommagée ou chiffrée (CRC) ; refaites l’archive du dossier."
        );
        assert_eq!(
            in_french(Tongue::English, &damaged),
            "Entry \"a\": it is damaged or encrypted (CRC); pack it."
        );
        let unknown = refusal("bad-request", "something else", "do so");
        assert_eq!(in_french(Tongue::French, &unknown), "Something else; do so.");
    }

    /// Every text that the researchers' pages can be refused with, read from the sources.
    #[test]
    fn every_refusal_to_a_researcher_has_its_french() {
        let sources = [
            include_str!("../accounts/forms.rs"),
            include_str!("../accounts/links.rs"),
            include_str!("../accounts/password.rs"),
            include_str!("../routes/accounts.rs"),
            include_str!("../routes/researcher.rs"),
            include_str!("../routes/uploads.rs"),
            include_str!("../uploads/mod.rs"),
        ];
        let mut seen = 0;
        for source in sources {
            for call in source.split("bad_request(").skip(1) {
                let text = call.trim_start().trim_start_matches("format!(");
                let Some(text) = text.strip_prefix('"') else { continue };
                let text = text.split('"').next().unwrap_or_default();
                let message = filled_in(text);
                assert!(by_message(&message).is_some(), "no French for {message:?}");
                seen += 1;
            }
        }
        assert!(seen >= 18, "{seen} refusals seen");
        let archive = include_str!("../uploads/archive.rs");
        for text in archive.split("#[error(").skip(1) {
            let Some(text) = text.trim_start().strip_prefix('"') else { continue };
            let text = text.split("\"\n").next().unwrap_or_default();
            let text = text.split("\")]").next().unwrap_or_default();
            // A failing disk is the server's affair.
            if text.starts_with("the server") {
                continue;
            }
            let (message, _) = text.rsplit_once("; ").expect(text);
            let message = filled_in(message);
            assert!(by_message(&message).is_some(), "no French for {message:?}");
        }
    }

    /// A format string with its places filled.
    fn filled_in(format: &str) -> String {
        let mut parts = format.split('{');
        let first = parts.next().unwrap_or_default().to_owned();
        parts.fold(first, |text, part| {
            text + "7" + part.split_once('}').map_or("", |(_, rest)| rest)
        })
    }
}
