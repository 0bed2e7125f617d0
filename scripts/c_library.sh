#!/usr/bin/env bash
# Makes the C library: header, static and shared library and lightbuffer.pc below a folder, as they are installed.
#
#   scripts/c_library.sh FOLDER [CARGO OPTIONS]   builds what is missing; without options, in release
#
# lightbuffer.pc says that they are in that folder; scripts/install_c.sh puts them elsewhere.
set -euo pipefail

if [ $# -lt 1 ]; then
    echo "usage: scripts/c_library.sh FOLDER [CARGO OPTIONS]" >&2
    exit 2
fi
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || set -- --release

version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -1)
major=${version%%.*}
cc=${CC:-cc}
command -v "$cc" >/dev/null || { echo "c_library.sh: no C compiler \`$cc\`; install Debian package gcc, or set CC" >&2; exit 1; }

# Cargo says where the archive is and what the crate links with.
messages=$("${CARGO:-cargo}" build --example c_library --message-format=json "$@")
archive=$(sed -n 's/.*"filenames":\["\([^"]*libc_library\.a\)"\].*/\1/p' <<<"$messages")
embree=$(sed -n 's/.*"package_id":"[^"]*lightbuffer[@#][^"]*".*"linked_libs":\[[^]]*"dylib=\(embree[0-9]*\)".*/\1/p' <<<"$messages")
folders=$(sed -n 's/.*"package_id":"[^"]*lightbuffer[@#][^"]*".*"linked_paths":\[\([^]]*\)\].*/\1/p' <<<"$messages" |
    tr ',' '\n' | sed -n 's/^"native=\(.*\)"$/-L\1/p')
[ -f "$archive" ] || { echo "c_library.sh: cargo names no archive libc_library.a" >&2; exit 1; }
# What the standard library of Rust asks of the system, and Embree.
private="${embree:+-l$embree }-lgcc_s -lpthread -lm -ldl"

mkdir -p "$folder/include" "$folder/lib/pkgconfig"
install -m 644 include/lightbuffer.h "$folder/include/lightbuffer.h"
install -m 644 "$archive" "$folder/lib/liblightbuffer.a"
# Every exported function is a root; what none of them needs, the command line among it, is left out. The library stays in
# memory until the process ends, as whatever starts threads must.
roots=$(sed -n 's/^ *\(lightbuffer_[a-z_]*\);$/-Wl,-u,\1/p' scripts/lightbuffer.map)
shared=liblightbuffer.so.$version
# shellcheck disable=SC2086
"$cc" -shared -o "$folder/lib/$shared" -Wl,-soname,liblightbuffer.so."$major" \
    -Wl,--version-script=scripts/lightbuffer.map -Wl,--gc-sections -Wl,-z,defs,-z,relro,-z,now,-z,nodelete -Wl,--as-needed \
    -Wl,--build-id $roots "$archive" $folders $private
ln -sf "$shared" "$folder/lib/liblightbuffer.so.$major"
ln -sf "liblightbuffer.so.$major" "$folder/lib/liblightbuffer.so"
cat >"$folder/lib/pkgconfig/lightbuffer.pc" <<PC
prefix=$folder
libdir=\${prefix}/lib
includedir=\${prefix}/include

Name: lightbuffer
Description: Exact shadow testing with the light buffer
Version: $version
Cflags: -I\${includedir}
Libs: -L\${libdir} -llightbuffer
Libs.private: $private
PC
