#!/usr/bin/env bash
# Runs a program on an X display of its own, without a screen: on_display.sh WIDTHxHEIGHT PROGRAM [ARGUMENT …]
set -euo pipefail
screen=$1
shift
said=$(mktemp)
trap 'rm -f "$said"' EXIT
# The server takes the first free number and tells it, so that many can start at once. The kernel ends both the server and
# the program with this script, should it be killed.
# -noreset: a server that starts over when its last window closes refuses the next one for a moment.
exec {number_from}< <(exec setpriv --pdeathsig TERM -- \
  Xvfb -displayfd 3 -screen 0 "${screen}x24" -noreset -nolisten tcp 3>&1 >"$said" 2>&1)
server=$!
if ! read -r -t 60 number <&"$number_from"; then
  printf 'Xvfb gave no display within 60 s:\n%s\n' "$(cat "$said")" >&2
  exit 1
fi
exec {number_from}<&-
rm -f "$said"
status=0
DISPLAY=:$number setpriv --pdeathsig KILL -- "$@" || status=$?
kill "$server"
wait "$server" || true
exit "$status"
