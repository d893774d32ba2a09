-- SPDX-License-Identifier: GPL-3.0-or-later
-- The paper once more, ordered like any job. The table of jobs once more with this kind.
CREATE TABLE job_new (
  id               INTEGER PRIMARY KEY AUTOINCREMENT,
  kind             TEXT NOT NULL DEFAULT 'optimize' CHECK (kind IN ('optimize', 'prepare', 'study', 'tolerance', 'reproduce')),
  problem          INTEGER REFERENCES problem (id) ON DELETE CASCADE,
  study            TEXT CHECK (length(study) = 64),  -- hash of what is asked for: equal studies take equal paths
  space            TEXT CHECK (length(space) = 64),  -- hash of the variables and their bounds
  pair             TEXT CHECK (length(pair) = 64),   -- of a preparation: hash of what is prepared
  design           TEXT NOT NULL CHECK (json_valid(design)), -- every default resolved
  spec             TEXT CHECK (spec IS NULL OR json_valid(spec)), -- of a study or a reproduction: the document that asks for it
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
  unclean          INTEGER NOT NULL DEFAULT 0 CHECK (unclean >= 0), -- ends of the process in the middle of it
  reached          INTEGER NOT NULL DEFAULT 0 CHECK (reached >= 0), -- evaluations it had when that last happened
  CHECK (idempotency IS NULL OR request IS NOT NULL)
) STRICT;
INSERT INTO sqlite_sequence (name, seq) SELECT 'job_new', seq FROM sqlite_sequence WHERE name = 'job';
INSERT INTO job_new (id, kind, problem, study, space, pair, design, name, algorithm, fresh, import_upto, served, priority, state, stop, attempts, stopped,
                     error, progress, true_evaluations, individuals, best, best_value, result, idempotency, request, created, started, finished, updated,
                     unclean, reached)
  SELECT id, kind, problem, study, space, pair, design, name, algorithm, fresh, import_upto, served, priority, state, stop, attempts, stopped,
         error, progress, true_evaluations, individuals, best, best_value, result, idempotency, request, created, started, finished, updated,
         unclean, reached FROM job;
DROP TABLE job;
ALTER TABLE job_new RENAME TO job;
CREATE INDEX job_study ON job (study);
CREATE INDEX job_queue ON job (kind, priority DESC, id) WHERE state = 'queued' AND served = 1;
CREATE INDEX job_state ON job (state);
CREATE INDEX job_pair ON job (pair) WHERE pair IS NOT NULL;
CREATE INDEX job_problem ON job (problem);
