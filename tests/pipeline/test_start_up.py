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
    *("smachac.checks.classes", "smachac.checks.code", "smachac.checks.concurrence.concurrence"),
    *("smachac.checks.concurrence.races", "smachac.checks.properties", "smachac.checks.ros"),
    *("smachac.checks.findings.candidate_keys", "smachac.checks.findings.clash_findings"),
    *("smachac.checks.findings.class_value_types", "smachac.checks.findings.code_findings"),
    *("smachac.checks.findings.renamed_names", "smachac.checks.findings.types_with_code"),
    *("smachac.checks.robot.robot", "smachac.checks.robot.units", "smachac.checks.robot.workspace"),
    *("smachac.checks.userdata", "smachac.analysis.definite_assignment"),
    *("smachac.analysis.failed_properties", "smachac.analysis.message_keys"),
    *("smachac.analysis.expression_types", "smachac.analysis.lost_outputs"),
    *("smachac.analysis.properties", "smachac.analysis.resource_claims"),
    *("smachac.analysis.state_code", "smachac.analysis.successors"),
    *("smachac.diagnostics.baseline", "smachac.diagnostics.clusters"),
    *("smachac.frontend.errors.python_machines", "smachac.frontend.robots"),
    *("smachac.frontend.script.properties", "smachac.frontend.text.yaml_errors"),
    *("smachac.frontend.text.yaml_indents", "smachac.frontend.text.yaml_recovery"),
    *("smachac.ir.class_facts", "smachac.ir.code_slips", "smachac.ir.expressions"),
    *("smachac.ir.function_facts", "smachac.ir.properties", "smachac.ir.python_code"),
    *("smachac.ir.robot", "smachac.ir.written", "smachac.ir.parser", "smachac.ir.printer"),
    *("smachac.pysource.class_reader", "smachac.pysource.faults", "smachac.pysource.flow"),
    *("smachac.pysource.modules.library_names", "smachac.pysource.modules.modules"),
    *("smachac.pysource.machines", "smachac.pysource.values"),
    *("smachac.robots.description", "smachac.robots.fields", "smachac.robots.files"),
    *("smachac.robots.urdf", "smachac.robots.xacro_files", "smachac.robots.xml_tree"),
    *("smachac.grammars.standalone", "smachac.targets.python.package"),
    "smachac.driver.python_machines",
    "smachac.targets.cpp",
    "smachac.targets.html",
    "smachac.repair",
    *("smachac.sim", "smachac.verify", "smachac.refactor", "smachac.diff", "smachac.sweep"),
    *("smachac.view", "smachac.lsp", "smachac.interpreter"),
    *("networkx", "jinja2", "lark", "pyflakes", "pybullet", "numpy", "xml", "asyncio"),
    *("dataclasses", "inspect", "difflib", "json", "tokenize"),
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
    assert sum(module.startswith("smachac") for module in modules) <= 162
