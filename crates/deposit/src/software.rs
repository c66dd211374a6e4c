//! The software that asked, kept and computed: its version, how to get it, and what it is made of, as Cargo's lock file has
//! it, in CycloneDX 1.5.

use serde::Deserialize;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use crate::about::{SOFTWARE_LICENCE, SOFTWARE_REPOSITORY, SOFTWARE_VERSION};
use crate::file::{DepositFile, NotWritten, json_bytes};

/// Its folder in the deposit.
pub const FOLDER: &str = "software";

/// What this program was compiled from: every crate with its version and the SHA-256 of its archive.
const LOCK: &str = include_str!("../../../Cargo.lock");

#[derive(Deserialize)]
struct Lock {
    package: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    /// None of the workspace's own.
    source: Option<String>,
    checksum: Option<String>,
}

/// README, bill of materials, lock file.
pub(crate) fn files() -> Result<Vec<DepositFile>, NotWritten> {
    Ok(vec![
        DepositFile::made(format!("{FOLDER}/README.md"), readme().into_bytes()),
        DepositFile::made(format!("{FOLDER}/sbom.cdx.json"), json_bytes(&bill()?)?),
        DepositFile::made(format!("{FOLDER}/Cargo.lock"), LOCK.as_bytes().to_vec()),
    ])
}

/// The bill of materials: every crate of the lock file, those of tests and of the pages too.
fn bill() -> Result<Value, toml::de::Error> {
    let lock: Lock = toml::from_str(LOCK)?;
    let of_others = lock.package.iter().filter(|package| package.source.is_some());
    let components: Vec<Value> = of_others
        .map(|package| {
            let key = format!("pkg:cargo/{}@{}", package.name, package.version);
            let mut entry = json!({
                "type": "library",
                "bom-ref": key,
                "name": package.name,
                "version": package.version,
                "purl": key,
            });
            if let Some(checksum) = &package.checksum {
                entry["hashes"] = json!([{ "alg": "SHA-256", "content": checksum }]);
            }
            entry
        })
        .collect();
    let digest = Sha256::digest(LOCK.as_bytes());
    let mut id = [0; 16];
    id.copy_from_slice(&digest[..16]);
    // A UUID of version 8, of what is listed.
    id[6] = id[6] & 0x0f | 0x80;
    id[8] = id[8] & 0x3f | 0x80;
    let id = hex::encode(id);
    let parts = [&id[..8], &id[8..12], &id[12..16], &id[16..20], &id[20..]];
    Ok(json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "serialNumber": format!("urn:uuid:{}", parts.join("-")),
        "version": 1,
        "metadata": {
            "component": {
                "type": "application",
                "bom-ref": format!("mimique@{SOFTWARE_VERSION}"),
                "name": "mimique",
                "version": SOFTWARE_VERSION,
                "licenses": [{ "expression": SOFTWARE_LICENCE }],
                "externalReferences": [{ "type": "vcs", "url": SOFTWARE_REPOSITORY }],
            },
        },
        "components": components,
    }))
}

fn readme() -> String {
    format!(
        "# The software\n\n\
         The study was asked, kept and analysed by Mimique {SOFTWARE_VERSION} ({SOFTWARE_LICENCE}), which is developed at\n\
         {SOFTWARE_REPOSITORY}.\n\n\
         To get this version:\n\n```sh\npip install mimique=={SOFTWARE_VERSION}\n```\n\n\
         or its archive for your system from {SOFTWARE_REPOSITORY}/releases, or from source:\n\n```sh\n\
         git clone {SOFTWARE_REPOSITORY}\ncd mimique\ngit checkout v{SOFTWARE_VERSION}\ncargo xtask demo --no-serve\n```\n\n\
         `Cargo.lock` names every crate that it is compiled from, with the SHA-256 of its archive; `sbom.cdx.json` says the\n\
         same as CycloneDX 1.5.\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bill_names_every_crate_of_others_with_its_hash() {
        let bill = bill().unwrap();
        let components = bill["components"].as_array().unwrap();
        assert_eq!(components.len(), LOCK.matches("\nsource = ").count());
        let serde = components.iter().find(|own| own["name"] == "serde").unwrap();
        assert_eq!(serde["hashes"][0]["content"].as_str().unwrap().len(), 64);
        assert!(components.iter().all(|own| own["name"] != "mimique"));
        let serial = bill["serialNumber"].as_str().unwrap();
        assert!(serial.starts_with("urn:uuid:") && serial.len() == 45, "{serial}");
    }
}
