//! `/assets` and `/packs`: files that never change under their address.

use axum::extract::{Path, State};
use axum::http::HeaderMap;
use axum::response::Response;

use crate::error::Error;
use crate::state::App;

pub(crate) async fn asset(
    State(app): State<App>,
    Path((hash, name)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    app.assets.get(&hash, &name).ok_or(Error::NotFound)?.respond(&headers)
}

pub(crate) async fn pack(
    State(app): State<App>,
    Path(name): Path<String>,
    headers: HeaderMap,
) -> Result<Response, Error> {
    app.catalogue.pack(&name).ok_or(Error::UnknownPack)?.respond(&headers)
}
