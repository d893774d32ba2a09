-- SPDX-License-Identifier: GPL-3.0-or-later
-- What limits on the rating look at: of the duty cycle, in the row of its first load case; NULL elsewhere and where no limit asked for it.
ALTER TABLE raw ADD COLUMN flank_safety REAL;
ALTER TABLE raw ADD COLUMN root_safety REAL;
ALTER TABLE raw ADD COLUMN film_ratio REAL;
ALTER TABLE raw ADD COLUMN contact_temperature_C REAL;
