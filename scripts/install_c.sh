#!/usr/bin/env bash
# Installs what scripts/c_library.sh has made in a folder: below DESTDIR, PREFIX and, relative to that, LIBDIR.
#
#   PREFIX=/usr/local LIBDIR=lib DESTDIR= scripts/install_c.sh FOLDER
set -euo pipefail

from=${1:?usage: scripts/install_c.sh FOLDER}
prefix=${PREFIX:-/usr/local}
libdir=${LIBDIR:-lib}
to=${DESTDIR:-}$prefix

install -d "$to/include" "$to/$libdir/pkgconfig"
install -m 644 "$from/include/lightbuffer.h" "$to/include/"
install -m 644 "$from/lib/liblightbuffer.a" "$from"/lib/liblightbuffer.so.*.*.* "$to/$libdir/"
cp -P "$from/lib/liblightbuffer.so" "$from"/lib/liblightbuffer.so.[0-9] "$to/$libdir/"
sed -e "s|^prefix=.*|prefix=$prefix|" -e "s|^libdir=.*|libdir=\${prefix}/$libdir|" \
    "$from/lib/pkgconfig/lightbuffer.pc" >"$to/$libdir/pkgconfig/lightbuffer.pc"
chmod 644 "$to/$libdir/pkgconfig/lightbuffer.pc"
