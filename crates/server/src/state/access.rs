//! How the server is reached and what is open without an account.

/// How the server is reached and what is open without an account.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Access {
    /// Previews and the list of studies are for everybody, as in the demonstration.
    pub open_preview: bool,
    /// The address that people type, e.g. `https://faces.example.org`, where a proxy stands before
    /// the server. `https` says the same as [`crate::Settings`]' `behind_tls`.
    pub public_url: Option<String>,
    /// The studio alone, on its user's own machine: it is the first page, and whoever reaches it may have a study
    /// hosted that it has made, to see the preview.
    pub studio_alone: bool,
}
