-- SPDX-License-Identifier: GPL-3.0-or-later
-- Stored designs, and jobs as the server's queue knows them.
CREATE TABLE design (
  id       INTEGER PRIMARY KEY AUTOINCREMENT,
  revision INTEGER NOT NULL DEFAULT 1 CHECK (revision > 0),
  name     TEXT NOT NULL,
  document TEXT NOT NULL CHECK (json_valid(document)),
  created  TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  updated  TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))
) STRICT;

-- The same job table with more states, and what is known only once a job begins allowed to be missing.
CREATE TABLE job_new (
  id               INTEGER PRIMARY KEY AUTOINCREMENT,
  kind             TEXT NOT NULL DEFAULT 'optimize' CHECK (kind IN ('optimize', 'prepare')),
  problem          INTEGER REFERENCES problem (id) ON DELETE CASCADE,
  study            TEXT CHECK (length(study) = 64),  -- hash of the design: equal studies take equal paths
  space            TEXT CHECK (length(space) = 64),  -- hash of the variables and their bounds
  pair             TEXT CHECK (length(pair) = 64),   -- of a preparation: hash of what is prepared
  design           TEXT NOT NULL CHECK (json_valid(design)), -- every default resolved
  name             TEXT NOT NULL,
  algorithm        TEXT NOT NULL,
  fresh            INTEGER NOT NULL CHECK (fresh IN (0, 1)), -- 1: the algorithm knew no earlier rows
  import_upto      INTEGER CHECK (import_upto >= 0), -- evaluations that were there when it began
  served           INTEGER NOT NULL DEFAULT 0 CHECK (served IN (0, 1)), -- 1: the server's queue runs it
  priority         INTEGER NOT NULL DEFAULT 0 CHECK (priority BETWEEN -10 AND 10),
  state            TEXT NOT NULL CHECK (state IN ('queued', 'preparing', 'running', 'done', 'failed', 'cancelled')),
  stop             INTEGER NOT NULL DEFAULT 0 CHECK (stop IN (0, 1)), -- 1: somebody wants it to end
  attempts         INTEGER NOT NULL DEFAULT 0 CHECK (attempts >= 0),  -- how often it was begun
  stopped          TEXT NOT NULL DEFAULT '',
  error            TEXT CHECK (error IS NULL OR json_valid(error)),
  progress         TEXT CHECK (progress IS NULL OR json_valid(progress)),
  true_evaluations INTEGER NOT NULL DEFAULT 0 CHECK (true_evaluations >= 0),
  individuals      INTEGER NOT NULL DEFAULT 0 CHECK (individuals >= true_evaluations),
  best             INTEGER REFERENCES evaluation (id) ON DELETE SET NULL,
  best_value       REAL,
  result           TEXT CHECK (result IS NULL OR json_valid(result)),
  idempotency      TEXT UNIQUE CHECK (length(idempotency) BETWEEN 1 AND 255), -- the client's name for the request
  request          TEXT CHECK (length(request) = 64),                        -- hash of that request
  created          TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  started          TEXT,
  finished         TEXT,
  updated          TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  CHECK (idempotency IS NULL OR request IS NOT NULL)
) STRICT;
INSERT INTO sqlite_sequence (name, seq) SELECT 'job_new', seq FROM sqlite_sequence WHERE name = 'job';
INSERT INTO job_new (id, problem, study, space, design, name, algorithm, fresh, import_upto, state, stopped, true_evaluations, individuals, best,
                     best_value, result, created, updated)
  SELECT id, problem, study, space, design, name, algorithm, fresh, import_upto, state, stopped, true_evaluations, individuals, best,
         best_value, result, created, updated FROM job;
DROP TABLE job;
ALTER TABLE job_new RENAME TO job;
CREATE INDEX job_study ON job (study);
CREATE INDEX job_queue ON job (kind, priority DESC, id) WHERE state = 'queued' AND served = 1;
CREATE INDEX job_state ON job (state);
CREATE INDEX job_pair ON job (pair) WHERE pair IS NOT NULL;
CREATE INDEX job_problem ON job (problem);
