#!/usr/bin/env bash
# Runs clang-tidy on the sources that differ from a commit, with the flags of the preset dev, which
# compiles each source separately.
#
#   tools/tidy_changed.sh [COMMIT]   default: the last commit, so uncommitted changes
#   tools/tidy_changed.sh --all      every source
#
# A header is checked with the sources that include it, so a change to a header alone needs --all.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

commands=build/dev/compile_commands.json
cmake --preset dev >/dev/null

compiled() { sed -n "s|^ *\"file\": \"$PWD/\\(.*\\)\",\\?\$|\\1|p" "$commands" | grep -v ^build/ | sort -u; }

changed() {
  {
    git diff --name-only --diff-filter=d "$1" -- '*.cpp'
    git ls-files --others --exclude-standard -- '*.cpp'
  } | sort -u
}

if [[ ${1:-} == --all ]]; then
  mapfile -t files < <(compiled)
else
  mapfile -t files < <(comm -12 <(compiled) <(changed "${1:-HEAD}"))
fi
((${#files[@]})) || { echo "tidy: nothing to do" && exit 0; }

echo "tidy: ${#files[@]} sources"
# The commands are g++'s; flags unknown to clang are ignored.
printf '%s\0' "${files[@]}" | xargs -0 -n 1 -P "$(nproc)" \
  clang-tidy-19 -p build/dev --quiet --extra-arg=-Wno-unknown-warning-option 2>&1 |
  sed -E '/^[0-9]+ warnings? generated\.$/d' # its count of what .clang-tidy leaves out
