//! The server: pages, packs, answers kept in SQLite or PostgreSQL, export.
//!
//! [`App`] joins studies ([`HostedStudy`]), their packs ([`PackStore`]), the pages ([`Assets`]) and
//! [`Storage`](mimique_storage::Storage); [`router`] is its HTTP interface (the bodies are `mimique_session::wire`), [`serve`]
//! runs it until it is told to stop, [`export`] writes what was answered.
//!
//! What it promises: an append is acknowledged only after its transaction is on disk; sending a
//! request again changes nothing; a participant number is never given twice; tokens, codes and keys
//! are kept as hashes; no address of a participant is stored and no answer is logged.
//!
//! ```
//! use axum::{body::Body, http::Request};
//! use mimique_server::{App, Assets, PackStore, router};
//! use mimique_storage::Storage;
//! use tower::ServiceExt as _;
//!
//! # tokio::runtime::Runtime::new()?.block_on(async {
//! let folder = tempfile::tempdir()?;
//! let pages = folder.path().join("pages");
//! for (part, page) in [("participant", "index.html"), ("style", "style.css")] {
//!     std::fs::create_dir_all(pages.join(part))?;
//!     std::fs::write(pages.join(part).join(page), "")?;
//! }
//! let assets = Assets::from_folder(&pages)?;
//! let url = format!("sqlite:{}", folder.path().join("answers.sqlite").display());
//! let storage = Storage::open(&url).await?;
//! // Studies are checked and prepared before: here there are none.
//! let app = App::new(Vec::new(), PackStore::default(), assets, storage).await?;
//! let asked = Request::get("/healthz").body(Body::empty())?;
//! let answer = router(app).oneshot(asked).await?;
//! assert_eq!(answer.status(), 200);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! # })?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod accounts;
mod clock;
mod comparison;
mod connections;
mod error;
pub mod export;
mod files;
mod hosting;
mod http;
mod panic_hook;
mod participant;
mod researcher;
mod retention;
mod secret;
mod serve;
mod state;
mod studio;
mod uploads;

pub use accounts::links::reset_link;
pub use files::assets::{Assets, AssetsError, EmbeddedFile};
pub use files::packs::{PackError, PackStore};
pub use hosting::{Hosting, prepare_hosting};
pub use http::router;
pub use panic_hook::log_panics;
pub use participant::first_page::first_page;
pub use participant::withdrawal::withdrawal_hash;
pub use researcher::dashboard::session_sums::FORM as SUMS_FORM;
pub use researcher::pages::replay::player::player as replay_player;
pub use researcher::pages::replay::words::script_words as replay_words;
pub use retention::{ClockDoubt, Sweep, Swept, clock_doubt, confirm_clock, sweep_overdue};
pub use serve::{ServeError, serve};
pub use state::App;
pub use state::access::Access;
pub use state::hosted_study::{HostedStudy, Stage};
pub use state::network::{Network, NetworkError};
pub use state::settings::Settings;
pub use state::start_error::AppError;
pub use state::web_address::{folder_address, origin, server_address};
pub use studio::{StudioFile, StudioFiles, StudioRole};
pub use uploads::{ZIP_START, is_archive, unpack_study};
