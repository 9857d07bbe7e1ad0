"""Refactorings of states with time limits, retries, loops and `on_error`."""

from __future__ import annotations

import random
import tempfile
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.commands.cli import main
from smachac.ir.nodes import Leaf
from smachac.ir.script_paths import walk_script
from tests.refactor.test_refactorings import (
    command,
    inside,
    machine,
    machine_text,
    texts,
    transcript,
)


def written(draw: random.Random) -> str:
    """A script whose states and containers have sugar."""
    rows = ["name: sm", "template: Base", "outcomes: [done, failed, stopped]",
            "userdata: {todo: [1, 2], total: 0}"]  # fmt: skip
    rows += ["on_error: LAST"] if draw.random() < 0.5 else []
    rows += ["states:", *_states(draw, ["A", "B", "C"], "LAST", "  ", 2)]
    rows += ["  - LAST: {template: ScriptedState, outcomes: [ok], transitions: {ok: failed}}"]
    return "\n".join(rows) + "\n"


def _states(draw: random.Random, names: list[str], last: str, pad: str, depth: int) -> list[str]:
    rows = []
    for name, after in zip(names, [*names[1:], last], strict=True):
        sugar = [
            f"timeout: {draw.randint(1, 9)}s",
            "retry: {on: [bad], max: 3}",
            "retry: {on: [bad], max: 2, delay: 1s}",
            "for_each: {item: one, in: todo, on: [good]}",
            "for_each: {item: one, in: [1, 2], on: [good]}",
        ]
        mine = {line.partition(":")[0]: line for line in draw.sample(sugar, draw.randint(0, 3))}
        rows += [f"{pad}- {name}:"]
        body = ["outcomes: [good, bad]", *mine.values()]
        if depth > 1 and draw.random() < 0.4:
            body += ["template: StateMachine", "input_keys: [todo, total]"]
            inner = [f"{name}{number}" for number in (1, 2)]
            body += ["states:", *_states(draw, inner, "good", "  ", depth - 1)]
            ends = {"timeout": "bad", "exhausted": "bad", "preempted": "bad", "bad": "bad"}
        else:
            body += ["template: ScriptedState", "input_keys: [total]"]
            body += ["output_keys: [total]"] if draw.random() < 0.5 else []
            ends = {}
        ends = dict.fromkeys(["timeout"] * ("timeout" in mine), "")
        ends |= dict.fromkeys(["exhausted"] * ("retry" in mine), "")
        ends |= dict.fromkeys(["preempted"] * bool(mine), "")
        ends |= {} if "retry" in mine else {"bad": ""}
        out = "failed" if depth == 2 else "bad"
        pairs = {"good": after, **dict.fromkeys(ends, draw.choice([out, after]))}
        if draw.random() < 0.2:
            pairs["error"] = after
        body.append(f"transitions: {{{', '.join(f'{key}: {to}' for key, to in pairs.items())}}}")
        rows += [f"{pad}    {line}" for line in body]
    return rows


@pytest.mark.parametrize("scripts", [10, pytest.param(100, marks=pytest.mark.nightly)])
@pytest.mark.slow
def test_sugar_survives_refactoring(scripts: int) -> None:
    """Contained states run as before; a container that is extracted can be inlined again; a state
    that is renamed twice has its old name."""

    @settings(max_examples=scripts, deadline=None)
    @given(st.integers(0, 10**9))
    def survives(seed: int) -> None:
        draw = random.Random(seed)
        with tempfile.TemporaryDirectory() as folder, inside(folder):
            Path("main.yml").write_text(written(draw), "utf-8")
            before, text = machine(), machine_text()
            found = [item for item in walk_script(before.root) if not item.added][1:]
            outer = [
                item for item in found if not isinstance(item.node, Leaf) and not item.node.sugar
            ]
            for item in outer[:1]:
                assert command("extract", "main.yml", item.plain, "--to", "sub.yml") == 0
                assert machine_text() == text
                assert command("inline", "main.yml", item.plain) == 0
                Path("sub.yml").unlink()
                assert machine_text() == text
            old = draw.choice(found)
            around, _, name = old.plain.rpartition("/")
            assert command("rename", "main.yml", old.plain, "NEW_NAME", "--kind", "state") == 0
            new = f"{around}/NEW_NAME"
            assert command("rename", "main.yml", new, name, "--kind", "state") == 0
            assert machine_text() == text
            first = draw.randrange(3)
            names = ["A", "B", "C"][first : first + draw.randint(1, 3)]
            code = command("contain", "main.yml", "NEW", "StateMachine", *names)
            after = machine()
        assert (code == 0) == ("NEW" in {item.node.name for item in walk_script(after.root)})
        for number in range(10 if code == 0 else 0):
            assert transcript(after, number) == transcript(before, number)

    survives()


def test_most_states_with_sugar_can_be_contained() -> None:
    done = Counter[int]()
    for seed in range(12):
        with tempfile.TemporaryDirectory() as folder, inside(folder):
            Path("main.yml").write_text(written(random.Random(seed)), "utf-8")
            done[command("contain", "main.yml", "NEW", "StateMachine", "A", "B")] += 1
    assert done[0] >= 10


SCRIPT = """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {todo: [1, 2]}
states:
  - DRIVE:
      template: ScriptedState
      outcomes: [succeeded, aborted]
      input_keys: [one, todo]
      retry: {on: [aborted], max: 2}
      timeout: 5s
      for_each: {item: one, in: todo}
      transitions: {succeeded: LOOK, timeout: failed, exhausted: failed, preempted: failed}
  - LOOK:
      template: ScriptedState
      outcomes: [succeeded]
      timeout: 2s
      transitions: {succeeded: done, timeout: failed, preempted: failed}
"""


@pytest.mark.parametrize(
    ("words", "reason", "place"),
    [
        ("rename main.yml DRIVE/TIMER X", "`timeout` of `DRIVE` adds it", "main.yml:6:5"),
        ("contain main.yml NEW StateMachine LOOK/TIMER", "`timeout` of `LOOK`", "main.yml:14:5"),
        ("rename main.yml DRIVE/exhausted lost", "`retry` gives the outcome", "main.yml:10:7"),
        ("rename main.yml LOOK/timeout late", "`timeout` gives the outcome", "main.yml:17:7"),
        ("rename main.yml DRIVE/one place", "is the item of `for_each`", "main.yml:6:5"),
        ("extract main.yml DRIVE", "`DRIVE` is not a container", "main.yml:6:5"),
        ("inline main.yml LOOK", "`LOOK` calls no sub-script", "main.yml:14:5"),
    ],
)
def test_what_is_refused_has_a_reason_and_a_place(
    words: str,
    reason: str,
    place: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.yml").write_text(SCRIPT, "utf-8")
    before = texts()
    assert main(words.split()) == 1
    shown = capsys.readouterr().err
    assert reason in shown
    assert f"--> {place}" in shown
    assert texts() == before


def test_the_items_of_a_loop_are_renamed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.yml").write_text(SCRIPT, "utf-8")
    assert main(["rename", "main.yml", "sm/todo", "places", "--kind", "key"]) == 0
    text = texts()["main.yml"]
    assert "in: places" in text
    assert "input_keys: [one, places]" in text
    assert "todo" not in text


@pytest.mark.parametrize("path", ["DRIVE", "sm/DRIVE", "DRIVE (retry)", "sm/DRIVE/TRIES/TIMED"])
def test_each_form_of_a_path_names_the_state(
    path: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.yml").write_text(SCRIPT, "utf-8")
    assert main(["contain", "main.yml", "NEW", "StateMachine", path]) == 0
    assert "NEW" in texts()["main.yml"]
