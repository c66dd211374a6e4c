//! What somebody reads before agreeing: the same on the participant's page and in the HTML that stands
//! there before the page's module does.

use mimique_study::text::{Words, typeset};
use mimique_study::{LocalText, Section, StudyProjection};

use super::view::{ContactView, SectionView};

/// The text of the agreement.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AgreementView {
    /// Title of the study.
    pub title: String,
    /// What it is, in a sentence or two.
    pub description: String,
    /// The text; the lines on age and retention are its last sections.
    pub sections: Vec<SectionView>,
    /// Heading of the contacts.
    pub contact: String,
    /// Whom to write to.
    pub contacts: Vec<ContactView>,
}

impl AgreementView {
    /// In one of the study's languages, whose fixed texts are `words`.
    pub fn new(study: &StudyProjection, language: &str, words: &Words) -> Self {
        let mut sections = Vec::new();
        if let Some(consent) = &study.consent {
            sections.extend(consent.sections.iter().map(|each| section(language, each)));
            if let Some(retention) = &consent.retention {
                let text = paragraphs(language, retention);
                sections.push(SectionView { heading: words.retention().into(), text });
            }
            if let Some(years) = consent.minimum_age {
                let text = vec![words.minimum_age(years)];
                sections.push(SectionView { heading: words.age().into(), text });
            }
        }
        let contact = study.contact.as_ref();
        let people = [
            (words.investigator(), contact.map(|contact| &contact.investigator)),
            (words.ethics_board(), contact.and_then(|contact| contact.ethics_board.as_ref())),
        ];
        let contacts = people.into_iter().filter_map(|(role, person)| {
            person.map(|person| ContactView {
                role: role.to_owned(),
                name: text(language, &person.name),
                email: person.email.clone(),
                reference: person.reference.clone(),
            })
        });
        Self {
            title: text(language, &study.title),
            description: text(language, &study.description),
            sections,
            contact: words.contact().to_owned(),
            contacts: contacts.collect(),
        }
    }
}

/// A text of the study in a language, with that language's spaces and quotation marks.
pub(super) fn text(language: &str, text: &LocalText) -> String {
    typeset(language, text.in_language(language)).into_owned()
}

/// Its paragraphs: what blank lines part.
pub(super) fn paragraphs(language: &str, of: &LocalText) -> Vec<String> {
    let whole = text(language, of);
    let paragraphs = whole.split("\n\n").map(str::trim).filter(|each| !each.is_empty());
    paragraphs.map(str::to_owned).collect()
}

/// A section of the study in a language.
pub(super) fn section(language: &str, of: &Section) -> SectionView {
    SectionView { heading: text(language, &of.heading), text: paragraphs(language, &of.text) }
}
