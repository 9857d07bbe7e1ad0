#!/usr/bin/env bash
# Builds the source archive and the wheel, and tries both on every Python from 3.10 that is on PATH, each
# in a new virtual environment and from an empty folder; the wheel also with `uv tool` and `pipx`, where
# these are installed. Without SMACHAC_NIGHTLY only the first of these Pythons tries the archive.
# Needs the network. BUILD_PYTHON=... has the package build.
set -euo pipefail
CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${BUILD_PYTHON:-.venv/bin/python}" -m build --outdir "$folder/dist" >"$folder/build.log" 2>&1 || {
  cat "$folder/build.log" >&2
  exit 1
}
wheel=("$folder"/dist/*.whl) archive=("$folder"/dist/*.tar.gz)

# A first session with the program `$1` in an empty folder.
try() {
  local empty
  empty=$(mktemp -d -p "$folder")
  (
    cd "$empty"
    "$1" doctor >/dev/null
    "$1" new my_robot >/dev/null
    cd my_robot
    "$1" check >/dev/null
    "$1" build main.yml --target python -o out >/dev/null
    "$1" build main.yml --target html -o out >/dev/null
    "$1" verify main.yml >/dev/null
    "$1" completion bash >/dev/null
    "$1" schema script >/dev/null
  )
}

for name in python3.{10..14}; do
  "$name" -c '' 2>/dev/null || continue
  packages=("${wheel[0]}")
  [[ -n ${tried:-} && -z ${SMACHAC_NIGHTLY:-} ]] || packages+=("${archive[0]}")
  tried=$name
  for package in "${packages[@]}"; do
    venv=$(mktemp -d -p "$folder")
    "$name" -m venv "$venv"
    "$venv/bin/python" -m pip install -q --disable-pip-version-check "$package"
    try "$venv/bin/smachac"
    [[ -s $venv/share/man/man1/smachac.1 ]]
    (cd "$folder" && "$venv/bin/smachac" docs tutorial >/dev/null)
    echo "$name: ${package##*/} works"
    rm -rf "$venv"
  done
done
if command -v uv >/dev/null; then
  UV_TOOL_DIR=$folder/uv UV_TOOL_BIN_DIR=$folder/uv_bin uv tool install -q "${wheel[0]}"
  try "$folder/uv_bin/smachac"
  echo "uv tool: works"
fi
if command -v pipx >/dev/null; then
  PIPX_HOME=$folder/pipx PIPX_BIN_DIR=$folder/pipx_bin PIPX_MAN_DIR=$folder/pipx_man \
    pipx install -q "${wheel[0]}" >/dev/null
  try "$folder/pipx_bin/smachac"
  [[ -e $folder/pipx_man/man1/smachac.1 ]]
  echo "pipx: works"
fi
