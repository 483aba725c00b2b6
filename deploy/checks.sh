# The stages of deploy/test, and their sum. Sourced, not run.
# shellcheck shell=bash

passed=0
failed=0
declare -a summary=() broken=() failures=()
results=${root:?}/build/test-results

# Adds to the sum: count PASSED FAILED.
count() {
  passed=$((passed + $1))
  failed=$((failed + $2))
}

# Remembers the failed tests that a stage names, one a line of the input: what the last lines of a long log must say.
remember() {
  local -a named
  mapfile -t named
  failures+=("${named[@]}")
}

# A stage that is one check: it passes or it does not.
check() {
  if "$@"; then count 1 0; else count 0 1; fi
}

# run_stage NAME runs stage_NAME, times it, and remembers whether anything in it failed.
run_stage() {
  local name=$1 before=$failed start=$SECONDS outcome=passed
  say "Stage $name"
  mkdir -p "$results"
  "stage_$name"
  if [[ $failed -gt $before ]]; then
    outcome=FAILED
    broken+=("$name")
  fi
  summary+=("$(printf '%-8s %-7s %5d s' "$name" "$outcome" $((SECONDS - start)))")
}

# The end of deploy/test, however it comes to it: a run that did not reach its last stage has failed.
finish() {
  local status=$?
  trap - EXIT
  if [[ $status -ne 0 ]]; then count 0 1; fi
  report
}

report() {
  printf '\n'
  if [[ ${#summary[@]} -gt 0 ]]; then printf '%s\n' "${summary[@]}"; fi
  if [[ ${#failures[@]} -gt 0 ]]; then printf 'failed: %s\n' "${failures[@]}"; fi
  if [[ ${#broken[@]} -gt 0 ]]; then
    printf 'phrenic: repair what the stages name above; "deploy/test %s" runs them alone.\n' "${broken[*]}"
  fi
  printf '%d passed, %d failed\n' "$passed" "$failed"
  [[ $failed -eq 0 ]]
}

# The files that people write: those that git knows, or all but what is made where there is no git.
sources() {
  (cd "$root" && { git ls-files -z --cached --others --exclude-standard "$@" 2>/dev/null ||
    find server client tests -regextype posix-extended -regex '.*\.(cc|h)' -not -path '*/node_modules/*' -print0; })
}

# --- form ---
check_clang_format() {
  (cd "$root" && sources 'server/*.cc' 'server/*.h' 'client/*.cc' 'client/*.h' 'tests/*.cc' 'tests/*.h' |
    xargs -0 -r clang-format --dry-run -Werror)
}

check_prettier() {
  (cd "$root/web" && npm run --silent lint)
}

stage_format() {
  check check_clang_format
  check check_prettier
}

check_shellcheck() {
  (cd "$root" && shellcheck -x deploy/run deploy/test deploy/report deploy/faults deploy/cluster deploy/*.sh client/examples/*.sh tests/client/slurm/* .ci/run tests/deploy/*.sh)
}

stage_scripts() {
  check check_shellcheck
  check "$root/tests/deploy/deploy_test.sh"
}

check_buf() {
  (cd "$root/proto" && ../web/node_modules/.bin/buf lint --config '{"version":"v2","lint":{"use":["STANDARD"]}}')
}

stage_proto() {
  check check_buf
}

# --- the web ---
# vitest NAME SCRIPT runs the npm script and counts its tests; a run that breaks without a failed test counts as one.
vitest() {
  local json=$results/$1.json status=0 good=0 bad=0
  rm -f "$json"
  (cd "$root/web" && npm run --silent "$2" -- --reporter=default --reporter=json --outputFile.json="$json") || status=$?
  if [[ -f $json ]]; then
    read -r good bad < <(node -e 'const r = require(process.argv[1]); console.log(r.numPassedTests, r.numFailedTests)' "$json")
    remember < <(failed_of "$json")
  fi
  if [[ $status -ne 0 && $bad -eq 0 ]]; then bad=1; fi
  count "$good" "$bad"
}

# The failed tests of vitest's JSON, each with the first line of its message.
failed_of() {
  # shellcheck disable=SC2016  # the template is JavaScript's own
  node -e '
    for (const { assertionResults } of require(process.argv[1]).testResults)
      for (const { status, fullName, failureMessages } of assertionResults)
        if (status === "failed") console.log(`${fullName}: ${(failureMessages[0] ?? "").split("\n")[0]}`);' "$1"
}

stage_web() {
  vitest web test
  check build_web
}

stage_e2e() {
  vitest e2e e2e
}

# --- C++ ---
# As deploy/run builds it, and all else.
check_build() {
  # shellcheck disable=SC2154  # unity is lib.sh's
  configure "$root/build" -DCMAKE_BUILD_TYPE=Release "${unity[@]}" && build "$root/build"
}

stage_build() {
  check check_build
}

# ctests FOLDER [OPTION...] runs the tests built there and counts them; a run that breaks counts as one failed.
ctests() {
  local folder=$1 log status=0 bad all
  shift
  log=$results/$(basename "$folder").log
  ctest --test-dir "$folder" -j "$(nproc)" --no-tests=error --output-on-failure --progress "$@" >"$log" 2>&1 || status=$?
  tr '\r' '\n' <"$log" | grep -vE '^ *[0-9]+/[0-9]+ Test|^\[ *[0-9]' || true
  read -r bad all < <(sed -nE 's/.* ([0-9]+) tests? failed out of ([0-9]+)$/\1 \2/p' "$log") || true
  remember < <(sed -nE '/\(Skipped\)$/!s/^\t *[0-9]+ - (.*) \((.*)\).*$/\1: \2/p' "$log")
  if [[ -z ${all:-} ]]; then
    count 0 1
  else
    count $((all - bad)) $((bad == 0 && status != 0 ? 1 : bad))
  fi
}

# Campaigns run on a Slurm of this machine alone where one can be started; their test says where it cannot.
stage_tests() {
  local slurm=$root/build/slurm
  if [[ $(id -u) == 0 ]] && "$root/tests/client/slurm/start" "$slurm" > /dev/null; then
    export SLURM_CONF=$slurm/slurm.conf
  fi
  ctests "$root/build"
  if [[ -n ${SLURM_CONF:-} ]]; then "$root/tests/client/slurm/stop" "$slurm"; fi
}

# sanitized FOLDER SANITIZERS TARGET... builds the targets with the sanitizers.
sanitized() {
  local folder=$1 sanitizers=$2
  shift 2
  configure "$folder" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_CXX_FLAGS_RELWITHDEBINFO='-O1 -g1' "${unity[@]}" -DPHRENIC_SANITIZE="$sanitizers" && build "$folder" "$@"
}

# programs FOLDER [OPTION...] runs the test programs there, each once, and counts the tests in them by the XML that they
# write: instead of a program that wrote one, its tests.
programs() {
  local xml good bad
  xml=$results/$(basename "$1")
  rm -rf "$xml"
  GTEST_OUTPUT=xml:$xml/ ctests "$@"
  remember < <(sed -nE 's/^\[  FAILED  \] ([^ ,]+).*\([0-9]+ ms\)$/\1/p' "$xml.log")
  read -r good bad < <(cat "$xml"/*.xml |
    awk -F'"' '/^<testsuites/ { good += $2 - $4 - ($4 == 0); bad += $4 - ($4 > 0) } END { print good + 0, bad + 0 }')
  count "$good" "$bad"
}

# The physiology tests simulate a whole breath of 20,000 vertices: too long here, and the same code runs in the others.
stage_asan() {
  local folder=$root/build/asan
  check sanitized "$folder" address,undefined tests
  ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1 programs "$folder" -E '^physiology$'
}

# gRPC's library is not built for ThreadSanitizer, so only tests of folders below service/ run under it.
stage_tsan() {
  local folder=$root/build/tsan options=ignore_noninstrumented_modules=1:halt_on_error=1
  check sanitized "$folder" thread tsan_test stream_test session_test
  TSAN_OPTIONS=$options programs "$folder" -R '^(tsan|stream|session)$'
}

check_tidy() {
  local folder=$root/build/tidy
  configure "$folder" "${unity[@]}" && build "$folder" generated_headers || return
  # Options of gcc's are in the commands that it reads.
  run-clang-tidy -p "$folder" -quiet -j "$(nproc)" -extra-arg=-Wno-unknown-warning-option '/phrenic(_[a-z]*|d|)\.dir/Unity/' '_kernel\.cc$' \
    >"$results/tidy.log" 2>&1 && return
  grep -E -A3 '(error|warning):' "$results/tidy.log" || cat "$results/tidy.log"
  return 1
}

stage_tidy() {
  check check_tidy
}
