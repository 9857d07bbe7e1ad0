#!/usr/bin/env bash
# xacro 2.1.1: a parameter of a macro that looks like a number or a truth value is not put in as written.
#
# An arm of a cell has the number `01`, a tool the serial number `12e3`, a part the side `true`. They are
# parameters of a macro, which puts them into the names of links, as `arm_${id}_base`.
# Guess before the run: the text is put in, so that the link is `arm_01_base`.
# Seen: each value goes through int, float and the words of truth values first, and is printed again.
# `01` and `1` so give one name, and two arms `01` and `1` become two links with one name, without a
# message of xacro. A value with `_` or in single quotes stays as written.
# Output:
#   01 -> arm_1_base      12e3 -> arm_12000.0_base   infinity -> arm_inf_base   true -> arm_True_base
#   0x10 -> arm_0x10_base   1_0 -> arm_1_0_base   '01' -> arm_01_base
# Ends with 1 if xacro behaves otherwise.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check xacro==2.1.1 PyYAML==6.0.2
cat >"$folder/cell.xacro" <<'END'
<robot name="cell" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="arm" params="id"><link name="arm_${id}_base"/></xacro:macro>
  <xacro:arm id="01"/>
  <xacro:arm id="12e3"/>
  <xacro:arm id="infinity"/>
  <xacro:arm id="true"/>
  <xacro:arm id="0x10"/>
  <xacro:arm id="1_0"/>
  <xacro:arm id="'01'"/>
</robot>
END
"$folder/venv/bin/xacro" "$folder/cell.xacro" >"$folder/cell.urdf"
"$folder/venv/bin/python" - "$folder/cell.xacro" "$folder/cell.urdf" <<'END'
import sys
from xml.dom import minidom

source, expanded = map(minidom.parse, sys.argv[1:])
ids = [call.getAttribute("id") for call in source.getElementsByTagName("xacro:arm")]
names = [link.getAttribute("name") for link in expanded.getElementsByTagName("link")]
for given, name in zip(ids, names):
    print(f"{given} -> {name}")
middles = ["1", "12000.0", "inf", "True", "0x10", "1_0", "01"]
sys.exit(names != [f"arm_{middle}_base" for middle in middles])
END
