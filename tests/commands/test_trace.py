"""`smachac trace check`: what it prints, and its exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
outcomes: [done, lost]
states:
  - A: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: B, bad: lost}}
  - B:
      template: ScriptedState
      outcomes: [ok, bad]
      retry: {on: [bad], max: 2}
      transitions: {ok: done, exhausted: lost, preempted: lost}
"""


@pytest.fixture
def recorded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Path:
    """The trace of a run of SCRIPT, in the current folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.yml").write_text(SCRIPT, "utf-8")
    assert main(["run", "main.yml", "-q", "--trace", "run.jsonl"]) == 0
    capsys.readouterr()
    return tmp_path / "run.jsonl"


def test_a_run_is_allowed(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["trace", "check", "main.yml", "run.jsonl", "run.jsonl"]) == 0
    count = len(recorded.read_text("utf-8").splitlines())
    line = f"run.jsonl: {count} events, ended with `done`\n"
    assert capsys.readouterr().out == line * 2 + (
        "2 traces, all allowed\n2 of 6 transitions taken (33 %)\n"
        "  not taken: sm/A: bad -> sm:lost  (main.yml:4)\n"
        "  not taken: sm/B: exhausted -> sm:lost  (main.yml:9)\n"
        "  not taken: sm/B: preempted -> sm:lost  (main.yml:9)\n"
        "  not taken: sm/B: bad -> sm/B (loop)  (main.yml:5)\n"
    )


def test_a_changed_run_is_not(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = recorded.read_text("utf-8").replace('"to": "sm/B (retry)"', '"to": "sm:lost"')
    recorded.write_text(text, "utf-8")
    line = next(n for n, row in enumerate(text.splitlines(), 1) if '"to": "sm:lost"' in row)
    assert main(["trace", "check", "main.yml", "run.jsonl"]) == 1
    assert capsys.readouterr().out.startswith(
        f"run.jsonl:{line}: `ok` of `sm/A` leads to `sm:lost`, in the script to `sm/B`"
        " (main.yml:4)\n1 trace, 1 not allowed\n"
    )
    assert main(["trace", "check", "main.yml", "run.jsonl", "--format", "json"]) == 1
    (trace,) = json.loads(capsys.readouterr().out)["traces"]
    assert (trace["allowed"], trace["line"], trace["src"]) == (False, line, "main.yml:4")


PARTS = """\
name: sm
outcomes: [done, lost]
states:
  - A:
      template: ScriptedState
      outcomes: [ok, bad]
      timeout: 5 s
      retry: {on: [bad], max: 2, delay: 1 s}
      transitions: {ok: done, exhausted: lost, timeout: lost, preempted: lost}
"""


@pytest.mark.parametrize(
    ("old", "new", "message", "generated"),
    [
        (
            '"path": "sm/A (timeout)", "outcome": "ok"',
            '"path": "sm/A (timeout)", "outcome": "bad"',
            "the time limit of `sm/A` ends with `bad`, in the script with `ok`",
            "`sm/A (timeout)` ends with `bad`, in the script with `ok`",
        ),
        (
            '"exit", "path": "sm/A", "outcome": "ok"',
            '"exit", "path": "sm/A", "outcome": "lost"',
            "`sm/A` ends with `lost`, which is none of its outcomes",
            "`sm/A` ends with `lost`, which is none of its outcomes",
        ),
        (
            '"path": "sm/A (try)", "outcome": "ok", "to": "sm/A (retry):ok"',
            '"path": "sm/A (try)", "outcome": "ok", "to": "sm/A (retry):bad"',
            "`ok` of a try of `sm/A` leads to `sm/A:bad`, in the script to `sm/A:ok`",
            "`ok` of `sm/A (try)` leads to `sm/A (retry):bad`, in the script to `sm/A (retry):ok`",
        ),
        (
            '"enter", "path": "sm/A (retry)"',
            '"enter", "path": "sm/A (timeout)/TIMER"',
            "the time limit of `sm/A` is not running",
            "`sm/A (timeout)` is not running",
        ),
    ],
)
def test_what_is_made_of_fields_is_named_by_its_state(
    old: str,
    new: str,
    message: str,
    generated: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.yml").write_text(PARTS, "utf-8")
    assert main(["run", "main.yml", "-q", "--trace", "run.jsonl"]) == 0
    text = Path("run.jsonl").read_text("utf-8")
    assert old in text
    Path("run.jsonl").write_text(text.replace(old, new), "utf-8")
    for options, expected in (([], message), (["--generated"], generated)):
        capsys.readouterr()
        assert main(["trace", "check", "main.yml", "run.jsonl", *options]) == 1
        assert expected in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("no json", "this line is not JSON"),
        ("[" * 100_000, "this line has too many brackets in brackets"),
        ("[1]", "this line is not an event of a trace"),
        ('{"event": "jump", "path": "sm"}', "`jump` is not a kind of event"),
        ('{"event": "exit", "path": "sm"}', "the event `exit` has no text `outcome`"),
        ('{"event": "enter", "path": "sm/Ü"}', "the script has no state `sm/Ü`"),
        ('{"event": "enter", "path": "sm/A"}', "`sm` is not running"),
        ('{"event": "transition", "path": "sm", "outcome": "x", "to": "y"}', "`sm` is"),
    ],
)
def test_other_lines(
    line: str, message: str, recorded: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded.write_text(line + "\n", "utf-8")
    assert main(["trace", "check", "main.yml", "run.jsonl"]) == 1
    assert capsys.readouterr().out.startswith(f"run.jsonl:1: {message}")


def test_a_torn_last_line_is_no_fault(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorded.write_text(recorded.read_text("utf-8")[:-60], "utf-8")
    assert main(["trace", "check", "main.yml", "run.jsonl"]) == 0
    assert "has not ended" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["none.jsonl", "."])
def test_files_that_cannot_be_read(
    name: str, recorded: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["trace", "check", "main.yml", name]) == 2
    assert f"the trace {name} cannot be read" in capsys.readouterr().err
    assert recorded.is_file()


def test_statistics_of_states(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["trace", "stats", "main.yml", "run.jsonl", "run.jsonl", "--format", "json"]) == 0
    data = json.loads(capsys.readouterr().out)
    fields = ("path", "visits", "outcomes", "rounds")
    assert [tuple(state[name] for name in fields) for state in data["states"]] == [
        ("sm", 2, {"done": 2}, {}),
        ("sm/A", 2, {"ok": 2}, {}),
        ("sm/B", 2, {"ok": 2}, {"try": 2}),
    ]
    assert {"path": "sm/A", "outcome": "bad", "to": "sm:lost"} in data["never_taken"]
    assert main(["trace", "stats", "main.yml", "run.jsonl"]) == 0
    shown = capsys.readouterr().out.splitlines()
    assert shown[0].split() == ["state", "visits", "mean", "longest", "outcomes"]
    assert shown[2].startswith("  A ")
    assert shown[2].endswith("ok 100.0 %")
    assert shown[3].endswith("ok 100.0 %, 1 try")
    assert shown[4] == "never taken: sm/A: bad -> sm:lost"


def test_the_page_of_statistics(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stats", "main.yml", "run.jsonl", "run.jsonl", "--format", "html"]) == 0
    page = capsys.readouterr().out
    start = page.index('<script type="application/json" id="smachac-model">')
    model = json.loads(page[page.index(">", start) + 1 : page.index("</script>", start)])
    found = model["statistics"]
    assert set(found["states"]) <= {node["path"] for node in model["nodes"]}
    assert found["states"]["sm/A"]["outcomes"] == {"ok": 2}
    assert found["transitions"] == 6
    assert found["never"][0] == {
        "path": "sm/A",
        "text": "sm/A: bad -> sm:lost",
        "failure": False,
    }
    assert len(found["never"]) == 4
    assert main(["stats", "main.yml", "run.jsonl", "--format", "html", "--success", "done"]) == 2
    assert "--success has no effect" in capsys.readouterr().err


def test_a_prediction(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stats", "main.yml", "run.jsonl"]) == 0
    shown = capsys.readouterr().out.splitlines()
    assert shown[0] == "1 run"
    assert shown[2].split() == ["done", "100.0", "%", "20.7", "%", "to", "100.0", "%", "100.0", "%"]
    assert main(["stats", "main.yml", "run.jsonl", "--success", "dnoe"]) == 2
    assert "did you mean `done`?" in capsys.readouterr().err


@pytest.mark.parametrize("words", [["stats"], ["trace", "stats"]], ids=" ".join)
def test_no_statistics_of_a_trace_that_is_not_allowed(
    words: list[str], recorded: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recorded.write_text("x\n", "utf-8")
    assert main([*words, "main.yml", "run.jsonl"]) == 1
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("run.jsonl:1: this line is not JSON\n")


def test_a_trace_without_a_run(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recorded.write_text("", "utf-8")
    assert main(["trace", "check", "main.yml", "run.jsonl"]) == 0
    assert main(["stats", "main.yml", "run.jsonl"]) == 2
    assert "the traces have no run" in capsys.readouterr().err


def test_the_graph_shows_the_statistics(recorded: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = recorded.read_text("utf-8")
    # A second run, in which `A` ends the machine.
    bad = [line for line in text.splitlines(keepends=True) if '"sm/B' not in line]
    changed = "".join(bad).replace('"outcome": "ok"', '"outcome": "bad"')
    changed = changed.replace('"outcome": "done"', '"outcome": "lost"')
    lines = [json.loads(line) for line in changed.splitlines()]
    assert [event["event"] for event in lines] == ["start", "enter", "exit", "finish"]
    added = {**lines[2], "event": "transition", "to": "sm:lost"}
    rows = [*lines[:3], added, lines[3]]
    (recorded.parent / "other.jsonl").write_text("".join(json.dumps(row) + "\n" for row in rows))
    assert main(["stats", "main.yml", "run.jsonl", "other.jsonl", "--format", "dot"]) == 0
    found = capsys.readouterr().out
    assert found.startswith('digraph "sm" {')
    (box,) = [line for line in found.splitlines() if line.strip().startswith('"sm/A" [')]
    assert "2 visits, " in box
    (edge,) = [
        line for line in found.splitlines() if line.strip().startswith('"sm/A" -> "sm=lost"')
    ]
    assert "bad 50.0 %" in edge


WRITE = '{"seq": 4, "event": "write", "path": "sm/A", "key": "k", "value": %s}'
ENTER = '{"seq": 4, "event": "enter", "path": "sm%s"}'
LONG_LINES = {
    "value": (WRITE % ("[" + "[]," * 2_000_000 + "[]]"), "this line has more than 4,000,000"),
    "text": (WRITE % f'"{"x" * 5_000_000}"', "this line has more than 4,000,000"),
    "no JSON": ("x" * 5_000_000, "this line has more than 4,000,000"),
    "path": (ENTER % ("/a" * 1_000_000), "its `path` has more than 10,000 characters"),
    "quoted": (ENTER % ("/a" * 4_000), "/a/a` (8002 characters)"),
    "kind": ('{"event": "' + "a" * 100_000 + '", "path": "sm"}', "a` (100000 characters) is not"),
}


@pytest.mark.parametrize(("line", "message"), LONG_LINES.values(), ids=LONG_LINES)
def test_a_long_line_is_refused_in_a_few_words(
    recorded: Path, capsys: pytest.CaptureFixture[str], line: str, message: str
) -> None:
    first = recorded.read_text().splitlines(keepends=True)[0]
    recorded.write_text(f"{first}{line}\n")
    assert main(["trace", "check", "main.yml", "run.jsonl"]) == 1
    shown = capsys.readouterr().out
    assert f"run.jsonl:2: {'' if '`' in message else message}" in shown
    assert message in shown
    assert len(shown) < 1500
    assert main(["trace", "stats", "main.yml", "run.jsonl"]) == 1
    assert len(capsys.readouterr().err) < 1000


def test_a_long_line_is_refused_at_the_end_of_a_trace_too(recorded: Path) -> None:
    recorded.write_text(f"{recorded.read_text()}{LONG_LINES['text'][0]}")
    assert main(["trace", "check", "main.yml", "run.jsonl"]) == 1
