#!/usr/bin/env bash
# Runs a command and says every few seconds that it is still at work, so that nobody wonders.
#
#   with_heartbeat.sh WHAT COMMAND [ARGUMENT...]
#
# With HEARTBEAT=without-bars it keeps still on a terminal, where the command has bars of its own.
set -euo pipefail

what=$1
shift
if [ "${HEARTBEAT:-}" = without-bars ] && [ -t 2 ]; then
    exec "$@"
fi
"$@" &
command=$!
# Ctrl-C reaches both; a signal to this script alone is handed on.
trap 'kill -TERM "$command" 2>/dev/null || true' TERM INT HUP
begin=$SECONDS
(
    while sleep 4 && kill -0 "$command" 2>/dev/null; do
        echo "  ... $what: $((SECONDS - begin)) s" >&2
    done
) &
ticker=$!
code=0
wait "$command" || code=$?
kill "$ticker" 2>/dev/null || true
wait "$ticker" 2>/dev/null || true
exit "$code"
