"""The start of `smachac check`: small scripts against the bare imports, and against another
checkout. CPU time of whole processes, run in turn, the fastest of several.

    python bench/start_up.py [rounds] [checkout]
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from compile import PYTHON, best

HERE = Path(__file__).parents[1]

STATE = """\
  - S{0}:
      template: SleepState
      time: 0.1
      transitions: {{succeeded: {1}, preempted: failed}}
"""


def ten_states() -> str:
    """A correct script of ten states."""
    states = [STATE.format(at, f"S{at + 1}" if at < 9 else "done") for at in range(10)]
    return "name: m\ntemplate: Base\noutcomes: [done, failed]\nstates:\n" + "".join(states)


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 9
    checkouts = {"": HERE}
    if len(sys.argv) > 2:
        checkouts[" before"] = Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder, "ten.yml")
        script.write_text(ten_states())
        example = HERE / "examples" / "05_userdata" / "main.yml"
        commands = {"imports": [PYTHON, "-c", "import ruamel.yaml, networkx"]}
        for name, checkout in checkouts.items():
            start = ["env", f"PYTHONPATH={checkout}", PYTHON, "-m", "smachac"]
            for what, words in (
                ("--version", ["--version"]),
                ("--help", ["--help"]),
                ("check of ten states", ["check", str(script)]),
                ("check of examples/05_userdata", ["check", str(example)]),
            ):
                commands[what + name] = [*start, *words]
        found = best(commands, folder, rounds)
    imports = found["imports"][0]
    for name, (cpu, _) in found.items():
        print(f"{name}: {1000 * cpu:.1f} ms, {cpu / imports:.2f} of the imports")
    for name in [name for name in found if f"{name} before" in found]:
        print(f"{name}: {found[name][0] / found[f'{name} before'][0]:.2f} of before")


if __name__ == "__main__":
    os.environ.pop("PYTHONPATH", None)
    main()
