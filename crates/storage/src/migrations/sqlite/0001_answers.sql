-- Studies, sessions and events. Times are milliseconds since 1970.

CREATE TABLE server_keys (
    name TEXT PRIMARY KEY,
    secret TEXT NOT NULL
) STRICT;

CREATE TABLE studies (
    study_id TEXT PRIMARY KEY,
    config_hash TEXT NOT NULL,
    next_participant INTEGER NOT NULL
) STRICT;

CREATE TABLE study_versions (
    study_id TEXT NOT NULL,
    config_hash TEXT NOT NULL,
    file TEXT NOT NULL,
    clips TEXT NOT NULL,
    first_served_ms INTEGER NOT NULL,
    PRIMARY KEY (study_id, config_hash)
) STRICT;

CREATE TABLE sessions (
    session_key INTEGER PRIMARY KEY AUTOINCREMENT,
    token_hash TEXT NOT NULL UNIQUE,
    study_id TEXT NOT NULL REFERENCES studies,
    participant INTEGER NOT NULL,
    config_hash TEXT NOT NULL,
    seed INTEGER NOT NULL,
    stage TEXT NOT NULL,
    language TEXT NOT NULL,
    client TEXT NOT NULL,
    withdrawal_hash TEXT NOT NULL,
    status TEXT NOT NULL,
    started_ms INTEGER NOT NULL,
    last_event_ms INTEGER,
    ended_ms INTEGER,
    event_count INTEGER NOT NULL,
    next_sequence INTEGER NOT NULL,
    receipt TEXT,
    receipt_events INTEGER,
    UNIQUE (study_id, participant)
) STRICT;

CREATE TABLE events (
    session_key INTEGER NOT NULL REFERENCES sessions,
    sequence INTEGER NOT NULL,
    at_ms REAL NOT NULL,
    received_ms INTEGER NOT NULL,
    body TEXT NOT NULL,
    PRIMARY KEY (session_key, sequence)
) STRICT, WITHOUT ROWID;

-- A second body for a stored sequence: kept, never part of the responses.
CREATE TABLE event_conflicts (
    session_key INTEGER NOT NULL REFERENCES sessions,
    sequence INTEGER NOT NULL,
    digest TEXT NOT NULL,
    at_ms REAL NOT NULL,
    received_ms INTEGER NOT NULL,
    body TEXT NOT NULL,
    PRIMARY KEY (session_key, sequence, digest)
) STRICT, WITHOUT ROWID;

-- Identifiers of the recruitment platform, apart from the answers.
CREATE TABLE recruitment (
    session_key INTEGER NOT NULL REFERENCES sessions,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (session_key, name)
) STRICT, WITHOUT ROWID;

-- Researcher's links (kind 'link') and browser sessions (kind 'browser'), by the hash of their secret.
CREATE TABLE researcher_access (
    secret_hash TEXT PRIMARY KEY,
    kind TEXT NOT NULL,
    expires_ms INTEGER NOT NULL
) STRICT;
