#!/bin/bash
# Laws of deploy/: each failure is a sentence that says what to do, and nothing is done twice. Changes nothing on the
# system: programs that would are replaced by doubles in a scratch folder.
# shellcheck disable=SC2016  # single quotes hold text for other shells
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failures=0

# double NAME BODY puts a program in the way of the system's.
double() {
  mkdir -p "$scratch/bin"
  printf '#!/bin/bash\n%s\n' "$2" >"$scratch/bin/$1"
  chmod +x "$scratch/bin/$1"
}

# in_lib COMMAND... runs functions of lib.sh with the doubles first on the PATH; its output and status.
in_lib() {
  PATH=$scratch/bin:$PATH PHRENIC_NODE_DIR=$scratch/node bash -c 'set -euo pipefail; source "$0/deploy/lib.sh"; "$@"' \
    "$root" "$@" 2>&1 || echo "status $?"
}

# expect LAW OUTPUT PART... fails where a part is missing.
expect() {
  local law=$1 output=$2 part
  shift 2
  for part in "$@"; do
    if [[ $output != *"$part"* ]]; then
      printf 'FAILED %s: "%s" is not in:\n%s\n' "$law" "$part" "$output"
      failures=$((failures + 1))
      return
    fi
  done
  printf 'ok %s\n' "$law"
}

expect_equal() {
  if [[ $2 == "$3" ]]; then
    printf 'ok %s\n' "$1"
  else
    printf 'FAILED %s: got "%s", not "%s"\n' "$1" "$2" "$3"
    failures=$((failures + 1))
  fi
}

packages() {
  expect SectionsHoldTheirPackages "$(in_lib packages_of build node)" cmake libgrpc++-dev nodejs npm
  expect_equal SectionsKeepApart "$(in_lib packages_of build | grep -c chromium || true)" 0
  double dpkg-query 'echo "installed cmake"; echo "config-files ninja-build"'
  expect_equal InstalledPackagesAreNotMissing "$(in_lib missing_packages cmake)" ""
  expect_equal RemovedPackagesAreMissing "$(in_lib missing_packages cmake ninja-build)" ninja-build
  double apt-get 'echo "apt-get $*"'
  double sudo '"$@"'
  expect_equal NothingMissingAsksNoApt "$(in_lib install_packages cmake)" ""
  expect MissingPackagesAreInstalled "$(in_lib install_packages cmake ninja-build)" \
    "==> Installing Debian packages: ninja-build" "apt-get update" "install -y -q --no-install-recommends ninja-build"
  double apt-get 'exit 100'
  expect NoNetworkIsSaid "$(in_lib install_packages ninja-build)" "apt-get update failed" "check the network" "status 1"
  double apt-get 'if test "$*" = "update -q"; then exit 0; else exit 100; fi'
  expect FailedInstallIsSaid "$(in_lib install_packages ninja-build)" "could not install ninja-build" "status 1"
  rm -r "${scratch:?}/bin"
}

node() {
  double npm 'exit 1'
  double node 'echo v20.19.0'
  expect_equal ANewNodeIsTaken "$(in_lib ensure_node)" ""
  double node 'echo v18.20.4'
  expect FailedFetchIsSaid "$(in_lib ensure_node)" "could not fetch Node.js" "registry.npmjs.org" "status 1"
  double uname 'echo mips'
  expect UnknownMachineIsSaid "$(in_lib ensure_node)" "no ready-made Node.js for mips" "install Node.js 20.19"
  rm -r "${scratch:?}/bin"
}

run_flags() {
  expect HelpIsGiven "$("$root/deploy/run" --help)" --listen --web --data "Ctrl-C"
  expect BadAddressIsSaid "$("$root/deploy/run" --web nonsense 2>&1 || echo "status $?")" \
    "--web nonsense is not HOST:PORT" "127.0.0.1:8080" "status 1"
  expect MissingValueIsSaid "$("$root/deploy/run" --data 2>&1 || echo "status $?")" "--data needs a value" "status 1"
  expect MissingDataIsSaid "$("$root/deploy/run" --data /nowhere 2>&1 || echo "status $?")" \
    "there is no folder /nowhere" "status 1"
}

stages() {
  expect UnknownStageIsSaid "$("$root/deploy/test" nonsense 2>&1 || echo "status $?")" \
    "there is no stage nonsense" "format scripts" "status 1"
  expect HelpNamesTheStages "$("$root/deploy/test" --help)" "clang-tidy" "format quick_build laws browser, in about" " min"
}

# in_checks COMMAND... runs functions of checks.sh as deploy/test does, with stages of the test's own; results go to the
# scratch folder.
in_checks() {
  bash -c 'set -euo pipefail; source "$0/deploy/lib.sh"; source "$0/deploy/checks.sh"
    results=$1/results times=$1/times
    stage_proto() { check true; }
    stage_web() { check false; }
    check_tidy() { echo "tidy at priority $(nice)"; }
    check_warnings() { false; }
    stage_tests() { check true; }
    shift; "$@"' "$root" "$scratch" "$@" 2>&1 || echo "status $?"
}

stages_are_counted_and_timed() {
  rm -f "$scratch/times"
  expect StagesSayHowLongIsLeft "$(in_checks run_stages proto web)" "==> Stage proto (1 of 2): buf's lint; that clients of the last release go on working. About 2 min left." \
    "==> Stage web (2 of 2)" "About 2 min left."
  expect_equal TimesOfPassedStagesAreKept "$(sed 's/ [01]$//' "$scratch/times")" proto
  echo "web 400" >>"$scratch/times"
  expect_equal TheLastRunTellsTheTime "$(in_checks time_left proto web)" "7 min"
  expect TheLastLineCounts "$(in_checks eval 'trap finish EXIT; run_stages proto web' | tail -6)" "proto        passed" \
    "web          FAILED" '"deploy/test web" runs them alone' "1 passed, 1 failed"
}

checks_run_beside_tests() {
  local output
  output=$(in_checks eval 'trap finish EXIT; run_stages tests tidy')
  expect ChecksBesideTestsCount "$output" "tidy at priority 19" "2 passed, 1 failed"
  output=$(in_checks eval 'vitest() { ps -o stat= -p "$beside"; }
    check_tidy() { sleep 3; }
    check_warnings() { true; }
    begin_beside tidy; stage_e2e; ps -o stat= -p "$beside"; trap finish EXIT')
  expect_equal TheyPauseWhileBrowsersDraw "$(head -2 <<<"$output" | cut -c1 | tr -d '\n' | tr RSD r)" Tr
  expect TheReleaseBuildRunsBesideTheInstallation "$(in_checks eval 'trap finish EXIT
    check_build() { echo "build at priority $(nice)"; }
    begin_build format build tests; echo installed; run_stages build')" "installed" "build at priority 19" "1 passed, 0 failed"
  expect_equal NoBuildRunsBesideTestsBeforeIt "$(in_checks eval 'check_build() { true; }; begin_build tests build; echo "${beside:-alone}"')" alone
  expect_equal WithoutTestsTheyRunAlone "$(in_checks run_stages tidy | grep -c 'priority 19')" 0
}

# Changes of the protos that would break a client of the last release, each by a sed script on one file.
broken_protos_are_refused() {
  local folder=$scratch/protos
  [[ -x $root/web/node_modules/.bin/buf ]] || return 0
  mkdir -p "$folder"
  expect_equal TheProtosKeepTheLastReleases "$(in_checks check_breaking)" ""
  breaks ARemovedFieldIsRefused server.proto '/ web_port = /d' '"web_port" on message "GetServerResponse" was deleted'
  breaks ARenumberedFieldIsRefused server.proto 's/ web_port = 2;/ web_port = 22;/' "was deleted" "Keep what it names"
  breaks ARetypedFieldIsRefused server.proto 's/int32 web_port/string web_port/' "changed type" "status 1"
  breaks ARemovedCallIsRefused server.proto '/rpc GetServer(/d' 'RPC "GetServer"'
  cp -r "$root/proto/phrenic" "$folder"
  sed -i 's/bool encrypted = 5;/&\n  string motto = 600;/' "$folder/phrenic/v1/server.proto"
  expect_equal ANewFieldIsNot "$(in_checks check_breaking "$folder")" ""
}

breaks() {
  local law=$1 file=$2 script=$3
  shift 3
  cp -r "$root/proto/phrenic" "$folder"
  sed -i "$script" "$folder/phrenic/v1/$file"
  expect "$law" "$(in_checks check_breaking "$folder")" "$@"
}

failed_tests_are_named() {
  local json=$scratch/vitest.json
  printf '%s' '{"testResults": [{"assertionResults": [{"status": "passed", "fullName": "Holds"},' \
    '{"status": "failed", "fullName": "Breaks", "failureMessages": ["expected 1 to be 2\n at line 3"]}]}]}' >"$json"
  expect_equal FailedBrowserTestsAreNamed "$(in_checks failed_of "$json")" "Breaks: expected 1 to be 2"
}

# units.py on a build folder of one file.
units_are_checked_once() {
  local folder=$scratch/units
  mkdir -p "$folder"
  echo 'int main() { return 0; }' >"$folder/a.cc"
  printf '[{"directory": "%s", "file": "%s/a.cc", "command": "ccache g++ -Wall -Werror -o a.o -c %s/a.cc"}]' \
    "$folder" "$folder" "$folder" >"$folder/compile_commands.json"
  expect_equal AGoodUnitPasses "$(CI='' "$root/deploy/units.py" "$folder" 'a\.cc$' gcc 2>&1 || echo "status $?")" ""
  expect_equal AGoodUnitIsKnown "$(find "$folder/good" -type f | wc -l)" 1
  echo 'int main() { int unused; }' >"$folder/a.cc"
  expect ABadUnitIsNamed "$(CI='' "$root/deploy/units.py" "$folder" 'a\.cc$' gcc 2>&1 || echo "status $?")" \
    "unused variable" "status 1"
  expect NoUnitIsAFault "$("$root/deploy/units.py" "$folder" nothing gcc 2>&1 || echo "status $?")" "no file of" "status 1"
}

guards_are_valid() {
  local file
  PATH=$PATH:/usr/sbin
  command -v nginx >/dev/null || return 0
  for file in guard.conf cluster.conf; do
    mkdir -p "$scratch/$file"
    in_lib make_nginx_folder "$scratch/$file" 18443 "$file"
    echo "server 127.0.0.1:1;" | tee "$scratch/$file/phrenic/servers-grpc.conf" >"$scratch/$file/phrenic/servers-web.conf"
    expect "GuardIsValid: $file" "$(nginx -t -p "$scratch/$file" -c "$scratch/$file/nginx.conf" -e stderr 2>&1)" \
      "test is successful"
  done
  expect GuardFlagsAreSaid "$("$root/deploy/guard" --nonsense 2>&1 || echo "status $?")" "no flag --nonsense" "status 1"
}

# systemd's measure of what the service may do, in tenths: 0 is nothing, 100 everything.
service_is_confined() {
  command -v systemd-analyze >/dev/null || return 0
  expect ServiceIsConfined \
    "$(systemd-analyze security --offline=true --threshold=20 "$root/deploy/phrenicd.service" 2>&1 || echo "status $?")" \
    "exposure level for phrenicd.service: 1."
}

packages
node
run_flags
service_is_confined
guards_are_valid
stages
failed_tests_are_named
broken_protos_are_refused
stages_are_counted_and_timed
checks_run_beside_tests
units_are_checked_once
[[ $failures -eq 0 ]]
