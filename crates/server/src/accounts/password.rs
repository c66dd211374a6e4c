//! Passwords: argon2id with OWASP's parameters (19 MiB, two passes, one lane), off the threads that
//! answer requests, and few at a time so that many log-ins cannot take the memory.

use argon2::password_hash::phc::PasswordHash;
use argon2::{Argon2, PasswordHasher, PasswordVerifier};
use tokio::sync::Semaphore;

use super::identity::Researcher;
use crate::clock::now_ms;
use crate::error::Error;
use crate::state::App;

/// Characters of a password at least (NIST SP 800-63B asks for 8 beside a second factor, 15 without).
pub(crate) const SHORTEST_PASSWORD: usize = 12;
/// Bytes of a password at most: longer ones only cost time.
const LONGEST_PASSWORD: usize = 1024;
/// Passwords worked at together: 19 MiB each.
const AT_ONCE: usize = 2;
/// Passwords that may wait for their turn; beyond it people are asked to come back.
const MOST_WAITING: usize = 64;

static TURNS: Semaphore = Semaphore::const_new(AT_ONCE);
static QUEUE: Semaphore = Semaphore::const_new(MOST_WAITING);

/// A hash that no password has: verified where there is no account, so that an unknown address takes
/// as long as a wrong password.
const NOBODY: &str = "$argon2id$v=19$m=19456,t=2,p=1$AAAAAAAAAAAAAAAAAAAAAA\
     $AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA";

/// Why a password cannot be taken, if it cannot.
pub(super) fn check_length(password: &str) -> Result<(), Error> {
    if password.chars().count() < SHORTEST_PASSWORD {
        return Err(Error::ShortPassword { least: SHORTEST_PASSWORD });
    }
    if password.len() > LONGEST_PASSWORD {
        return Err(Error::LongPassword);
    }
    Ok(())
}

/// The hash to keep.
pub(super) async fn hash(password: &str) -> Result<String, Error> {
    let mut salt = [0; 16];
    getrandom::fill(&mut salt).map_err(Error::internal)?;
    let password = password.as_bytes().to_vec();
    in_turn(move || hash_now(&password, &salt)).await?
}

/// Whether the password is the one of this hash; without a hash as long, and false.
pub(super) async fn verify(password: &str, hash: Option<&str>) -> Result<bool, Error> {
    // A longer one was never taken; its length is no secret.
    let password = password.as_bytes().get(..LONGEST_PASSWORD + 1).unwrap_or(password.as_bytes());
    let password = password.to_vec();
    let known = hash.is_some();
    let hash = hash.unwrap_or(NOBODY).to_owned();
    let same = in_turn(move || Argon2::default().verify_password(&password, hash.as_str()).is_ok());
    Ok(same.await? && known)
}

/// Changes the password of one who knows the old one; every other session of
/// theirs ends, and every token.
pub(crate) async fn change_password(
    app: &App,
    who: &Researcher,
    old: &str,
    new: &str,
) -> Result<(), Error> {
    check_length(new)?;
    let session = who.session().ok_or(Error::NotAllowed)?;
    super::login::throttle_session(app, session).await?;
    if !verify(old, Some(&who.account.password_hash)).await? {
        return Err(Error::WrongOldPassword);
    }
    let hash = hash(new).await?;
    app.storage.set_password(who.account.key, &hash, session, now_ms()).await?;
    Ok(())
}

async fn in_turn<T: Send + 'static>(work: impl FnOnce() -> T + Send + 'static) -> Result<T, Error> {
    let _place = QUEUE.try_acquire().map_err(|_| Error::TooManyAttempts)?;
    let closed = |_| Error::internal("the queue of passwords is closed");
    let _turn = TURNS.acquire().await.map_err(closed)?;
    tokio::task::spawn_blocking(work).await.map_err(Error::internal)
}

fn hash_now(password: &[u8], salt: &[u8]) -> Result<String, Error> {
    let hash: Result<PasswordHash, _> = Argon2::default().hash_password_with_salt(password, salt);
    hash.map(|hash| hash.to_string()).map_err(Error::internal)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_password_is_known_by_its_hash_alone() {
        let kept = hash("correct horse battery").await.unwrap();
        assert!(kept.starts_with("$argon2id$v=19$m=19456,t=2,p=1$"), "{kept}");
        assert!(verify("correct horse battery", Some(&kept)).await.unwrap());
        assert!(!verify("correct horse batterY", Some(&kept)).await.unwrap());
        assert_ne!(kept, hash("correct horse battery").await.unwrap(), "every hash is salted");
        // Nobody's hash is worked at like any other, and opens nothing.
        assert!(PasswordHash::new(NOBODY).is_ok());
        assert!(!verify("nobody", None).await.unwrap());
        assert!(check_length("elevenchars").is_err());
        assert!(check_length("twelve chars").is_ok());
    }
}
