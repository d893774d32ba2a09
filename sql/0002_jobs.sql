-- SPDX-License-Identifier: GPL-3.0-or-later
-- Optimization jobs: what was asked for, how far it came, and what it gave.
CREATE TABLE job (
  id               INTEGER PRIMARY KEY AUTOINCREMENT,
  problem          INTEGER NOT NULL REFERENCES problem (id) ON DELETE CASCADE,
  study            TEXT NOT NULL CHECK (length(study) = 64), -- hash of the design: equal studies take equal paths
  space            TEXT NOT NULL CHECK (length(space) = 64), -- hash of the variables and their bounds
  design           TEXT NOT NULL CHECK (json_valid(design)), -- every default resolved
  name             TEXT NOT NULL,
  algorithm        TEXT NOT NULL,
  fresh            INTEGER NOT NULL CHECK (fresh IN (0, 1)), -- 1: the algorithm knew no earlier rows
  import_upto      INTEGER NOT NULL CHECK (import_upto >= 0),-- evaluations that were there when it began
  state            TEXT NOT NULL CHECK (state IN ('queued', 'running', 'cancelled', 'done', 'failed')),
  stopped          TEXT NOT NULL DEFAULT '',
  true_evaluations INTEGER NOT NULL DEFAULT 0 CHECK (true_evaluations >= 0),
  individuals      INTEGER NOT NULL DEFAULT 0 CHECK (individuals >= true_evaluations),
  best             INTEGER REFERENCES evaluation (id) ON DELETE SET NULL,
  best_value       REAL,
  result           TEXT CHECK (result IS NULL OR json_valid(result)),
  created          TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  updated          TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))
) STRICT;
CREATE INDEX job_study ON job (study);

-- The true evaluations a job asked for, in its order. x: doubles in the unit cube, little endian.
CREATE TABLE candidate (
  job        INTEGER NOT NULL REFERENCES job (id) ON DELETE CASCADE,
  ordinal    INTEGER NOT NULL CHECK (ordinal >= 0),
  generation INTEGER NOT NULL,
  individual INTEGER NOT NULL,
  evaluation INTEGER NOT NULL REFERENCES evaluation (id) ON DELETE CASCADE,
  reused     INTEGER NOT NULL CHECK (reused IN (0, 1)),      -- 1: known before the job asked
  x          BLOB NOT NULL CHECK (length(x) % 8 = 0),
  PRIMARY KEY (job, ordinal)
) STRICT, WITHOUT ROWID;
CREATE INDEX candidate_evaluation ON candidate (evaluation);

-- Individuals whose fitness was predicted: an audit that may be pruned.
CREATE TABLE prediction (
  job         INTEGER NOT NULL REFERENCES job (id) ON DELETE CASCADE,
  generation  INTEGER NOT NULL,
  individual  INTEGER NOT NULL,
  fitness     REAL NOT NULL,
  credibility REAL NOT NULL,
  x           BLOB NOT NULL CHECK (length(x) % 8 = 0),
  PRIMARY KEY (job, generation, individual)
) STRICT, WITHOUT ROWID;
