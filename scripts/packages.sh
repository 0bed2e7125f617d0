#!/usr/bin/env bash
# Installs the Debian packages that building and testing need and that are missing. Asks nothing, and does
# nothing when nothing is missing. With --build-only it leaves out what only tests need.
set -euo pipefail

# libembree-dev: the oracle. libclang-dev: bindgen reads Embree's header with it.
packages=(libembree-dev libclang-dev)
# openexr and openimageio-tools: their exrheader, idiff and oiiotool read our files in the tests. chromium: opens the
# report page there. g++, pkg-config and valgrind: programs of the tests use the C library.
if [ "${1:-}" != --build-only ]; then
    packages+=(openexr openimageio-tools chromium g++ pkg-config valgrind)
fi

if ! command -v cargo >/dev/null; then
    echo "Rust is missing; get it with: curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh -s -- -y" >&2
    exit 1
fi

if ! command -v dpkg-query >/dev/null; then
    echo "This is not Debian: see that Embree 3 or 4 and libclang (with headers) and exrheader, idiff, oiiotool, chromium, g++, pkg-config and valgrind are installed." >&2
    exit 0
fi

missing=()
for package in "${packages[@]}"; do
    # An unknown package makes dpkg-query fail; a removed one may still be known by its configuration.
    state=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2>/dev/null || true)
    if [ "$state" != installed ]; then
        missing+=("$package")
    fi
done

if [ ${#missing[@]} -eq 0 ]; then
    exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
        echo "Missing packages: as root, run: apt-get update && apt-get install -y ${missing[*]}" >&2
        exit 1
    fi
    as_root=(sudo)
fi

echo "Installing Debian packages: ${missing[*]}"
# env, because sudo does not pass the variable on.
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q </dev/null
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" </dev/null
