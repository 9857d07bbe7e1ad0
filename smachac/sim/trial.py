"""Loads files into PyBullet in a process of its own: a program, which imports nothing of smachac.

Its argument is a JSON object: `path` is `sys.path`, `files` are the files, and `progress` is the
file in which the number of files that are loaded is written. It ends at the first that is not.
"""

import json
import sys
from pathlib import Path
from typing import Any


def main(task: dict[str, Any]) -> None:
    """Load the files of a task, and make one physics step with each."""
    sys.path[:] = task["path"]
    import numpy  # noqa: F401  (PyBullet needs it, and does not report that it is missing)
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    for number, name in enumerate([*task["files"], None]):
        Path(task["progress"]).write_text(str(number), encoding="utf-8")
        if name is None:
            return
        try:
            if name.lower().endswith(".sdf"):
                pybullet.loadSDF(name)
            else:
                pybullet.loadURDF(name, useFixedBase=True)
        except pybullet.error:
            return
        pybullet.stepSimulation()
        pybullet.resetSimulation()


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
