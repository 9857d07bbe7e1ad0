#!/usr/bin/env bash
# Pinocchio (package pin 4.1.0 of PyPI): the names of joints decide about their order, and about whether a
# gripper can be loaded.
#
# A URDF file has no order of joints of its own, and each <mimic> may refer to any joint.
# Guess before the run: the joints of a hand come in the order of the file (MuJoCo 4.0.0 keeps it),
# and a finger that mimics another one is read, whatever the two are called.
# Seen: joints with one parent are sorted by name, so that a vector of positions from another program
# has its entries exchanged. With mimic=True a joint has to come after the one that it mimics in that
# order: `left_finger` that mimics `right_finger` is refused, `slave_finger` is not. Without mimic=True
# the element is left out, and the finger is a free joint.
# Output:
#   left_finger mimics right_finger:  order ['left_finger', 'right_finger'], with mimic=True ValueError
#   slave_finger mimics right_finger: order ['right_finger', 'slave_finger'], with mimic=True 1 position
# Ends with 1 if it behaves otherwise.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q --disable-pip-version-check pin==4.1.0
cat >"$folder/hand.py" <<'END'
import pinocchio

HAND = """<robot name="hand">
  <link name="palm"/>
  <link name="right"/>
  <joint name="right_finger" type="prismatic"><parent link="palm"/><child link="right"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.04" effort="9" velocity="1"/></joint>
  <link name="left"/>
  <joint name="{name}" type="prismatic"><parent link="palm"/><child link="left"/>
    <axis xyz="0 -1 0"/><limit lower="0" upper="0.04" effort="9" velocity="1"/>
    <mimic joint="right_finger"/></joint>
</robot>"""


def loaded(name):
    """The order of the joints, and the number of positions with mimic=True or the kind of error."""
    text = HAND.format(name=name)
    order = list(pinocchio.buildModelFromXML(text).names)[1:]
    try:
        return order, pinocchio.buildModelFromXML(text, mimic=True).nq
    except Exception as error:
        return order, type(error).__name__


found = {name: loaded(name) for name in ("left_finger", "slave_finger")}
for name, (order, result) in found.items():
    print(f"{name} mimics right_finger: order {order}, with mimic=True {result}")
expected = {
    "left_finger": (["left_finger", "right_finger"], "ValueError"),
    "slave_finger": (["right_finger", "slave_finger"], 1),
}
raise SystemExit(found != expected)
END
"$folder/venv/bin/python" "$folder/hand.py"
