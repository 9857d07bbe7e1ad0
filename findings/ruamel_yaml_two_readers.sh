#!/usr/bin/env bash
# ruamel.yaml 0.19.1 with ruamel.yaml.clibz 0.3.7: each of its two readers refuses valid YAML that the other reads.
#
# Guess before the run: the reader in C is the same language, only faster.
# Output: the reader in Python refuses a text below `|` whose first line is blank (YAML 1.2.2, 8.1.3)
# and a tab before a comment (6.2); the reader in C, a copy of libyaml 0.1.7, refuses the plain text
# `http://x.org` in braces (7.3.3). Whether a file is YAML depends on what else is installed.
# The package in C has no wheels: the script needs a C compiler.
# Ends with 1 if a version behaves otherwise.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check ruamel.yaml==0.19.1 ruamel.yaml.clibz==0.3.7
"$folder/venv/bin/python" - <<'END'
import sys

from ruamel.yaml import YAML
from ruamel.yaml.cyaml import CParser
from ruamel.yaml.error import YAMLError

TEXTS = ("text: |\n \n    hello\n", "A:\t# first\n", "{url: http://x.org}\n")


def in_c(text):
    return list(iter(CParser(text).get_event, None))


def in_python(text):
    return list(YAML(typ="safe", pure=True).parse(text))


def is_read(reader, text):
    try:
        return bool(reader(text))
    except YAMLError:
        return False


found = [(is_read(in_c, text), is_read(in_python, text)) for text in TEXTS]
for text, (fast, pure) in zip(TEXTS, found):
    print(f"{text!r}: in C {fast}, in Python {pure}")
sys.exit(found != [(True, False), (True, False), (False, True)])
END
