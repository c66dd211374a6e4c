-- Studies, sessions and events. Times are milliseconds since 1970.

CREATE TABLE server_keys (
    name TEXT PRIMARY KEY,
    secret TEXT NOT NULL
);

CREATE TABLE studies (
    study_id TEXT PRIMARY KEY,
    config_hash TEXT NOT NULL,
    next_participant BIGINT NOT NULL
);

CREATE TABLE study_versions (
    study_id TEXT NOT NULL,
    config_hash TEXT NOT NULL,
    file TEXT NOT NULL,
    clips TEXT NOT NULL,
    first_served_ms BIGINT NOT NULL,
    PRIMARY KEY (study_id, config_hash)
);

CREATE TABLE sessions (
    session_key BIGINT GENERATED ALWAYS AS IDENTITY PRIMARY KEY,
    token_hash TEXT NOT NULL UNIQUE,
    study_id TEXT NOT NULL REFERENCES studies,
    participant BIGINT NOT NULL,
    config_hash TEXT NOT NULL,
    seed BIGINT NOT NULL,
    stage TEXT NOT NULL,
    language TEXT NOT NULL,
    client TEXT NOT NULL,
    withdrawal_hash TEXT NOT NULL,
    status TEXT NOT NULL,
    started_ms BIGINT NOT NULL,
    last_event_ms BIGINT,
    ended_ms BIGINT,
    event_count BIGINT NOT NULL,
    next_sequence BIGINT NOT NULL,
    receipt TEXT,
    receipt_events BIGINT,
    UNIQUE (study_id, participant)
);

CREATE TABLE events (
    session_key BIGINT NOT NULL REFERENCES sessions,
    sequence BIGINT NOT NULL,
    at_ms DOUBLE PRECISION NOT NULL,
    received_ms BIGINT NOT NULL,
    body TEXT NOT NULL,
    PRIMARY KEY (session_key, sequence)
);

-- A second body for a stored sequence: kept, never part of the responses.
CREATE TABLE event_conflicts (
    session_key BIGINT NOT NULL REFERENCES sessions,
    sequence BIGINT NOT NULL,
    digest TEXT NOT NULL,
    at_ms DOUBLE PRECISION NOT NULL,
    received_ms BIGINT NOT NULL,
    body TEXT NOT NULL,
    PRIMARY KEY (session_key, sequence, digest)
);

-- Identifiers of the recruitment platform, apart from the answers.
CREATE TABLE recruitment (
    session_key BIGINT NOT NULL REFERENCES sessions,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (session_key, name)
);

-- Researcher's links (kind 'link') and browser sessions (kind 'browser'), by the hash of their secret.
CREATE TABLE researcher_access (
    secret_hash TEXT PRIMARY KEY,
    kind TEXT NOT NULL,
    expires_ms BIGINT NOT NULL
);
