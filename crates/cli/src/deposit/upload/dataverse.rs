//! Dataverse's native interface (guides.dataverse.org, API guide): a dataset in a collection, each file added with its
//! folder, publication. Tables are not taken apart (`tabIngest`), so that each file stays the one that was sent.

use std::collections::BTreeMap;

use anyhow::{Context as _, anyhow, bail, ensure};
use mimique_deposit::DepositFile;
use mimique_study::percent_encoded;
use serde_json::{Value, json};

use super::http::{Answer, Client, Sent};
use super::state::State;
use super::{Done, Planned, Upload, archive};

/// The requests of an upload.
pub(super) fn plan(upload: &Upload<'_>, collection: &str, dataset: &Value) -> Vec<Planned> {
    let mut planned = vec![
        Planned::new("POST", datasets(collection), "makes a draft, whose persistent id it answers")
            .with(dataset.clone()),
    ];
    for file in upload.files {
        planned.push(Planned::new(
            "POST",
            add("{id}"),
            format!("{} ({} bytes)", file.path, file.bytes),
        ));
    }
    planned.push(Planned::new(
        "GET",
        listed("{id}"),
        "its checksum of each file is held against ours",
    ));
    planned.push(Planned::new("POST", publish("{id}"), "only with --publish"));
    planned
}

/// Uploads a deposit, or goes on with one that was begun.
pub(super) fn upload(
    client: &Client,
    state: &mut State,
    upload: &Upload<'_>,
    collection: &str,
    dataset: &Value,
) -> anyhow::Result<Done> {
    let id = match state.id() {
        Some(id) => id.to_owned(),
        None => {
            let path = datasets(collection);
            let answer = client.making(&path, Sent::Json(dataset), &|| Ok(None))?;
            ensure!(
                answer.status != 404,
                "POST {path}: there is no collection {collection:?}; name one by --collection"
            );
            let id = answer.body["data"]["persistentId"].as_str();
            let id =
                id.context("the answer has no persistent id; look whether this is a Dataverse")?;
            state.keep(id)?;
            id.to_owned()
        }
    };
    let gone = || anyhow!("{id} is not there any more; remove {} to begin another", state.place());
    let before = there(client, &id)?.with_context(gone)?;
    let (mut sent, mut were_there) = (0, 0);
    for file in upload.files {
        match before.get(&file.path) {
            Some(checksum) if checksum.is_of(file, upload)? => were_there += 1,
            Some(_) => bail!(
                "{}: {id} has another file of this path; remove it on the dataset's page and run the command again",
                file.path
            ),
            None => {
                add_file(client, &id, file, upload)?;
                sent += 1;
            }
        }
    }
    let after = there(client, &id)?.with_context(gone)?;
    for file in upload.files {
        let is_same = match after.get(&file.path) {
            Some(checksum) => checksum.is_of(file, upload)?,
            None => false,
        };
        ensure!(
            is_same,
            "{}: what is there is not what was sent; remove it on the dataset's page and run the command again",
            file.path
        );
    }
    let ours = |path: &&String| upload.files.iter().any(|file| file.path == **path);
    if let Some(path) = after.keys().find(|path| !ours(path)) {
        bail!(
            "{path}: it is in the dataset, and not of this deposit; remove it on the dataset's page"
        );
    }
    let address = client.address(&format!("/dataset.xhtml?persistentId={}", percent_encoded(&id)));
    let mut done = Done { address, sent, there: were_there, published: false };
    if upload.publish {
        let is_published = || -> anyhow::Result<Option<Answer>> {
            let path =
                format!("/api/datasets/:persistentId/?persistentId={}", percent_encoded(&id));
            let answer = client.repeatable("GET", &path, Sent::Nothing)?;
            let state = &answer.body["data"]["latestVersion"]["versionState"];
            Ok((state == "RELEASED").then_some(answer))
        };
        if is_published()?.is_none() {
            client.making(&publish(&id), Sent::Nothing, &is_published)?;
        }
        done.published = true;
    }
    Ok(done)
}

/// What a dataset says of a file.
struct Checksum {
    kind: String,
    value: String,
    bytes: Option<u64>,
}

impl Checksum {
    /// Whether it is that of this file. Of kinds that are not known here size alone is compared.
    fn is_of(&self, file: &DepositFile, upload: &Upload<'_>) -> anyhow::Result<bool> {
        Ok(match self.kind.as_str() {
            "MD5" => self.value == archive::md5(&upload.folder.join(&file.path))?,
            "SHA-256" => self.value == file.sha256,
            _ => self.bytes == Some(file.bytes),
        })
    }
}

fn add_file(
    client: &Client,
    id: &str,
    file: &DepositFile,
    upload: &Upload<'_>,
) -> anyhow::Result<()> {
    let (folder, name) = file.path.rsplit_once('/').unwrap_or(("", &file.path));
    let about = json!({ "directoryLabel": folder, "tabIngest": "false", "restrict": "false" });
    let path = upload.folder.join(&file.path);
    let form = Sent::Form { json: &about, name, file: &path };
    // What was stored though its answer was lost is not sent twice.
    let is_made = || -> anyhow::Result<Option<Answer>> {
        let there = there(client, id)?.unwrap_or_default();
        let is_there = there.contains_key(&file.path);
        Ok(is_there.then_some(Answer { status: 200, body: Value::Null }))
    };
    let answer = client.making(&add(id), form, &is_made)?;
    ensure!(answer.status != 404, "{}: {id} is not there any more", file.path);
    Ok(())
}

/// What a dataset has, by path; none where it is not there.
fn there(client: &Client, id: &str) -> anyhow::Result<Option<BTreeMap<String, Checksum>>> {
    let answer = client.repeatable("GET", &listed(id), Sent::Nothing)?;
    if answer.status == 404 {
        return Ok(None);
    }
    let file = |entry: &Value| {
        let label = entry["label"].as_str()?;
        let path = match entry["directoryLabel"].as_str() {
            Some(folder) if !folder.is_empty() => format!("{folder}/{label}"),
            _ => label.to_owned(),
        };
        let data = &entry["dataFile"];
        let text = |value: &Value| value.as_str().map(str::to_owned);
        let of_kind = text(&data["checksum"]["type"]).zip(text(&data["checksum"]["value"]));
        let md5 = || Some(("MD5".to_owned(), text(&data["md5"])?));
        let (kind, value) = of_kind.or_else(md5).unwrap_or_default();
        Some((path, Checksum { kind, value, bytes: data["filesize"].as_u64() }))
    };
    Ok(Some(answer.body["data"].as_array().into_iter().flatten().filter_map(file).collect()))
}

fn datasets(collection: &str) -> String {
    format!("/api/dataverses/{}/datasets", percent_encoded(collection))
}

fn of(id: &str) -> String {
    // A place for the id that is not known yet is left to be read.
    match id {
        "{id}" => format!("persistentId={id}"),
        id => format!("persistentId={}", percent_encoded(id)),
    }
}

fn add(id: &str) -> String {
    format!("/api/datasets/:persistentId/add?{}", of(id))
}

fn listed(id: &str) -> String {
    format!("/api/datasets/:persistentId/versions/:latest/files?{}", of(id))
}

fn publish(id: &str) -> String {
    format!("/api/datasets/:persistentId/actions/:publish?{}&type=major", of(id))
}
