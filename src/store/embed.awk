# SPDX-License-Identifier: GPL-3.0-or-later
# Numbered SQL files -> a C array, so that the program carries its schema and nothing can be missing at run time.
function quote(line) {
  gsub(/\\/, "\\\\", line)
  gsub(/"/, "\\\"", line)
  return "\"" line "\\n\""
}
BEGIN {
  print "/* Made from sql/ by src/store/embed.awk. */"
  print "#include \"store/migrations.h\"\n"
  print "const char *const eo_store_migrations[] = {"
}
FNR == 1 {
  if (count++)
    print "    ,"
  name = FILENAME
  sub(/.*\//, "", name)
  if (substr(name, 1, 4) + 0 != count) {
    print "sql/: " name " is not number " count > "/dev/stderr"
    failed = 1
    exit 1
  }
}
{ print "    " quote($0) }
END {
  if (failed)
    exit 1
  print "};"
  print "const int eo_store_schema = " count + 0 ";"
}
