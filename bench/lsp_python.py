"""The language server on Python files: CPU time of an edit of a file of 500 lines.

    python bench/lsp_python.py 30

The file builds four machines of eight states each; its 16 state classes are in it, 16 others are in
a module of the same repository, which itself imports 20 modules. Each edit changes one character of
one line and is followed by the check, hover, symbols and the picture, as an editor requests them.
"""

from __future__ import annotations

import gc
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

from smachac.lsp.session import Session

STATES, MACHINES = 8, 4

STATE = '''

class {name}(smach.State):
    """Moves part {number}."""

    def __init__(self, speed=0.1, limit=3):
        smach.State.__init__(
            self,
            outcomes=["succeeded", "failed"],
            input_keys=["part", "pose"],
            output_keys=["place"],
        )
        self.speed = speed
        self.limit = limit

    def execute(self, userdata):
        for attempt in range(self.limit):
            if userdata.part is None:
                return "failed"
            userdata.place = userdata.pose, attempt * self.speed
        return "succeeded"
'''

ADD = """    smach.StateMachine.add(
        "{name}",
        {cls}(speed=0.2),
        transitions={{"succeeded": "{target}", "failed": "stopped"}},
    )
"""


def main_text() -> str:
    """The file that is edited: about 500 lines."""
    own = range(0, STATES * MACHINES, 2)
    parts = ["import smach\nfrom more_states import *\n"]
    parts += [STATE.format(name=f"State{number}", number=number) for number in own]
    for machine in range(MACHINES):
        parts.append(f'\n\nsm_{machine} = smach.StateMachine(outcomes=["done", "stopped"])\n'
                     f"sm_{machine}.userdata.part = 1\nsm_{machine}.userdata.pose = 2\n"
                     f"with sm_{machine}:\n")  # fmt: skip
        for at in range(STATES):
            number = machine * STATES + at
            target = f"S{number + 1}" if at + 1 < STATES else "done"
            parts.append(ADD.format(name=f"S{number}", cls=f"State{number}", target=target))
    return "".join(parts)


def project(folder: Path) -> Path:
    """Writes the repository; the file that is edited."""
    (folder / ".git").mkdir()
    names = [f"tools_{number}" for number in range(20)]
    for name in names:
        body = "".join(f"\n\ndef work_{at}(part):\n    return part + {at}\n" for at in range(20))
        (folder / f"{name}.py").write_text(f"import os\n{body}")
    others = range(1, STATES * MACHINES, 2)
    text = "import smach\n" + "".join(f"import {name}\n" for name in names)
    text += "".join(STATE.format(name=f"State{number}", number=number) for number in others)
    (folder / "more_states.py").write_text(text)
    path = folder / "machine.py"
    path.write_text(main_text())
    return path


def edited(text: str, number: int) -> str:
    """The text with an edit: alternately a wrong target, and an argument of one state."""
    wrong = text.replace('"succeeded": "S3"', '"succeeded": "S33"') if number % 2 else text
    return wrong.replace("speed=0.2", f"speed=0.{number + 3}", 1)


def main(edits: int) -> None:
    with tempfile.TemporaryDirectory() as name:
        path = project(Path(os.path.realpath(name)))
        text = path.read_text()
        session = Session([path.parent])
        times: list[float] = []
        collections: list[float] = []
        gc.disable()  # the server collects garbage when nobody types
        for number in range(edits + 1):
            started = time.process_time()
            session.change(str(path), edited(text, number))
            found = session.check(str(path))[str(path)]
            times.append(time.process_time() - started)
            assert bool(found) == bool(number % 2), found
            started = time.process_time()
            gc.collect()
            collections.append(time.process_time() - started)
        first, *rest = times
        print(f"{len(text.splitlines())} lines: first read {first * 1000:.0f} ms, an edit"
              f" {statistics.median(rest) * 1000:.1f} ms (median of {edits}),"
              f" {max(rest) * 1000:.1f} ms at most; then a collection of garbage"
              f" {statistics.median(collections) * 1000:.1f} ms")  # fmt: skip


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 30)
