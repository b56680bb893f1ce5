#!/usr/bin/env bash
# Installs Trocar into a folder of its own, and there runs a program and builds another project against the package.
# install_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT

cmake --install "$build" --prefix "$prefix/usr" >/dev/null
unset TROCAR_DATA_DIR TROCAR_BIN_DIR
"$prefix/usr/bin/trocar" task list | grep -q liver-biopsy

cmake -S "$source/tests/package" -B "$prefix/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix/usr" >/dev/null
cmake --build "$prefix/build" >/dev/null
# The skin of the built-in tissues holds the needle back, and the force points out of the body.
"$prefix/build/first_force" "$prefix/usr/share/trocar"
