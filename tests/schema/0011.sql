-- What version 8 of the schema left behind, with the tables of version 9, the column of version 10 and the kinds of jobs of version 11.
PRAGMA foreign_keys=OFF;
BEGIN TRANSACTION;
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
INSERT INTO "candidate" VALUES(1,0,0,0,2,0,X'0EB42FCE029BEA3FE21EB823ABA6E23FC754C7A8D607D73FEFF164FC9360E53F33BB72A90B268D3F');
INSERT INTO "candidate" VALUES(1,1,0,1,3,0,X'1AA87F8C5B0DCA3F06F540DBB22CE73F0B7A79359BCDDE3F461F32D15807E13F7B1AD88DF456ED3F');
INSERT INTO "candidate" VALUES(1,2,0,2,4,0,X'28A0EAABD060DD3F2DA73F0310B2E93F9EA5389EC5F7E13FB0203CA9037EED3F9BAC6AAF527BDB3F');
CREATE TABLE design (
  id       INTEGER PRIMARY KEY AUTOINCREMENT,
  revision INTEGER NOT NULL DEFAULT 1 CHECK (revision > 0),
  name     TEXT NOT NULL,
  document TEXT NOT NULL CHECK (json_valid(document)),
  created  TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  updated  TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now'))
) STRICT;
INSERT INTO "design" VALUES(1,1,'paper pair','{"version":1}','2026-11-22T04:51:11.190Z','2026-11-22T04:51:11.190Z');
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
INSERT INTO "evaluation" VALUES(1,1,'{}','converged','',4.08737999999999809808e-03,'2026-11-22T03:08:09.842Z','110e99b935c810e75cbeb722b41173b8c71e0ceb3279aebbfe854ee1d45938fe');
INSERT INTO "evaluation" VALUES(2,1,'{"pinion":{"left":{"lead_crowning_um":0.512378005896872,"root_relief_start_mm":3.5733926443981967,"root_relief_um":23.313811102451474,"tip_relief_start_mm":1.8113843843995379,"tip_relief_um":33.25688944655219},"right":{"lead_crowning_um":0.512378005896872,"root_relief_start_mm":3.5733926443981967,"root_relief_um":23.313811102451474,"tip_relief_start_mm":1.8113843843995379,"tip_relief_um":33.25688944655219}}}','converged','',3.6004679999999990303e-03,'2026-11-22T03:08:09.885Z','5ad230a67ba06894853fed72270d05a7d163a453f868141deefcd8fb22bdc1da');
INSERT INTO "evaluation" VALUES(3,1,'{"pinion":{"left":{"lead_crowning_um":33.00712773648937,"root_relief_start_mm":2.9075195332232293,"root_relief_um":28.968255166242926,"tip_relief_start_mm":2.321456689194755,"tip_relief_um":8.141305679430417},"right":{"lead_crowning_um":33.00712773648937,"root_relief_start_mm":2.9075195332232293,"root_relief_um":28.968255166242926,"tip_relief_start_mm":2.321456689194755,"tip_relief_um":8.141305679430417}}}','converged','',4.22342100000000063991e-03,'2026-11-22T03:08:09.885Z','2266de99370da35eac2042f8ec9759f5d790cf38d861885d71697ff0b6f52c78');
INSERT INTO "evaluation" VALUES(4,1,'{"pinion":{"left":{"lead_crowning_um":15.45847336482356,"root_relief_start_mm":4.815999765043857,"root_relief_um":32.11944604282414,"tip_relief_start_mm":2.6582815150345933,"tip_relief_um":18.361365046967055},"right":{"lead_crowning_um":15.45847336482356,"root_relief_start_mm":4.815999765043857,"root_relief_um":32.11944604282414,"tip_relief_start_mm":2.6582815150345933,"tip_relief_um":18.361365046967055}}}','converged','',3.88074399999999847254e-03,'2026-11-22T03:08:09.885Z','b52cc8acddbbe6d0f0c489846d6c64295c70bd0d4359d895939a5127f7de8c3d');
CREATE TABLE "job" (
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
INSERT INTO "job" VALUES(1,'optimize',1,'e55de1cc6b2ead67baa34af6be191070e448c16541b34c5b56c1eb3bb08c22ee','79066b6f31bd4956922fc23eac447c7279474dcde70183e5202e4325864b7430',NULL,'{}',NULL,'paper pair','credibility-ga',1,0,0,0,'done',0,0,'budget',NULL,NULL,3,3,4,5.54383302556712420638e-01,NULL,NULL,NULL,'2026-11-22T03:08:09.829Z',NULL,NULL,'2026-11-22T03:08:09.904Z',0,0);
INSERT INTO "job" VALUES(2,'optimize',NULL,NULL,NULL,NULL,'{}',NULL,'waiting','ga',0,NULL,1,2,'queued',0,0,'',NULL,NULL,0,0,NULL,NULL,NULL,'key-1','0000000000000000000000000000000000000000000000000000000000000000','2026-11-22T04:51:11.190Z',NULL,NULL,'2026-11-22T04:51:11.190Z',0,0);
INSERT INTO "job" VALUES(3,'prepare',NULL,NULL,NULL,'1111111111111111111111111111111111111111111111111111111111111111','{}',NULL,'prepared','',0,NULL,1,10,'done',0,1,'',NULL,'{"progress":{"fraction":1}}',0,0,NULL,NULL,NULL,NULL,NULL,'2026-11-22T04:51:11.190Z','2026-11-22T05:00:00.000Z','2026-11-22T05:00:01.000Z','2026-11-22T04:51:11.190Z',0,0);
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
INSERT INTO "measurement" VALUES(1,1,'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa','modified',828.0,209.4,NULL,'bbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbbb','{"file":"run.csv"}','{"file":"run.csv"}','2026-11-22T05:24:29.655Z');
CREATE TABLE measurement_file (
  measurement INTEGER NOT NULL REFERENCES measurement (id) ON DELETE CASCADE,
  ordinal     INTEGER NOT NULL CHECK (ordinal >= 0),
  name        TEXT NOT NULL,                                      -- the client's, cleaned; never a name on this disk
  size        INTEGER NOT NULL CHECK (size >= 0),
  sha256      TEXT NOT NULL CHECK (length(sha256) = 64),
  PRIMARY KEY (measurement, ordinal)
) STRICT, WITHOUT ROWID;
INSERT INTO "measurement_file" VALUES(1,0,'run.csv',1138492,'c789f19fbba338d820426bab7aed0528f0e062e624b4008e13fb0abdfaaf4716');
CREATE TABLE point (
  evaluation INTEGER NOT NULL REFERENCES evaluation (id) ON DELETE CASCADE,
  space      TEXT NOT NULL CHECK (length(space) = 64), -- hash of the variables and their bounds
  x          BLOB NOT NULL CHECK (length(x) % 8 = 0),
  PRIMARY KEY (evaluation, space)
) STRICT, WITHOUT ROWID;
INSERT INTO "point" VALUES(2,'79066b6f31bd4956922fc23eac447c7279474dcde70183e5202e4325864b7430',X'0EB42FCE029BEA3FE21EB823ABA6E23FC754C7A8D607D73FEFF164FC9360E53F33BB72A90B268D3F');
INSERT INTO "point" VALUES(3,'79066b6f31bd4956922fc23eac447c7279474dcde70183e5202e4325864b7430',X'1AA87F8C5B0DCA3F06F540DBB22CE73F0B7A79359BCDDE3F461F32D15807E13F7B1AD88DF456ED3F');
INSERT INTO "point" VALUES(4,'79066b6f31bd4956922fc23eac447c7279474dcde70183e5202e4325864b7430',X'28A0EAABD060DD3F2DA73F0310B2E93F9EA5389EC5F7E13FB0203CA9037EED3F9BAC6AAF527BDB3F');
CREATE TABLE prediction (
  job         INTEGER NOT NULL REFERENCES job (id) ON DELETE CASCADE,
  generation  INTEGER NOT NULL,
  individual  INTEGER NOT NULL,
  fitness     REAL NOT NULL,
  credibility REAL NOT NULL,
  x           BLOB NOT NULL CHECK (length(x) % 8 = 0),
  PRIMARY KEY (job, generation, individual)
) STRICT, WITHOUT ROWID;
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
INSERT INTO "problem" VALUES(1,'639184bc2e20e4e7e14e227de3eacb40a9d4f6cbdc47f22451cc611431e46c72','{"alignment":{"pinion_axial":"floating","pinion_axial_stiffness_N_per_um":200,"shaft_angle_error_in_plane_deg":0.1,"shaft_angle_error_out_of_plane_deg":0,"stagger":0},"gear_pair":{"addendum_coefficient":1,"backlash_um":100,"centre_distance_mm":200.31843896660655,"dedendum_coefficient":1.25,"ends":2,"face_width_mm":55,"fillet_radius_coefficient":0.38,"gear_bore_mm":90,"gear_groove_diameter_mm":271.98397752559634,"gear_profile_shift":0,"gear_teeth":44,"gear_tip_diameter_mm":300.98397752559634,"groove_width_mm":50,"helix_angle_deg":24,"normal_module_mm":6,"normal_pressure_angle_deg":20,"pinion_bore_mm":0,"pinion_groove_diameter_mm":94.65290040761677,"pinion_profile_shift":0,"pinion_teeth":17,"pinion_tip_diameter_mm":123.65290040761677,"rim_thickness_coefficient":3.5},"load_cases":[{"speed_rpm":2000,"torque_Nm":621},{"speed_rpm":2000,"torque_Nm":828},{"speed_rpm":2000,"torque_Nm":1035}],"material":{"density_kg_per_m3":7850,"poissons_ratio":0.3,"youngs_modulus_GPa":206},"resolution":{"cells_per_line":8,"fillet_elements":8,"flank_rows":5,"harmonics":8,"impact_in_dynamics":"none","impact_patch_mm":5,"layers":8,"mesh_law":"tangent","neighbour_coupling":false,"positions":16,"sector_teeth":3,"solver":"harmonic_balance","te_harmonics":6,"tip_edge_contact":true},"shafts":{"enabled":false,"gear_drive_side":"left","gear_left_bearing_mm":-107.50000000000001,"gear_right_bearing_mm":107.50000000000001,"gear_shaft_diameter_mm":217.5871820204771,"pinion_drive_side":"left","pinion_left_bearing_mm":-107.50000000000001,"pinion_right_bearing_mm":107.50000000000001,"pinion_shaft_diameter_mm":75.72232032609342},"supports":{"bearing_damping_ratio":0.05,"gear_axial_stiffness_left_N_per_um":200,"gear_axial_stiffness_right_N_per_um":200,"gear_bearing_stiffness_N_per_um":1000,"gear_groove_axial_stiffness_N_per_um":213161.90761472686,"gear_groove_torsional_stiffness_Nm_per_rad":841121351.5381068,"gear_inertia_kg_m2":0.39700498678794277,"gear_mass_kg":35.725439967223856,"groove_damping_ratio":0.02,"mesh_damping_ratio":0.07,"mesh_damping_stiffness_N_per_um":null,"pinion_bearing_stiffness_N_per_um":800,"pinion_groove_axial_stiffness_N_per_um":28990.449567479885,"pinion_groove_torsional_stiffness_Nm_per_rad":12487038.997513207,"pinion_inertia_kg_m2":0.008133856745044268,"pinion_mass_kg":5.608208422335393,"torsional_coupling":"paper"},"wants":{"evaluator":1,"root_stress":false}}',1,1,3,'paper pair','2026-11-22T03:08:09.829Z');
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
  failed              INTEGER NOT NULL CHECK (failed IN (0, 1)), flank_safety REAL, root_safety REAL, film_ratio REAL, contact_temperature_C REAL, curve BLOB CHECK (curve IS NULL OR length(curve) % 8 = 0),
  PRIMARY KEY (evaluation, scenario, load_case)
) STRICT, WITHOUT ROWID;
INSERT INTO "raw" VALUES(1,0,0,1.75715962772765727506e-06,6.6639595906601243767e+03,6.50952962450315340001e+01,1.66588007256711864473e+09,NULL,1.12025662054721711347e-01,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(1,0,1,1.53598032379575831127e-06,7.18994223874057661284e+03,5.26549128404323596441e+01,1.84663433118179249768e+09,NULL,1.11867024883746710162e-01,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(1,0,2,1.3633772756247903332e-06,7.61943474284758303846e+03,4.03700097219102502785e+01,1.98895025366176891323e+09,NULL,1.10667798509865189515e-01,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(2,0,0,2.23389574952371332142e-06,3.70609130570766046736e+03,3.30904748178103389486e+01,1.24465002569000029563e+09,NULL,9.41193563647434346119e-03,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(2,0,1,1.84212726290785977229e-06,4.99517292903654561066e+03,2.85507851654618036727e+01,1.36528324643909382816e+09,NULL,1.93924423804139496596e-02,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(2,0,2,1.57258739521128739421e-06,5.76305960890031928993e+03,2.61197964820912176264e+01,1.46323975916946291925e+09,NULL,2.4425960740592594228e-02,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(3,0,0,1.57367530513778468813e-06,6.86502823299848841977e+02,3.71609546535971091429e+01,9.88580395940032243765e+08,NULL,2.36039197012470683412e-02,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(3,0,1,2.34042976317086956201e-06,7.48206942831411424797e+02,4.38503450301889756684e+01,1.05739908515037500853e+09,NULL,2.81955502388140655245e-02,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(3,0,2,2.6134002112409108478e-06,7.9505536003302643166e+02,4.70006433989622252056e+01,1.11761419405516648295e+09,NULL,3.1819885682375433078e-02,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(4,0,0,6.96580803738851761161e-07,1917.1868066133,4.73407346208185515496e+01,9.33628896548709273379e+08,NULL,2.10639463695058426484e-02,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(4,0,1,6.95837759389578e-07,3.80340680354947880906e+03,2.84677894623643084059e+01,1.06285857372741019723e+09,NULL,2.54260109580245162452e-02,0.0,0,NULL,NULL,NULL,NULL,NULL);
INSERT INTO "raw" VALUES(4,0,2,8.11382923716504712331e-07,4.96680222395553209926e+03,2.94987124275896803746e+01,1.19332919287266969678e+09,NULL,2.7953892079609625465e-02,0.0,0,NULL,NULL,NULL,NULL,NULL);
CREATE TABLE variant (
  job     INTEGER NOT NULL REFERENCES job (id) ON DELETE CASCADE,
  ordinal INTEGER NOT NULL CHECK (ordinal >= 0),
  row     INTEGER NOT NULL REFERENCES variant_row (id) ON DELETE CASCADE,
  reused  INTEGER NOT NULL CHECK (reused IN (0, 1)),         -- 1: known before the study asked
  PRIMARY KEY (job, ordinal)
) STRICT, WITHOUT ROWID;
CREATE TABLE variant_columns (
  id    INTEGER PRIMARY KEY AUTOINCREMENT,
  names TEXT NOT NULL UNIQUE CHECK (json_valid(names))
) STRICT;
CREATE TABLE variant_row (
  id        INTEGER PRIMARY KEY AUTOINCREMENT,
  design    TEXT NOT NULL CHECK (length(design) = 64),       -- hash of what was evaluated
  evaluator INTEGER NOT NULL CHECK (evaluator > 0),          -- version of the model
  columns   INTEGER NOT NULL REFERENCES variant_columns (id),
  outcome   TEXT NOT NULL CHECK (outcome IN ('converged', 'not_converged', 'refused')),
  reason    TEXT NOT NULL DEFAULT '',
  cost_s    REAL NOT NULL CHECK (cost_s >= 0),
  numbers   BLOB NOT NULL CHECK (length(numbers) % 8 = 0),   -- doubles, little endian, in the units of their names; NaN: none
  digest    TEXT NOT NULL CHECK (length(digest) = 64),       -- SHA-256 of the row
  created   TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  UNIQUE (design, evaluator, columns)
) STRICT;
CREATE INDEX candidate_evaluation ON candidate (evaluation);
CREATE INDEX measurement_design ON measurement (design, id);
CREATE INDEX job_study ON job (study);
CREATE INDEX job_queue ON job (kind, priority DESC, id) WHERE state = 'queued' AND served = 1;
CREATE INDEX job_state ON job (state);
CREATE INDEX job_pair ON job (pair) WHERE pair IS NOT NULL;
CREATE INDEX job_problem ON job (problem);
CREATE INDEX variant_of_row ON variant (row);
DELETE FROM "sqlite_sequence";
INSERT INTO "sqlite_sequence" VALUES('problem',1);
INSERT INTO "sqlite_sequence" VALUES('evaluation',4);
INSERT INTO "sqlite_sequence" VALUES('design',1);
INSERT INTO "sqlite_sequence" VALUES('measurement',1);
INSERT INTO "sqlite_sequence" VALUES('job',3);
COMMIT;
PRAGMA application_id = 1161909061; PRAGMA user_version = 11;
