#!/usr/bin/env bash
# PyYAML 6.0.4 (libyaml 0.2.6): a colon in the name of an anchor changes the value behind it.
#
# YAML 1.2.2, section 6.9.2: the name of an anchor has all characters but spaces and `[]{},`, so that
# `&left:home 0.5` is the number 0.5 with the anchor `left:home`.
# Guess before the run: 0.5, or a syntax error.
# Output: ':home 0.5', a text. The name ends at the colon, and the rest of it becomes the value,
# without a message; the parser in C and the one in Python agree. ruamel.yaml 0.18.10 gives 0.5.
# Whoever reads a set point of a robot so gets a text for a number.
# Ends with 1 if a version behaves otherwise.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check PyYAML==6.0.4 ruamel.yaml==0.18.10
cat >"$folder/arm.yml" <<'END'
speed: &left:home 0.5
END
"$folder/venv/bin/python" - "$folder/arm.yml" <<'END'
import sys
import yaml
from ruamel.yaml import YAML

text = open(sys.argv[1]).read()
in_c, in_python = (yaml.load(text, loader)["speed"] for loader in (yaml.CSafeLoader, yaml.SafeLoader))
other = YAML(typ="safe", pure=True).load(text)["speed"]
print("libyaml:", repr(in_c), " PyYAML's Python:", repr(in_python), " ruamel.yaml:", repr(other))
sys.exit((in_c, in_python, other) != (":home 0.5", ":home 0.5", 0.5))
END
