-- What was measured of the clips of a version of a study: a JSON list.
ALTER TABLE study_versions ADD COLUMN measures TEXT NOT NULL DEFAULT '[]';
