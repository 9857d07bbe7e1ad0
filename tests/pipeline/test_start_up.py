"""A check of ten correct states loads no module that it does not need: a hook and an editor start
it often."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

STATE = (
    "- S{}: {{template: SleepState, time: 1.0, transitions: {{succeeded: {}, preempted: done}}}}\n"
)

NOT_NEEDED = (
    *("smachac.pysource.class_reader", "smachac.pysource.modules", "smachac.pysource.flow"),
    *("smachac.robots.description", "smachac.robots.urdf"),
    *("smachac.grammars.standalone", "smachac.targets.python.package"),
    "smachac.frontend.robots",
    "smachac.pysource.machines",
    "smachac.driver.python_machines",
    "smachac.targets.cpp",
    "smachac.targets.html",
    "smachac.repair",
    *("smachac.sim", "smachac.verify", "smachac.refactor", "smachac.diff", "smachac.sweep"),
    *("smachac.view", "smachac.lsp", "smachac.interpreter"),
    *("networkx", "jinja2", "lark", "pyflakes", "pybullet", "numpy", "xml.etree", "asyncio"),
    *("logging", "subprocess", "tempfile", "multiprocessing", "pickle"),
)
"""Packages and modules that the check does not load, with all below them."""

PROGRAM = """
import sys
from smachac.commands.cli import main
code = main(["check", sys.argv[1]])
print(code, *sorted(sys.modules))
"""


def test_a_check_of_ten_states_loads_no_module_that_it_does_not_need(tmp_path: Path) -> None:
    states = "".join(STATE.format(n, f"S{n + 1}" if n < 10 else "done") for n in range(1, 11))
    script = tmp_path / "main.yml"
    script.write_text(f"name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n{states}", "utf-8")
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(script)], capture_output=True, text=True, check=True
    )
    code, *modules = done.stdout.splitlines()[-1].split()
    assert code == "0", done.stdout
    loaded = [
        module
        for module in modules
        if any(module == name or module.startswith(f"{name}.") for name in NOT_NEEDED)
    ]
    assert loaded == []
    assert sum(module.startswith("smachac") for module in modules) <= 204
