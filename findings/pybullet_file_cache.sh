#!/usr/bin/env bash
# Subject:   PyBullet 3.2.7, loadURDF of a file that was changed between two loads.
# Guess:     each call of loadURDF reads the file.
# Behaviour: a second load with the same name in the same physics client returns the robot of the
#            first content, without a message. A new client reads the file again. With
#            setPhysicsEngineParameter(enableFileCaching=0) each call reads it.
# Why it matters: a program that writes a URDF file, loads it, and writes it again under the same
#            name gets another robot than that of the file.
# Output seen:
#   first content: one
#   second content, same client: one
#   second content, new client: two
#   third content, same client, no caching: three
# The script exits with 1 if the behaviour has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"${PYTHON:-python3.11}" -m venv venv
venv/bin/pip install --quiet pybullet==3.2.7 numpy==1.26.4
cat > main.py <<'PYTHON'
import pybullet


def loaded(name, client):
    with open("robot.urdf", "w") as file:
        file.write(f'<robot name="{name}"><link name="base"/></robot>\n')
    body = pybullet.loadURDF("robot.urdf", physicsClientId=client)
    return pybullet.getBodyInfo(body, physicsClientId=client)[1].decode()


first = pybullet.connect(pybullet.DIRECT)
print("seen first content:", loaded("one", first))
print("seen second content, same client:", loaded("two", first))
second = pybullet.connect(pybullet.DIRECT)
print("seen second content, new client:", loaded("two", second))
pybullet.setPhysicsEngineParameter(enableFileCaching=0, physicsClientId=second)
print("seen third content, same client, no caching:", loaded("three", second))
PYTHON
venv/bin/python main.py 2> /dev/null | grep -o "seen .*" | cut -c 6- | tee seen.txt
diff seen.txt - <<'EXPECTED'
first content: one
second content, same client: one
second content, new client: two
third content, same client, no caching: three
EXPECTED
