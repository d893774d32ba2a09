-- SPDX-License-Identifier: GPL-3.0-or-later
-- Stored designs as they came leave things out, and what stands for them depends on the version of the document (src/document/design_migration.h): those from
-- before documents had one are of version 1, so that they give the same numbers as when they were stored.
UPDATE design SET document = json_set(document, '$.version', 1)
  WHERE json_type(document) = 'object' AND json_type(document, '$.version') IS NULL;
