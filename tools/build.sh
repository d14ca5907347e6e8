#!/usr/bin/env bash
# Configures a preset if necessary and builds it, with a progress bar on stderr.
#
#   tools/build.sh PRESET [TARGET...]        default: all targets
#
# Builds of one folder are serialised. Without a terminal: one line per tenth.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
preset=$1
shift
case $preset in
  ci) build=$root/build/release ;;
  *) build=$root/build/$preset ;;
esac

say() { printf '%s\n' "$*" >&2; }

# CMake reconfigures by itself when a CMakeLists.txt changes, but not after a change of presets, a
# move of the folder, or the installation or removal of libraries.
surroundings() {
  echo "$root"
  cat "$root/CMakePresets.json"
  if command -v dpkg-query >/dev/null; then
    awk '$1 ~ /^(run|more)$/ { print $2 }' "$root/tools/packages.txt" |
      xargs dpkg-query -W -f='${Package} ${Version} ${Status}\n' 2>/dev/null | sort || true
  fi
}

configure() {
  local now had
  now=$(surroundings)
  if [[ -f $build/build.ninja && -f $build/.configured ]]; then
    had=$(<"$build/.configured")
    # A configuration for the tests is a release build, too.
    if [[ $had == "$preset"$'\n'"$now" || $preset == release && $had == ci$'\n'"$now" ]]; then
      return
    fi
  fi
  say "configure: ${build#"$root"/}"
  if ! (cd "$root" && cmake --fresh --preset "$preset") >"$build/configure.log" 2>&1; then
    cat "$build/configure.log" >&2
    return 1
  fi
  if sed -n 's/^-- \(Without .*\)/  \1/p' "$build/configure.log" | grep . >&2; then
    say "  To add what is left out: tools/setup.sh more, and build again."
  fi
  printf '%s\n%s' "$preset" "$now" >"$build/.configured"
}

# "12 s", "3 min": rounded up, so that 0 means finished.
left() {
  if (($1 > 90)); then echo "$((($1 + 59) / 60)) min"; else echo "$1 s"; fi
}

# Converts ninja's lines "@ done total what" to a bar; all other lines are the compiler's.
show_bar() {
  local line done total seconds tenth=0 width=30 bar blank
  bar=$(printf '#%.0s' $(seq "$width"))
  blank=$(printf '.%.0s' $(seq "$width"))
  local began=$SECONDS
  while IFS= read -r line; do
    if [[ $line =~ ^@\ ([0-9]+)\ ([0-9]+)\  ]]; then
      done=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
      ((total >= 10)) || continue
      seconds=$(((SECONDS - began) * (total - done) / (done > 0 ? done : 1)))
      if [[ -t 2 ]]; then
        printf '\rbuild: %s%s %d of %d, about %s left \e[K' "${bar:0:width * done / total}" \
          "${blank:0:width - width * done / total}" "$done" "$total" "$(left "$seconds")" >&2
      elif ((10 * done / total > tenth)); then
        tenth=$((10 * done / total))
        say "build: $done of $total, $((SECONDS - began)) s"
      fi
    elif [[ $line != "ninja: no work to do." && $line != "ninja: Entering directory"* ]]; then
      [[ ! -t 2 ]] || printf '\r\e[K' >&2
      say "$line"
    fi
  done
  [[ ! -t 2 ]] || printf '\r\e[K' >&2
}

mkdir -p "$build"
exec 9>"$build/.lock"
flock 9
configure
NINJA_STATUS='@ %f %t ' ninja -C "$build" -j "$(nproc)" "$@" 2>&1 9>&- | show_bar
