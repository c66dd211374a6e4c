-- Researchers' accounts and what they did. Times are milliseconds since 1970; every secret is kept as
-- its hash.

DROP TABLE researcher_access;

CREATE TABLE accounts (
    account_key BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    email TEXT NOT NULL UNIQUE,
    role TEXT NOT NULL,
    password_hash TEXT NOT NULL,
    created_ms BIGINT NOT NULL,
    disabled_ms BIGINT
);

-- One-time links: purpose 'first-owner', 'invitation', 'reset'.
CREATE TABLE account_links (
    secret_hash TEXT PRIMARY KEY,
    purpose TEXT NOT NULL,
    email TEXT NOT NULL,
    role TEXT NOT NULL,
    expires_ms BIGINT NOT NULL,
    used_ms BIGINT
);

CREATE TABLE account_sessions (
    secret_hash TEXT PRIMARY KEY,
    account_key BIGINT NOT NULL REFERENCES accounts,
    seen_ms BIGINT NOT NULL,
    expires_ms BIGINT NOT NULL
);

CREATE TABLE api_tokens (
    token_key BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    secret_hash TEXT NOT NULL UNIQUE,
    account_key BIGINT NOT NULL REFERENCES accounts,
    name TEXT NOT NULL,
    role TEXT NOT NULL,
    created_ms BIGINT NOT NULL,
    used_ms BIGINT,
    revoked_ms BIGINT
);

-- Attempts to log in, by a keyed hash of the address that was tried.
CREATE TABLE login_attempts (
    subject TEXT NOT NULL,
    at_ms BIGINT NOT NULL
);
CREATE INDEX login_attempts_by_subject ON login_attempts (subject, at_ms);

-- Who did what, when; never an answer.
CREATE TABLE audit_log (
    entry_key BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    at_ms BIGINT NOT NULL,
    who TEXT NOT NULL,
    action TEXT NOT NULL,
    study_id TEXT NOT NULL,
    subject TEXT NOT NULL
);

-- Each exclusion and each taking back of one; the latest counts. No reason: taken back.
CREATE TABLE exclusions (
    exclusion_key BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    session_key BIGINT NOT NULL REFERENCES sessions,
    reason TEXT,
    who TEXT NOT NULL,
    at_ms BIGINT NOT NULL
);
CREATE INDEX exclusions_by_session ON exclusions (session_key, exclusion_key);

-- Studies that came through the page; their files are in study_versions, their packs in the data folder.
CREATE TABLE uploaded_studies (
    study_id TEXT PRIMARY KEY,
    config_hash TEXT NOT NULL,
    archive_hash TEXT NOT NULL,
    stage TEXT NOT NULL,
    changed_ms BIGINT NOT NULL,
    removed_ms BIGINT
);
