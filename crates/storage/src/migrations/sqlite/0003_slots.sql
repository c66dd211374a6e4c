-- The place in the balance of conditions (slot): counts those who finish; who drops out gives it
-- back. Marks that tell a second participation. Times are milliseconds since 1970.

-- Sessions of before: their order was drawn by the participant number, so that is their slot.
ALTER TABLE sessions ADD COLUMN slot INTEGER NOT NULL DEFAULT 0;
-- Kept until then unless a sign of life comes; NULL: kept for good, or given to somebody else.
ALTER TABLE sessions ADD COLUMN slot_expires_ms INTEGER;
ALTER TABLE sessions ADD COLUMN slot_lasts_ms INTEGER NOT NULL DEFAULT 3600000;
-- 1 when somebody else has the slot now.
ALTER TABLE sessions ADD COLUMN slot_given INTEGER NOT NULL DEFAULT 0;
-- 1 when the participant came to the end, not merely to a refusal.
ALTER TABLE sessions ADD COLUMN finished INTEGER NOT NULL DEFAULT 0;
ALTER TABLE sessions ADD COLUMN identifiers_erased_ms INTEGER;

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
    session_key INTEGER NOT NULL REFERENCES sessions,
    PRIMARY KEY (study_id, stage, mark)
) STRICT, WITHOUT ROWID;
CREATE INDEX repeat_marks_by_session ON repeat_marks (session_key);
