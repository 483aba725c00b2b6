#!/bin/bash
# An evaluation harness in the shell: each scene's integrators against an independent reference, held against limits,
# with a page for each. Exit code 0 where every limit is kept.
#
#   client/examples/harness.sh [SCENE ...]         PHRENIC=path/to/phrenic OUT=folder
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
phrenic="${PHRENIC:-$here/../../build/phrenic}"
out="${OUT:-harness}"
mkdir -p "$out"
scenes=("$@")
if [[ ${#scenes[@]} -eq 0 ]]; then scenes=(cube-springs cube-tensegrity); fi

failed=0
for scene in "${scenes[@]}"; do
  code=0
  "$phrenic" --output json study error "$scene" --seconds 1 --levels 4 --check "$here/limits.textproto" \
    >"$out/$scene.json" || code=$?
  case $code in
    0) echo "$scene: every limit kept" ;;
    4) echo "$scene: a limit is passed" && failed=1 ;;
    *) echo "$scene: no answer (exit code $code)" && failed=1 ;;
  esac
done
echo "the numbers are in $out/"
exit $failed
