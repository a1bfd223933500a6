# The report of the GPU kit, as Markdown, from the tables that run.sh writes, the logs of tests, and what aspic printed with --json
# (one key a line).
# Usage: awk -f report.awk info.json compare.tsv start.tsv tests.tsv tests/*.log bench/*.json
function value(line) {
  sub(/^[^:]*: */, "", line)
  sub(/,$/, "", line)
  gsub(/^"|"$/, "", line)
  return line
}
function figure(x) {
  return x >= 100 ? sprintf("%.0f", x) : sprintf("%.3g", x)
}
FNR == 1 {
  kind = FILENAME
  sub(/.*\//, "", kind)
  if (FILENAME ~ /\/bench\/[^\/]*$/) kind = "bench"
  if (FILENAME ~ /\.log$/) kind = "log"
}
kind == "info.json" && /^    "(renderer|version|vendor|software)":/ {
  key = $1
  gsub(/[":]/, "", key)
  info[key] = value($0)
}
kind == "info.json" && /^  "version":/ { aspic = value($0) }
kind == "info.json" && /units in the last place|Workaround/ {
  line = $0
  gsub(/^ *"|",?$/, "", line)
  arithmetic[++sentences] = line
}
kind == "compare.tsv" {
  split($0, part, "\t")
  if (!(part[1] in row)) { row[part[1]] = ++scenes; scene[scenes] = part[1] }
  result[part[1], part[2]] = part[4]
  ++comparisons
  if (part[4] == "identical") ++identical
}
kind == "tests.tsv" {
  split($0, part, "\t")
  if (part[2] != 0 && part[2] != 1) broken = broken "- " part[1] ": exit code " part[2] "\n"
}
kind == "log" && /^\[       OK \] .* ms\)$/ { ++passed }
kind == "log" && /^\[  FAILED  \] .* ms\)$/ {
  ++failures
  sub(/^\[  FAILED  \] /, "")
  sub(/ \([0-9]+ ms\)$/, "")
  sub(/, where GetParam.*/, "")
  failed = failed "- `" $0 "`\n"
}
kind == "start.tsv" {
  split($0, part, "\t")
  if (part[2] == "cold") started[++starts] = part[1]
  start[part[1], part[2]] = part[3]
}
kind == "bench" && /^      "name":/ { ++rows; title[rows] = value($0) }
kind == "bench" && /^      "size":/ { size[rows] = value($0) }
kind == "bench" && /^      "springs":/ { springs[rows] = value($0) }
kind == "bench" && /^      "steps":/ { count[rows] = value($0) }
kind == "bench" && /^      "spread":/ { spread[rows] = value($0) }
kind == "bench" && /^      "steps_per_second":/ { steps[rows] = value($0) }
kind == "bench" && /^      "spring_evaluations_per_second":/ { rate[rows] = value($0) }
kind == "bench" && /^          "milliseconds":/ { kernel[rows] += value($0) }
END {
  printf "# Aspic %s on %s\n\n%s, %s. Written by the GPU kit.\n", aspic, info["renderer"], info["vendor"], info["version"]
  if (info["software"] == "true") print "\n**Warning: this is a software rasterizer. No figure below is a GPU's.**"
  print "\n## Arithmetic\n"
  if (sentences == 0) print "Every operation that was tried is exact."
  for (i = 1; i <= sentences; ++i) print "- " arithmetic[i]

  printf "\n## The GPU against the reference\n\n%d of %d comparisons are identical in every step.\n\n", identical, comparisons
  methods = split("explicit-euler runge-kutta-4 implicit-euler", method, " ")
  print "| scene | explicit-euler | runge-kutta-4 | implicit-euler |\n|---|---|---|---|"
  for (i = 1; i <= scenes; ++i) {
    line = "| " scene[i] " |"
    for (m = 1; m <= methods; ++m) {
      cell = result[scene[i], method[m]]
      line = line " " (cell == "" ? "left out" : cell) " |"
    }
    print line
  }

  printf "\n## Tests\n\n%d passed, %d failed.\n%s", passed, failures, failed == "" ? "" : "\n" failed
  if (broken != "") printf "\nPrograms that did not run to their end:\n\n%s", broken

  print "\n## Throughput\n"
  print "\"Total\" is wall-clock time, \"kernel\" the time stamps of the passes of one step.\n"
  print "| program | n | springs | steps per repeat | ms/step, total | ms/step, kernel | 10^9 springs/s, total | kernel | spread |"
  print "|---|---|---|---|---|---|---|---|---|"
  for (i = 1; i <= rows; ++i) {
    if (rate[i] + 0 <= 0 || shown[title[i], size[i]]++) continue
    printf "| %s | %d | %d | %d | %s | %s | %s | %s | %.0f %% |\n", title[i], size[i], springs[i], count[i], figure(1000 / steps[i]),
      (kernel[i] > 0 ? figure(kernel[i]) : ""), figure(rate[i] / 1e9), (kernel[i] > 0 ? figure(springs[i] / kernel[i] / 1e6) : ""),
      100 * spread[i]
  }

  print "\n## Start-up\n\nWall-clock time of one step in a new process [s]. Cold: the driver's and Aspic's caches are empty.\n"
  print "| scene | cold | warm |\n|---|---|---|"
  for (i = 1; i <= starts; ++i)
    printf "| %s | %.2f | %.2f |\n", started[i], start[started[i], "cold"] / 1000, start[started[i], "warm"] / 1000
}
