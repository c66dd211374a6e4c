-- A session is found by the withdrawal code alone.

CREATE INDEX sessions_by_withdrawal ON sessions (withdrawal_hash);

-- Why an event cannot be one of its session (`mimique_session::Misfit`): kept as it came, in no table.
ALTER TABLE events ADD COLUMN misfit TEXT;

-- The lowest sequence that is not stored: what a page has to send next.
ALTER TABLE sessions ADD COLUMN first_gap INTEGER NOT NULL DEFAULT 0;

UPDATE sessions SET first_gap = next_sequence WHERE event_count = next_sequence;
UPDATE sessions SET first_gap = (
    SELECT MIN(e.sequence) + 1 FROM events e WHERE e.session_key = sessions.session_key
    AND NOT EXISTS (SELECT 1 FROM events n
        WHERE n.session_key = e.session_key AND n.sequence = e.sequence + 1))
WHERE event_count <> next_sequence AND EXISTS (
    SELECT 1 FROM events e WHERE e.session_key = sessions.session_key AND e.sequence = 0);

-- Since when the answers are known to be over their time: they are deleted when the grace is over.
ALTER TABLE sessions ADD COLUMN overdue_ms INTEGER;

-- Times that the server has seen, to know a clock that has jumped: 'seen' is the latest that was
-- believed, 'passed over' the newest event that an owner has said not to go by.
CREATE TABLE clock_marks (
    name TEXT PRIMARY KEY,
    at_ms INTEGER NOT NULL
) STRICT;

-- What a researcher wrote about somebody goes with their answers.
DELETE FROM exclusions WHERE session_key IN
    (SELECT session_key FROM sessions WHERE deleted_ms IS NOT NULL);

-- Characters of all that is kept of a session's events: it is bounded by what its study can give.
ALTER TABLE sessions ADD COLUMN stored_bytes INTEGER NOT NULL DEFAULT 0;

UPDATE sessions SET stored_bytes = COALESCE(
    (SELECT SUM(LENGTH(e.body)) FROM events e WHERE e.session_key = sessions.session_key), 0);

-- How far preparing an uploaded study is, for every server on this database: 'under' way or
-- 'ended'; what is to be said of it is JSON.
CREATE TABLE preparations (
    study_id TEXT PRIMARY KEY,
    state TEXT NOT NULL,
    notes TEXT NOT NULL,
    changed_ms INTEGER NOT NULL
) STRICT;
