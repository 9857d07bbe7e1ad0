"""The picture of a view: the page and the messages with the machine and its findings."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from typing import Any

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source, Span
from smachac.ir.nodes import Machine, StateMachine
from smachac.ir.written import Written, written
from smachac.targets.html.model import finding_data, machine_model
from smachac.targets.html.page import render_page
from smachac.view.feed import Feed


class Picture:
    """The last machine of a script that has no error, and what is found in the script now.

    As long as there was no such machine, the picture is that of the machine as far as it can be
    read, or an empty one with the name `name`. `editable`: the page can edit the script,
    `simulated`: it can simulate the machine. `data` is more data for the page, by element id;
    `view` are the states of a machine that are drawn.

    Each model has a `revision`, greater than that of every model before it, also of one that
    another process has made before: a page gets models from the stream and from answers to edits,
    and shows none that is older than its own.
    """

    def __init__(
        self,
        feed: Feed,
        name: str,
        *,
        editable: bool = False,
        simulated: bool = False,
        data: Mapping[str, object] | None = None,
        view: Callable[[Machine], Written] = written,
    ) -> None:
        self.name = name
        self._data = data
        self._view = view
        self._editable, self._simulated = editable, simulated
        self._feed = feed
        self._lock = threading.Lock()
        self._is_good = False
        nothing = StateMachine(type="", name=name, span=Span(Source(name, ""), 0, 0))
        self._machine = Machine(root=nothing)
        self._revision = 0
        self._model: Mapping[str, Any] = {}
        self._show(self._machine, [])

    def update(self, machine: Machine | None, report: Report) -> None:
        """Publish the result of a check."""
        broken = machine is None or any(item.severity is Severity.ERROR for item in report)
        if machine is not None and not (broken and self._is_good):
            with self._lock:
                self._is_good = not broken
                is_new = self._show(machine, report)
            if is_new:
                self._feed.publish({"kind": "model", "model": self._model})
        self._feed.publish(
            {
                "kind": "report",
                "broken": broken,
                "outdated": machine is None or (broken and self._is_good),
                "findings": [finding_data(item, self._view(self._machine)) for item in report],
            }
        )

    def edited(self) -> None:
        """The script is edited in the page: the next machine is drawn even if it has errors, so
        that the next edit can repair it."""
        with self._lock:
            self._is_good = False

    def _show(self, machine: Machine, report: Report) -> bool:
        """Make the model of a machine; whether it differs from the last one."""
        self._machine = machine
        model = {
            **machine_model(machine, report, live=True, view=self._view(machine)),
            "revision": self._revision,
        }
        if self._editable:
            model["editable"] = True
        if self._simulated:
            model["simulated"] = True
        if model == self._model:
            return False
        milliseconds = int(time.time() * 1000)
        self._revision = max(self._revision + 1, milliseconds)
        self._model = {**model, "revision": self._revision}
        return True

    @property
    def machine(self) -> Machine:
        """The machine that is shown."""
        return self._machine

    @property
    def model(self) -> Mapping[str, Any]:
        """The model of the machine that is shown."""
        return self._model

    def page(self) -> str:
        """The page as it is now."""
        with self._lock:
            return render_page(self._machine, self._model, self._data, connect=True)
