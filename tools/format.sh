#!/usr/bin/env bash
# Formats the C++ sources according to .clang-format.
#
#   tools/format.sh           in place
#   tools/format.sh --check   changes nothing; fails and shows the deviations
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case ${1:-} in
  '') mode=(-i) ;;
  --check) mode=(--dry-run -Werror) ;;
  *)
    echo "usage: tools/format.sh [--check]" >&2
    exit 2
    ;;
esac

# clang-format 14 and 19 disagree, so the version is part of the style.
find src apps python tests bench fuzz examples rig -name '*.[ch]pp' -print0 |
  xargs -0 clang-format-19 "${mode[@]}"
