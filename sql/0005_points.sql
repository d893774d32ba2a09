-- SPDX-License-Identifier: GPL-3.0-or-later
-- Where in the unit cube over its variables an evaluation was asked for, bit for bit: a study that knows earlier rows finds the same points again, also
-- when the job that asked for them has been removed.
CREATE TABLE point (
  evaluation INTEGER NOT NULL REFERENCES evaluation (id) ON DELETE CASCADE,
  space      TEXT NOT NULL CHECK (length(space) = 64), -- hash of the variables and their bounds
  x          BLOB NOT NULL CHECK (length(x) % 8 = 0),
  PRIMARY KEY (evaluation, space)
) STRICT, WITHOUT ROWID;

INSERT OR IGNORE INTO point (evaluation, space, x)
  SELECT c.evaluation, j.space, c.x FROM candidate c JOIN job j ON j.id = c.job WHERE c.reused = 0 AND j.space IS NOT NULL ORDER BY c.job, c.ordinal;
