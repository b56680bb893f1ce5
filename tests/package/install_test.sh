#!/usr/bin/env bash
# Installs Trocar into a folder of its own, runs a program there and builds another project against the package:
# install_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT

cmake --install "$build" --prefix "$prefix/usr" >/dev/null
unset TROCAR_DATA_DIR TROCAR_BIN_DIR
"$prefix/usr/bin/trocar" task list | grep -q liver-biopsy

# With the same flags: a library with a sanitizer needs it in its user, too.
flags=$(sed -n 's/^CMAKE_CXX_FLAGS:[A-Z]*=//p' "$build/CMakeCache.txt")
cmake -S "$source/tests/package/consumer" -B "$prefix/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="$flags" -DCMAKE_PREFIX_PATH="$prefix/usr" >/dev/null
cmake --build "$prefix/build"
# It pushes a needle into the skin of an embedded patient, and fails if it feels no force.
TROCAR_DATA_DIR=$prefix/usr/share/trocar "$prefix/build/first_force" "$prefix/usr/share/trocar"
