//! Every refusal of the server in one table: its values, its status, its code, and its words in English
//! and French. Programs read the code, people the words.

/// What is wrong, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Words {
    pub message: String,
    pub remedy: String,
}

/// Makes the enum and what is said of it from rows of the form
/// `Name { value: Type } = STATUS "code", en "message"; "remedy", fr "message"; "remedy";`.
macro_rules! refusals {
    ($($(#[$doc:meta])* $name:ident $({ $($value:ident: $kind:ty),+ })? = $status:ident $code:expr,
        en $message:literal; $remedy:literal, fr $french:literal; $french_remedy:literal;)+) => {
        /// Why a request is refused.
        #[derive(Debug)]
        pub(crate) enum Error {
            $($(#[$doc])* $name $({ $($value: $kind),+ })?,)+
        }

        // A row need not put each of its values into each of its texts.
        #[allow(unused_variables)]
        impl Error {
            pub fn status(&self) -> axum::http::StatusCode {
                match self {
                    $(Self::$name $({ $($value),+ })? => axum::http::StatusCode::$status,)+
                }
            }

            /// The stable word that programs read.
            pub fn code(&self) -> &'static str {
                match self {
                    $(Self::$name $({ $($value),+ })? => $code,)+
                }
            }

            /// The words in a language. A message begins with a small letter and ends without a stop.
            pub fn words(&self, language: mimique_locale::Language) -> Words {
                match (self, language) {
                    $((Self::$name $({ $($value),+ })?, mimique_locale::Language::English) => {
                        Words { message: format!($message), remedy: format!($remedy) }
                    }
                    (Self::$name $({ $($value),+ })?, mimique_locale::Language::French) => {
                        Words { message: format!($french), remedy: format!($french_remedy) }
                    })+
                }
            }

            /// One of each, with empty values.
            #[cfg(test)]
            pub fn one_of_each() -> Vec<Self> {
                vec![$(Self::$name $({ $($value: Default::default()),+ })?,)+]
            }
        }
    };
}

refusals! {
    // Of every address.
    NotFound = NOT_FOUND "not-found",
        en "nothing is at this address"; "check it, or start again from the study's address",
        fr "il n’y a rien à cette adresse"; "vérifiez-la, ou repartez de l’adresse de l’étude";
    MethodNotAllowed = METHOD_NOT_ALLOWED "method-not-allowed",
        en "this address does not take this method"; "see the list of routes",
        fr "cette adresse ne s’emploie pas ainsi"; "passez par les pages";
    TooLarge = PAYLOAD_TOO_LARGE "too-large",
        en "the request is too large"; "send fewer events in one request",
        fr "la demande est trop grande"; "envoyez moins d’événements à la fois";
    NotJson = UNSUPPORTED_MEDIA_TYPE "bad-request",
        en "the body is not JSON by its Content-Type"; "send application/json",
        fr "le corps n’est pas du JSON d’après son Content-Type"; "envoyez application/json";
    UnreadableBody { problem: String } = BAD_REQUEST "bad-request",
        en "the body is not what this address takes: {problem}"; "see the interface's description",
        fr "le corps n’est pas ce que prend cette adresse : {problem}"; "voyez la description de l’interface";
    BrokenBody = BAD_REQUEST "bad-request",
        en "the body could not be read to its end"; "send the request again",
        fr "le corps n’a pas pu être lu jusqu’au bout"; "envoyez la demande à nouveau";
    UnreadableQuery { problem: String } = BAD_REQUEST "bad-request",
        en "the query: {problem}"; "see the interface's description",
        fr "la demande n’est pas comprise ({problem})"; "voyez la description de l’interface";
    RateLimited = TOO_MANY_REQUESTS "too-often",
        en "too many requests from one address"; "wait a moment and send it again",
        fr "trop de demandes de la même adresse"; "attendez un instant et renvoyez-la";
    NulInText = BAD_REQUEST "bad-request",
        en "the text has a NUL in it"; "send text without one",
        fr "le texte contient un caractère nul"; "envoyez un texte sans lui";
    NotOneHost = BAD_REQUEST "bad-request",
        en "the request does not name exactly one host"; "send one Host header",
        fr "la demande ne nomme pas exactement un hôte"; "envoyez un seul en-tête Host";
    NoSuchRange = RANGE_NOT_SATISFIABLE "no-such-range",
        en "the part asked for is beyond the end"; "ask for less",
        fr "la partie demandée dépasse la fin"; "demandez-en moins";
    Timeout = REQUEST_TIMEOUT "timeout",
        en "the request took too long to arrive"; "send it again",
        fr "la demande a mis trop de temps à arriver"; "envoyez-la à nouveau";
    /// The database does not answer, or the server is stopping.
    Unavailable = SERVICE_UNAVAILABLE "unavailable",
        en "the server could not do it"; "nothing that was acknowledged is lost, try again",
        fr "le serveur ne peut rien écrire pour l’instant"; "rien de ce qu’il a confirmé n’est perdu, réessayez";
    /// The detail is for the log alone: it holds neither answers nor identifiers.
    Internal { detail: String } = INTERNAL_SERVER_ERROR "internal",
        en "the server could not do it"; "nothing that was acknowledged is lost, try again",
        fr "le serveur n’y est pas parvenu"; "rien de ce qu’il a confirmé n’est perdu, réessayez";

    // Of studies and participants' sessions.
    UnknownStudy = NOT_FOUND "unknown-study",
        en "no study is called so on this server"; "check the address",
        fr "aucune étude ne porte ce nom sur ce serveur"; "vérifiez l’adresse";
    UnknownPack = NOT_FOUND "unknown-pack",
        en "no pack has this hash"; "reload the page",
        fr "aucun paquet n’a cette empreinte"; "rechargez la page";
    NoExertion { problem: String } = CONFLICT "no-exertion",
        en "the exertion cannot be computed: {problem}"; "see that the study's files are where it names them",
        fr "l’effort ne peut pas être calculé : {problem}"; "vérifiez que les fichiers de l’étude sont où elle les nomme";
    NoComparison { problem: String } = CONFLICT "no-comparison",
        en "the clips cannot be compared: {problem}"; "start the server again, so that it prepares the study anew",
        fr "les clips ne peuvent pas être comparés : {problem}"; "redémarrez le serveur, afin qu’il prépare de nouveau l’étude";
    NoReplay { problem: String } = CONFLICT "no-replay",
        en "the session cannot be gone through again: {problem}"; "read its events in the export",
        fr "la session ne peut pas être parcourue de nouveau : {problem}"; "lisez ses événements dans l’export";
    UnknownSession = NOT_FOUND "unknown-session",
        en "no session has this token"; "start the study again from its address",
        fr "aucune session n’a ce jeton"; "reprenez l’étude depuis son adresse";
    Withdrawn = GONE "withdrawn",
        en "the participant has withdrawn"; "nothing more is stored",
        fr "la personne s’est retirée"; "plus rien n’est enregistré";
    MissingEvents { count: usize, first: u64, sequences: Vec<u64> } = CONFLICT "missing-events",
        en "{count} events are missing, first {first}"; "send them again",
        fr "{count} événements manquent, le premier est {first}"; "envoyez-les à nouveau";
    EventConflict { count: usize, sequences: Vec<u64> } = CONFLICT "event-conflict",
        en "{count} events differ from what is stored under their sequence"; "reload the page",
        fr "{count} événements diffèrent de ce qui est enregistré sous leur numéro"; "rechargez la page";
    WrongWithdrawalCode = FORBIDDEN "wrong-withdrawal-code",
        en "the withdrawal code is not the one of this session"; "copy it as it was shown",
        fr "le code de retrait n’est pas celui de cette session"; "recopiez-le tel qu’il a été affiché";
    SessionFull = PAYLOAD_TOO_LARGE "session-full",
        en "the session has more events than its study can give"; "start the study again from its address",
        fr "la session a plus d’événements que l’étude ne peut en donner"; "reprenez l’étude depuis son adresse";
    UnknownWithdrawalCode = NOT_FOUND "unknown-withdrawal-code",
        en "no participant of this study has this withdrawal code"; "copy it as the last page showed it",
        fr "aucune personne de cette étude n’a ce code de retrait"; "recopiez-le tel que la dernière page l’a affiché";
    TooManyStarts = TOO_MANY_REQUESTS "too-often",
        en "too many sessions begin from one address"; "wait a moment and send it again",
        fr "trop de sessions commencent depuis la même adresse"; "attendez un instant et renvoyez-la";
    AlreadyTookPart = FORBIDDEN "already-took-part",
        en "this person has already taken part"; "everybody can take part once",
        fr "cette personne a déjà participé"; "on ne participe qu’une fois";
    StudyFull = FORBIDDEN "study-full",
        en "the study has all the participants it wants"; "a place may become free later",
        fr "l’étude a toutes les personnes qu’elle cherche"; "une place se libérera peut-être";
    /// Nobody begins by this address; the words are the study's own, in the participant's language.
    CannotBegin { code: &'static str, message: String, remedy: String } = FORBIDDEN *code,
        en "{message}"; "{remedy}",
        fr "{message}"; "{remedy}";
    BadNonce = BAD_REQUEST "bad-request",
        en "the nonce is not 32 lower-case hexadecimal digits"; "make it of 128 random bits",
        fr "le nonce n’a pas 32 chiffres hexadécimaux minuscules"; "tirez 128 bits au hasard";
    BadEventCount { events: u64 } = BAD_REQUEST "bad-request",
        en "a session cannot be complete with {events} events"; "send how many events the session has",
        fr "une session ne peut pas être complète avec {events} événements"; "envoyez leur nombre";
    EventBeyondEnd { sequence: u64, most: u64 } = BAD_REQUEST "bad-request",
        en "event {sequence}: a session has at most {most} events"; "number the events of a session from 0 without gaps",
        fr "événement {sequence} : une session a au plus {most} événements"; "numérotez-les à partir de 0, sans trou";
    EventNotAnObject { sequence: u64 } = BAD_REQUEST "bad-request",
        en "event {sequence}: the body is no object"; "send an object with its `type`",
        fr "événement {sequence} : le corps n’est pas un objet"; "envoyez un objet avec son `type`";
    EventTooLarge { sequence: u64, most_bytes: usize } = BAD_REQUEST "bad-request",
        en "event {sequence}: the body is larger than {most_bytes} bytes"; "shorten its frame log",
        fr "événement {sequence} : le corps dépasse {most_bytes} octets"; "raccourcissez son journal d’images";

    // Of accounts.
    LogInFirst = UNAUTHORIZED "log-in-first",
        en "nobody is logged in"; "log in, or send a token",
        fr "personne n’est connecté"; "connectez-vous, ou envoyez un jeton";
    NotAllowed = FORBIDDEN "not-allowed",
        en "your role does not allow this"; "ask an owner of this server",
        fr "votre rôle ne le permet pas"; "demandez à une personne responsable";
    ForeignForm = FORBIDDEN "foreign-form",
        en "the form is not from this page, or the page is too old"; "load the page again",
        fr "le formulaire ne vient pas de cette page, ou la page est trop ancienne"; "rechargez-la";
    NotAForm = BAD_REQUEST "bad-request",
        en "this is no form"; "send the page's own form",
        fr "ce n’est pas un formulaire"; "envoyez celui de la page";
    IncompleteForm { problem: String } = BAD_REQUEST "bad-request",
        en "the form: {problem}"; "fill in every field",
        fr "le formulaire est incomplet ({problem})"; "remplissez tous les champs";
    UnknownAction = BAD_REQUEST "bad-request",
        en "unknown action"; "use the page's own form",
        fr "action inconnue"; "employez le formulaire de la page";
    WrongPassword = FORBIDDEN "wrong-password",
        en "address or password is wrong"; "type both again, or ask an owner for a new link",
        fr "l’adresse ou le mot de passe est faux"; "saisissez-les à nouveau, ou demandez un lien à une personne responsable";
    WrongOldPassword = BAD_REQUEST "bad-request",
        en "the old password is wrong"; "type it again",
        fr "l’ancien mot de passe est faux"; "saisissez-le à nouveau";
    ShortPassword { least: usize } = BAD_REQUEST "bad-request",
        en "the password has fewer than {least} characters"; "choose a longer one, for example four words",
        fr "le mot de passe a moins de {least} caractères"; "choisissez-en un plus long, par exemple quatre mots";
    LongPassword = BAD_REQUEST "bad-request",
        en "the password is too long"; "choose a shorter one",
        fr "le mot de passe est trop long"; "choisissez-en un plus court";
    TooManyAttempts = TOO_MANY_REQUESTS "too-many-attempts",
        en "there were too many attempts"; "wait a quarter of an hour",
        fr "il y a eu trop d’essais"; "attendez un quart d’heure";
    DeadLink = GONE "dead-link",
        en "the link was used, has expired or never was"; "ask for a new one",
        fr "le lien a servi, a expiré ou n’a jamais existé"; "demandez-en un autre";
    NotAnEmail = BAD_REQUEST "bad-request",
        en "this is no e-mail address"; "write name@host",
        fr "ce n’est pas une adresse de courriel"; "écrivez nom@hôte";
    AccountExists = BAD_REQUEST "bad-request",
        en "somebody has an account by this address"; "give them a link for a new password instead",
        fr "quelqu’un a déjà un compte à cette adresse"; "donnez-lui plutôt un lien pour un nouveau mot de passe";
    NoSuchRole = BAD_REQUEST "bad-request",
        en "there is no such role"; "choose one of the page's",
        fr "ce rôle n’existe pas"; "choisissez-en un de la page";
    LastOwner = CONFLICT "last-owner",
        en "nobody would be left to own this server"; "choose another role or account first",
        fr "il ne resterait personne de responsable de ce serveur"; "choisissez d’abord un autre rôle ou un autre compte";
    AccountDisabled = CONFLICT "account-disabled",
        en "this account is disabled"; "enable it first",
        fr "ce compte est désactivé"; "réactivez-le d’abord";
    NamelessToken = BAD_REQUEST "bad-request",
        en "the token has no name"; "name what it is for",
        fr "le jeton n’a pas de nom"; "dites à quoi il sert";

    // Of the dashboard.
    TooManyStreams = TOO_MANY_REQUESTS "too-many-streams",
        en "this account has too many dashboards open"; "close one",
        fr "ce compte a trop de tableaux de bord ouverts"; "fermez-en un";
    NoReason = BAD_REQUEST "bad-request",
        en "there is no reason"; "say why the participant is excluded",
        fr "il manque la raison"; "dites pourquoi la personne est exclue";
    NotConfirmed { participant: String } = BAD_REQUEST "not-confirmed",
        en "the name typed is not the participant’s"; "type {participant} to delete",
        fr "le nom saisi n’est pas celui de la personne, rien n’est supprimé"; "saisissez {participant} pour supprimer";
    NoReport { problem: String } = CONFLICT "no-report",
        en "there is no report: {problem}"; "correct what is named, or wait for more answers",
        fr "il n’y a pas de rapport : {problem}"; "corrigez ce qui est nommé, ou attendez d’autres réponses";

    // Of uploads.
    NoDataFolder = BAD_REQUEST "bad-request",
        en "this server has no data folder"; "start it with --data-dir",
        fr "ce serveur n’a pas de dossier de données"; "lancez-le avec --data-dir";
    NotAnUpload = BAD_REQUEST "bad-request",
        en "this is no upload"; "send the page's own form",
        fr "ce n’est pas un dépôt de fichier"; "employez le formulaire de la page";
    BrokenUpload = BAD_REQUEST "bad-request",
        en "the upload broke off"; "send it again",
        fr "le dépôt s’est interrompu"; "recommencez";
    NoFile = BAD_REQUEST "bad-request",
        en "there is no file"; "choose one",
        fr "il n’y a pas de fichier"; "choisissez-en un";
    UploadTooLarge = PAYLOAD_TOO_LARGE "too-large",
        en "the upload is too large"; "512 MiB are taken at most",
        fr "le fichier est trop grand"; "512 Mio sont acceptés au plus";
    OwnStudy { study: String } = BAD_REQUEST "bad-request",
        en "study {study:?} is hosted from the server's own files"; "give the study another id",
        fr "l’étude {study:?} est servie depuis les fichiers du serveur"; "donnez à la vôtre un autre identifiant";
    BeingPrepared { study: String } = BAD_REQUEST "bad-request",
        en "study {study:?} is being prepared"; "wait until that is done",
        fr "l’étude {study:?} est en préparation"; "attendez la fin";
    NotUploaded = BAD_REQUEST "bad-request",
        en "this study is hosted from the server's own files"; "change it where the server is started",
        fr "cette étude est servie depuis les fichiers du serveur"; "changez-la là où le serveur est lancé";
    NoSuchPhase = BAD_REQUEST "bad-request",
        en "there is no such stage"; "choose pilot or live",
        fr "cette phase n’existe pas"; "choisissez pilote ou réelle";
    NotAnArchive { problem: String } = UNPROCESSABLE_ENTITY "bad-upload",
        en "this is neither a ZIP archive nor a study file: {problem}"; "upload a .zip or a .json",
        fr "ce n’est ni une archive ZIP ni un fichier d’étude ({problem})"; "déposez un .zip ou un .json";
    TooManyEntries { entries: usize, most: usize } = UNPROCESSABLE_ENTITY "bad-upload",
        en "the archive has {entries} entries"; "{most} are taken at most",
        fr "l’archive a {entries} entrées"; "{most} sont acceptées au plus";
    EntryOutside { entry: String } = UNPROCESSABLE_ENTITY "bad-upload",
        en "entry {entry:?}: the name leads out of the archive"; "pack the folder anew",
        fr "entrée {entry:?} : le nom mène hors de l’archive"; "refaites l’archive du dossier";
    EntryLink { entry: String } = UNPROCESSABLE_ENTITY "bad-upload",
        en "entry {entry:?}: it is a link"; "put the file itself into the archive",
        fr "entrée {entry:?} : c’est un lien"; "mettez le fichier lui-même dans l’archive";
    EntryTwice { entry: String } = UNPROCESSABLE_ENTITY "bad-upload",
        en "entry {entry:?}: another entry has this name, or one like it"; "rename one of them",
        fr "entrée {entry:?} : une autre entrée a ce nom ou un nom semblable"; "renommez l’une des deux";
    EntryAndFolder { entry: String } = UNPROCESSABLE_ENTITY "bad-upload",
        en "entry {entry:?}: one name is that of a file and of a folder"; "rename one of them",
        fr "entrée {entry:?} : un même nom désigne un fichier et un dossier"; "renommez l’un des deux";
    JsonTooLarge { entry: String, most_mib: u64 } = UNPROCESSABLE_ENTITY "bad-upload",
        en "entry {entry:?}: the file of JSON is too large"; "{most_mib} MiB are taken at most",
        fr "entrée {entry:?} : le fichier JSON est trop grand"; "{most_mib} Mio sont acceptés au plus";
    ContentTooLarge { entry: String } = UNPROCESSABLE_ENTITY "bad-upload",
        en "entry {entry:?}: the archive holds more than 2 GiB unpacked"; "leave out what the study does not name",
        fr "entrée {entry:?} : l’archive dépasse 2 Gio une fois décompressée"; "laissez de côté ce que l’étude ne nomme pas";
    EntryDamaged { entry: String, problem: String } = UNPROCESSABLE_ENTITY "bad-upload",
        en "entry {entry:?}: it is damaged or encrypted ({problem})"; "pack the folder anew",
        fr "entrée {entry:?} : elle est endommagée ou chiffrée ({problem})"; "refaites l’archive du dossier";
    NoStudyFile = UNPROCESSABLE_ENTITY "bad-upload",
        en "there is no study file at the top of the archive"; "name it study.json, or put only one .json there",
        fr "il n’y a pas de fichier d’étude au premier niveau de l’archive"; "nommez-le study.json, ou n’y mettez qu’un seul .json";
}

#[cfg(test)]
mod tests {
    use mimique_locale::Language;

    use super::*;

    /// The compiler asks each row for its texts; this asks that they say something, each language in
    /// its own words, and that no text names a value without its place.
    #[test]
    fn every_refusal_has_words_in_every_language() {
        for error in Error::one_of_each() {
            if matches!(error, Error::CannotBegin { .. }) {
                continue;
            }
            let [english, french] = [Language::English, Language::French].map(|l| error.words(l));
            for words in [&english, &french] {
                assert!(!words.message.is_empty() && !words.remedy.is_empty(), "{error:?}");
                for text in [&words.message, &words.remedy] {
                    assert!(!text.ends_with('.') && !text.contains("; "), "{error:?}: {text}");
                }
            }
            assert_ne!(english.message, french.message, "{error:?}");
            assert_ne!(english.remedy, french.remedy, "{error:?}");
            assert!(!error.code().is_empty(), "{error:?}");
            assert!(error.status().is_client_error() || error.status().is_server_error());
        }
    }

    #[test]
    fn values_stand_in_the_words_of_both_languages() {
        let damaged = Error::EntryDamaged { entry: "a".into(), problem: "CRC".into() };
        assert_eq!(
            damaged.words(Language::English).message,
            "entry \"a\": it is damaged or encrypted (CRC)"
        );
        assert_eq!(
            damaged.words(Language::French).message,
            "entrée \"a\" : elle est endommagée ou chiffrée (CRC)"
        );
    }
}
