-- SPDX-License-Identifier: GPL-3.0-or-later
-- What was truly evaluated. SI units; a value that was not computed or is not finite is NULL.

-- Everything an evaluation depends on but the modification: two designs that share it share their evaluations.
CREATE TABLE problem (
  id        INTEGER PRIMARY KEY AUTOINCREMENT,
  hash      TEXT NOT NULL UNIQUE CHECK (length(hash) = 64),  -- SHA-256 of spec
  spec      TEXT NOT NULL CHECK (json_valid(spec)),          -- canonical JSON
  evaluator INTEGER NOT NULL CHECK (evaluator > 0),          -- version of the model
  scenarios INTEGER NOT NULL CHECK (scenarios > 0),          -- of a robust objective; else 1
  cases     INTEGER NOT NULL CHECK (cases > 0),              -- load cases
  name      TEXT NOT NULL,                                   -- of the first design, for people
  created   TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))
) STRICT;

-- Numbers are never used again, so that "all rows up to" means the same for ever.
CREATE TABLE evaluation (
  id           INTEGER PRIMARY KEY AUTOINCREMENT,
  problem      INTEGER NOT NULL REFERENCES problem (id) ON DELETE CASCADE,
  modification TEXT NOT NULL CHECK (json_valid(modification)), -- canonical JSON, defaults left out
  outcome      TEXT NOT NULL CHECK (outcome IN ('converged', 'not_converged', 'refused')),
  reason       TEXT NOT NULL DEFAULT '',
  cost_s       REAL NOT NULL CHECK (cost_s >= 0),
  created      TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  digest       TEXT NOT NULL CHECK (length(digest) = 64),     -- SHA-256 of the row and its raw values
  UNIQUE (problem, modification)
) STRICT;

-- Raw values per load case (and scenario of a robust objective), before weights.
CREATE TABLE raw (
  evaluation          INTEGER NOT NULL REFERENCES evaluation (id) ON DELETE CASCADE,
  scenario            INTEGER NOT NULL CHECK (scenario >= 0),
  load_case           INTEGER NOT NULL CHECK (load_case >= 0),
  peak_to_peak_m      REAL,
  impact_N            REAL,
  rms_m_per_s2        REAL,
  contact_pressure_Pa REAL,
  root_stress_Pa      REAL,
  edge_load_share     REAL,
  contact_loss        REAL,
  failed              INTEGER NOT NULL CHECK (failed IN (0, 1)),
  PRIMARY KEY (evaluation, scenario, load_case)
) STRICT, WITHOUT ROWID;
