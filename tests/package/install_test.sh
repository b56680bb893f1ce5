#!/usr/bin/env bash
# Installs Trocar into a folder of its own, runs a program there, writes the man pages and builds another project against the package:
# install_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT

cmake --install "$build" --prefix "$prefix/usr" >/dev/null
unset TROCAR_DATA_DIR TROCAR_BIN_DIR
"$prefix/usr/bin/trocar" task list | grep -q liver-biopsy

# Every file belongs to a Debian package.
for component in trocar hapticd trainer dev; do
  cmake --install "$build" --prefix "$prefix/parts" --component "$component" >/dev/null
done
diff <(cd "$prefix/usr" && find . | sort) <(cd "$prefix/parts" && find . | sort)
rm -rf "$prefix/parts"

# Man pages of all commands, without a warning where groff can tell.
for program in trocar trocar-hapticd trocar-trainer; do
  page=$prefix/$program.1
  "$source/scripts/man_pages" --version 1.0 "$prefix/usr/bin/$program" "$page"
  grep -q '^\.SH OPTIONS' "$page"
  if command -v groff >/dev/null; then
    warnings=$(groff -man -Tutf8 -Kutf8 -ww -z "$page" 2>&1)
    [[ -z $warnings ]] || { echo "error: $page: $warnings" >&2 && exit 1; }
  fi
done
grep -q 'trocar patient build' "$prefix/trocar.1"

# With the same flags: a library with a sanitizer needs it in its user, too.
flags=$(sed -n 's/^CMAKE_CXX_FLAGS:[A-Z]*=//p' "$build/CMakeCache.txt")
configure() {
  cmake -S "$source/tests/package/consumer" -B "$1" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS="$flags" \
    -DCMAKE_PREFIX_PATH="$prefix/usr" "${@:2}"
}
# refuses MESSAGE OPTION...: a wrong find_package says why.
refuses() {
  local said
  rm -rf "$prefix/refused"
  if said=$(configure "$prefix/refused" "${@:2}" 2>&1) || [[ ${said//$'\n'/ } != *$1* ]]; then
    echo "error: not refused with \"$1\": $said" >&2
    exit 1
  fi
}
refuses "there is no module haptic;" -DCOMPONENTS="anatomy;haptic"
refuses "project(NAME" -DCOMPONENTS=exams
# A module of many others, and with it nearly all third-party libraries.
configure "$prefix/many" -DLANGUAGES="C;CXX" -DCOMPONENTS=exams >/dev/null
configure "$prefix/build" >/dev/null
cmake --build "$prefix/build"
# It pushes a needle into the skin of an embedded patient, and fails if it feels no force.
TROCAR_DATA_DIR=$prefix/usr/share/trocar "$prefix/build/first_force" "$prefix/usr/share/trocar"
