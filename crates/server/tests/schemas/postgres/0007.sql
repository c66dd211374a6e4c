-- A database as version 7 of the schema left it: five participants of one study. Never changed.

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

-- The place in the balance of conditions (slot): counts those who finish; who drops out gives it
-- back. Marks that tell a second participation. Times are milliseconds since 1970.

-- Sessions of before: their order was drawn by the participant number, so that is their slot.
ALTER TABLE sessions ADD COLUMN slot BIGINT NOT NULL DEFAULT 0;
-- Kept until then unless a sign of life comes; NULL: kept for good, or given to somebody else.
ALTER TABLE sessions ADD COLUMN slot_expires_ms BIGINT;
ALTER TABLE sessions ADD COLUMN slot_lasts_ms BIGINT NOT NULL DEFAULT 3600000;
-- 1 when somebody else has the slot now.
ALTER TABLE sessions ADD COLUMN slot_given BIGINT NOT NULL DEFAULT 0;
-- 1 when the participant came to the end, not merely to a refusal.
ALTER TABLE sessions ADD COLUMN finished BIGINT NOT NULL DEFAULT 0;
ALTER TABLE sessions ADD COLUMN identifiers_erased_ms BIGINT;

UPDATE sessions SET slot = participant;
UPDATE sessions SET finished = 1 WHERE status = 'completed' AND EXISTS (
    SELECT 1 FROM events WHERE events.session_key = sessions.session_key
    AND events.body LIKE '%"type":"finished"%');

CREATE INDEX sessions_by_slot ON sessions (study_id, config_hash, stage, slot);
CREATE INDEX sessions_by_expiry ON sessions (study_id, config_hash, stage, slot_expires_ms);

-- Keyed hashes of a recruitment identifier or of a browser's mark.
CREATE TABLE repeat_marks (
    study_id TEXT NOT NULL REFERENCES studies,
    stage TEXT NOT NULL,
    mark TEXT NOT NULL,
    session_key BIGINT NOT NULL REFERENCES sessions,
    PRIMARY KEY (study_id, stage, mark)
);
CREATE INDEX repeat_marks_by_session ON repeat_marks (session_key);

-- Conditions between participants: which one a session is in; empty in a study without. Each has slots
-- of its own.

ALTER TABLE sessions ADD COLUMN assigned_condition TEXT NOT NULL DEFAULT '';

DROP INDEX sessions_by_slot;
DROP INDEX sessions_by_expiry;
CREATE INDEX sessions_by_slot
    ON sessions (study_id, config_hash, stage, assigned_condition, slot);
CREATE INDEX sessions_by_expiry
    ON sessions (study_id, config_hash, stage, assigned_condition, slot_expires_ms);

CREATE TABLE schema_migrations (version BIGINT PRIMARY KEY);
INSERT INTO schema_migrations (version) VALUES (1);
INSERT INTO schema_migrations (version) VALUES (2);
INSERT INTO schema_migrations (version) VALUES (3);
INSERT INTO schema_migrations (version) VALUES (4);
INSERT INTO server_keys (name, secret) VALUES ('tokens', 'k1'), ('receipts', 'k2');
INSERT INTO studies (study_id, config_hash, next_participant) VALUES ('faces', 'c1', 6);
INSERT INTO study_versions (study_id, config_hash, file, clips, first_served_ms) VALUES ('faces', 'c1', '{}', '{}', 1700000000000);
INSERT INTO sessions (session_key, token_hash, study_id, participant, config_hash, seed, stage, language, client, withdrawal_hash, status, started_ms, last_event_ms, ended_ms, event_count, next_sequence, receipt, receipt_events, slot, slot_expires_ms, slot_lasts_ms, slot_given, finished, identifiers_erased_ms, assigned_condition) OVERRIDING SYSTEM VALUE
VALUES (11, '254c714ad1de6ac2a58b995585803f03da548f8716b02db1911b214223532d26', 'faces', 1, 'c1', -7, 'live', 'fr', '{"browser":"Firefox"}', '7081ddeead677749c7f2bd687fa6eaddc6f5009d797ebe4942e6a2424461ff8d', 'completed', 1700000000000, 1700000000500, 1700000000900, 3, 3, 'receipt-1', 3, 1, NULL, 3600000, 0, 1, NULL, 'plain');
INSERT INTO sessions (session_key, token_hash, study_id, participant, config_hash, seed, stage, language, client, withdrawal_hash, status, started_ms, last_event_ms, ended_ms, event_count, next_sequence, receipt, receipt_events, slot, slot_expires_ms, slot_lasts_ms, slot_given, finished, identifiers_erased_ms, assigned_condition) OVERRIDING SYSTEM VALUE
VALUES (12, '04cf1e890f970fac4d4b4977d544278894fb3026b6319c32666966bf7717b219', 'faces', 2, 'c1', -7, 'live', 'fr', '{"browser":"Firefox"}', 'e30ef9c2d867517f6fc1383d62c401cb31c12e5d9c910b44d93aa560da2fe615', 'started', 1700000000000, 1700000000600, NULL, 2, 2, NULL, NULL, 2, 1700003600600, 3600000, 0, 0, NULL, 'named');
INSERT INTO sessions (session_key, token_hash, study_id, participant, config_hash, seed, stage, language, client, withdrawal_hash, status, started_ms, last_event_ms, ended_ms, event_count, next_sequence, receipt, receipt_events, slot, slot_expires_ms, slot_lasts_ms, slot_given, finished, identifiers_erased_ms, assigned_condition) OVERRIDING SYSTEM VALUE
VALUES (13, '0e93ef25c9fb2553425a36c7ca395cc8c33446ee1e7f0d0f05df3db2954ae77f', 'faces', 3, 'c1', -7, 'live', 'fr', '{"browser":"Firefox"}', '6298421d9f6c448aaf7fd177079d67a669cefa4c8a0d76138b3327c57f362ea4', 'withdrawn', 1700000000000, NULL, 1700000000700, 0, 0, NULL, NULL, 3, NULL, 3600000, 1, 0, NULL, 'plain');
INSERT INTO sessions (session_key, token_hash, study_id, participant, config_hash, seed, stage, language, client, withdrawal_hash, status, started_ms, last_event_ms, ended_ms, event_count, next_sequence, receipt, receipt_events, slot, slot_expires_ms, slot_lasts_ms, slot_given, finished, identifiers_erased_ms, assigned_condition) OVERRIDING SYSTEM VALUE
VALUES (14, '21739c76445a0fac0423a72de7daef6731d8a5e9859b5a707c390244f67fdafa', 'faces', 4, 'c1', -7, 'live', 'fr', '{"browser":"Firefox"}', '5ec8155bcd8e98674ab654a85b29dc09d6cae9a2d2f70735a4d340a75fde6884', 'completed', 1700000000000, 1700000000500, 1700000000900, 1, 1, 'receipt-4', 1, 4, NULL, 3600000, 1, 0, 1700000001000, 'named');
INSERT INTO sessions (session_key, token_hash, study_id, participant, config_hash, seed, stage, language, client, withdrawal_hash, status, started_ms, last_event_ms, ended_ms, event_count, next_sequence, receipt, receipt_events, slot, slot_expires_ms, slot_lasts_ms, slot_given, finished, identifiers_erased_ms, assigned_condition) OVERRIDING SYSTEM VALUE
VALUES (15, '730c945f6b0db3eac44bd3148e2d633807eef1f14211a2f67f3afa04fcd08ce4', 'faces', 5, 'c1', -7, 'live', 'fr', '{"browser":"Firefox"}', '41d5090baaf687b5a3a2f8e4c2ed608673393fb68a2885d3ca76a9f97f67011d', 'started', 1700000000000, 1700000000600, NULL, 0, 0, NULL, NULL, 3, 1700003600600, 3600000, 0, 0, NULL, 'plain');
INSERT INTO events (session_key, sequence, at_ms, received_ms, body) VALUES (11, 0, 1700000000123.25, 1700000000400, '{"type":"opened","note":"é \u0000 \"finished\""}');
INSERT INTO events (session_key, sequence, at_ms, received_ms, body) VALUES (11, 1, 1700000000123.1, 1700000000400, '{"answer":0.1,"type":"answered"}');
INSERT INTO events (session_key, sequence, at_ms, received_ms, body) VALUES (11, 2, 0.3333333333333333, 1700000000400, '{"type":"finished"}');
INSERT INTO events (session_key, sequence, at_ms, received_ms, body) VALUES (12, 0, 1, 1700000000400, '{"type":"opened"}');
INSERT INTO events (session_key, sequence, at_ms, received_ms, body) VALUES (12, 1, 2, 1700000000400, '{"note":"\"type\":\"finished\"","type":"answered"}');
INSERT INTO events (session_key, sequence, at_ms, received_ms, body) VALUES (14, 0, 1, 1700000000400, '{"type":"declined"}');
INSERT INTO event_conflicts (session_key, sequence, digest, at_ms, received_ms, body) VALUES (11, 1, '2d711642b726b04401627ca9fbac32f5c8530fb1903cc4db02258717921a4881', 5.5, 1700000000450, '{"type":"answered"}');
INSERT INTO recruitment (session_key, name, value) VALUES (11, 'PROLIFIC_PID', 'abc'), (12, 'PROLIFIC_PID', 'def');
INSERT INTO repeat_marks (study_id, stage, mark, session_key) VALUES ('faces', 'live', '62c66a7a5dd70c3146618063c344e531e6d4b59e379808443ce962b3abd63c5a', 12);
SELECT setval(pg_get_serial_sequence('sessions', 'session_key'), 16, false);

-- How a session stands, in one vocabulary and by its events: active, completed, declined, device_refused,
-- screened_out, practice_failed, failed_checks, withdrawn. When its answers were deleted stands apart.

ALTER TABLE sessions ADD COLUMN deleted_ms BIGINT;

UPDATE sessions SET deleted_ms = COALESCE(ended_ms, started_ms)
WHERE status IN ('withdrawn', 'erased');

-- The first event that ends a session counts; who takes everything back does so at any time; who has
-- agreed or gone on can no longer decline. Of answers that were deleted only `finished` is known.
UPDATE sessions SET status = CASE
    WHEN status = 'withdrawn' OR EXISTS (
        SELECT 1 FROM events e WHERE e.session_key = sessions.session_key
        AND e.body LIKE '%"type":"withdrawn"}') THEN 'withdrawn'
    WHEN status = 'erased' AND finished = 1 THEN 'completed'
    ELSE COALESCE((
        SELECT CASE
            WHEN e.body LIKE '%"type":"finished"}' THEN 'completed'
            WHEN e.body LIKE '%"type":"declined"}' THEN 'declined'
            WHEN e.body LIKE '%"type":"checks_failed"}' THEN 'failed_checks'
            WHEN e.body LIKE '%"reason":"device"%' THEN 'device_refused'
            WHEN e.body LIKE '%"reason":"training"%' THEN 'practice_failed'
            ELSE 'screened_out' END
        FROM events e WHERE e.session_key = sessions.session_key AND (
            e.body LIKE '%"type":"finished"}'
            OR e.body LIKE '%"type":"checks_failed"}'
            OR e.body LIKE '%"type":"screened_out"}'
            OR (e.body LIKE '%"type":"declined"}' AND NOT EXISTS (
                SELECT 1 FROM events b WHERE b.session_key = e.session_key
                AND b.sequence < e.sequence
                AND (b.body LIKE '%"type":"consented"%' OR b.body LIKE '%"type":"page_finished"}'
                    OR b.body LIKE '%"type":"trial_finished"}'))))
        ORDER BY e.sequence LIMIT 1), 'active') END;

ALTER TABLE sessions DROP COLUMN finished;
INSERT INTO schema_migrations (version) VALUES (5);
-- A session is found by the withdrawal code alone.

CREATE INDEX sessions_by_withdrawal ON sessions (withdrawal_hash);

-- Why an event cannot be one of its session (`mimique_session::Misfit`): kept as it came, in no table.
ALTER TABLE events ADD COLUMN misfit TEXT;

-- The lowest sequence that is not stored: what a page has to send next.
ALTER TABLE sessions ADD COLUMN first_gap BIGINT NOT NULL DEFAULT 0;

UPDATE sessions SET first_gap = next_sequence WHERE event_count = next_sequence;
UPDATE sessions SET first_gap = (
    SELECT MIN(e.sequence) + 1 FROM events e WHERE e.session_key = sessions.session_key
    AND NOT EXISTS (SELECT 1 FROM events n
        WHERE n.session_key = e.session_key AND n.sequence = e.sequence + 1))
WHERE event_count <> next_sequence AND EXISTS (
    SELECT 1 FROM events e WHERE e.session_key = sessions.session_key AND e.sequence = 0);

-- Since when the answers are known to be over their time: they are deleted when the grace is over.
ALTER TABLE sessions ADD COLUMN overdue_ms BIGINT;

-- Times that the server has seen, to know a clock that has jumped: 'seen' is the latest that was
-- believed, 'passed over' the newest event that an owner has said not to go by.
CREATE TABLE clock_marks (
    name TEXT PRIMARY KEY,
    at_ms BIGINT NOT NULL
);

-- What a researcher wrote about somebody goes with their answers.
DELETE FROM exclusions WHERE session_key IN
    (SELECT session_key FROM sessions WHERE deleted_ms IS NOT NULL);

-- Characters of all that is kept of a session's events: it is bounded by what its study can give.
ALTER TABLE sessions ADD COLUMN stored_bytes BIGINT NOT NULL DEFAULT 0;

UPDATE sessions SET stored_bytes = COALESCE(
    (SELECT SUM(LENGTH(e.body)) FROM events e WHERE e.session_key = sessions.session_key), 0);

-- How far preparing an uploaded study is, for every server on this database: 'under' way or
-- 'ended'; what is to be said of it is JSON.
CREATE TABLE preparations (
    study_id TEXT PRIMARY KEY,
    state TEXT NOT NULL,
    notes TEXT NOT NULL,
    changed_ms BIGINT NOT NULL
);
INSERT INTO schema_migrations (version) VALUES (6);
-- What the dashboard counts of a session, of the form that the program gives it: made of the events that
-- counted when there were so many of them and the receipt covered so many (-1: no receipt).
CREATE TABLE session_sums (
    session_key BIGINT PRIMARY KEY REFERENCES sessions,
    form BIGINT NOT NULL,
    event_count BIGINT NOT NULL,
    receipt_events BIGINT NOT NULL,
    sums TEXT NOT NULL
);

-- What an account may do in a study, beside what its own role lets it do in all of them ('none': nothing).
CREATE TABLE study_roles (
    account_key BIGINT NOT NULL REFERENCES accounts,
    study_id TEXT NOT NULL,
    role TEXT NOT NULL,
    PRIMARY KEY (account_key, study_id)
);

-- The study that an invitation is to; empty: to all.
ALTER TABLE account_links ADD COLUMN study_id TEXT NOT NULL DEFAULT '';

INSERT INTO accounts (email, role, password_hash, created_ms)
VALUES ('analyst@example.org', 'none', 'no password', 1);
INSERT INTO study_roles (account_key, study_id, role)
SELECT MIN(account_key), 'faces', 'analyst' FROM accounts;
INSERT INTO session_sums (session_key, form, event_count, receipt_events, sums)
SELECT session_key, 1, event_count, receipt_events, '{"progress":[1,2]}' FROM sessions
WHERE receipt_events IS NOT NULL AND participant = 1;
INSERT INTO schema_migrations (version) VALUES (7);
