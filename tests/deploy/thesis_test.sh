#!/bin/bash
# thesis_test.sh PHRENIC DIR: deploy/thesis makes each figure and table of the thesis that a program can make, from coarse
# meshes and short trials.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
page=$2/thesis.html
rm -rf "$2"
"$root/deploy/thesis" --quick --phrenic "$1" --out "$2"
failures=0

# expect PATTERN fails if no line of the page has it.
expect() {
  grep -qE "$1" "$page" && return
  echo "FAILED: $page has no $1"
  failures=$((failures + 1))
}

for figure in 4.4 4.8 5.1 5.2 5.3 5.4-5.6 5.7 5.8 5.9 5.10-5.11 5.12-5.13 5.14-5.15 5.16-5.17 5.18 5.19-5.20 5.21-5.22 \
  5.23 5.24 5.25 5.26 5.27; do
  expect "<h[123][^>]*>$figure:"
done
expect '<svg'
expect '<table'
if grep -nE '>(nan|inf|None)<' "$page" | head -3 | cut -c1-200 | grep .; then failures=$((failures + 1)); fi
[[ $failures -eq 0 ]]
