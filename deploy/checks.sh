# The stages of deploy/test and their results. Sourced, not run.
# shellcheck shell=bash

# NAME, seconds on two cores with nothing built or cached, what the stage checks; in the order in which they run.
stage_table() {
  cat <<'TEXT'
format     20 clang-format and prettier
scripts    40 shellcheck, and the tests of deploy/
proto       5 buf's lint; that clients of the last release go on working
web       110 type check, unit tests and build of the viewer
build     510 the Release build by gcc, warnings as errors
tests     470 what depends on that build: laws of mechanics, formats, physiology, judges, benches, trials
e2e       430 the viewer in headless Chromium
asan     1000 all other tests under ASan and UBSan, built by clang
tsan      120 the tests of threads under ThreadSanitizer
tidy      330 clang-tidy; gcc's warnings in the tests that only clang compiles
quick_build 480 the Release build of the server and of the laws
laws       60 the laws of the tree and of mechanics, and the golden files
browser    40 one end-to-end test
TEXT
}
# shellcheck disable=SC2034  # used by deploy/test
full_stages=(format scripts proto web build tests e2e asan tsan tidy)
# shellcheck disable=SC2034
quick_stages=(format quick_build laws browser)

passed=0
failed=0
declare -a summary=() broken=() failures=()
results=${root:?}/build/test-results
times=$root/build/test-times

# about NAME prints what a stage checks.
about() {
  stage_table | sed -n "s/^$1 *[0-9]* //p"
}

# seconds_of NAME prints how long a stage took when it last passed, or by the table.
seconds_of() {
  { stage_table && { cat "$times" 2>/dev/null || true; }; } | awk -v name="$1" '$1 == name { s = $2 } END { print s + 0 }'
}

# time_left NAME... prints how long the named stages take together.
time_left() {
  local sum=0 name
  for name in "$@"; do sum=$((sum + $(seconds_of "$name"))); done
  if [[ $sum -lt 60 ]]; then echo "$sum s"; else echo "$(((sum + 30) / 60)) min"; fi
}

# count PASSED FAILED adds to the results.
count() {
  passed=$((passed + $1))
  failed=$((failed + $2))
}

# Keeps the names of failed tests, one a line of the input: the last lines of a long log must name them.
remember() {
  local -a named
  mapfile -t named
  failures+=("${named[@]}")
}

# check COMMAND... is a stage, or part of one, that counts as one test.
check() {
  if "$@"; then count 1 0; else count 0 1; fi
}

# run_stages NAME... runs the stages, and says before each how long is left.
run_stages() {
  local -a left=("$@")
  local name
  mkdir -p "$results"
  for name in "$@"; do
    say "Stage $name ($(($# - ${#left[@]} + 1)) of $#): $(about "$name"). About $(time_left "${left[@]}") left."
    if [[ $name == tests ]]; then begin_beside "${left[@]}"; fi
    run_stage "$name"
    left=("${left[@]:1}")
  done
}

# run_stage NAME runs stage_NAME, times it, and keeps whether anything in it failed.
run_stage() {
  local name=$1 before=$failed start=$SECONDS outcome=passed seconds
  "stage_$name"
  seconds=$((SECONDS - start))
  if [[ $failed -gt $before ]]; then
    outcome=FAILED
    broken+=("$name")
  else
    echo "$name $seconds" >>"$times"
  fi
  note_time "$name" "$outcome" "$seconds"
}

note_time() {
  summary+=("$(printf '%-12s %-7s %5d s' "$1" "$2" "$3")")
}

# --- beside: compilation runs at the lowest priority while packages are installed and tests wait. clang-tidy and gcc's
# warnings run beside it in the scheduler's class "idle", so they use a core only while nothing else does ---
declare -a beside=() started=()  # process groups, and the names of their checks
# The checks of a stage that compile and run nothing.
compiled_by() {
  case $1 in
    build) echo release_build ;;
    asan) echo asan_build ;;
    tsan) echo tsan_build ;;
  esac
}

# The checks of a stage that read the sources alone.
read_by() {
  if [[ $1 == tidy ]]; then printf '%s\n' tidy warnings; fi
}

# begin_build STAGE... starts the Release build if it is one of the stages and no tests precede it.
begin_build() {
  case " $* " in
    *" tests "*"build "*) ;;
    *" build "*) begin_beside build ;;
  esac
}

# begin_beside STAGE... starts the compilations of the stages, one after the other, and the checks that read sources.
begin_beside() {
  local -a compiled read
  local stage
  mapfile -t compiled < <(for stage in "$@"; do compiled_by "$stage"; done)
  mapfile -t read < <(for stage in "$@"; do read_by "$stage"; done)
  begin_checks other "${compiled[@]}"
  begin_checks idle "${read[@]}"
}

# begin_checks CLASS NAME... starts the checks in a process group of the class, one after the other.
begin_checks() {
  local class=$1 name status
  shift
  [[ $# -gt 0 ]] || return 0
  mkdir -p "$results"
  for name in "$@"; do rm -f "$results/$name.status"; done
  set -m # a process group of its own, which finish can end
  (
    trap - EXIT
    renice -n 19 -p "$BASHPID" >/dev/null
    if [[ $class == idle ]]; then chrt --idle --pid 0 "$BASHPID" 2>/dev/null || true; fi # not every container allows it
    for name in "$@"; do
      status=0
      "check_$name" >"$results/$name.log" 2>&1 || status=$?
      echo "$status" >"$results/$name.status"
    done
  ) &
  beside+=("$!")
  started+=("$@")
  set +m
}

# signal_beside SIGNAL sends the signal to the process groups that run beside.
signal_beside() {
  local group
  for group in "${beside[@]}"; do kill "-$1" -- "-$group" 2>/dev/null || true; done
}

# pause_beside and resume_beside: browsers draw too slowly beside compilers, also beside those of the lowest priority.
pause_beside() {
  signal_beside STOP
}

resume_beside() {
  signal_beside CONT
}

# beside NAME runs check_NAME, or waits for begin_beside if that has started it.
beside() {
  local name=$1
  if [[ " ${started[*]} " != *" $name "* ]]; then
    "check_$name"
    return
  fi
  until [[ -f $results/$name.status ]] || ! kill -0 "${beside[@]}" 2>/dev/null; do sleep 1; done
  cat "$results/$name.log"
  [[ $(cat "$results/$name.status") == 0 ]]
}

# Ends deploy/test, for whatever reason: a run that did not reach its last stage has failed.
finish() {
  local status=$?
  trap - EXIT
  signal_beside TERM
  resume_beside # what is paused ends only then
  if [[ $status -ne 0 ]]; then count 0 1; fi
  note_time "all" "" "$SECONDS"
  report
}

report() {
  printf '\n'
  printf '%s\n' "${summary[@]}"
  if [[ ${#failures[@]} -gt 0 ]]; then printf 'failed: %s\n' "${failures[@]}"; fi
  if [[ ${#broken[@]} -gt 0 ]]; then
    printf 'phrenic: repair what the stages name above; "deploy/test %s" runs them alone.\n' "${broken[*]}"
  fi
  printf '%d passed, %d failed\n' "$passed" "$failed"
  [[ $failed -eq 0 ]]
}

# Prints the source files: those that git knows, or if there is no git, those that are not generated.
sources() {
  (cd "$root" && { git ls-files -z --cached --others --exclude-standard "$@" 2>/dev/null ||
    find server client tests -regextype posix-extended -regex '.*\.(cc|h)' -not -path '*/node_modules/*' -print0; })
}

# --- format, scripts, proto ---
check_clang_format() {
  (cd "$root" && sources 'server/*.cc' 'server/*.h' 'client/*.cc' 'client/*.h' 'tests/*.cc' 'tests/*.h' |
    xargs -0 -r -P "$(nproc)" -n 50 clang-format --dry-run -Werror)
}

check_prettier() {
  (cd "$root/web" && npm run --silent lint)
}

stage_format() {
  check check_clang_format
  check check_prettier
}

check_shellcheck() {
  (cd "$root" && shellcheck -x deploy/run deploy/test deploy/starts deploy/report deploy/faults deploy/cluster deploy/package deploy/guard deploy/*.sh \
    client/examples/*.sh tests/client/slurm/* .ci/run tests/deploy/*.sh)
}

check_compose() {
  docker-compose -f "$root/deploy/compose.yaml" config --quiet
}

stage_scripts() {
  check check_shellcheck
  check check_compose
  check "$root/tests/deploy/deploy_test.sh"
}

check_buf() {
  (cd "$root/proto" && ../web/node_modules/.bin/buf lint --config '{"version":"v2","lint":{"use":["STANDARD"]}}')
}

# check_breaking [FOLDER] compares the protos with those of the last release, which the file holds: a client of that
# release must still compile and understand every message.
released=$root/tests/proto/released.binpb.gz
check_breaking() {
  (cd "${1:-$root/proto}" && "$root/web/node_modules/.bin/buf" breaking --against "$released" \
    --config '{"version":"v2","breaking":{"use":["FILE"]}}') ||
    { echo "phrenic: a client of the last release breaks (above). Keep what it names, mark it deprecated and add a field." && false; }
}

stage_proto() {
  check check_buf
  check check_breaking
}

# --- the viewer ---
# vitest NAME SCRIPT [OPTION...] runs the npm script and counts its tests; a run that breaks without a failed test counts
# as one failed.
vitest() {
  local name=$1 script=$2 json=$results/$1.json status=0 good=0 bad=0
  shift 2
  rm -f "$json"
  (cd "$root/web" && npm run --silent "$script" -- --reporter=default --reporter=json --outputFile.json="$json" "$@") ||
    status=$?
  if [[ -f $json ]]; then
    read -r good bad < <(node -e 'const r = require(process.argv[1]); console.log(r.numPassedTests, r.numFailedTests)' "$json")
    remember < <(failed_of "$json")
  fi
  if [[ $status -ne 0 && $bad -eq 0 ]]; then bad=1; fi
  count "$good" "$bad"
}

# failed_of JSON prints the failed tests of vitest's report, each with the first line of its message.
failed_of() {
  # shellcheck disable=SC2016  # the template is JavaScript's
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
  pause_beside
  vitest e2e e2e
  resume_beside
}

stage_browser() {
  check build_web
  vitest browser e2e viewer.test.ts -t 'IsThereAndLive|ItsDiaphragmsPixelsMove'
}

# --- C++: Release ---
# check_build TARGET...
check_build() {
  configure_release && build "$root/build" "$@"
}

check_release_build() {
  check_build phrenicd phrenic package_words python_package release_tests
}

stage_build() {
  check beside release_build
}

# The laws: tests of ctest whose names begin so.
laws='^(architecture|contract|exact|golden|mechanics)/'

stage_quick_build() {
  check check_build phrenicd architecture_test contract_test exact_test golden_test mechanics_test
}

# Tests that run beside each other.
at_a_time=$(nproc)

# ctests FOLDER [OPTION...] runs the tests built there and counts them; a run that breaks counts as one failed.
ctests() {
  local folder=$1 log status=0 bad all
  shift
  log=$results/$(basename "$folder").log
  ctest --test-dir "$folder" -j "$at_a_time" --no-tests=error --output-on-failure --progress "$@" >"$log" 2>&1 || status=$?
  tr '\r' '\n' <"$log" | grep -vE '^ *[0-9]+/[0-9]+ Test|^\[ *[0-9]' || true
  read -r bad all < <(sed -nE 's/.* ([0-9]+) tests? failed out of ([0-9]+)$/\1 \2/p' "$log") || true
  remember < <(sed -nE '/\(Skipped\)$/!s/^\t *[0-9]+ - (.*) \((.*)\).*$/\1: \2/p' "$log")
  remember < <(sed -nE 's/^(FAIL|ERROR): (test\w+) \((.*)\)$/python: \3/p; s/^FAIL: (\w+: .*)$/\1/p' "$log")
  if [[ -z ${all:-} ]]; then
    count 0 1
  else
    count $((all - bad)) $((bad == 0 && status != 0 ? 1 : bad))
  fi
}

# What the Release build alone can show (tests/CMakeLists.txt): the same bits by gcc and at -O3, allocations, times.
stage_tests() {
  ctests "$root/build" -L '^release$'
}

stage_laws() {
  ctests "$root/build" -R "$laws"
}

# --- C++: sanitizers ---
# sanitized FOLDER SANITIZERS TARGET... builds the targets with the sanitizers. What computes is optimised
# (server/CMakeLists.txt, tests/CMakeLists.txt); what answers calls compiles in a third of the time without.
sanitized() {
  local folder=$1 sanitizers=$2
  shift 2
  # shellcheck disable=SC2154  # whole is set by lib.sh
  configure "$folder" -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_EXE_LINKER_FLAGS=-fuse-ld=lld \
    -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO='-O0 -g1' "${whole[@]}" \
    -DPHRENIC_SANITIZE="$sanitizers" && build "$folder" "$@"
}

# programs FOLDER [OPTION...] runs the test programs there, each once, one more at a time than there are processors, since
# those of the server and the client wait for a quarter of their time, and counts the tests in them by the XML that they
# write; a program that writes none counts as one.
programs() {
  local xml good bad at_a_time=$(($(nproc) + 1))
  xml=$results/$(basename "$1")
  rm -rf "$xml"
  GTEST_OUTPUT=xml:$xml/ ctests "$@"
  remember < <(sed -nE 's/^\[  FAILED  \] ([^ ,]+).*\([0-9]+ ms\)$/\1/p' "$xml.log")
  read -r good bad < <(cat "$xml"/*.xml |
    awk -F'"' '/^<testsuites/ { good += $2 - $4 - ($4 == 0); bad += $4 - ($4 > 0) } END { print good + 0, bad + 0 }')
  count "$good" "$bad"
}

check_asan_build() {
  sanitized "$root/build/asan" address,undefined tests
}

# Campaigns run on a Slurm of this machine alone if it can be started; if not, their test says so.
stage_asan() {
  local folder=$root/build/asan slurm=$root/build/slurm
  check beside asan_build
  if [[ $(id -u) == 0 ]] && "$root/tests/client/slurm/start" "$slurm" >/dev/null; then
    export SLURM_CONF=$slurm/slurm.conf
  fi
  ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1:malloc_context_size=10 UBSAN_OPTIONS=print_stacktrace=1 programs "$folder"
  if [[ -n ${SLURM_CONF:-} ]]; then "$root/tests/client/slurm/stop" "$slurm"; fi
}

check_tsan_build() {
  sanitized "$root/build/tsan" thread tsan_test stream_test session_test
}

# gRPC's library is not built for ThreadSanitizer, so only tests of folders below service/ run under it. Long tests with one
# thread are left out; the asan stage runs them.
stage_tsan() {
  local folder=$root/build/tsan options=ignore_noninstrumented_modules=1:halt_on_error=1
  check beside tsan_build
  GTEST_FILTER='-*OnThePatient/*:PredictedCodec.IsTheSmallestOnAThorax:*ShippedScene.*' TSAN_OPTIONS=$options \
    programs "$folder" -R '^(tsan|stream|session)$'
}

# --- C++: without running it ---
check_tidy() {
  local folder=$root/build/tidy
  configure "$folder" "${whole[@]}" && build "$folder" generated_headers &&
    "$root/deploy/units.py" "$folder" '/phrenic(_(?!grpc|proto)[a-z]*|d|)\.dir/Unity/|/server/.*_kernel\.cc$' tidy
}

# Prints the test programs of the Release build, as alternatives of a regular expression.
released_programs() {
  sed -n '/^set(in_release/,/)/p' "$root/tests/CMakeLists.txt" | tr '()\n/' '   _' | sed -E 's/ *set +in_release +//; s/ +$//; s/ +/|/g'
}

# gcc compiles no test program for the asan stage: it reads here those that the Release build does not compile.
check_warnings() {
  local folder=$root/build/tidy
  configure "$folder" "${whole[@]}" && build "$folder" generated_headers &&
    "$root/deploy/units.py" "$folder" "/tests/CMakeFiles/(?!($(released_programs))_test).*_test\.dir/Unity/|/tests/CMakeFiles/fuzz_replay\.dir/" gcc
}

stage_tidy() {
  check beside tidy
  check beside warnings
}
