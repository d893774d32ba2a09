-- SPDX-License-Identifier: GPL-3.0-or-later
-- Recordings of a rig. A row is there only once its files lie complete in the data folder, under measurements/ID/, and were read.
CREATE TABLE measurement (
  id            INTEGER PRIMARY KEY AUTOINCREMENT,
  design        INTEGER NOT NULL REFERENCES design (id) ON DELETE RESTRICT,
  digest        TEXT NOT NULL UNIQUE CHECK (length(digest) = 64), -- of the request and its files: the same again is the same measurement
  label         TEXT NOT NULL CHECK (label IN ('unmodified', 'modified')),
  torque_Nm     REAL NOT NULL CHECK (torque_Nm > 0),
  speed_rad_s   REAL CHECK (speed_rad_s > 0),                     -- as stated; the measured one is in result
  layout        TEXT CHECK (layout IS NULL OR json_valid(layout)), -- as asked for; the one that was found is in result
  pair          TEXT NOT NULL CHECK (length(pair) = 64),          -- hash of the tooth numbers and base radii it was measured with
  summary       TEXT NOT NULL CHECK (json_valid(summary)),        -- what lists and comparisons need of the result
  result        TEXT NOT NULL CHECK (json_valid(result)),
  created       TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))
) STRICT;
CREATE INDEX measurement_design ON measurement (design, id);

-- One file with both encoders, or the pinion's and the gear's.
CREATE TABLE measurement_file (
  measurement INTEGER NOT NULL REFERENCES measurement (id) ON DELETE CASCADE,
  ordinal     INTEGER NOT NULL CHECK (ordinal >= 0),
  name        TEXT NOT NULL,                                      -- the client's, cleaned; never a name on this disk
  size        INTEGER NOT NULL CHECK (size >= 0),
  sha256      TEXT NOT NULL CHECK (length(sha256) = 64),
  PRIMARY KEY (measurement, ordinal)
) STRICT, WITHOUT ROWID;
