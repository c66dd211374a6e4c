//! Researchers' accounts: who asks, what they may do, and that a form is their own.
//!
//! A person has a password (argon2id) and a session a browser: a random secret in a cookie that
//! scripts cannot read, kept as its hash in the database so that any server on it knows the session.
//! A script has a token in `Authorization: Bearer`. A form counts only with the token that its page
//! was given and from a page of this server. What is done is written to the log, never an answer.

pub(crate) mod audit;
pub(crate) mod csrf;
pub(crate) mod email;
pub(crate) mod identity;
pub(crate) mod links;
pub(crate) mod login;
pub(crate) mod password;
