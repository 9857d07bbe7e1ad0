#!/usr/bin/env bash
# Subject:   PyBullet 3.2.7, loadURDF of a file with long lines.
# Guess:     white space between elements has no meaning, so a robot in one line loads as well as
#            the same robot in many lines.
# Behaviour: the file is read in pieces of 1,023 characters of a line, and a line break is put
#            between them. Where it falls into a name, loadURDF raises "Cannot load URDF file.", or
#            it loads a robot with another name.
# Why it matters: xacro and other programs write URDF files, and some write them without line breaks.
# Output seen:
#   many lines: loaded
#   one line: Cannot load URDF file.
# The script exits with 1 if the behaviour has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"${PYTHON:-python3.11}" -m venv venv
venv/bin/pip install --quiet pybullet==3.2.7 numpy==1.26.4
cat > main.py <<'PYTHON'
import pybullet

parts = ['<robot name="row">', '<link name="part_of_the_left_front_leg_0"/>']
for k in range(1, 60):
    link, above = f"part_of_the_left_front_leg_{k}", f"part_of_the_left_front_leg_{k - 1}"
    parts.append(f'<link name="{link}"/>')
    parts.append(f'<joint name="joint_{k}" type="fixed"><parent link="{above}"/>')
    parts.append(f'<child link="{link}"/></joint>')
parts.append("</robot>")
pybullet.connect(pybullet.DIRECT)
for title, between in (("many lines", "\n"), ("one line", " ")):
    name = title.replace(" ", "_") + ".urdf"
    with open(name, "w") as file:
        file.write(between.join(parts))
    try:
        pybullet.loadURDF(name)
        print(f"seen {title}: loaded")
    except pybullet.error as error:
        print(f"seen {title}: {error}")
PYTHON
venv/bin/python main.py 2> /dev/null | grep -o "seen .*" | cut -c 6- | tee seen.txt
diff seen.txt - <<'EXPECTED'
many lines: loaded
one line: Cannot load URDF file.
EXPECTED
