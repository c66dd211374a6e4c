//! Who made a data set: `Family, Given; ORCID; affiliation`, or the name of a group.

use std::str::FromStr;

/// Somebody, or a group, who made the data set.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Author {
    /// What they are called.
    pub name: Name,
    /// Their ORCID, as `0000-0002-1825-0097`.
    pub orcid: Option<String>,
    /// Where they work.
    pub affiliation: Option<String>,
}

/// A name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Name {
    /// Of a person, in its parts.
    Person {
        /// Family name.
        family: String,
        /// Given names.
        given: String,
    },
    /// Of a group, or of somebody whose name was not given in parts.
    Whole(String),
}

impl Author {
    /// As lists of authors are sorted: `Family, Given`.
    pub fn sorted_name(&self) -> String {
        match &self.name {
            Name::Person { family, given } => format!("{family}, {given}"),
            Name::Whole(name) => name.clone(),
        }
    }

    /// As it is said: `Given Family`.
    pub fn said_name(&self) -> String {
        match &self.name {
            Name::Person { family, given } => format!("{given} {family}"),
            Name::Whole(name) => name.clone(),
        }
    }

    /// Address of their ORCID.
    pub fn orcid_address(&self) -> Option<String> {
        self.orcid.as_ref().map(|orcid| format!("https://orcid.org/{orcid}"))
    }
}

impl FromStr for Author {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = text.split(';').map(str::trim).filter(|part| !part.is_empty());
        let name = parts.next().ok_or("give a name, as \"Family, Given; ORCID; affiliation\"")?;
        let name = match name.split_once(',') {
            Some((family, given)) if !given.trim().is_empty() => {
                Name::Person { family: family.trim().to_owned(), given: given.trim().to_owned() }
            }
            _ => Name::Whole(name.trim_end_matches(',').to_owned()),
        };
        let mut author = Self { name, orcid: None, affiliation: None };
        for part in parts {
            let digits = part.strip_prefix("https://orcid.org/").unwrap_or(part);
            if digits.len() == 19 && digits.bytes().filter(|byte| *byte == b'-').count() == 3 {
                author.orcid = Some(orcid(digits)?);
            } else if author.affiliation.is_none() {
                author.affiliation = Some(part.to_owned());
            } else {
                return Err(format!("{part:?} is too much; give name, ORCID and affiliation"));
            }
        }
        Ok(author)
    }
}

/// An ORCID whose last digit is right (ISO 7064, modulus 11-2).
fn orcid(text: &str) -> Result<String, String> {
    let digits: String = text.to_uppercase().replace('-', "");
    let wrong = || format!("{text:?} is no ORCID; copy it anew from orcid.org");
    let (body, last) = digits.split_at_checked(15).ok_or_else(wrong)?;
    let mut total = 0_u32;
    for digit in body.chars() {
        total = (total + digit.to_digit(10).ok_or_else(wrong)?) * 2;
    }
    let check = match (12 - total % 11) % 11 {
        10 => "X".to_owned(),
        digit => digit.to_string(),
    };
    if last == check { Ok(text.to_uppercase()) } else { Err(wrong()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_has_its_parts_and_an_orcid_its_last_digit() {
        let author: Author =
            "Carberry, Josiah; 0000-0002-1825-0097; Brown University".parse().unwrap();
        assert_eq!(
            (author.sorted_name(), author.said_name()),
            ("Carberry, Josiah".into(), "Josiah Carberry".into())
        );
        assert_eq!(author.orcid_address().unwrap(), "https://orcid.org/0000-0002-1825-0097");
        assert_eq!(author.affiliation.as_deref(), Some("Brown University"));
        let group: Author = "The group of faces".parse().unwrap();
        assert_eq!(group.name, Name::Whole("The group of faces".into()));
        assert!("X, Y; 0000-0002-1825-0098".parse::<Author>().unwrap_err().contains("no ORCID"));
        assert_eq!(
            "X, Y; 0000-0002-1694-233x".parse::<Author>().unwrap().orcid.unwrap(),
            "0000-0002-1694-233X"
        );
        assert!(" ; ".parse::<Author>().is_err());
        assert!("X; a; b".parse::<Author>().unwrap_err().contains("too much"));
    }
}
