#!/usr/bin/env bash
# The checks of fields of rclpy 9.1.2 (ROS 2 Kilted) refuse the largest finite float32.
#
# Guess before the run: with `check_fields=True` a message accepts every value of its types, so that
# a received message can be checked and sent again.
# Seen: the guess fails. Float32 with the largest finite float32 (3.4028234663852886e+38) is an
# AssertionError, because the limit in the generated code is rounded to 3.402823466e+38, which is
# below. An infinity is accepted, and so is the largest float64.
# Output of the run:
#   largest float32: refused
#   float32 infinity: accepted
#   largest float64: accepted
# The exit code is 1 if rclpy behaves in another way.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3.11 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip -q install ros-rclpy==9.1.2 ros-std-msgs==5.5.1
cat >"$folder/checks.py" <<'PY'
import math
import struct
import sys

from std_msgs.msg import Float32, Float64

LARGEST = struct.unpack("<f", bytes.fromhex("ffff7f7f"))[0]


def check(name, make):
    try:
        make()
        answer = "accepted"
    except AssertionError:
        answer = "refused"
    print(f"{name}: {answer}")
    return answer


answers = [
    check("largest float32", lambda: Float32(data=LARGEST, check_fields=True)),
    check("float32 infinity", lambda: Float32(data=math.inf, check_fields=True)),
    check("largest float64", lambda: Float64(data=sys.float_info.max, check_fields=True)),
]
raise SystemExit(0 if answers == ["refused", "accepted", "accepted"] else 1)
PY
"$folder/venv/bin/python" "$folder/checks.py"
