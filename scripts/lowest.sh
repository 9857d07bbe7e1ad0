#!/usr/bin/env bash
# Runs core tests with the lowest versions of the dependencies that pyproject.toml states, in a virtual
# environment of its own. PYTHON=... chooses the interpreter, VENV=... the folder of the environment.
set -euo pipefail
CDPATH='' cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.."

python=${PYTHON:-$(command -v python3.11 || command -v python3)}
venv=${VENV:-.venv-lowest}
[[ -x $venv/bin/python ]] || "$python" -m venv "$venv"
mapfile -t lowest < <("$venv/bin/python" - <<'END'
import re
text = open("pyproject.toml", encoding="utf-8").read()
for table in ("dependencies", "sim"):
    rows = re.search(rf"^{table} = \[(.*?)\]$", text, re.M | re.S)[1]
    for name, version, rest in re.findall(r'"([\w.-]+)>=([\d.]+)([^"]*)"', rows):
        print(f"{name}=={version}{rest}")
END
)
echo "lowest versions: ${lowest[*]}"
# Installed, because the targets are found through the metadata of the package.
"$venv/bin/python" -m pip install -q --disable-pip-version-check -e . "${lowest[@]}" \
  'fissix>=24.4' 'xacro>=2.1,<2.2' 'pytest>=8' 'pytest-xdist>=3.6' 'hypothesis>=6.100' 'jsonschema>=4.20' 'ruff>=0.6' 'mypy>=1.11' 'ipython>=8.12'
tests=("$@")
# What uses PyYAML, networkx and jinja2; of the rules the examples of all codes, which
# are checked and built. The other tests of rules see only the graph.
((${#tests[@]})) || tests=(tests/frontend tests/pysource tests/ir tests/analysis tests/targets tests/report tests/refactor
  tests/pipeline tests/checks/test_examples.py tests/checks/test_graph_laws.py)
PYTHONPATH=$PWD "$venv/bin/python" -m pytest -q -n 2 -m "not slow and not nightly and not ros and not ros2 and not browser" "${tests[@]}"
