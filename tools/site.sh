#!/usr/bin/env bash
# Builds the site from README and docs/ and checks every link in it.
#
#   tools/site.sh [FOLDER]     default build/site; open FOLDER/index.html
#
# A page that is not linked, a broken link or anchor, and a page that would load anything from another
# site are errors.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
site=${1:-$root/build/site}
source=$site-source

python3 "$root/tools/site/stage.py" "$source"
sphinx-build -b html -q -W --keep-going -j auto -c "$root/tools/site" "$source" "$site" >&2
python3 "$root/tools/site/check_site.py" "$site"
