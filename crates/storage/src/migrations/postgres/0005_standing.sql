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
