//! The bill of materials of a package, in CycloneDX 1.5: what it is made of, with licences, checksums and who needs
//! whom. cargo-cyclonedx writes a file into each crate's folder and knows neither the union of program and pages nor
//! the npm package's share; `cargo metadata` does.

use anyhow::{Context, Result};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::dependencies::Components;
use super::facts::{LICENCE, PUBLISHER, REPOSITORY, VERSION};
use super::licences::canonical;

/// The bill of a package called `name` on `target`; the same bytes for the same components.
pub fn cyclonedx(name: &str, target: &str, components: &Components) -> Result<String> {
    let reference = format!("{name}@{VERSION}?target={target}");
    let mut listed = Vec::new();
    let mut dependencies = vec![json!({
        "ref": reference,
        "dependsOn": components.keys().collect::<Vec<_>>(),
    })];
    for (key, component) in components {
        let mut entry = json!({
            "type": "library",
            "bom-ref": key,
            "name": component.name,
            "version": component.version,
            "purl": key,
            "licenses": [{ "expression": canonical(&component.licence).with_context(|| key.clone())? }],
        });
        if let Some(checksum) = &component.checksum {
            entry["hashes"] = json!([{ "alg": "SHA-256", "content": checksum }]);
        }
        if let Some(repository) = &component.repository {
            entry["externalReferences"] = json!([{ "type": "vcs", "url": repository }]);
        }
        listed.push(entry);
        dependencies.push(json!({ "ref": key, "dependsOn": component.depends }));
    }
    let mut bill = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {
            "component": {
                "type": "application",
                "bom-ref": reference,
                "supplier": { "name": PUBLISHER },
                "name": name,
                "version": VERSION,
                "licenses": [{ "expression": LICENCE }],
                "externalReferences": [{ "type": "vcs", "url": REPOSITORY }],
            },
            "properties": [{ "name": "mimique:target", "value": target }],
        },
        "components": listed,
        "dependencies": dependencies,
    });
    bill["serialNumber"] = Value::from(serial_number(&bill));
    Ok(format!("{}\n", serde_json::to_string_pretty(&bill)?))
}

/// A UUID (version 8) of the content.
fn serial_number(bill: &Value) -> String {
    let mut bytes = [0; 16];
    bytes.copy_from_slice(&Sha256::digest(bill.to_string())[..16]);
    bytes[6] = bytes[6] & 0x0f | 0x80;
    bytes[8] = bytes[8] & 0x3f | 0x80;
    let text = hex::encode(bytes);
    format!(
        "urn:uuid:{}-{}-{}-{}-{}",
        &text[..8],
        &text[8..12],
        &text[12..16],
        &text[16..20],
        &text[20..]
    )
}

#[cfg(test)]
mod tests {
    use super::super::dependencies::{Component, key};
    use super::*;

    #[test]
    fn a_bill_names_versions_licences_and_who_needs_whom() {
        let component = |name: &str, licence: &str, depends: &[&str]| {
            let depends = depends.iter().map(|name| key(name, "1.0.0")).collect();
            let version = "1.0.0".to_owned();
            (
                key(name, "1.0.0"),
                Component {
                    name: name.into(),
                    version,
                    licence: licence.into(),
                    depends,
                    ..Component::default()
                },
            )
        };
        let components = Components::from([
            component("a", "MIT/Apache-2.0", &["b"]),
            component("b", "Zlib", &[]),
        ]);
        let text = cyclonedx("mimique", "somewhere", &components).unwrap();
        assert_eq!(text, cyclonedx("mimique", "somewhere", &components).unwrap());
        let bill: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(bill["metadata"]["component"]["version"], VERSION);
        assert_eq!(bill["components"][0]["purl"], "pkg:cargo/a@1.0.0");
        assert_eq!(bill["components"][0]["licenses"][0]["expression"], "MIT OR Apache-2.0");
        assert_eq!(bill["dependencies"][1]["dependsOn"][0], "pkg:cargo/b@1.0.0");
        let serial = bill["serialNumber"].as_str().unwrap();
        assert!(serial.starts_with("urn:uuid:") && serial.len() == 45, "{serial}");
        let refused =
            cyclonedx("mimique", "somewhere", &Components::from([component("c", "mine", &[])]))
                .unwrap_err();
        assert!(format!("{refused:#}").contains("pkg:cargo/c@1.0.0"), "{refused:#}");
    }
}
