-- SPDX-License-Identifier: GPL-3.0-or-later
-- Loaded transmission error over the mesh cycle less its mean (m), then the impacts of both ends (N): doubles, little endian. What
-- peak_to_peak_m and impact_N are the range and the largest of; NULL in rows of before and where there is none.
ALTER TABLE raw ADD COLUMN curve BLOB CHECK (curve IS NULL OR length(curve) % 8 = 0);
