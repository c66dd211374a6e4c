//! The container image, made from nothing but the static program: no base image, no container engine, no network.
//!
//! One archive per processor is an OCI image layout (`podman load`, `skopeo copy oci-archive:`) and has the
//! `manifest.json` by which `docker load` reads it, too.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::Program;
use super::check::{self, Placed, answer};
use super::contents::{DEMO, readme_and_demo};
use super::facts::{LICENCE, NAME, REPOSITORY, SUMMARY, VERSION};
use super::files::{self, File, Folder};
use super::target::Runner;
use crate::process::output;
use crate::tally::Tried;

const MANIFEST: &str = "application/vnd.oci.image.manifest.v1+json";
/// User and group of the program, as docs/guide/deployment has them.
const USER: u64 = 10001;
const DATA: &str = "var/lib/mimique";

/// Writes the image of a program.
pub fn make(program: &Program, out: &Path) -> Result<PathBuf> {
    let architecture = program.target.architecture.context("images are of Linux alone")?;
    let path = out.join(format!("{NAME}-{VERSION}-image-{architecture}.tar"));
    let layer = files::tar(&folders(), &whole(program)?)?;
    std::fs::write(&path, files::tar(&[], &layout(architecture, &layer)?)?)
        .with_context(|| path.display().to_string())?;
    Ok(path)
}

/// What an engine calls the image.
fn tag() -> String {
    format!("{NAME}:{VERSION}")
}

/// Folders that the program writes into.
fn folders() -> [Folder; 2] {
    [
        Folder { name: "tmp", mode: 0o1777, owner: 0 },
        Folder { name: DATA, mode: 0o755, owner: USER },
    ]
}

/// The files of the image's only layer.
fn whole(program: &Program) -> Result<Vec<File>> {
    let users = format!("root:x:0:0::/:/none\n{NAME}:x:{USER}:{USER}::/{DATA}:/none\n");
    let groups = format!("root:x:0:\n{NAME}:x:{USER}:\n");
    let mut whole = vec![
        File::text("etc/passwd", users),
        File::text("etc/group", groups),
        File::program(format!("usr/local/bin/{NAME}"), program.bytes.clone()),
    ];
    whole.extend(readme_and_demo()?.into_iter().map(|file| file.within("usr/share/mimique")));
    whole
        .extend(program.terms.files().into_iter().map(|file| file.within("usr/share/doc/mimique")));
    Ok(whole)
}

/// The files of the image's archive: blobs by their hashes, and what leads to them.
fn layout(architecture: &str, layer: &[u8]) -> Result<Vec<File>> {
    let mut blobs: BTreeMap<String, Vec<u8>> = BTreeMap::new();
    let mut blob = |media_type: &str, bytes: Vec<u8>| {
        let digest = hex::encode(Sha256::digest(&bytes));
        let descriptor = json!({ "mediaType": media_type, "digest": format!("sha256:{digest}"), "size": bytes.len() });
        blobs.insert(format!("blobs/sha256/{digest}"), bytes);
        descriptor
    };
    let packed = blob("application/vnd.oci.image.layer.v1.tar+gzip", files::gzip(layer)?);
    let configuration = blob(
        "application/vnd.oci.image.config.v1+json",
        serde_json::to_vec(&configuration(architecture, layer))?,
    );
    let manifest = json!({
        "schemaVersion": 2,
        "mediaType": MANIFEST,
        "config": configuration,
        "layers": [packed],
    });
    let mut listed = blob(MANIFEST, serde_json::to_vec(&manifest)?);
    listed["platform"] = json!({ "os": "linux", "architecture": architecture });
    listed["annotations"] = json!({ "org.opencontainers.image.ref.name": tag() });
    let index = json!({
        "schemaVersion": 2,
        "mediaType": "application/vnd.oci.image.index.v1+json",
        "manifests": [listed],
    });
    let place =
        |descriptor: &Value| descriptor["digest"].as_str().unwrap_or_default().replace(':', "/");
    let for_docker = json!([{
        "Config": format!("blobs/{}", place(&configuration)),
        "RepoTags": [tag()],
        "Layers": [format!("blobs/{}", place(&packed))],
    }]);
    let mut whole = vec![
        File::text("oci-layout", r#"{"imageLayoutVersion":"1.0.0"}"#),
        File::text("index.json", serde_json::to_vec(&index)?),
        File::text("manifest.json", serde_json::to_vec(&for_docker)?),
    ];
    whole.extend(blobs.into_iter().map(|(name, bytes)| File::text(name, bytes)));
    Ok(whole)
}

fn configuration(architecture: &str, layer: &[u8]) -> Value {
    json!({
        "architecture": architecture,
        "os": "linux",
        "config": {
            "User": format!("{USER}:{USER}"),
            "WorkingDir": format!("/{DATA}"),
            "Entrypoint": [format!("/usr/local/bin/{NAME}")],
            "Cmd": ["serve", "--help"],
            "ExposedPorts": { "8080/tcp": {} },
            "Volumes": { format!("/{DATA}"): {} },
            "Labels": {
                "org.opencontainers.image.title": NAME,
                "org.opencontainers.image.description": SUMMARY,
                "org.opencontainers.image.version": VERSION,
                "org.opencontainers.image.licenses": LICENCE,
                "org.opencontainers.image.source": REPOSITORY,
            },
        },
        "rootfs": { "type": "layers", "diff_ids": [format!("sha256:{}", hex::encode(Sha256::digest(layer)))] },
        "history": [{ "created_by": "cargo xtask package" }],
    })
}

/// Holds every blob against its hash, unpacks the layer and runs the program in it as in a container, with nothing
/// else around it; and by podman or docker where one answers.
pub fn check(program: &Program, image: &Path, work: &Path) -> Result<Tried> {
    let unpacked = work.join("image");
    std::fs::create_dir_all(&unpacked)?;
    answer(Command::new("tar").arg("-xf").arg(image).current_dir(&unpacked))?;
    for file in files::below(&unpacked.join("blobs/sha256"))? {
        ensure!(
            hex::encode(Sha256::digest(&file.bytes)) == file.name,
            "{}: a blob of another hash",
            file.name
        );
    }
    let list: Value = serde_json::from_slice(&files::read(&unpacked.join("manifest.json"))?)?;
    let layer = list[0]["Layers"][0].as_str().context("manifest.json: no layer")?;
    let system = work.join("system");
    std::fs::create_dir_all(&system)?;
    let mut unpack = Command::new("tar");
    // The owners of the layer are nobody here.
    unpack.args(["--no-same-owner", "-xzf"]).arg(unpacked.join(layer));
    answer(unpack.current_dir(&system))?;
    let path = system.join("usr/local/bin").join(NAME);
    let ran = check::placed(&Placed {
        program,
        path: &path,
        study: &system.join("usr/share/mimique").join(DEMO),
    })?;
    if !matches!(program.target.runner(), Runner::Directly) {
        return Ok(ran);
    }
    alone(&system)?;
    by_engine(image)
}

/// Runs the program with the layer as the root of all files.
fn alone(system: &Path) -> Result<()> {
    let start = || {
        // Without rights of its own, a user has them in a namespace of its own.
        let mut command = Command::new("unshare");
        command
            .args(["--user", "--map-root-user", "chroot"])
            .arg(system)
            .arg(format!("/usr/local/bin/{NAME}"));
        Ok(command)
    };
    let study = format!("/usr/share/mimique/{DEMO}");
    check::says_version_and_checks(&start, &study)?;
    check::serves(&mut start()?, &study, &format!("/{DATA}"))
}

fn by_engine(image: &Path) -> Result<Tried> {
    let engine = ["podman", "docker"]
        .into_iter()
        .find(|engine| output(Command::new(engine).arg("info")).is_some());
    let Some(engine) = engine else {
        return Ok(Tried::InPart(
            "run with its layer as the root of all files; neither podman nor docker answers here"
                .into(),
        ));
    };
    let said = answer(Command::new(engine).args(["load", "--input"]).arg(image))?;
    let name = said.trim().rsplit(": ").next().unwrap_or_default().to_owned();
    let start = || {
        let mut command = Command::new(engine);
        command.args(["run", "--rm", "--network", "none", &name]);
        Ok(command)
    };
    let first = start()?.arg("--version").output().with_context(|| engine.to_owned())?;
    // What engines answer where they themselves fail, not the program.
    let is_of_engine = matches!(first.status.code(), Some(125 | 126));
    let study = format!("/usr/share/mimique/{DEMO}");
    let ran = if is_of_engine { Ok(()) } else { check::says_version_and_checks(&start, &study) };
    answer(Command::new(engine).args(["rmi", "--force", &name]))?;
    ran?;
    ensure!(name.ends_with(&tag()), "{engine} has loaded {name} instead of {}", tag());
    if is_of_engine {
        return Ok(Tried::InPart(format!(
            "run with its layer as the root of all files, and loaded by {engine}, which starts no container here: {}",
            String::from_utf8_lossy(&first.stderr).trim()
        )));
    }
    Ok(Tried::Done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_descriptor_leads_to_its_blob() {
        let layer = files::tar(&folders(), &[File::text("etc/passwd", "root")]).unwrap();
        let whole = layout("arm64", &layer).unwrap();
        let blob = |descriptor: &Value| {
            let name =
                format!("blobs/{}", descriptor["digest"].as_str().unwrap().replace(':', "/"));
            let file = whole.iter().find(|file| file.name == name).unwrap();
            assert_eq!(descriptor["size"], file.bytes.len());
            file.bytes.clone()
        };
        let json = |bytes: &[u8]| serde_json::from_slice::<Value>(bytes).unwrap();
        let file = |name: &str| json(&whole.iter().find(|file| file.name == name).unwrap().bytes);
        let listed = &file("index.json")["manifests"][0];
        assert_eq!(listed["platform"]["architecture"], "arm64");
        let manifest = json(&blob(listed));
        let configuration = json(&blob(&manifest["config"]));
        assert_eq!(configuration["config"]["User"], "10001:10001");
        let digest = format!("sha256:{}", hex::encode(Sha256::digest(&layer)));
        assert_eq!(configuration["rootfs"]["diff_ids"][0], digest.as_str());
        assert_eq!(blob(&manifest["layers"][0]), files::gzip(&layer).unwrap());
        let for_docker = file("manifest.json");
        assert_eq!(for_docker[0]["RepoTags"][0], format!("mimique:{VERSION}"));
    }
}
