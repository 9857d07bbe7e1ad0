"""The command `view` and `run --view`, as processes: their page, their stream and their end."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main
from smachac.view.ros_topic import candidates
from smachac.view.server import HOST
from tests.support.viewed import Viewed, starter

GOOD = """\
name: sm
outcomes: [done, stopped]
states:
  - WAIT:
      template: SleepState
      time: 0.0
      transitions: {succeeded: LAST, preempted: stopped}
  - LAST:
      template: SleepState
      time: 0.0
      transitions: {succeeded: done, preempted: stopped}
"""


@pytest.fixture
def start() -> Iterator[Callable[..., Viewed]]:
    with starter() as start:
        yield start


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "main.yml"
    path.write_text(GOOD)
    return path


def waits_at(path: str) -> Callable[[Any], bool]:
    return lambda message: (
        message["kind"] == "control" and [item["path"] for item in message["at"]] == [path]
    )


def finished(message: Any) -> bool:
    return bool(message["kind"] == "trace" and message["events"][-1]["event"] == "finish")


def drawn(message: Any) -> list[str]:
    """The states of a message `model`."""
    return [node["path"] for node in message["model"]["nodes"]]


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    path = tmp_path / "scenario.yml"
    path.write_text("states: {WAIT: [succeeded], LAST: [succeeded]}\n")
    return path


@pytest.mark.parametrize("mock", [False, True])
def test_run_is_controlled_from_the_page(
    mock: bool, script: Path, scenario: Path, start: Callable[..., Viewed]
) -> None:
    view = start("run", script, "--view", "--view-paused", "-q", *["--mock", scenario] * mock)
    assert view.message()["model"]["name"] == "sm"
    view.until(waits_at("sm/WAIT"))
    assert view.act(action="break", path="sm/NONE") == 409
    assert view.act(action="step") == 200
    view.until(waits_at("sm/LAST"))
    assert view.act(action="outcome", outcome="preempted") == 200
    last = view.until(finished)
    assert last["events"][-1]["outcome"] == "stopped"
    assert view.until(lambda each: each["kind"] == "control" and each["ended"])
    assert view.message() is None
    assert view.end() == (0, "outcome: stopped\n", "")


def test_a_page_opened_late_shows_the_whole_run(
    script: Path, scenario: Path, start: Callable[..., Viewed]
) -> None:
    """A stream that begins in the middle of the run has all events, and those after it."""
    view = start("run", script, "--view", "--view-paused", "-q", "--mock", scenario)
    view.until(waits_at("sm/WAIT"))
    assert view.act(action="step") == 200
    view.until(waits_at("sm/LAST"))
    view.reopen()
    events: list[Any] = list(view.until(lambda each: each["kind"] == "trace")["events"])
    assert view.act(action="resume") == 200
    while (message := view.message()) is not None:
        events += message["events"] if message["kind"] == "trace" else []
    assert [event["seq"] for event in events] == list(range(1, 9))


@pytest.mark.parametrize("mock", [False, True])
def test_ctrl_c_ends_a_run_that_waits(
    mock: bool, script: Path, scenario: Path, start: Callable[..., Viewed]
) -> None:
    view = start("run", script, "--view", "--view-paused", "-q", *["--mock", scenario] * mock)
    view.until(waits_at("sm/WAIT"))
    view.process.send_signal(signal.SIGINT)
    code, out, _ = view.end()
    assert (code, out) == (130, "outcome: stopped\n")


def test_stop_ends_a_run_that_waits(script: Path, start: Callable[..., Viewed]) -> None:
    view = start("run", script, "--view", "--view-paused", "-q")
    view.until(waits_at("sm/WAIT"))
    assert view.act(action="stop") == 200
    assert view.end()[:2] == (0, "outcome: stopped\n")


def test_view_draws_again_when_the_script_changes(
    script: Path, start: Callable[..., Viewed]
) -> None:
    view = start("view", script, "--no-browser")
    assert drawn(view.message()) == ["sm", "sm/WAIT", "sm/LAST"]
    assert view.message() == {"kind": "report", "broken": False, "outdated": False, "findings": []}
    script.write_text(GOOD.replace("succeeded: LAST", "succeeded: NOWHERE"))
    report = view.message()
    assert report["broken"]
    assert "SM101" in [item["code"] for item in report["findings"]]
    assert "LAST" in view.page()
    script.write_text(GOOD.replace("LAST", "FINAL"))
    assert drawn(view.message()) == ["sm", "sm/WAIT", "sm/FINAL"]
    assert not view.message()["broken"]
    assert "FINAL" in view.page()
    assert view.act(action="pause") == 409
    view.process.send_signal(signal.SIGINT)
    code, output, messages = view.end()
    assert (code, output) == (130, "")
    assert messages.startswith("error[SM")
    assert messages.endswith("\ninterrupted\n")


def test_view_shows_a_script_that_is_broken_from_the_start(
    script: Path, start: Callable[..., Viewed]
) -> None:
    script.write_text("name: [")
    view = start("view", script, "--no-browser")
    assert view.lines[0].startswith("error[SM001]")
    report = view.until(lambda each: each["kind"] == "report")
    assert report["broken"]
    assert report["findings"]
    assert "<title>main</title>" in view.page()
    script.write_text(GOOD)
    assert view.message()["model"]["name"] == "sm"


def test_view_follows_a_trace(script: Path, tmp_path: Path, start: Callable[..., Viewed]) -> None:
    trace = tmp_path / "run.jsonl"
    event = {"seq": 1, "event": "start", "path": "sm", "t": 0.0}
    trace.write_text(json.dumps(event) + "\n")
    view = start("view", script, "--attach", trace, "--no-browser")
    assert view.until(lambda each: each["kind"] == "trace")["events"] == [event]
    text = json.dumps({**event, "seq": 2, "event": "enter", "value": list(range(1000))})
    with trace.open("a") as stream:
        stream.write(text[:20])
        stream.flush()
        stream.write(text[20:] + "\nnonsense\n[]\n")
    (second,) = view.message()["events"]
    assert second["seq"] == 2
    assert len(second["value"]) < 200
    trace.write_text(json.dumps({**event, "seq": 7}) + "\n")
    assert [item["seq"] for item in view.message()["events"]] == [7]
    view.process.send_signal(signal.SIGINT)
    code, _, err = view.end()
    assert code == 130
    assert "2 lines are no event of a trace" in err


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("other", "this is the trace of the machine `other`, not of `sm`"),
        ("sm/GONE", "the script has no state `sm/GONE`: it is not the version that ran"),
    ],
)
def test_a_trace_of_another_machine_is_named(
    script: Path, tmp_path: Path, start: Callable[..., Viewed], path: str, message: str
) -> None:
    trace = tmp_path / "run.jsonl"
    trace.write_text(json.dumps({"seq": 1, "event": "enter", "path": path, "t": 0.0}) + "\n")
    view = start("view", script, "--attach", trace, "--no-browser")
    assert view.lines[0] == f"{trace}: {message}\n"
    view.until(lambda each: each["kind"] == "trace")


def test_a_database_of_a_sweep_is_no_trace(script: Path, tmp_path: Path) -> None:
    (tmp_path / "sweep.db").write_bytes(b"SQLite format 3\0")
    found = smachac("view", script, "--attach", tmp_path / "sweep.db")
    assert found.returncode == 2
    assert "is the database of a sweep, which has no events: use `smachac stats`" in found.stderr


@pytest.mark.slow
def test_a_run_shows_the_states_that_fields_add(
    tmp_path: Path, start: Callable[..., Viewed]
) -> None:
    path = tmp_path / "limited.yml"
    path.write_text(
        "name: sm\noutcomes: [done]\nstates:\n  - A: {template: ScriptedState, outcomes: [ok],"
        " timeout: 9 s, transitions: {ok: done, timeout: done, preempted: done}}\n"
    )
    view = start("run", path, "--view", "--view-paused", "--generated", "-q")
    at = view.until(lambda each: each["kind"] == "control" and each["at"])["at"]
    assert [place["path"] for place in at] == ["sm/A"]
    assert view.act(action="break", path="sm/A/TIMER") == 200
    assert view.act(action="resume") == 200
    view.until(
        lambda each: (
            each["kind"] == "control" and each["at"][:1] and each["at"][0]["path"] == "sm/A/TIMER"
        )
    )
    assert view.act(action="stop") == 200
    view.end()


@pytest.mark.slow
def test_view_opens_the_page_of_a_run(script: Path, start: Callable[..., Viewed]) -> None:
    view = start("run", script, "--view", "--view-paused", "-q")
    words = ["view", "--attach", str(view.port), "--no-browser"]
    found = smachac(*words)
    assert (found.returncode, found.stderr) == (0, f"view: http://{HOST}:{view.port}/\n")
    assert view.act(action="stop") == 200
    view.end()
    assert smachac(*words).returncode == 2


def smachac(*words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "smachac", *map(str, words)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["view"], "a script is needed"),
        (["view", "--attach", "run.jsonl"], "a script is needed"),
        (["view", "none.yml"], "there is no file none.yml"),
        (["view", "."], ". is a folder: name a script"),
        (["view", "SCRIPT", "--attach", "none.jsonl"], "there is no trace none.jsonl"),
        (["view", "--attach", "70000"], "70000 is no port"),
        (["view", "SCRIPT", "--film", "SCRIPT"], "--film needs the trace of the run"),
        (["view", "SCRIPT", "--attach", "SCRIPT", "--film", "SCRIPT"], "main.yml is no film"),
        (["view", "SCRIPT", "--attach", "SCRIPT", "--film", "x.gif"], "x.gif cannot be read"),
        (["view", "SCRIPT", "--attach", "SCRIPT"], "main.yml is no trace"),
        (["view", "SCRIPT", "--port", "x"], "must be a port"),
        (["run", "SCRIPT", "--view-paused"], "--view-paused needs --view"),
        (["run", "SCRIPT", "--generated"], "--generated needs --view"),
        (["run", "--view", "SCRIPT"], "must be a port"),
    ],
)
def test_wrong_usage(words: list[str], message: str, script: Path) -> None:
    found = smachac(*(script if word == "SCRIPT" else word for word in words))
    assert found.returncode == 2
    assert message in found.stderr


def test_a_port_in_use_is_wrong_usage(script: Path, start: Callable[..., Viewed]) -> None:
    view = start("view", script, "--no-browser")
    for words in (["view", script, "--port", view.port], ["run", script, f"--view={view.port}"]):
        found = smachac(*words)
        assert found.returncode == 2
        assert f"port {view.port} cannot be used" in found.stderr


def test_a_ros_topic_needs_ros(
    script: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("smachac.view.ros_topic.find_spec", lambda name: None)
    assert main(["view", str(script), "--attach", "ros:/patrol"]) == 2
    message = capsys.readouterr().err
    assert "a ROS topic needs rclpy or rospy" in message
    assert message.count("\n") == 1
    assert main(["view", "--attach", "ros:/patrol"]) == 2
    assert "smachac view main.yml --attach ros:/patrol" in capsys.readouterr().err
    assert main(["view", str(script), "--attach", "ros:/patrol", "--film", str(script)]) == 2
    assert "--film needs the trace" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "topics"),
    [
        ("/patrol", ["/patrol/smach/container_status_json", "/patrol/smach/container_status"]),
        ("a/b/", ["/a/b/smach/container_status_json", "/a/b/smach/container_status"]),
        ("", ["/smach/container_status_json", "/smach/container_status"]),
        ("/p/smach/container_status", ["/p/smach/container_status"]),
        ("p/smach/container_status_json", ["/p/smach/container_status_json"]),
    ],
)
def test_the_topics_of_a_name(name: str, topics: list[str]) -> None:
    assert candidates(name) == topics
