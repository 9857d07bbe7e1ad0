"""Generated modules of YASMIN on the stand-in."""

from __future__ import annotations

import contextlib
import importlib
import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from smachac.diagnostics.diagnostic import Report
from smachac.driver import build
from smachac.frontend.loader import Library
from smachac.ir.nodes import Checked, Machine
from smachac.targets.yasmin import TARGET
from smachac.verify.players.yasmin import modules
from tests.support.typed_machines import with_state_types
from tests.yasmin import stand_in

ENGINE: Any = importlib.import_module("yasmin") if os.environ.get("SMACHAC_YASMIN") else stand_in
"""The stand-in, or with SMACHAC_YASMIN=1 the YASMIN that is installed."""

RUNTIME = Path(__file__).parents[2] / "smachac" / "runtime" / "yasmin" / "smachac_yasmin.py"


def files_of(machine: Machine, library: Library) -> dict[str, str] | None:
    """The files of a machine; None where YASMIN refuses it."""
    report: Report = []
    files = build(Checked(with_state_types(machine, library)), TARGET, library, report)
    assert {item.code for item in report} <= {"SM601"}, report
    return files or None


@contextmanager
def loaded(files: dict[str, str], yasmin: Any = ENGINE) -> Iterator[Any]:
    """The module for YASMIN, with those that it imports."""
    before = sys.modules.get("yasmin")
    sys.modules["yasmin"] = yasmin
    try:
        with modules(files) as module:
            yield module
    finally:
        if before is None:
            del sys.modules["yasmin"]
        else:
            sys.modules["yasmin"] = before


def trace(files: dict[str, str], asked: tuple[str, int] = ("", 0)) -> list[dict[str, Any]]:
    """The events of a run; `asked` is the visit in which the machine gets a request to stop."""
    events: list[dict[str, Any]] = []
    entered: list[str] = []
    with loaded(files) as module, contextlib.redirect_stdout(io.StringIO()):
        run = module.run()

        def observe(event: dict[str, Any]) -> None:
            events.append(event)
            if event["event"] == "enter":
                entered.append(event["path"])
                if (event["path"], entered.count(event["path"])) == asked:
                    run.request_preempt()

        run.observe(observe)
        with contextlib.suppress(Exception):
            run.execute()
    return events
