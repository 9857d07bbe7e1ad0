#!/usr/bin/env bash
# Texts that rclpy 9.1.2 (ROS 2 Kilted) with Fast DDS changes on their way, without an error.
#
# Guess before the run: a `string` is a sequence of Unicode characters, so that each text that Python
# can encode arrives as it was sent; the same for a `wstring`.
# Seen: the guess fails twice.
#   string  'a\x00b'     arrives as 'a':  the C structure ends a text at the first null character.
#   wstring '\ufeffab'   arrives as 'ab': Python decodes UTF-16, and takes the first U+FEFF for a mark
#                        of the byte order. Further inside a text it is kept.
#   wstring 'a\x00b'     arrives as it was sent.
# Output of the run:
#   string 'a\x00b' -> 'a'
#   string 'aü😀' -> 'aü😀'
#   wstring '\ufeffab' -> 'ab'
#   wstring 'a\ufeffb' -> 'a\ufeffb'
#   wstring 'a\x00b' -> 'a\x00b'
# The exit code is 1 if rclpy behaves in another way.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3.11 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip -q install ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 ros-test-msgs==2.3.0
cat >"$folder/texts.py" <<'PY'
import rclpy
from test_msgs.msg import Strings, WStrings

SENT = [
    (Strings, "string_value", "a\0b", "a"),
    (Strings, "string_value", "aü😀", "aü😀"),
    (WStrings, "wstring_value", "\ufeffab", "ab"),
    (WStrings, "wstring_value", "a\ufeffb", "a\ufeffb"),
    (WStrings, "wstring_value", "a\0b", "a\0b"),
]

rclpy.init()
node = rclpy.create_node("texts")
same = True
for number, (kind, field, text, expected) in enumerate(SENT):
    got = []
    node.create_subscription(kind, f"topic_{number}", got.append, 10)
    publisher = node.create_publisher(kind, f"topic_{number}", 10)
    while publisher.get_subscription_count() == 0:
        rclpy.spin_once(node, timeout_sec=0.1)
    publisher.publish(kind(**{field: text}))
    while not got:
        rclpy.spin_once(node, timeout_sec=0.1)
    arrived = getattr(got[0], field)
    print(field.partition("_")[0], ascii(text) if not text.endswith("😀") else repr(text), "->",
          ascii(arrived) if not arrived.endswith("😀") else repr(arrived))
    same = same and arrived == expected
rclpy.shutdown()
raise SystemExit(0 if same else 1)
PY
ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=99 timeout 120 "$folder/venv/bin/python" "$folder/texts.py"
