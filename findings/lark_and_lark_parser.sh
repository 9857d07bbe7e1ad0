#!/usr/bin/env bash
# lark 1.3.1 and lark-parser 0.12.0: two packages of PyPI write one folder `lark`, and pip does not say so.
#
# `ros-rosidl-parser`, a part of ROS 2 on PyPI, requires `lark-parser`; other programs require `lark`.
# Guess before the run: pip refuses the second package, or the newer parser stays usable.
# Output: pip reports no conflict; `pip check` finds nothing; the metadata of lark says 1.3.1, while
# `import lark` says 0.12.0. A grammar gives another tree, without a message: the missing optional
# part of `"a" [NAME]` is a child None with lark 1.3.1 alone, and no child after the second install.
# Ends with 1 if a version behaves otherwise.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
pip() { "$folder/venv/bin/pip" --disable-pip-version-check "$@"; }
pip install -q lark==1.3.1
children() {
  "$folder/venv/bin/python" -c "
import lark
grammar = 'start: \"a\" [NAME]\\nNAME: /[b-z]+/'
print(lark.__version__, lark.Lark(grammar, parser='lalr').parse('a').children)"
}
before=$(children)
pip install -q lark-parser==0.12.0
pip check
after=$(children)
stated=$("$folder/venv/bin/python" -c 'from importlib.metadata import version; print(version("lark"))')
printf '%s\n' "before: $before" "after: $after" "metadata of lark: $stated"
[[ "$before, $after, $stated" == "1.3.1 [None], 0.12.0 [], 1.3.1" ]]
