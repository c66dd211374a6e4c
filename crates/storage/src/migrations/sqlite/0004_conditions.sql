-- Conditions between participants: which one a session is in; empty in a study without. Each has slots
-- of its own.

ALTER TABLE sessions ADD COLUMN assigned_condition TEXT NOT NULL DEFAULT '';

DROP INDEX sessions_by_slot;
DROP INDEX sessions_by_expiry;
CREATE INDEX sessions_by_slot
    ON sessions (study_id, config_hash, stage, assigned_condition, slot);
CREATE INDEX sessions_by_expiry
    ON sessions (study_id, config_hash, stage, assigned_condition, slot_expires_ms);
