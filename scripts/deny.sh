#!/usr/bin/env bash
# Holds all dependencies against deny.toml with cargo-deny, which is installed if it is missing. The database of known
# holes has to be fetched; where that fails the rest is checked, and the last line says so.
set -euo pipefail
cd "$(dirname "$0")/.."

if ! cargo deny --version >/dev/null 2>&1; then
    echo "Installing cargo-deny, which takes some minutes" >&2
    cargo install --locked --quiet cargo-deny
fi

cargo deny --locked check licenses bans sources
if cargo deny --locked check advisories; then
    exit 0
fi
# Was it the database, or what is in it?
if cargo deny --locked fetch db >/dev/null 2>&1; then
    exit 1
fi
echo "make deny: licences, bans and sources are as they should be; known holes were NOT checked, because their database \
cannot be fetched" >&2
