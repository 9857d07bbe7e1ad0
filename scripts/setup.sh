#!/usr/bin/env bash
# Makes .venv ready: `setup.sh sim` for running and simulating, `setup.sh dev` for tests and checks too.
# `setup.sh ros` installs what the live tests need of Debian's ROS 1; its Python is the system's.
# `setup.sh ros2` makes .venv-ros2 with what the live tests need of ROS 2, which is on PyPI.
# `setup.sh browser` installs Chromium, and in viewer/node_modules what builds the viewer.
# Quick when nothing changed, safe to interrupt, safe to start twice. PYTHON=... chooses the interpreter.
set -euo pipefail
CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

say() { printf 'setup: %s\n' "$*" >&2; }

fail() {
  say "$@"
  exit 1
}

# Installs Debian packages where that is allowed; otherwise prints the line to run, and fails. One
# set-up at a time: two cannot read the lists of packages.
install_packages() (
  exec 8<Makefile
  ! command -v flock >/dev/null || flock 8
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  ((EUID == 0)) || apt=(sudo -n "${apt[@]}")
  if command -v apt-get >/dev/null && { ((EUID == 0)) || sudo -n true 2>/dev/null; }; then
    say "installing $*"
    local install=("${apt[@]}" install -y --no-install-recommends "$@")
    "${install[@]}" </dev/null >/dev/null 2>&1 && return
    "${apt[@]}" update </dev/null >/dev/null && "${install[@]}" </dev/null >/dev/null && return
  fi
  say "missing: $*. Run: sudo apt-get update && sudo apt-get install -y $*"
  return 1
)

# Prints `path version` of an interpreter, a shim or a virtual environment followed to its origin.
# Fails where it does not run, is older than 3.10, or cannot import the modules named after it.
probe() {
  "$1" -c '
import importlib, sys
if sys.version_info < (3, 10): sys.exit(1)
for name in sys.argv[1:]: importlib.import_module(name)
print(sys._base_executable, "%d.%d" % sys.version_info[:2], sep="\t")' "${@:2}" 2>/dev/null
}

# The first interpreter that serves, in the order of how readily PyBullet installs on it.
find_python() {
  local names=(python3.11 python3.10 python3.12 python3.13 python3.14 python3) name path
  [[ -z ${PYTHON:-} ]] || names=("$PYTHON")
  for name in "${names[@]}"; do
    while IFS= read -r path; do
      probe "$path" "$@" && return
    done < <(type -aP -- "$name")
  done
  return 1
}

choose_python() {
  local found packages=(python3 python3-venv)
  if ! found=$(find_python venv ensurepip); then
    [[ -z ${PYTHON:-} ]] || find_python >/dev/null || fail "PYTHON=$PYTHON does not run, or is older than 3.10"
    if found=$(find_python); then packages=("python${found##*$'\t'}-venv"); fi
    install_packages "${packages[@]}" || exit 1
    found=$(find_python venv ensurepip) || fail "no Python 3.10 or newer with venv was found"
  fi
  python=${found%$'\t'*} version=${found##*$'\t'}
}

# A virtual environment carries the file `unfinished` from its first moment until all is in it.
make_venv() {
  if [[ -z ${PYTHON:-} && -x .venv/bin/python && ! -e .venv/unfinished ]]; then
    PYTHON=.venv/bin/python choose_python
  else
    choose_python
  fi
  if [[ -e .venv/unfinished ]] || [[ "$(probe .venv/bin/python pip)" != "$python"$'\t'* ]]; then
    say "making .venv with Python $version ($python)"
    rm -rf .venv
    mkdir .venv
    touch .venv/unfinished
    "$python" -m venv .venv
  fi
  touch .venv/unfinished
}

pip() { .venv/bin/python -m pip --disable-pip-version-check --no-input "$@" </dev/null; }

# Prints the packages that compiling an extension for this Python still needs.
compiler_parts() {
  command -v g++ >/dev/null || echo g++
  "$python" -c 'import pathlib, sys, sysconfig
sys.exit(not pathlib.Path(sysconfig.get_path("include"), "Python.h").exists())' || echo "python$version-dev"
}

# Prints the packages with what the tests of the C++ target still need. One clang is enough, of any version.
cpp_parts() {
  command -v g++ >/dev/null || echo g++
  compgen -c clang++ >/dev/null || printf '%s\n' clang libclang-rt-dev
  compgen -c clang-format >/dev/null || echo clang-format
  command -v cmake >/dev/null || echo cmake
  [[ -d /usr/share/ament_cmake ]] || echo ament-cmake
  # A compiler over Newlib without its libraries: 53 MB to download, 480 MB installed.
  command -v arm-none-eabi-g++ >/dev/null ||
    printf '%s\n' gcc-arm-none-eabi libstdc++-arm-none-eabi-dev libnewlib-dev
  # Runs their programs: 5 MB to download, 30 MB installed.
  command -v qemu-system-arm >/dev/null || echo qemu-system-arm
}

# Prints the packages that judge the properties of machines in the tests: a model checker, and a C
# compiler that takes 0.1 s for one of its programs, for which gcc takes 4 s.
spin_parts() {
  local name
  for name in spin tcc; do command -v "$name" >/dev/null || echo "$name"; done
}

# PyPI has PyBullet ready-made for these alone.
prepare_pybullet() {
  if [[ "$version $(uname -sm)" =~ ^3\.1[01]\ Linux\ x86_64$ ]] || pip show -qq pybullet 2>/dev/null; then return; fi
  say "no ready-made PyBullet for Python $version here: compiling it, which takes about three minutes"
  say "(Python 3.11 and 3.10 need no compiling: PYTHON=python3.11 make ...)"
  local parts
  mapfile -t parts < <(compiler_parts)
  ((${#parts[@]} == 0)) || install_packages "${parts[@]}" || exit 1
}

# What tests and pictures gain from; everything else goes on without it.
prepare_optional() {
  command -v dot >/dev/null || install_packages graphviz || say "going on without Graphviz: no pictures"
  [[ $level == dev ]] || return 0
  local parts
  mapfile -t parts < <(compiler_parts)
  ((${#parts[@]} == 0)) || install_packages "${parts[@]}" || say "going on without a compiler"
  mapfile -t parts < <(cpp_parts)
  ((${#parts[@]} == 0)) || install_packages "${parts[@]}" || say "going on with fewer C++ compilers"
  mapfile -t parts < <(spin_parts)
  ((${#parts[@]} == 0)) || install_packages "${parts[@]}" || say "going on without SPIN"
}

# The state of .venv that a stamp stands for; the folder, because installed scripts name it.
key() { { cat pyproject.toml scripts/setup.sh && printf '%s\n' "$PWD" "${PYTHON:-}"; } | cksum; }

is_ready() { [[ -x .venv/bin/python && ! -e .venv/unfinished && -e .venv/ready-$level && $(<".venv/ready-$level") == "$(key)" ]]; }

set_up() {
  make_venv
  prepare_pybullet
  prepare_optional
  say "installing what is missing in .venv: a minute or two"
  if [[ $level == sim ]]; then pip install -q -e '.[sim]'; else pip install -q -e '.[sim,dev]'; fi
  # In a folder of its own: beside the other packages it would replace the bundled runtime.
  [[ $level == sim || -d .venv/standalone-smach/smach ]] ||
    pip install -q --no-deps --target .venv/standalone-smach standalone-smach==0.0.9
  key >.venv/ready-sim
  [[ $level == sim ]] || key >.venv/ready-dev
  rm .venv/unfinished
}

# Debian's ROS is for the system's Python, whatever .venv has. 25 s, 13 MB to download, 90 MB installed.
prepare_ros() {
  local packages=(
    python3-rospy python3-rosmaster python3-actionlib python3-std-srvs python3-geometry-msgs
    python3-sensor-msgs python3-tf2-ros python3-tf2-geometry-msgs python3-rosbag python3-rostopic
  ) missing
  mapfile -t missing < <(dpkg-query -Wf '${db:Status-Abbrev}${Package}\n' "${packages[@]}" 2>/dev/null |
    sed -n 's/^ii //p' | sort | comm -13 - <(printf '%s\n' "${packages[@]}" | sort))
  ((${#missing[@]} == 0)) || install_packages "${missing[@]}"
}

# 75 packages, 170 MB installed; wheels for x86_64 and arm64, Python 3.10 to 3.14. `interfaces` are
# the messages of the tests' own, built with cmake.
prepare_ros2() {
  local stamp=.venv-ros2/ready interfaces=tests/ros2/interfaces state
  state=$(find "$interfaces" scripts/setup.sh scripts/ros2.txt -type f -exec cat {} + | cksum)
  [[ -e $stamp && $(<"$stamp") == "$state $PWD" ]] && return
  command -v cmake >/dev/null && command -v g++ >/dev/null || install_packages cmake g++ || return 1
  [[ ! -x .venv/bin/python ]] || PYTHON=${PYTHON:-.venv/bin/python}
  choose_python
  say "installing ROS 2 in .venv-ros2: a minute or two"
  rm -f "$stamp"
  "$python" -m venv --clear .venv-ros2
  .venv-ros2/bin/python -m pip --disable-pip-version-check --no-input install -q -r scripts/ros2.txt \
    </dev/null || return 1
  build_interfaces "$interfaces" &>.venv-ros2/interfaces.log || {
    say "the interfaces of the tests cannot be built: the reason is in .venv-ros2/interfaces.log"
    return 1
  }
  printf '%s\n' "$state $PWD" >"$stamp"
}

# Builds the interface packages of the tests into .venv-ros2/interfaces. The wheels name folders of
# the machine that built them, which cmake refuses. ament splits paths at spaces, so a link without
# them takes the place of such a folder.
build_interfaces() {
  local here=$PWD root package site include
  if [[ $here == *[^A-Za-z0-9_./-]* ]]; then
    here=${TMPDIR:-/tmp}/smachac-$(cksum <<<"$PWD" | cut -d' ' -f1)
    ln -sfn "$PWD" "$here"
  fi
  root=$here/.venv-ros2
  site=$("$root/bin/python" -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
  include=$("$root/bin/python" -c 'import sysconfig; print(sysconfig.get_path("include"))')
  grep -rlZ /opt/python "$root/share" --include='*.cmake' | xargs -0r sed -i -E \
    "s#/opt/python/[^;\"]*/site-packages#$site#g; s#/opt/python/[^;\"]*/include/python[0-9.]+#$include#g"
  for package in "$here/$1"/*/; do
    rm -rf "$root/build"
    PATH=$root/bin:$PATH AMENT_PREFIX_PATH=$root CMAKE_PREFIX_PATH=$root \
      cmake -S "$package" -B "$root/build" -DCMAKE_INSTALL_PREFIX="$root/interfaces" \
      -DBUILD_TESTING=OFF -DPython3_EXECUTABLE="$root/bin/python" || return 1
    PATH=$root/bin:$PATH AMENT_PREFIX_PATH=$root cmake --build "$root/build" --target install -j 2 || return 1
  done
  rm -rf "$root/build"
  [[ $here == "$PWD" ]] || rm -f "$here"
}

# Prints the packages that the tests in a browser still need. npm comes with Node of other sources.
browser_parts() {
  compgen -c chromium >/dev/null || compgen -c google-chrome >/dev/null || echo chromium
  command -v node >/dev/null || echo nodejs
  command -v npm >/dev/null || echo npm
}

prepare_browser() {
  local parts stamp=viewer/node_modules/.ready state
  mapfile -t parts < <(browser_parts)
  ((${#parts[@]} == 0)) || install_packages "${parts[@]}" || return 1
  state=$(cat viewer/package.json viewer/package-lock.json | cksum)
  [[ -e $stamp && $(<"$stamp") == "$state" ]] && return
  say "installing what builds the viewer in viewer/node_modules"
  (cd viewer && npm ci --no-audit --no-fund --loglevel=error </dev/null >/dev/null) || return 1
  printf '%s\n' "$state" >"$stamp"
}

level=${1:-}
[[ $level == sim || $level == dev || $level == ros || $level == ros2 || $level == browser ]] ||
  fail "usage: setup.sh sim|dev|ros|ros2|browser"
if [[ $level == ros || $level == ros2 || $level == browser ]]; then
  "prepare_$level"
  exit
fi
is_ready && exit
trap 'exit 130' INT
exec 9<pyproject.toml
if command -v flock >/dev/null && ! flock -n 9; then
  say "waiting for another set-up to end"
  flock 9
fi
is_ready || set_up
