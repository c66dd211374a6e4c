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
