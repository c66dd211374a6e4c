//! Zenodo's deposit interface (developers.zenodo.org): a deposition, files put into its bucket, metadata, publication. The
//! folder goes as one archive; what people read first stands beside it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail, ensure};
use mimique_deposit::zenodo_metadata;
use mimique_study::percent_encoded;
use serde_json::{Value, json};
use tempfile::NamedTempFile;

use super::http::{Client, Sent};
use super::state::State;
use super::{Done, Planned, Upload, archive};

const DEPOSITIONS: &str = "/api/deposit/depositions";

/// Files that stand beside the archive, to be read without it.
const BESIDE: [&str; 4] =
    ["README.md", "CITATION.cff", "ro-crate-metadata.json", "manifest-sha256.txt"];

/// The requests of an upload.
pub(super) fn plan(upload: &Upload<'_>) -> Vec<Planned> {
    let mut planned = vec![
        Planned::new("POST", DEPOSITIONS, "makes a draft, whose id and bucket it answers")
            .with(json!({})),
    ];
    let archive = archive_name(upload);
    let whole = format!("the whole folder, {} files", upload.files.len());
    planned.push(Planned::new(
        "PUT",
        format!("/api/files/{{bucket}}/{}", percent_encoded(&archive)),
        whole,
    ));
    for name in BESIDE {
        let bytes = upload.files.iter().find(|file| file.path == name).map_or(0, |file| file.bytes);
        planned.push(Planned::new(
            "PUT",
            format!("/api/files/{{bucket}}/{name}"),
            format!("{bytes} bytes"),
        ));
    }
    planned.push(
        Planned::new("PUT", format!("{DEPOSITIONS}/{{id}}"), "metadata")
            .with(zenodo_metadata(upload.about)),
    );
    planned.push(Planned::new(
        "GET",
        format!("{DEPOSITIONS}/{{id}}/files"),
        "its MD5 of each file is held against ours",
    ));
    planned.push(Planned::new(
        "POST",
        format!("{DEPOSITIONS}/{{id}}/actions/publish"),
        "only with --publish",
    ));
    planned
}

/// Uploads a deposit, or goes on with one that was begun.
pub(super) fn upload(
    client: &Client,
    state: &mut State,
    upload: &Upload<'_>,
) -> anyhow::Result<Done> {
    let deposition = deposition(client, state)?;
    let id = id_of(&deposition)?;
    let own = format!("{DEPOSITIONS}/{id}");
    let page = deposition["links"]["html"].as_str().unwrap_or(&own).to_owned();
    let published = deposition["submitted"] == true;
    let bucket = bucket(client, &deposition)?;

    let name = archive_name(upload);
    let mut archive = NamedTempFile::new().context("a file for the archive")?;
    archive::zip(
        upload.folder,
        upload.files,
        name.trim_end_matches(".zip"),
        archive.as_file_mut(),
    )?;
    let mut wanted: Vec<(String, PathBuf)> = vec![(name, archive.path().to_owned())];
    wanted.extend(BESIDE.map(|name| (name.to_owned(), upload.folder.join(name))));

    let before = there(client, &own)?;
    let (mut sent, mut were_there) = (0, 0);
    for (name, path) in &wanted {
        let md5 = archive::md5(path)?;
        if before.get(name) == Some(&md5) {
            were_there += 1;
            continue;
        }
        ensure!(
            !published,
            "{id} is published, and {name} has changed since: make a new version of it on its page, {page}"
        );
        put(client, &bucket, name, path, &md5)?;
        sent += 1;
    }
    if !published {
        let metadata = zenodo_metadata(upload.about);
        let answer = client.repeatable("PUT", &own, Sent::Json(&metadata))?;
        ensure!(answer.status != 404, gone(state, &id));
    }
    compare(&there(client, &own)?, &wanted)?;
    let mut done = Done { address: page, sent, there: were_there, published };
    if upload.publish && !published {
        let is_published = || {
            let answer = client.repeatable("GET", &own, Sent::Nothing)?;
            Ok((answer.body["submitted"] == true).then_some(answer))
        };
        let answer =
            client.making(&format!("{own}/actions/publish"), Sent::Nothing, &is_published)?;
        let links = &answer.body["links"];
        let record = links["record_html"].as_str().or(links["html"].as_str());
        done.address = record.map_or(done.address, str::to_owned);
        done.published = true;
    }
    Ok(done)
}

/// The deposition that was begun, or a new one.
fn deposition(client: &Client, state: &mut State) -> anyhow::Result<Value> {
    if let Some(id) = state.id().map(str::to_owned) {
        let answer = client.repeatable("GET", &format!("{DEPOSITIONS}/{id}"), Sent::Nothing)?;
        ensure!(answer.status != 404, gone(state, &id));
        return Ok(answer.body);
    }
    let answer = client.making(DEPOSITIONS, Sent::Json(&json!({})), &|| Ok(None))?;
    ensure!(answer.status != 404, "POST {DEPOSITIONS}: 404; this is no Zenodo: correct --host");
    state.keep(&id_of(&answer.body)?)?;
    Ok(answer.body)
}

fn gone(state: &State, id: &str) -> anyhow::Error {
    anyhow!("{id} is not there any more; remove {} to begin another", state.place())
}

fn id_of(deposition: &Value) -> anyhow::Result<String> {
    let id = &deposition["id"];
    let id = id.as_u64().map(|id| id.to_string()).or(id.as_str().map(str::to_owned));
    id.context("the answer has no id of the deposition; look whether this is a Zenodo")
}

/// Where files are put: an address of the same host, since the token goes along.
fn bucket(client: &Client, deposition: &Value) -> anyhow::Result<String> {
    let address = deposition["links"]["bucket"].as_str();
    let address =
        address.context("the answer has no bucket for files; look whether this is a Zenodo")?;
    match client.path_of(address) {
        Some(path) => Ok(path.to_owned()),
        None => bail!("files would go to {address}, which is another host: nothing is sent there"),
    }
}

fn put(client: &Client, bucket: &str, name: &str, path: &Path, md5: &str) -> anyhow::Result<()> {
    let to = format!("{bucket}/{}", percent_encoded(name));
    let answer = client.repeatable("PUT", &to, Sent::File(path))?;
    ensure!(answer.status != 404, "PUT {to}: 404; the draft is not there any more");
    let told = answer.body["checksum"].as_str().map(plain);
    ensure!(
        told == Some(md5),
        "{name}: MD5 {} arrived where {md5} was sent; run the command again",
        told.unwrap_or("(none)")
    );
    Ok(())
}

/// What the draft has: MD5 by name.
fn there(client: &Client, own: &str) -> anyhow::Result<BTreeMap<String, String>> {
    let answer = client.repeatable("GET", &format!("{own}/files"), Sent::Nothing)?;
    let files = answer.body.as_array().into_iter().flatten();
    Ok(files
        .filter_map(|file| {
            let name = file["filename"].as_str()?.to_owned();
            Some((name, plain(file["checksum"].as_str()?).to_owned()))
        })
        .collect())
}

/// Whether all that was wanted is there, and nothing else.
fn compare(there: &BTreeMap<String, String>, wanted: &[(String, PathBuf)]) -> anyhow::Result<()> {
    for (name, path) in wanted {
        let md5 = archive::md5(path)?;
        let told = there.get(name).map_or("(none)", String::as_str);
        ensure!(
            told == md5,
            "{name}: MD5 {told} is there where {md5} was sent; run the command again"
        );
    }
    let more = there.keys().find(|name| !wanted.iter().any(|(own, _)| own == *name));
    match more {
        Some(name) => bail!(
            "{name}: it is in the draft, and not of this deposit; remove it on the draft's page"
        ),
        None => Ok(()),
    }
}

/// A checksum without the name of its kind.
fn plain(checksum: &str) -> &str {
    checksum.strip_prefix("md5:").unwrap_or(checksum)
}

fn archive_name(upload: &Upload<'_>) -> String {
    format!("{}.zip", upload.about.study)
}
