#!/usr/bin/env bash
# Subject:   PyBullet 3.2.7, limits of joints in a URDF file.
# Guess:     as in the specification of URDF (http://wiki.ros.org/urdf/XML/joint): a continuous joint
#            has no limits, also with `lower` and `upper`; of a revolute joint each of the two is 0
#            if it is left out.
# Behaviour: a continuous joint with `lower` and `upper` stops at them. A missing `upper` is -1, so
#            getJointInfo reports limits of -2 to -1 for `lower="-2"`. A continuous joint without
#            limits is reported as revolute with the limits 0 and -1: it cannot be told from a
#            revolute joint with a `<limit>` without both.
# Output seen (limits that getJointInfo reports, and the position in rad after a command of 3.0):
#   continuous, lower -1, upper 1: limits -1.0 1.0, moved to 1.00
#   continuous, no limit: limits 0.0 -1.0, moved to 3.00
#   revolute, lower -2: limits -2.0 -1.0
#   revolute, neither: limits 0.0 -1.0, moved to 3.00
# The script exits with 1 if the behaviour has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"${PYTHON:-python3.11}" -m venv venv
venv/bin/pip install --quiet pybullet==3.2.7 numpy==1.26.4
cat > main.py <<'PYTHON'
import pybullet

INERTIAL = (
    '<inertial><mass value="1"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>'
    "</inertial>"
)
CASES = [
    ("continuous, lower -1, upper 1", "continuous", 'lower="-1" upper="1" '),
    ("continuous, no limit", "continuous", ""),
    ("revolute, lower -2", "revolute", 'lower="-2" '),
    ("revolute, neither", "revolute", ""),
]
pybullet.connect(pybullet.DIRECT)
for k, (title, kind, limits) in enumerate(CASES):
    with open(f"robot_{k}.urdf", "w") as file:
        file.write(
            f'<robot name="robot">\n<link name="a">{INERTIAL}</link>\n'
            f'<link name="b">{INERTIAL}</link>\n<joint name="j" type="{kind}"><parent link="a"/>'
            f'<child link="b"/><axis xyz="0 0 1"/>\n<limit {limits}effort="10" velocity="3"/>'
            "</joint>\n</robot>\n"
        )
    body = pybullet.loadURDF(f"robot_{k}.urdf", useFixedBase=True)
    info = pybullet.getJointInfo(body, 0)
    line = f"seen {title}: limits {info[8]} {info[9]}"
    if title != "revolute, lower -2":
        for _ in range(2400):
            pybullet.setJointMotorControl2(
                body, 0, pybullet.POSITION_CONTROL, targetPosition=3.0, force=10
            )
            pybullet.stepSimulation()
        line += f", moved to {pybullet.getJointState(body, 0)[0]:.2f}"
    print(line)
PYTHON
venv/bin/python main.py 2> /dev/null | grep -o "seen .*" | cut -c 6- | tee seen.txt
diff seen.txt - <<'EXPECTED'
continuous, lower -1, upper 1: limits -1.0 1.0, moved to 1.00
continuous, no limit: limits 0.0 -1.0, moved to 3.00
revolute, lower -2: limits -2.0 -1.0
revolute, neither: limits 0.0 -1.0, moved to 3.00
EXPECTED
