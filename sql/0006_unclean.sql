-- SPDX-License-Identifier: GPL-3.0-or-later
-- Ends of the process in the middle of a job, and the evaluations it had when that last happened: a job that comes no further is not begun for ever.
ALTER TABLE job ADD COLUMN unclean INTEGER NOT NULL DEFAULT 0 CHECK (unclean >= 0);
ALTER TABLE job ADD COLUMN reached INTEGER NOT NULL DEFAULT 0 CHECK (reached >= 0);
