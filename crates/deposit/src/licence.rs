//! The licences that a deposit can be given: what they are called by SPDX, by people, and by repositories.

/// A licence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Licence {
    /// Its identifier in the list of SPDX, which Zenodo takes in small letters.
    pub spdx: &'static str,
    /// Its name.
    pub name: &'static str,
    /// Where its text is.
    pub address: &'static str,
    /// What Dataverse calls it, where it is among the licences that installations come with.
    pub dataverse: Option<(&'static str, &'static str)>,
}

const fn licence(
    spdx: &'static str,
    name: &'static str,
    address: &'static str,
    dataverse: Option<(&'static str, &'static str)>,
) -> Licence {
    Licence { spdx, name, address, dataverse }
}

/// What data are put under.
pub const DATA_LICENCES: [Licence; 6] = [
    licence(
        "CC-BY-4.0",
        "Creative Commons Attribution 4.0 International",
        "https://creativecommons.org/licenses/by/4.0/",
        Some(("CC BY 4.0", "http://creativecommons.org/licenses/by/4.0")),
    ),
    licence(
        "CC0-1.0",
        "Creative Commons Zero 1.0 Universal",
        "https://creativecommons.org/publicdomain/zero/1.0/",
        Some(("CC0 1.0", "http://creativecommons.org/publicdomain/zero/1.0")),
    ),
    licence(
        "CC-BY-SA-4.0",
        "Creative Commons Attribution Share Alike 4.0 International",
        "https://creativecommons.org/licenses/by-sa/4.0/",
        Some(("CC BY-SA 4.0", "http://creativecommons.org/licenses/by-sa/4.0")),
    ),
    licence(
        "CC-BY-NC-4.0",
        "Creative Commons Attribution Non Commercial 4.0 International",
        "https://creativecommons.org/licenses/by-nc/4.0/",
        Some(("CC BY-NC 4.0", "http://creativecommons.org/licenses/by-nc/4.0")),
    ),
    licence(
        "ODC-By-1.0",
        "Open Data Commons Attribution License v1.0",
        "https://opendatacommons.org/licenses/by/1-0/",
        None,
    ),
    licence(
        "ODbL-1.0",
        "Open Data Commons Open Database License v1.0",
        "https://opendatacommons.org/licenses/odbl/1-0/",
        None,
    ),
];

/// What the study file and the scripts of the report are put under.
pub const CODE_LICENCES: [Licence; 6] = [
    licence("MIT", "MIT License", "https://spdx.org/licenses/MIT.html", None),
    licence(
        "Apache-2.0",
        "Apache License 2.0",
        "https://www.apache.org/licenses/LICENSE-2.0",
        None,
    ),
    licence(
        "BSD-3-Clause",
        "BSD 3-Clause \"New\" or \"Revised\" License",
        "https://spdx.org/licenses/BSD-3-Clause.html",
        None,
    ),
    licence(
        "CC0-1.0",
        "Creative Commons Zero 1.0 Universal",
        "https://creativecommons.org/publicdomain/zero/1.0/",
        None,
    ),
    licence(
        "CC-BY-4.0",
        "Creative Commons Attribution 4.0 International",
        "https://creativecommons.org/licenses/by/4.0/",
        None,
    ),
    licence(
        "GPL-3.0-or-later",
        "GNU General Public License v3.0 or later",
        "https://www.gnu.org/licenses/gpl-3.0-standalone.html",
        None,
    ),
];

/// The licence of this identifier among some.
///
/// # Errors
/// There is none; the sentence names those that there are.
pub fn licence_named(list: &'static [Licence], spdx: &str) -> Result<&'static Licence, String> {
    list.iter().find(|licence| licence.spdx.eq_ignore_ascii_case(spdx)).ok_or_else(|| {
        let known: Vec<&str> = list.iter().map(|licence| licence.spdx).collect();
        format!("there are {}", known.join(", "))
    })
}
