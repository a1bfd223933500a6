# The report of the GPU kit, as Markdown, from what aspic printed with --json (one key a line), and the picture chart.svg.
# Usage: awk -f report.awk -v out=DIRECTORY info.json verify.json compare/*.json bench/*.json
function value(line) {
  sub(/^[^:]*: */, "", line)
  sub(/,$/, "", line)
  gsub(/^"|"$/, "", line)
  return line
}
function figure(x) {
  return x >= 100 ? sprintf("%.0f", x) : sprintf("%.3g", x)
}
function log10(x) {
  return log(x) / log(10)
}
FNR == 1 {
  kind = FILENAME ~ /info\.json$/ ? "info" : FILENAME ~ /verify\.json$/ ? "verify" : FILENAME ~ /\/compare\/[^\/]*$/ ? "compare" : "bench"
  if (kind == "compare") {
    name = FILENAME
    sub(/.*\//, "", name)
    sub(/\.json$/, "", name)
    compared[++comparisons] = name
  }
}
kind == "info" && /^ *"(renderer|version|vendor)":/ {
  key = $1
  gsub(/[":]/, "", key)
  if (/^    /) info[key] = value($0)
}
kind == "info" && /^ *"version":/ && !/^    / { aspic = value($0) }
kind == "info" && /units in the last place|are exact|rounds/ {
  line = $0
  gsub(/^ *"|",?$/, "", line)
  if (line !~ /are exact/) arithmetic[++sentences] = line
}
kind == "verify" && /^      "name":/ { check = value($0) }
kind == "verify" && /^      "measured":/ { measured = value($0) }
kind == "verify" && /^      "verdict":/ {
  ++verdicts[value($0)]
  if (value($0) == "fail") failures = failures "- " check ": " measured "\n"
}
kind == "compare" && /^ *"identical":/ { same[name] = value($0) }
kind == "compare" && /^ *"largest_ulp":/ && value($0) + 0 > ulps[name] + 0 { ulps[name] = value($0) }
kind == "bench" && /^      "name":/ { row = ++rows; title[row] = value($0) }
kind == "bench" && /^      "integrator":/ { method[row] = value($0) }
kind == "bench" && /^      "size":/ { size[row] = value($0) }
kind == "bench" && /^      "springs":/ { springs[row] = value($0) }
kind == "bench" && /^      "median_seconds":/ { median[row] = value($0) }
kind == "bench" && /^      "spread":/ { spread[row] = value($0) }
kind == "bench" && /^      "steps_per_second":/ { steps[row] = value($0) }
kind == "bench" && /^      "spring_evaluations_per_second":/ { rate[row] = value($0) }
kind == "bench" && /^      "bytes":/ { bytes[row] = value($0) }
END {
  printf "# Aspic %s on %s\n\n%s, %s. Written by the GPU kit.\n", aspic, info["renderer"], info["vendor"], info["version"]
  print "\n## Arithmetic\n"
  if (sentences == 0) print "Every operation that was tried is exact."
  for (i = 1; i <= sentences; ++i) print "- " arithmetic[i]
  print "\n## Verification\n"
  for (v in verdicts) printf "%s%s %d", separator++ ? ", " : "", v, verdicts[v]
  print separator ? "." : "No result: see the steps that failed."
  if (failures != "") printf "\nFailed:\n\n%s", failures
  print "\n## The GPU against the reference\n"
  for (i = 1; i <= comparisons; ++i) {
    name = compared[i]
    if (same[name] == "true") ++identical
    else others = others "- " name ": " (name in ulps ? ulps[name] " ULP at most" : "not compared") "\n"
  }
  printf "%d of %d comparisons are identical in every step.\n%s", identical, comparisons, others == "" ? "" : "\n" others
  print "\n## Throughput\n\n![spring evaluations by size](chart.svg)\n"
  print "| program | integrator | n | springs | ms/step | million spring evaluations/s | spread | MiB |"
  print "|---|---|---|---|---|---|---|---|"
  for (i = 1; i <= rows; ++i) {
    if (rate[i] + 0 <= 0) continue
    printf "| %s | %s | %d | %d | %s | %s | %.0f %% | %s |\n", title[i], method[i], size[i], springs[i],
      figure(1000 / steps[i]), figure(rate[i] / 1e6), 100 * spread[i], figure(bytes[i] / 1048576)
  }
  chart()
}
# Spring evaluations against particles per edge, both logarithmic, a line for each program with explicit Euler.
function chart(i, x, y, n, left, right, low, high, colours, at, series, key) {
  left = 1e9
  low = 1e99
  for (i = 1; i <= rows; ++i) {
    if (method[i] != "explicit-euler" || rate[i] + 0 <= 0) continue
    if (size[i] + 0 < left) left = size[i] + 0
    if (size[i] + 0 > right) right = size[i] + 0
    if (rate[i] + 0 < low) low = rate[i] + 0
    if (rate[i] + 0 > high) high = rate[i] + 0
  }
  if (high == "" || right <= left) return
  low = int(log10(low))
  high = int(log10(high)) + 1
  split("#1b6ca8 #d1495b #2e8b57 #edae49 #6a4c93 #444444", colours, " ")
  file = out "/chart.svg"
  print "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 720 440' font-family='sans-serif' font-size='13'>" > file
  print "<rect width='720' height='440' fill='white'/>" > file
  for (y = low; y <= high; ++y) {
    at = 400 - 370 * (y - low) / (high - low)
    printf "<path d='M70 %.1fH560' stroke='#ddd'/><text x='64' y='%.1f' text-anchor='end'>10^%d</text>\n", at, at + 4, y > file
  }
  print "<text x='70' y='16'>spring evaluations per second, explicit Euler</text><text x='560' y='434' text-anchor='end'>particles per edge</text>" > file
  for (i = 1; i <= rows; ++i) {
    if (method[i] != "explicit-euler" || rate[i] + 0 <= 0) continue
    if ((title[i], size[i]) in drawn) continue
    drawn[title[i], size[i]] = 1
    x = 70 + 490 * log(size[i] / left) / log(right / left)
    y = 400 - 370 * (log10(rate[i]) - low) / (high - low)
    if (!(title[i] in series)) {
      series[title[i]] = ++n
      names[n] = title[i]
    }
    places[title[i]] = places[title[i]] sprintf(" %08.1f,%.1f", x, y)
    if (!(size[i] in marked)) printf "<text x='%.1f' y='418' text-anchor='middle'>%d</text>\n", x, size[i] > file
    marked[size[i]] = 1
  }
  for (i = 1; i <= n; ++i) {
    printf "<polyline fill='none' stroke='%s' stroke-width='2' points='%s'/>\n", colours[(i - 1) % 6 + 1], in_order(places[names[i]]) > file
    printf "<text x='572' y='%d' fill='%s'>%s</text>\n", 40 + 20 * i, colours[(i - 1) % 6 + 1], names[i] > file
  }
  print "</svg>" > file
}
# Points by ascending x, whose digits are of one length.
function in_order(text, part, count, i, j, held) {
  count = split(text, part, " ")
  for (i = 2; i <= count; ++i)
    for (j = i; j > 1 && part[j] < part[j - 1]; --j) {
      held = part[j]
      part[j] = part[j - 1]
      part[j - 1] = held
    }
  text = ""
  for (i = 1; i <= count; ++i) text = text " " part[i]
  return text
}
