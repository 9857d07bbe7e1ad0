"""The simulation of a view: its actions, what the pages get, and the scenarios that it saves."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main
from smachac.commands.view import save_scenario
from smachac.diagnostics.source import Source
from smachac.driver import analyse_script
from smachac.ir.nodes import Machine
from smachac.ir.written import generated, written
from smachac.view.feed import Feed
from smachac.view.server import ActionError
from smachac.view.simulation import Simulation
from tests.support.viewed import Viewed, starter

SCRIPT = """\
name: sm
outcomes: [done, lost, stopped]
userdata: {count: 0}
states:
  - LOOK:
      template: ScriptedState
      outcomes: [found, nothing]
      output_keys: [place]
      transitions: {found: GRASP, nothing: lost}
  - GRASP:
      template: ScriptedState
      input_keys: [place]
      outcomes: [held, failed]
      timeout: 30 s
      retry: {on: [failed], max: 3}
      transitions: {held: TEST, exhausted: lost, timeout: lost, preempted: stopped}
  - TEST:
      template: ConditionalOutcomeState
      input_keys: [count]
      outcomes: ["yes", "no"]
      callbacks: {"yes": "lambda ud: 1 / ud.count > 0.0"}
      default_outcome: "no"
      transitions: {"yes": done, "no": lost}
"""


def machine_of(text: str) -> Machine:
    machine = analyse_script(Source("main.yml", text)).machine
    assert machine is not None
    return machine


class Page:
    """A page of a simulation: what it shows, and its actions."""

    def __init__(self, simulation: Simulation, feed: Feed) -> None:
        self._simulation = simulation
        self._reader = feed.open()
        self.status: dict[str, Any] = {"state": "off"}

    def act(self, action: str, **body: object) -> Any:
        answer = self._simulation.act({"action": action, "at": self.at, **body})
        self.update()
        return answer

    def choose(self, path: str, outcome: str = "", **body: object) -> None:
        named = {"outcome": outcome} if outcome else {}
        self.act("choose", path=path, **named, **body)

    def refused(self, action: str, **body: object) -> str:
        with pytest.raises(ActionError) as caught:
            self.act(action, **body)
        return str(caught.value)

    def update(self) -> None:
        messages = self._reader.wait(0) or []
        if messages:
            self.status = json.loads(messages[-1])

    @property
    def at(self) -> int:
        return len(self.status.get("steps", ()))

    @property
    def error(self) -> str:
        """The message of the first error in the trace."""
        events = self.status["events"]
        return str(next(each["message"] for each in events if each["event"] == "error"))

    @property
    def waiting(self) -> list[str]:
        return [each["path"] for each in self.status["at"]]


Pages = Callable[..., tuple[Simulation, Page]]


@pytest.fixture
def pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Pages:
    """Starts the simulation of a script, in the current folder, with a page."""
    monkeypatch.chdir(tmp_path)

    def opened(text: str = SCRIPT, **options: Any) -> tuple[Simulation, Page]:
        path = Path("main.yml")
        path.write_text(text)
        machine = analyse_script(path).machine
        feed = Feed()
        simulation = Simulation(feed, "main.yml", partial(save_scenario, path), **options)
        simulation.use(machine)
        page = Page(simulation, feed)
        page.act("start")
        return simulation, page

    return opened


def test_it_stands_before_each_state_until_the_end(pages: Pages) -> None:
    _, page = pages()
    assert page.waiting == ["sm/LOOK"]
    (look,) = page.status["at"]
    found, nothing = look["outcomes"]
    assert [key["value"] for key in found["keys"]] == ["[2, 3]"]
    assert (look["run"], look["wait"]) == ("", "")
    assert nothing["name"] == "nothing"
    page.choose("sm/LOOK", "found", set={"place": "{frame: map, at: [0.5, .nan]}"})
    (grasp,) = page.status["at"]
    assert grasp["path"] == "sm/GRASP"
    assert grasp["wait"] == "time limit of GRASP in 30 s: let it pass"
    page.choose("sm/GRASP", "failed", after="20 s")
    assert page.status["at"][0]["wait"] == "time limit of GRASP in 30 s: let it pass"
    page.choose("sm/GRASP", "held")
    page.choose("sm/TEST", "yes")
    assert (page.status["state"], page.status["outcome"], page.status["t"]) == (
        "ended",
        "done",
        20.0,
    )
    assert [step["text"] for step in page.status["steps"]] == [
        "found, place = {frame: map, at: [0.5, .nan]}",
        "failed, after 20 s",
        "held",
        "yes",
    ]


def test_a_step_back_is_a_run_with_one_choice_less(pages: Pages) -> None:
    _, page = pages()
    first = page.status
    page.choose("sm/LOOK", "found")
    second = page.status
    page.choose("sm/GRASP", "failed")
    page.act("back")
    assert page.status == second
    page.choose("sm/GRASP", "held")
    page.act("back", to=0)
    assert page.status == first
    assert page.refused("back") == "there is no such step"
    assert page.refused("back", to=True) == "there is no such step"


def test_time_limits_stops_and_errors(pages: Pages) -> None:
    _, page = pages()
    page.choose("sm/LOOK", "found")
    page.choose("sm/GRASP", wait=True)
    assert (page.status["outcome"], page.status["t"]) == ("lost", 30.0)
    page.act("back")
    page.choose("sm/GRASP", "held", stop=True)
    assert page.status["outcome"] == "stopped"
    page.act("back")
    page.choose("sm/GRASP", error=" the gripper: is 'gone' ")
    assert (page.status["state"], page.at) == ("failed", 2)
    assert page.error == "the gripper: is 'gone'"
    saved = page.act("save", name="gone")
    assert main(saved["command"].split()[1:]) == 1
    assert Path("scenarios/gone.yml").read_text() == (
        "# smachac run main.yml --mock scenarios/gone.yml\n"
        "# the run fails in sm/GRASP: the gripper: is 'gone'\n"
        "states:\n"
        "  sm/LOOK: found\n"
        "  sm/GRASP: {error: \"the gripper: is 'gone'\"}\n"
    )


def test_an_expression_that_fails_ends_the_run(pages: Pages) -> None:
    _, page = pages()
    page.choose("sm/LOOK", "found")
    page.choose("sm/GRASP", "held")
    assert page.status["at"][0]["run"] == "run its functions"
    page.choose("sm/TEST", run=True)
    assert page.status["state"] == "failed"
    assert "zero" in page.error
    page.act("back")
    page.choose("sm/TEST", "no")
    assert page.status["outcome"] == "lost"


SECRET_KEY = """\
name: sm
outcomes: [done]
userdata: {password: {type: str, value: "", secret: true}}
states:
  - A:
      template: ScriptedState
      outcomes: [ok]
      output_keys: [password]
      transitions: {ok: done}
"""


def test_secret_values_are_not_shown(pages: Pages) -> None:
    _, page = pages(SECRET_KEY)
    page.choose("sm/A", "ok", set={"password": "open sesame"})
    assert "sesame" not in json.dumps(page.status)
    assert page.status["steps"][0]["text"] == "ok, password = (secret)"


KEYS = """\
name: sm
outcomes: [done]
states:
  - A:
      template: Typed
      transitions: {ok: done}
"""

INTERFACE = """\
kind: state
outcomes: {ok: {}}
output_keys:
  flag: {type: bool}
  count: {type: int}
  width: {type: "float<m>"}
  words: {type: str}
  many: {type: "list[int]"}
  place: {type: Pose}
  form: {type: {name: str, size: float}}
  goal: {type: geometry_msgs/Pose}
  path: {type: "list[geometry_msgs/Pose]"}
"""


@pytest.mark.parametrize(
    ("key", "text", "value"),
    [
        ("flag", "false", False),
        ("count", "-7", -7),
        ("count", "2.5", "`count` is int: `2.5` does not fit"),
        ("count", "seven", "`count` is int: `seven` does not fit"),
        ("width", ".nan", "nan"),
        ("width", "-.inf", "-inf"),
        ("width", "1e-7", 1e-7),
        ("words", "", ""),
        ("words", "yes: [no", "yes: [no"),
        ("words", "12", "12"),
        ("words", "  two\tparts\n", "  two\tparts\n"),
        ("many", "[]", []),
        ("many", "[1, 2, 3]", [1, 2, 3]),
        ("many", "[1, two]", "`many` is"),
        ("place", "[[1.5, 0, 0], [0, 0, 0, 1]]", [[1.5, 0, 0], [0, 0, 0, 1]]),
        ("form", "{name: box, size: 0.5}", {"name": "box", "size": 0.5}),
        ("goal", "{position: {x: 1.5}}", {"position": {"x": 1.5}}),
        ("form", "{name: box", "the value of `form` cannot be read: write it as in a scenario"),
        ("count", "", "the value of `count` cannot be read"),
        ("count", "&a [*a, *a]", "the value of `count` cannot be read"),
        ("size", "1", "`size` is not an output key of `A`"),
    ],
)
def test_values_of_keys(key: str, text: str, value: object, pages: Pages) -> None:
    Path("templates").mkdir()
    Path("templates/Typed.yml").write_text(INTERFACE)
    _, page = pages(KEYS)
    if isinstance(value, str) and value.startswith(("`", "the value")):
        assert page.refused("choose", path="sm/A", outcome="ok", set={key: text}).startswith(value)
        return
    page.choose("sm/A", "ok", set={key: text})
    events = page.status["events"]
    assert [event["value"] for event in events if event["event"] == "write"] == [value]
    saved = page.act("save", name="it")
    assert main([*saved["command"].split()[1:], "--trace", "run.jsonl", "-q"]) == 0
    assert [json.loads(line) for line in Path("run.jsonl").read_text().splitlines()] == events


def test_the_values_that_are_proposed_are_accepted(pages: Pages) -> None:
    Path("templates").mkdir()
    Path("templates/Typed.yml").write_text(INTERFACE)
    _, page = pages(KEYS)
    (ok,) = page.status["at"][0]["outcomes"]
    assert [key["choices"] for key in ok["keys"]][:2] == [["true", "false"], []]
    page.choose("sm/A", "ok", set={key["name"]: key["value"] for key in ok["keys"]})
    assert page.status["outcome"] == "done"


def test_two_pages_show_one_simulation(pages: Pages) -> None:
    simulation, page = pages()
    other = Page(simulation, simulation._feed)
    other.update()
    assert other.status == page.status
    page.choose("sm/LOOK", "found")
    late = other.refused("choose", path="sm/LOOK", outcome="nothing")
    assert late == "the simulation has gone on in another page: look at it again"
    other.update()
    other.choose("sm/GRASP", "held")
    page.update()
    assert page.waiting == ["sm/TEST"]
    page.act("end")
    other.update()
    assert other.status == {"kind": "simulation", "state": "off"}
    assert other.refused("back") == "no simulation runs"


WITHOUT_RETRY = SCRIPT.replace("      retry: {on: [failed], max: 3}\n", "").replace(
    "exhausted:", "failed:"
)


@pytest.mark.parametrize(
    ("text", "left", "note"),
    [
        (SCRIPT.replace("30 s", "40 s"), 3, ""),
        (WITHOUT_RETRY, 2, "step 3 of 3, `sm/GRASP: held`"),
        (SCRIPT.replace("held", "grasped"), 2, "step 3 of 3, `sm/GRASP: held`"),
        (SCRIPT.replace("GRASP", "GRIP"), 1, "step 2 of 3, `sm/GRASP: failed`"),
        (SCRIPT.replace("found", "seen"), 0, "step 1 of 3, `sm/LOOK: found, place = [2, 3]`"),
        (SCRIPT.replace("place", "pose"), 0, "step 1 of 3, `sm/LOOK: found, place = [2, 3]`"),
        (SCRIPT.replace("  - LOOK:", "  - FIRST: {template: ScriptedState, outcomes: [ok],"
                        " transitions: {ok: LOOK}}\n  - LOOK:"), 0, "step 1 of 3, `sm/LOOK:"),
    ],
)  # fmt: skip
def test_an_edit_keeps_the_choices_that_fit(pages: Pages, text: str, left: int, note: str) -> None:
    simulation, page = pages()
    page.choose("sm/LOOK", "found", set={"place": "[2, 3]"})
    page.choose("sm/GRASP", "failed")
    page.choose("sm/GRASP", "held")
    simulation.use(machine_of(text))
    page.update()
    assert page.at == left
    assert note in page.status["note"]
    simulation.use(None)  # a version with errors
    page.update()
    assert page.at == left
    page.act("back") if left else page.choose(page.waiting[0], error="no")
    assert page.status["note"] == ""


def test_scenarios_are_saved_once(pages: Pages) -> None:
    _, page = pages()
    assert page.refused("save", name="a") == "the machine has not ended: choose on, or go back"
    page.choose("sm/LOOK", "nothing")
    for name in ("", "../a", "a/b", ".a", "a b", "x" * 200, None, 7):
        assert page.refused("save", name=name).startswith("the name of a scenario has letters")
    saved = page.act("save", name="lost")
    assert saved == {
        "file": "scenarios/lost.yml",
        "command": "smachac run main.yml --mock scenarios/lost.yml --expect lost",
    }
    path = Path("scenarios/lost.yml")
    before = path.read_bytes()
    assert page.act("save", name="lost") == saved
    page.act("back")
    page.choose("sm/LOOK", error="broken")
    assert page.refused("save", name="lost") == (
        "scenarios/lost.yml exists and is another scenario: choose another name"
    )
    assert path.read_bytes() == before


FOUND = {"action": "choose", "path": "sm/LOOK", "outcome": "found"}


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ({"action": "jump"}, "there is no such action"),
        ({"action": "choose", "path": "sm/TEST", "outcome": "yes"}, "`sm/TEST` does not wait"),
        ({"action": "choose", "path": 7}, "`7` does not wait"),
        ({"action": "choose", "path": "sm/LOOK", "outcome": "open"}, "`open` is not an outcome"),
        ({"action": "choose", "path": "sm/LOOK"}, "`None` is not an outcome"),
        (
            {"action": "choose", "path": "sm/LOOK", "outcome": "found", "after": "soon"},
            "the time is",
        ),
        ({"action": "choose", "path": "sm/LOOK", "outcome": "found", "after": -1}, "the time is"),
        ({"action": "choose", "path": "sm/LOOK", "outcome": "found", "set": []}, "the values"),
        ({"action": "choose", "path": "sm/LOOK", "outcome": "found", "set": {"a": "1"}}, "`a` is"),
        ({"action": "choose", "at": 3}, "the simulation has gone on"),
        ({"action": "choose", "at": None}, "the simulation has gone on"),
    ],
)
def test_what_is_refused(pages: Pages, body: dict[str, Any], message: str) -> None:
    _, page = pages()
    before = page.status
    assert page.refused(**body).startswith(message)
    assert page.status == before


def test_a_script_with_errors_is_not_simulated(pages: Pages) -> None:
    simulation, page = pages()
    page.act("end")
    simulation.use(None)
    assert page.refused("start") == "the script has errors, which must be fixed first"


@pytest.mark.parametrize("view", [written, generated])
def test_timers_need_no_choice(pages: Pages, view: Any) -> None:
    _, page = pages(view=view)
    page.choose("sm/LOOK", "found")
    (path,) = page.waiting
    assert path == ("sm/GRASP" if view is written else "sm/GRASP/TIMED/GRASP")


SLOW_RETRY = """\
name: sm
outcomes: [done, lost]
states:
  - A:
      template: ScriptedState
      outcomes: [ok]
      timeout: 30 s
      retry: {on: [timeout], max: 2, delay: 10 s}
      transitions: {ok: done, exhausted: lost, preempted: lost}
"""


def test_the_time_to_a_limit_is_without_the_pause_behind_it(pages: Pages) -> None:
    _, page = pages(SLOW_RETRY)
    for t in (0.0, 40.0):
        assert page.status["t"] == t
        assert page.status["at"][0]["wait"] == "time limit of A in 30 s: let it pass"
        page.choose("sm/A", wait=True)
    assert (page.status["outcome"], page.status["t"]) == ("lost", 70.0)


RACE = """\
name: sm
outcomes: [done, bad]
states:
  - RACE:
      template: Concurrence
      join: any
      outcomes: [done, bad]
      default_outcome: bad
      outcome_map: {done: {A: ok}}
      transitions: {done: done, bad: bad}
      states:
        - A: {template: ScriptedState, outcomes: [ok, preempted]}
        - B: {template: SleepState, time: 5.0}
"""


def test_branches_of_a_race(pages: Pages) -> None:
    _, page = pages(RACE)
    assert page.waiting == ["sm/RACE/A", "sm/RACE/B"]
    assert [each["wait"] for each in page.status["at"]] == ["wait for a stop request"] * 2
    assert [each["run"] for each in page.status["at"]] == ["", "wait 5 s"]
    page.choose("sm/RACE/B", run=True)
    (a,) = page.status["at"]
    assert a["wait"] == "wait 5 s for a stop request"
    page.choose("sm/RACE/A", wait=True)
    assert (page.status["outcome"], page.status["t"]) == ("bad", 5.0)
    page.act("back", to=0)
    page.choose("sm/RACE/B", wait=True)
    page.choose("sm/RACE/A", "ok")
    assert (page.status["outcome"], page.status["t"]) == ("done", 0.0)
    saved = page.act("save", name="race")
    assert main(saved["command"].split()[1:]) == 0


@pytest.fixture
def start() -> Iterator[Callable[..., Viewed]]:
    with starter() as start:
        yield start


@pytest.mark.slow
def test_the_server_simulates_the_script_on_disk(
    tmp_path: Path, start: Callable[..., Viewed]
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(SCRIPT)
    view = start("view", script, "--no-browser")
    assert view.post("/simulate", {"action": "start"})[0] == 200
    view.until(lambda each: each["kind"] == "simulation")
    choice = {"action": "choose", "at": 0, "path": "sm/LOOK", "outcome": "found"}
    assert view.post("/simulate", choice) == (200, {})
    script.write_text(SCRIPT.replace("found", "seen"))
    status = view.until(lambda each: each["kind"] == "simulation" and each["note"])
    assert status["steps"] == []
    assert view.post("/simulate", {**choice, "outcome": "nothing"})[0] == 200
    assert view.post("/simulate", {"action": "save", "at": 1, "name": "lost"})[0] == 200
    saved = str(tmp_path / "scenarios" / "lost.yml")
    command = [sys.executable, "-m", "smachac", "run", str(script), "--mock", saved]
    found = subprocess.run(command, check=False)
    assert found.returncode == 0
