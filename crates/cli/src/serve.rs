//! `mimique serve`: hosts studies: questionnaire, preview and researcher's page.
//!
//! Every study is checked and its stimuli are prepared before the first connection is taken; all
//! problems of all studies are said at once.

use std::io::Write as _;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use indicatif::{ProgressBar, ProgressStyle};
use mimique_locale::counted;
use mimique_server::{
    Access, App, Assets, EmbeddedFile, HostedStudy, Hosting, Network, PackStore, Settings, Stage,
    folder_address, log_panics, origin, prepare_hosting, server_address,
};
use mimique_stimulus::Places;
use mimique_storage::{Storage, durable_file};
use mimique_study::{MEDIA_PREFIX, RepeatPrevention, Severity};
use serde_json::json;
use tokio::net::TcpListener;

use crate::check::check_file;
use crate::study_file::in_data_folder;

/// Options.
#[derive(clap::Args)]
pub struct Args {
    /// Study files to host, or ZIP archives of their folders
    #[arg(required = true)]
    studies: Vec<PathBuf>,
    /// Address and port to listen on
    #[arg(long, default_value = "127.0.0.1:8080")]
    listen: SocketAddr,
    /// Where answers are kept: sqlite:FILE or postgres://USER@HOST/NAME
    /// [default: sqlite:DATA_DIR/answers.sqlite]
    #[arg(long)]
    database: Option<String>,
    /// Folder for answers and prepared stimuli
    #[arg(long, default_value = "mimique-data")]
    data_dir: PathBuf,
    /// Folder of the pages, instead of those inside the binary
    #[arg(long)]
    web_dir: Option<PathBuf>,
    /// Address as people type it, e.g. `https://faces.example.org`, where a proxy stands before the
    /// server; https implies --behind-tls
    #[arg(long, value_parser = server_address)]
    public_url: Option<String>,
    /// Let everybody see the previews and the list of studies, not only researchers
    #[arg(long)]
    open_preview: bool,
    /// Mark the answers as those of a pilot
    #[arg(long)]
    pilot: bool,
    /// People come by https://, through a proxy that ends TLS: browsers are told to insist on it,
    /// cookies are marked Secure, links begin with https
    #[arg(long)]
    behind_tls: bool,
    /// A proxy stands in front and names the caller in X-Real-IP (used to bound the rate of requests,
    /// never stored)
    #[arg(long)]
    behind_proxy: bool,
    /// With --behind-proxy: address or network of a proxy on another machine (10.0.0.0/8); X-Real-IP of
    /// others is not believed. May be given several times
    #[arg(long, requires = "behind_proxy")]
    proxy: Vec<Network>,
    /// Address under which browsers find packs by their hash, instead of here:
    /// `https://cdn.example.org/packs`
    #[arg(long, value_parser = folder_address)]
    packs_url: Option<String>,
    /// Origin of a page that may embed the participants' pages in a frame: `https://survey.example.org`. May be given
    /// several times; without it none may
    #[arg(long, value_name = "ORIGIN", value_parser = origin)]
    allow_embedding: Vec<String>,
    /// Token with which /metrics may be read from elsewhere than this machine; better given by the
    /// variable MIMIQUE_METRICS_TOKEN
    #[arg(long)]
    metrics_token: Option<String>,
    /// Connections at once; further ones wait
    #[arg(long, default_value_t = Settings::default().most_connections)]
    most_connections: usize,
    /// Connections of one address at once; further ones are closed
    #[arg(long, default_value_t = Settings::default().connections_per_address)]
    connections_per_address: usize,
    /// Sessions that begin from one address in a minute; further pages wait
    #[arg(long, default_value_t = Settings::default().starts_per_minute)]
    starts_per_minute: u32,
    /// Requests a second from one address in the long run; ten times as many at once
    #[arg(long, default_value_t = Settings::default().requests_per_second)]
    requests_per_second: u32,
}

impl Args {
    fn settings(&self) -> anyhow::Result<Settings> {
        if let Some(url) = self.public_url.as_ref().filter(|url| url.starts_with("http://")) {
            anyhow::ensure!(
                !self.behind_tls,
                "--public-url: {url}: not encrypted, and --behind-tls says that it is; write https://…"
            );
        }
        let from_environment = || std::env::var("MIMIQUE_METRICS_TOKEN").ok();
        Ok(Settings {
            behind_tls: self.behind_tls,
            behind_proxy: self.behind_proxy,
            proxies: self.proxy.clone(),
            packs_address: self.packs_url.clone(),
            embedding: self.allow_embedding.clone(),
            metrics_token: self.metrics_token.clone().or_else(from_environment),
            most_connections: self.most_connections,
            connections_per_address: self.connections_per_address,
            requests_per_second: self.requests_per_second,
            starts_per_minute: self.starts_per_minute,
            ..Settings::default()
        })
    }
}

/// Runs the command.
pub fn run(args: Args, pages: &[EmbeddedFile], json: bool) -> anyhow::Result<()> {
    tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_target(false)
        .with_max_level(tracing::Level::INFO)
        .init();
    log_panics();
    let settings = args.settings()?;
    let assets = crate::pages::assets(args.web_dir.as_deref(), pages)?;
    let cannot_listen =
        || format!("{}: cannot listen there; choose another address by --listen", args.listen);
    // A port that is taken is said before the stimuli are prepared.
    drop(std::net::TcpListener::bind(args.listen).with_context(cannot_listen)?);
    durable_file::private_folder(&args.data_dir).with_context(|| {
        format!("{}: cannot be made; choose another folder by --data-dir", args.data_dir.display())
    })?;
    let packs_folder = args.data_dir.join("packs");
    let stage = if args.pilot { Stage::Pilot } else { Stage::Live };
    let files: Vec<PathBuf> = (args.studies.iter())
        .map(|given| in_data_folder(given, &args.data_dir))
        .collect::<anyhow::Result<_>>()?;
    let studies = load_studies(&files, &packs_folder, stage)?;
    let mut packs = PackStore::default();
    for clip in studies.iter().flat_map(|study| study.bundle().clips.values()) {
        for hash in clip.packs() {
            packs.load(&packs_folder, hash)?;
        }
    }
    let runtime = tokio::runtime::Runtime::new().context("the server's threads")?;
    runtime.block_on(host(args, settings, studies, packs, assets, json))
}

async fn host(
    args: Args,
    settings: Settings,
    studies: Vec<HostedStudy>,
    mut packs: PackStore,
    assets: Assets,
    json: bool,
) -> anyhow::Result<()> {
    let database = match &args.database {
        Some(url) => url.clone(),
        None => format!("sqlite:{}", args.data_dir.join("answers.sqlite").display()),
    };
    let listener = TcpListener::bind(args.listen).await.with_context(|| {
        format!("{}: cannot listen there; choose another address by --listen", args.listen)
    })?;
    let storage =
        Storage::open(&database).await.with_context(|| Storage::without_password(&database))?;
    packs.load_earlier_versions(&storage, &args.data_dir.join("packs")).await?;
    if let Some(study) = studies.iter().find(|study| is_repeatable_in_a_frame(study, &args)) {
        eprintln!(
            "warning: study {}: repeatPrevention \"browser\" does nothing in a frame of another site without https; \
             give --public-url https://… or --behind-tls",
            study.id()
        );
    }
    let hosted: Vec<Hosted> = studies.iter().map(Hosted::of).collect();
    let kind = storage.kind();
    let access = Access {
        open_preview: args.open_preview,
        public_url: args.public_url.clone(),
        studio_alone: false,
    };
    let app = App::new(studies, packs, assets, storage)
        .await?
        .with_access(access)
        .with_data_folder(args.data_dir.clone())
        .with_settings(settings);
    app.host_uploads().await?;
    let base = app.base_address(reachable(listener.local_addr()?));
    // Without an account there is a link that makes the first.
    let first_link = app.first_owner_link().await?;
    let researcher = format!("{base}{}", first_link.as_deref().unwrap_or("/researcher"));
    let version = |id: &str| app.registered(id).map_or(1, |facts| facts.version);
    let mut out = std::io::stdout().lock();
    if json {
        let studies: Vec<_> =
            hosted.iter().map(|study| study.as_json(&base, version(&study.id))).collect();
        let line = json!({
            "url": base, "studies": studies, "researcher": researcher, "database": kind,
        });
        writeln!(out, "{line}")?;
    } else {
        for study in &hosted {
            study.print(&mut out, &base, version(&study.id))?;
        }
        writeln!(out, "researcher      {researcher}")?;
        if first_link.is_some() {
            writeln!(out, "                (makes the first account; works once, for two days)")?;
        }
        writeln!(out, "Answers are kept in {kind}. Stop with Ctrl-C.")?;
    }
    out.flush()?;
    drop(out);
    mimique_server::serve(app, listener, stop_signal()).await?;
    Ok(())
}

/// Whether a study that takes each browser once may be embedded by pages of other sites without encryption: browsers
/// then send no cookie from the frame, so that none is recognised.
fn is_repeatable_in_a_frame(study: &HostedStudy, args: &Args) -> bool {
    let is_public = args.public_url.as_ref().is_some_and(|url| url.starts_with("https://"));
    let is_marked = study.study().recruitment.repeat_prevention == RepeatPrevention::Browser;
    is_marked && !args.allow_embedding.is_empty() && !args.behind_tls && !is_public
}

/// A study that is hosted, as it is told at the start.
struct Hosted {
    id: String,
    config_hash: String,
    clips: usize,
}

impl Hosted {
    fn of(study: &HostedStudy) -> Self {
        let clips = study.bundle().clips.keys().filter(|id| !id.starts_with(MEDIA_PREFIX));
        Self {
            id: study.id().to_owned(),
            config_hash: study.config_hash().to_owned(),
            clips: clips.count(),
        }
    }

    fn as_json(&self, base: &str, version: u64) -> serde_json::Value {
        let Self { id, config_hash, clips } = self;
        json!({
            "id": id,
            "config_hash": config_hash,
            "version": version,
            "clips": clips,
            "participant": format!("{base}/s/{id}/"),
            "preview": format!("{base}/preview/{id}"),
        })
    }

    fn print(
        &self,
        out: &mut impl std::io::Write,
        base: &str,
        version: u64,
    ) -> std::io::Result<()> {
        let Self { id, config_hash, clips } = self;
        let clips = counted(*clips, "clip");
        writeln!(out, "study {id} ({clips}, version {version}, {})", &config_hash[..12])?;
        writeln!(out, "  participants  {base}/s/{id}/")?;
        writeln!(out, "  preview       {base}/preview/{id}")
    }
}

/// Checks and prepares every study; what is wrong with any of them is said before giving up.
fn load_studies(files: &[PathBuf], packs: &Path, stage: Stage) -> anyhow::Result<Vec<HostedStudy>> {
    let mut studies = Vec::new();
    let mut problems = Vec::new();
    for file in files {
        let report = check_file(file)?;
        for issue in &report.issues {
            let place = issue.place();
            let text =
                format!("{}: {place}: {}; {}", file.display(), issue.message(), issue.remedy());
            match issue.severity {
                Severity::Error => problems.push(text),
                Severity::Warning => eprintln!("warning: {text}"),
            }
        }
        let Some(checked) = report.study else { continue };
        match prepare_study(file, checked.study(), packs) {
            Ok(hosting) => {
                let study = HostedStudy::new(checked.value().clone(), hosting.clips, stage)?
                    .with_measures(hosting.measures);
                studies.push(study.with_places(Places::of(file, packs)));
            }
            Err(faults) => problems.extend(faults),
        }
    }
    anyhow::ensure!(problems.is_empty(), "{}", problems.join("\nerror: "));
    Ok(studies)
}

pub fn prepare_study(
    file: &Path,
    study: &mimique_study::Study,
    packs: &Path,
) -> Result<Hosting, Vec<String>> {
    // Hidden where no terminal is.
    let bar = ProgressBar::new(0);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg}") {
        bar.set_style(style);
    }
    let prepared = prepare_hosting(study, &Places::of(file, packs), &mut |progress| {
        bar.set_length(progress.total as u64);
        bar.set_position(progress.done as u64);
        bar.set_message(format!("preparing {}", progress.what));
    });
    bar.finish_and_clear();
    let named = |fault| format!("{}: {fault}", file.display());
    let prepared = prepared.map_err(|faults| faults.into_iter().map(named).collect::<Vec<_>>())?;
    for (pointer, text) in &prepared.warnings {
        eprintln!("warning: {}: {pointer}: {text}", file.display());
    }
    Ok(prepared)
}

/// An address that a browser on this machine can open.
pub(crate) fn reachable(mut address: SocketAddr) -> SocketAddr {
    if address.ip().is_unspecified() {
        address.set_ip(match address {
            SocketAddr::V4(_) => std::net::Ipv4Addr::LOCALHOST.into(),
            SocketAddr::V6(_) => std::net::Ipv6Addr::LOCALHOST.into(),
        });
    }
    address
}

/// Resolves at Ctrl-C, or when the system asks the process to end.
pub(crate) async fn stop_signal() {
    let interrupted = async {
        if tokio::signal::ctrl_c().await.is_err() {
            std::future::pending::<()>().await;
        }
    };
    #[cfg(unix)]
    let terminated = async {
        match tokio::signal::unix::signal(tokio::signal::unix::SignalKind::terminate()) {
            Ok(mut signal) => drop(signal.recv().await),
            Err(_) => std::future::pending().await,
        }
    };
    #[cfg(not(unix))]
    let terminated = std::future::pending::<()>();
    tokio::select! {
        () = interrupted => {}
        () = terminated => {}
    }
    tracing::info!("stopping: requests in progress end first");
}
