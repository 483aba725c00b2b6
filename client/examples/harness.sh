#!/bin/bash
# An evaluation script: compares each scene's integrators with an independent reference and checks limits. Exit code 0
# if every limit is met.
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
    4) echo "$scene: a limit is exceeded" && failed=1 ;;
    *) echo "$scene: no answer (exit code $code)" && failed=1 ;;
  esac
done
echo "the numbers are in $out/"
exit $failed
