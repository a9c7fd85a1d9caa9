#!/bin/sh
# Sets up, builds, and runs clast on Debian 12. Needs nothing but a shell, and root for packages that are missing.
#
#   ./setup.sh demo     install what is missing, build clast alone, run the demo campaign
#   ./setup.sh test     install what is missing, build with warnings as errors, pass every test; again under sanitizers
#                       (test --full: instead the long form of every test: hours to days, best as root)
#   ./setup.sh build    install what is missing, build build/release/clast
#   ./setup.sh deb DIR  install what is missing, put clast's Debian package into the folder DIR
#   ./setup.sh packages only install what is missing
set -eu
cd "$(dirname "$0")"

packages="build-essential cmake ninja-build pkg-config
libfyaml-dev libopenmpi-dev openmpi-bin libsqlite3-dev libhdf5-dev libgsl-dev librandom123-dev
libcairo2-dev zlib1g-dev libcmocka-dev libqhull-dev uthash-dev clang-format
libmicrohttpd-dev libjansson-dev nettle-dev
gnuplot-nox
python3 python3-jsonschema python3-ruamel.yaml sqlite3"
# The page of `clast report` is bundled by npm; its tests open it in a browser. The demo needs neither.
page_packages="nodejs npm"
test_packages="chromium file" # cpack needs file
full_packages="clang debootstrap iproute2 munge slurm-wlm"

say() { printf '\n== %s\n' "$*" >&2; }

usage() {
  sed -n '2,10s/^# \{0,1\}//p' "$0"
  exit "$1"
}

install_missing() { # install_missing PACKAGE...
  command -v apt-get >/dev/null || {
    echo "setup.sh: this is not Debian (no apt-get). Install the equivalents of: $*" >&2
    exit 66
  }
  missing=
  for package in "$@"; do
    [ "$package" != npm ] || ! command -v npm >/dev/null || continue # Node's own packages bring npm, and exclude Debian's
    case "$(dpkg-query -W -f '${Status}' "$package" 2>/dev/null || true)" in
      "install ok installed") ;;
      *) missing="$missing $package" ;;
    esac
  done
  [ -n "$missing" ] || return 0
  say "installing:$missing"
  if [ "$(id -u)" -ne 0 ]; then
    echo "setup.sh: run this as root, or first: sudo apt-get install$missing" >&2
    exit 66
  fi
  export DEBIAN_FRONTEND=noninteractive
  apt-get update -qq
  # shellcheck disable=SC2086
  watched "$(mktemp)" '/^Setting up/ { if (++n % 25 == 0) print "  " n " packages set up" }' \
    apt-get install -y -q --no-install-recommends $missing
}

# watched LOG AWK COMMAND...: all that COMMAND prints goes into LOG, and what AWK makes of it to the terminal. COMMAND's
# exit code.
watched() {
  log=$1 show=$2
  shift 2
  { code=0; "$@" 2>&1 || code=$?; echo "$code" >"$log.code"; } | tee "$log" | awk "$show" >&2
  return "$(cat "$log.code")"
}

build() { # build PRESET [TARGET]
  say "building build/$1"
  cmake --preset "$1" >/dev/null
  # ninja prints [STEP/STEPS] before each step: a line for every tenth of them
  if ! NINJA_STATUS='[%f/%t] ' watched "build/$1/build.log" '
    split($1, step, /[][\/]/) == 4 && int(10 * step[2] / step[3]) > tenths {
      tenths = int(10 * step[2] / step[3]); print "  " step[2] " of " step[3] " steps"; fflush() }
    /^npm (pack failed|ERR!)/' \
    cmake --build --preset "$1" -j "$(nproc)" --target "${2:-all}"; then
    grep -E -A12 "^FAILED|error" "build/$1/build.log" >&2
    say "the build failed; all it printed is in build/$1/build.log" >&2
    exit 70
  fi
}

# told_since WHAT: keeps a line for the end, with the processor time of all that this shell has waited for, and the time by
# the clock, since the last call.
lines= spent=0 clock=$(date +%s)
told_since() {
  before=$spent began=$clock clock=$(date +%s)
  times >"$counted"
  spent=$(awk 'NR == 2 { gsub(/[ms]/, " "); print int(60 * ($1 + $3) + $2 + $4) }' "$counted")
  lines="$lines$(printf '\n  %-48s %5d s of processor time %5d s elapsed' "$1" $((spent - before)) $((clock - began)))"
}

tests() { # tests PRESET WHAT
  say "tests, $2"
  code=0
  ctest --preset "$1" -j "$(nproc)" --output-log "build/$1/tests.log" || code=$?
  told_since "$(sed -n 's/.* tests failed out of //p' "build/$1/tests.log") tests, $2"
  return "$code"
}

# shellcheck disable=SC2086 # lists of packages
case "${1:-}" in
  packages)
    install_missing $packages $page_packages $test_packages
    ;;
  build)
    install_missing $packages $page_packages
    build release
    if grep -q "^npm pack failed" build/release/build.log; then
      say "the program is built, but not the page of clast report: $(grep -m1 "^npm pack failed" build/release/build.log)" >&2
      exit 69
    fi
    ;;
  deb) # a build folder of its own: build/ may have come along from a machine with other paths
    [ -n "${2:-}" ] || usage 64 >&2
    install_missing $packages $page_packages file git # git: the program tells its commit, stores keep it
    build=$(mktemp -d)
    say "building the package in $build"
    cmake --preset release -B "$build"
    cmake --build "$build" --target clast clast_manual clast_page
    cpack -G DEB --config "$build/CPackConfig.cmake" -B "$build"
    mkdir -p "$2"
    mv "$build"/*.deb "$2"
    rm -rf "$build"
    ;;
  demo)
    install_missing $packages
    build release clast
    say "build/release/clast run campaign/examples/demo.yaml"
    build/release/clast run campaign/examples/demo.yaml
    say "the program is $PWD/build/release/clast, the results are in demo.db; go on with"
    cat <<'END'
  export PATH=$PWD/build/release:$PATH
  clast estimates demo.db                           # the table again
  clast map demo.db map.png -x strain -y angle      # M_1/M over both thresholds
  clast simulate disc-explosion --picture disc.png  # one run, drawn
  ./setup.sh build && clast report demo.db          # a page for a browser; installs what the page needs
END
    ;;
  test)
    install_missing $packages $page_packages $test_packages
    if [ "${2:-}" = --full ]; then
      install_missing $full_packages
      build ci
      say "tests, long forms; those that cannot run here are told as skipped"
      ctest --preset full -j "$(nproc)"
      exit
    fi
    counted=$(mktemp)
    trap 'rm -f "$counted"; say "time of each part:$lines"' EXIT
    told_since "packages"
    lines=
    build ci
    told_since "build, release"
    tests ci "release"
    build asan-ubsan
    told_since "build, sanitizers"
    tests asan-ubsan "address and undefined-behaviour sanitizers"
    ;;
  -h | --help | help) usage 0 ;;
  *) usage 64 >&2 ;;
esac
