#!/usr/bin/env bash
# Introduces faults into a source and reports which of them the module's own tests catch.
#
#   tools/mutate.sh FILE SED_EXPRESSION...
#
#   tools/mutate.sh src/proofmass/core/statistics.cpp 's/count - 1/count/' 's/1\.4826/1.4/'
#
# Each expression is one mutant of FILE, tested separately. Mutants are in a copy of the tree under
# build/mutate, so the working tree is never modified, even if interrupted. One line per mutant:
#
#   caught    a test failed, crashed or reached the time limit: the desired result
#   SURVIVED  every test passed: a test is missing, or the mutant has no relevant effect
#   invalid   the expression changes nothing, or the result does not compile
#
# Exit status: 0 all caught, 1 some survived, 2 usage or an invalid mutant.
set -euo pipefail

if (($# < 2)) || [[ ! $1 =~ ^src/proofmass/([a-z_]+)/.*\.[ch]pp$ ]]; then
  sed -n '2,/^set -/ { /^#/ s/^# \{0,1\}//p }' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
file=$1
suite=${BASH_REMATCH[1]}_test
shift

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
copy=$root/build/mutate/tree
build=$root/build/mutate/dev
mark=$root/build/mutate/mutated # name of the currently mutated file, if any
limit_s=300

# Restored last: newer than any object made from a mutant, so that it is recompiled.
restore() {
  [[ -f $mark ]] || return 0
  local mutated
  mutated=$(<"$mark")
  cp "$root/$mutated" "$copy/$mutated"
  rm "$mark"
}
trap restore EXIT
trap 'exit 130' INT TERM

mkdir -p "$copy"
restore
cp -a "$root"/{CMakeLists.txt,CMakePresets.json,CHANGELOG.md,LICENSE,README.md} "$copy"
cp -a "$root"/{apps,cmake,completions,docs,examples,packaging,rig,src,tests,tools} "$copy"
[[ -d $root/../shared/data ]] && export PROOFMASS_DATA=${PROOFMASS_DATA:-$root/../shared/data}

make_tests() {
  cmake --build "$build" -j "$(nproc)" --target "$suite" >"$build/mutate.log" 2>&1
}
run_tests() {
  timeout "$limit_s" "$(find "$build" -name "$suite" -type f)" --gtest_brief=1 \
    >"$build/mutate.log" 2>&1 </dev/null
}

echo "mutate: building $suite as it is" >&2
cmake -S "$copy" --preset dev -B "$build" >/dev/null
if ! make_tests || ! run_tests; then
  tail -n 30 "$build/mutate.log" >&2
  echo "mutate: $suite fails without any mutant; see above" >&2
  exit 2
fi

survived=0 invalid=0
for expression; do
  echo "$file" >"$mark"
  sed -E "$expression" "$root/$file" >"$copy/$file"
  verdict=caught
  if cmp -s "$root/$file" "$copy/$file" || ! make_tests; then
    verdict=invalid
    invalid=$((invalid + 1))
  elif run_tests; then
    verdict=SURVIVED
    survived=$((survived + 1))
  fi
  printf '%-8s  %s  %s\n' "$verdict" "$file" "$expression"
  restore
done
printf '%d mutants, %d survived, %d invalid\n' $# "$survived" "$invalid"
((invalid == 0)) || exit 2
((survived == 0)) || exit 1
