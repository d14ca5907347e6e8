#!/usr/bin/env bash
# Installs what `./run`, `./test` or `./test --long` needs and this machine lacks; `more` is `run` with
# the libraries of all live sources.
#
#   tools/setup.sh run|more|test|long
#
# Where everything is there it needs neither network nor root. Speaks on stderr only.
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
# Node.js is taken as it is wherever it comes from; it is named here for that.
if [[ $groups == *test* ]] && ! command -v npm >/dev/null; then
  missing+=(nodejs npm)
fi

# What tests need by npm: programs of others that tests/readers/ holds our files against, what builds
# the page, and what drives it. Those tests are skipped without.
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

# The lock of an unattended upgrade is waited for, and a mirror that stumbles is asked again.
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -qq \
    -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 "$@" </dev/null >&2
}
say "installing ${missing[*]}"
apt update
apt install --no-install-recommends "${missing[@]}"
install_by_npm
