-- What the dashboard counts of a session, of the form that the program gives it: made of the events that
-- counted when there were so many of them and the receipt covered so many (-1: no receipt).
CREATE TABLE session_sums (
    session_key INTEGER PRIMARY KEY REFERENCES sessions,
    form INTEGER NOT NULL,
    event_count INTEGER NOT NULL,
    receipt_events INTEGER NOT NULL,
    sums TEXT NOT NULL
) STRICT;

-- What an account may do in a study, beside what its own role lets it do in all of them ('none': nothing).
CREATE TABLE study_roles (
    account_key INTEGER NOT NULL REFERENCES accounts,
    study_id TEXT NOT NULL,
    role TEXT NOT NULL,
    PRIMARY KEY (account_key, study_id)
) STRICT, WITHOUT ROWID;

-- The study that an invitation is to; empty: to all.
ALTER TABLE account_links ADD COLUMN study_id TEXT NOT NULL DEFAULT '';
