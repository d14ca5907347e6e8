#!/usr/bin/env bash
# Installs the missing dependencies of `./run`, `./test` or `./test --long`; `more` is `run` with the
# libraries of all live sources.
#
#   tools/setup.sh run|more|test|long
#
# If nothing is missing it needs neither network nor root. Prints to stderr only.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
say() { printf 'setup: %s\n' "$*" >&2; }

case ${1:-} in
  run) groups='run' ;;
  more) groups='run|more' ;;
  test) groups='run|more|test' ;;
  long) groups='run|more|test|long' ;;
  *)
    say "expected run, more, test or long, got '${1:-}'"
    exit 2
    ;;
esac

if ! command -v dpkg-query >/dev/null; then
  say "no dpkg here, so nothing is installed; the packages of tools/packages.txt have to be there"
  exit 0
fi

mapfile -t wanted < <(awk -v groups="^($groups)\$" '$1 ~ groups { print $2 }' "$here/packages.txt")
mapfile -t missing < <(
  dpkg-query -W -f='${Package} ${Status}\n' "${wanted[@]}" 2>/dev/null |
    awk '/ install ok installed$/ { print $1 }' | sort -u |
    comm -13 - <(printf '%s\n' "${wanted[@]}" | sort -u)
)
# Any installation of Node.js is accepted; therefore it is not in the package list.
if [[ $groups == *test* ]] && ! command -v npm >/dev/null; then
  missing+=(nodejs npm)
fi

# npm packages of the tests: third-party programs for tests/readers/, the build of the page, and the
# driver of its browser. Without them those tests are skipped.
install_by_npm() {
  local folder installed
  [[ $groups == *test* ]] || return 0
  for folder in tests/readers web tests/page; do
    folder=$here/../$folder
    installed=$folder/node_modules/.installed
    if cmp -s "$folder/package.json" "$installed"; then continue; fi
    say "installing what ${folder#"$here"/../}/package.json names"
    if npm --prefix "$folder" install --no-package-lock --ignore-scripts --no-audit --no-fund \
      --loglevel=error </dev/null >&2; then
      cp "$folder/package.json" "$installed"
    else
      say "npm could not install them: ${folder#"$here"/../} will be skipped"
    fi
  done
}

if ((${#missing[@]} == 0)); then
  install_by_npm
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo >/dev/null; then
    say "missing, and only root can install them: apt-get install ${missing[*]}"
    exit 1
  fi
  as_root=(sudo)
fi

# Waits for the lock of an unattended upgrade, and retries a failing mirror.
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -qq \
    -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 "$@" </dev/null >&2
}
say "installing ${missing[*]}"
apt update
apt install --no-install-recommends "${missing[@]}"
install_by_npm
