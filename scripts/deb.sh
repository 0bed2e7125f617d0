#!/usr/bin/env bash
# Builds Debian packages into target/debian: lightbuffer (the program), liblightbuffer0 and liblightbuffer-dev (the C library).
# What they hold is said in Cargo.toml; cargo-deb is installed if it is missing. DEBFULLNAME and DEBEMAIL, if set, are the
# maintainer's, as for all of Debian's tools.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo=${CARGO:-cargo}

for tool in dpkg-shlibdeps strip; do
    command -v "$tool" >/dev/null || { echo "make deb: $tool is missing; install Debian packages dpkg-dev and binutils" >&2; exit 1; }
done
if ! "$cargo" deb --version >/dev/null 2>&1; then
    echo "Installing cargo-deb, which takes some minutes" >&2
    "$cargo" install --locked --quiet cargo-deb --version ^3
fi

version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -1)
maintainer=$(sed -n 's/^maintainer = "\(.*\)"$/\1/p' Cargo.toml | head -1)
[ -z "${DEBEMAIL:-}" ] || maintainer="${DEBFULLNAME:-$DEBEMAIL} <$DEBEMAIL>"
# Of the last commit, so that equal sources make equal packages.
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct 2>/dev/null || date +%s)}

from=target/deb
rm -rf "$from"
mkdir -p "$from"
# The program in the same go: one library for both.
bash scripts/c_library.sh target/c --release --bins
target/release/lightbuffer manual -o "$from/man"
for shell in bash zsh fish; do
    target/release/lightbuffer completions "$shell" >"$from/completions.$shell"
done
# Where lightbuffer.pc is to say that things are; cargo-deb moves what is below usr/lib into the architecture's folder.
multiarch=$(dpkg-architecture -qDEB_HOST_MULTIARCH)
DESTDIR="$from/root" PREFIX=/usr LIBDIR=lib/$multiarch bash scripts/install_c.sh target/c
mv "$from/root/usr/lib/$multiarch" "$from/lib"
strip --strip-unneeded "$from"/lib/liblightbuffer.so.*.*.*
strip --strip-debug "$from/lib/liblightbuffer.a"

for package in lightbuffer liblightbuffer0 liblightbuffer-dev; do
    cat >"$from/$package.changelog" <<CHANGES
$package ($version-1) unstable; urgency=medium

  * As of CHANGELOG.md.

 -- $maintainer  $(date -u -R -d "@$SOURCE_DATE_EPOCH")
CHANGES
done
"$cargo" deb --no-build --strip --maintainer "$maintainer"
for variant in library development; do
    "$cargo" deb --no-build --maintainer "$maintainer" --multiarch same --variant "$variant"
done

# What the library needs, by the symbols that it asks for.
library=$(cd "$from/lib" && ls "$PWD"/liblightbuffer.so.*.*.*)
mkdir -p "$from/needs/debian"
touch "$from/needs/debian/control"
needs=$(cd "$from/needs" && dpkg-shlibdeps -O "$library" 2>/dev/null | sed -n 's/^shlibs:Depends=//p')
[ -n "$needs" ] || { echo "make deb: dpkg-shlibdeps says nothing of $library" >&2; exit 1; }
package=$(ls target/debian/liblightbuffer0_"$version"-1_*.deb)
dpkg-deb --raw-extract "$package" "$from/repack"
sed -i "s/^Depends: .*/Depends: $needs/" "$from/repack/DEBIAN/control"
dpkg-deb --root-owner-group --build "$from/repack" "$package" >/dev/null
