"""`smachac sweep`: its reports, its database, and how it goes on after an interruption."""

from __future__ import annotations

import json
import resource
import shutil
import sqlite3
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import pytest

from smachac import load
from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.ir.written import written
from smachac.robots.faults import read_file
from smachac.robots.files import plain
from smachac.sweep.task import Runner, Task
from smachac.sweep.variation import read_variation
from tests.support.sweeps import CHANCES, ONCE, SCRIPT, smachac, work_folder

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with SCRIPT and its scenario."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "main.yml").write_text(SCRIPT, "utf-8")
    (tmp_path / "chances.yml").write_text(CHANCES, "utf-8")
    return tmp_path


MOCK = ("sweep", "main.yml", "--mock", "chances.yml", "--jobs", "1")


def swept(capsys: pytest.CaptureFixture[str], *more: str) -> dict[str, Any]:
    assert main([*MOCK, "--format", "json", *more]) == 0
    found: dict[str, Any] = json.loads(capsys.readouterr().out)
    return found


def seeds(database: Path) -> list[int]:
    connection = sqlite3.connect(database)
    try:
        return [seed for (seed,) in connection.execute("SELECT seed FROM runs ORDER BY seed")]
    finally:
        connection.close()


def test_the_report(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    summary = swept(capsys, "--runs", "60", "--jobs", "2")
    assert summary["runs"] == 60
    assert sum(item["count"] for item in summary["outcomes"]) == 60
    good = summary["success"]
    assert good["outcomes"] == ["succeeded"]
    assert good["interval"][0] < good["share"] < good["interval"][1]
    assert summary["coverage"]["states"] == {"visited": 3, "total": 3, "missing": []}
    assert [
        (item["path"], item["outcome"]) for item in summary["coverage"]["transitions"]["missing"]
    ] == [("sm/GRASP", "preempted")]
    assert sum(group["count"] for group in summary["failures"]) == 60 - good["count"]


def test_each_failure_is_replayed_by_its_command(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    summary = swept(capsys, "--runs", "60")
    assert len(summary["failures"]) == 2
    for group in summary["failures"]:
        words = group["replay"].split()
        assert words[:2] == ["smachac", "run"]
        assert main([*words[1:], "--quiet"]) == 0
        assert capsys.readouterr().out == f"outcome: {group['outcome']}\n"


@pytest.mark.slow
def test_seeds_decide_and_not_the_number_of_processes(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = swept(capsys, "--runs", "30", "--jobs", "1")
    assert one == swept(capsys, "--runs", "30", "--jobs", "2")


@pytest.mark.slow
def test_the_prediction_is_within_the_interval_of_the_sweep(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    summary = swept(capsys, "--runs", "1000", "--database", "sweep.db")
    assert main(["stats", "main.yml", "sweep.db", "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["runs"] == 1000
    assert found["measured"]["outcomes"]["succeeded"] == summary["success"]["share"]
    low, high = summary["success"]["interval"]
    exact = 0.95 * (1 - 0.4**3)
    assert low < found["prediction"]["outcomes"]["succeeded"] < high
    assert low < exact < high
    assert abs(found["prediction"]["outcomes"]["succeeded"] - exact) < (high - low) / 2
    assert [item["path"] for item in found["failures"]] == ["sm/GRASP", "sm/FIND"]


@pytest.mark.slow
def test_a_sweep_goes_on_where_it_was(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    few = swept(capsys, "--runs", "20", "--database", "sweep.db")
    more = swept(capsys, "--runs", "50", "--database", "sweep.db")
    assert (few["runs"], more["runs"]) == (20, 50)
    assert seeds(folder / "sweep.db") == list(range(50))
    assert few == swept(capsys, "--runs", "20", "--database", "sweep.db")


def test_other_inputs_are_refused_with_help(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    swept(capsys, "--runs", "5", "--database", "sweep.db")
    (folder / "chances.yml").write_text(CHANCES.replace("0.95", "0.9").replace("0.05", "0.1"))
    assert main([*MOCK, "--runs", "5", "--database", "sweep.db"]) == 2
    shown = capsys.readouterr().err
    assert "sweep.db has runs with other inputs: scenario" in shown
    assert "delete it, or give another file with --database" in shown


@pytest.mark.parametrize("content", [b"", b"no database at all", b"SQLite format 3\0" + bytes(84)])
def test_other_files_are_not_changed(
    folder: Path, capsys: pytest.CaptureFixture[str], content: bytes
) -> None:
    (folder / "notes.txt").write_bytes(content)
    code = main([*MOCK, "--runs", "5", "--database", "notes.txt"])
    assert code == (2 if content else 0)
    if content:
        assert (folder / "notes.txt").read_bytes() == content
        assert "notes.txt" in capsys.readouterr().err


def test_a_database_of_another_program_is_refused(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    connection = sqlite3.connect(folder / "other.db")
    connection.execute("CREATE TABLE runs (seed INTEGER)")
    connection.close()
    assert main([*MOCK, "--database", "other.db"]) == 2
    assert "other.db is not a database of `smachac sweep`" in capsys.readouterr().err
    assert main(["stats", "main.yml", "other.db"]) == 2
    assert "is not a database of `smachac sweep`" in capsys.readouterr().err


def broken(path: Path, change: str) -> None:
    """Damages a database of a sweep: cuts it off, removes a byte of its first ones, or changes one
    value of the run with seed 3."""
    if change == "cut":
        path.write_bytes(path.read_bytes()[:5000])
        return
    if change == "other":
        path.write_bytes(b"SQLite" + path.read_bytes()[7:])
        return
    connection = sqlite3.connect(path)
    with connection:
        connection.execute(f"UPDATE runs SET {change} WHERE seed = 3")
    connection.close()


VALUES_ARE_WRONG = "the values of the run with seed 3 are wrong"
DAMAGE = {
    "cut": "database disk image is malformed",
    "other": "file is not a database",
    "steps = 'no JSON'": VALUES_ARE_WRONG,
    "states = '[1]'": VALUES_ARE_WRONG,
    "covered = NULL": VALUES_ARE_WRONG,
    "vary = '7'": VALUES_ARE_WRONG,
    "faults = '{}'": VALUES_ARE_WRONG,
    "wall = 'long'": VALUES_ARE_WRONG,
}


def test_a_damaged_database_is_one_message(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """All in one test, as all damage one sweep."""
    swept(capsys, "--runs", "8", "--database", "whole.db")
    for change, reason in DAMAGE.items():
        shutil.copy(folder / "whole.db", folder / "sweep.db")
        broken(folder / "sweep.db", change)
        message = f"the database sweep.db cannot be used: {reason}\n"
        for command in ("stats", "trace stats"):
            assert main([*command.split(), "main.yml", "sweep.db"]) == 2, change
            assert capsys.readouterr().err == f"smachac: error: {message}"
        assert main([*MOCK, "--runs", "8", "--database", "sweep.db"]) in (1, 2), change
        assert capsys.readouterr().err.endswith(message), change


@pytest.mark.parametrize(
    ("words", "names"),
    [
        (["-o", "main.yml"], "--output main.yml is the script"),
        (["--junit", "./chances.yml"], "--junit chances.yml is the file of --mock"),
        (["--database", "main.yml"], "--database main.yml is the script"),
        (["--database", "a.db", "--junit", "a.db"], "--junit a.db is the file of --database"),
        (["-o", "a.xml", "--junit", "a.xml"], "--junit a.xml is the file of --output"),
        (["-o", "linked.yml"], "--output linked.yml is the script"),
    ],
)
def test_a_file_has_one_use(
    folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], names: str
) -> None:
    (folder / "linked.yml").symlink_to("main.yml")
    assert main([*MOCK, *words]) == 2
    assert names in capsys.readouterr().err
    assert (folder / "main.yml").read_text() == SCRIPT
    assert (folder / "chances.yml").read_text() == CHANCES
    assert sorted(path.name for path in folder.iterdir()) == [
        *("chances.yml", "linked.yml", "main.yml"),
    ]


def test_statistics_are_those_of_the_same_script(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    swept(capsys, "--runs", "5", "--database", "sweep.db")
    (folder / "main.yml").write_text(SCRIPT.replace("max: 3", "max: 4"))
    assert main(["stats", "main.yml", "sweep.db"]) == 2
    assert "its runs are those of another script" in capsys.readouterr().err
    assert main(["trace", "check", "main.yml", "sweep.db"]) == 2
    assert "a sweep's database has no events" in capsys.readouterr().err


def test_expectations_decide_the_exit_code(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    short = [*MOCK, "--runs", "40", "--database", "sweep.db"]
    assert main([*short, "--expect", "succeeded", "--at-least", "0.5"]) == 0
    assert main([*short, "--expect", "succeeded"]) == 1
    assert "expected: succeeded in at least 100 % of the runs" in capsys.readouterr().err
    assert main([*short, "--at-least", "0.99"]) == 1
    assert main([*short, "--expect", "suceeded"]) == 2
    assert "did you mean `succeeded`?" in capsys.readouterr().err


def test_junit_has_a_test_for_each_run(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    summary = swept(capsys, "--runs", "40", "--junit", "sweep.xml")
    suite = ET.parse(folder / "sweep.xml").getroot()[0]
    assert [test.get("name") for test in suite] == [f"seed {seed}" for seed in range(40)]
    failed = 40 - summary["success"]["count"]
    assert suite.get("failures") == str(failed)
    assert len(suite.findall("testcase/failure")) == failed > 0
    assert "smachac run main.yml --mock chances.yml --seed" in str(suite.findtext(".//failure"))


def test_the_page_stands_alone_and_escapes(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    name = "<b>&sm"
    (folder / "main.yml").write_text(SCRIPT.replace("name: sm", f'name: "{name}"'))
    assert main([*MOCK, "--runs", "20", "--format", "html", "-o", "sweep.html"]) == 0
    assert capsys.readouterr().out == ""
    page = (folder / "sweep.html").read_text("utf-8")
    assert "&lt;b&gt;&amp;sm" in page
    assert "<b>&sm" not in page
    own, _, graph = page.partition(' srcdoc="')
    graph, _, rest = graph.partition('"')
    assert not any(word in own + rest for word in ("http", "<script", "<link", "src="))
    assert "default-src &#x27;none&#x27;" in graph
    first = own.partition("<h2>Failures</h2>")[2].partition("<h3>")[2]
    assert first.startswith(("GRASP: exhausted (3 tries)", "FIND: failed"))
    assert "prefers-color-scheme: dark" in page
    ET.fromstring(page[page.index("<section>") : page.index("</section>") + 10])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--vary", "params.speed=1..2"], "--vary: the script has no value `params.speed`"),
        (["--vary", "speed"], "--vary: `speed` is not `NAME=LOW..HIGH`"),
        (["--faults", "faults.yml"], "--faults needs the simulation"),
    ],
)
def test_wrong_usage(
    folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], message: str
) -> None:
    assert main([*MOCK, *words]) == 2
    assert message in capsys.readouterr().err


def test_a_killed_sweep_goes_on(tmp_path: Path) -> None:
    kill = ONCE.format("os.kill(os.getppid(), signal.SIGKILL), threading.Event().wait()")
    work_folder(tmp_path, kill, seed=5)
    words = ("sweep", "main.yml", "--runs", "12", "--jobs", "2", "--database", "sweep.db")
    first = smachac(*words, folder=tmp_path)
    assert first.returncode == -9
    done = seeds(tmp_path / "sweep.db")
    assert 5 not in done
    second = smachac(*words, "--format", "json", folder=tmp_path)
    assert second.returncode == 0, second.stderr
    assert json.loads(second.stdout)["success"]["count"] == 12
    assert seeds(tmp_path / "sweep.db") == list(range(12))
    begun = (tmp_path / "begun").read_text().split()
    assert len(begun) <= 12 + 2, "only runs that were going on are repeated"


@pytest.mark.slow
def test_ctrl_c_keeps_what_is_done(tmp_path: Path) -> None:
    stop = ONCE.format("os.kill(os.getppid(), signal.SIGINT), threading.Event().wait()")
    work_folder(tmp_path, stop, seed=5)
    words = ("sweep", "main.yml", "--runs", "12", "--jobs", "2", "--database", "sweep.db")
    first = smachac(*words, folder=tmp_path)
    assert first.returncode == 130, first.stderr
    done = len(seeds(tmp_path / "sweep.db"))
    assert f"{done} of 12 runs of sm" in first.stdout
    assert first.stderr.endswith(
        f"interrupted: {done} of 12 runs are done and kept in sweep.db; the same command"
        " continues\n"
    )
    assert "Traceback" not in first.stderr
    assert 5 not in seeds(tmp_path / "sweep.db")
    assert smachac(*words, folder=tmp_path).returncode == 0
    assert seeds(tmp_path / "sweep.db") == list(range(12))


@pytest.mark.slow
def test_two_sweeps_at_once_count_each_run_once(folder: Path) -> None:
    words = (*MOCK, "--runs", "60", "--database", "sweep.db", "--format", "json")
    with ThreadPoolExecutor(2) as pool:
        both = list(pool.map(lambda _: smachac(*words, folder=folder), range(2)))
    assert [item.returncode for item in both] == [0, 0], [item.stderr for item in both]
    assert both[0].stdout == both[1].stdout
    assert json.loads(both[0].stdout)["runs"] == 60
    assert seeds(folder / "sweep.db") == list(range(60))


@pytest.mark.slow
def test_a_full_disk_is_a_message(folder: Path) -> None:
    limit = 40_000

    def small_files() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    words = (*MOCK, "--runs", "300", "--database", "sweep.db")
    found = smachac(*words, folder=folder, preexec_fn=small_files)
    assert found.returncode == 1
    assert found.stderr.startswith("the database sweep.db cannot be used: ")
    assert "Traceback" not in found.stderr


@pytest.mark.slow
def test_a_run_in_a_worker_equals_a_run_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    script = str(EXAMPLES / "13_recovery" / "main.yml")
    faults = ("--faults", str(EXAMPLES / "13_recovery" / "slips.yml"))
    database = tmp_path / "sweep.db"
    vary = ("--vary", "scene.block.x=0.62..0.68")
    words = ("sweep", script, *faults, *vary, "--runs", "2", "--jobs", "1", "--seed", "4")
    found = smachac(*words, "--database", str(database), folder=tmp_path)
    assert found.returncode == 0, found.stderr
    connection = sqlite3.connect(database)
    rows = connection.execute(
        "SELECT vary, outcome, states, world FROM runs WHERE seed = 5"
    ).fetchall()
    connection.close()
    ((values, outcome, states, world),) = rows
    drawn = json.loads(values)["scene.block.x"]
    assert main(
        ["run", script, *faults, "--seed", "5", "--set", f"scene.block.x={drawn}",
         "--trace", "run.jsonl", "--quiet"]
    ) == 0  # fmt: skip
    assert capsys.readouterr().out.endswith(f"outcome: {outcome}\n")
    assert main(["trace", "stats", script, "run.jsonl", "--format", "json"]) == 0
    alone = json.loads(capsys.readouterr().out)["states"]
    view = written(load(Path(script)))
    swept = {
        view.state(path): (outcomes, longest)
        for path, (outcomes, _, longest, _) in json.loads(states).items()
        if view.is_whole(path)
    }
    assert len(swept) > 20
    assert swept == {item["path"]: (item["outcomes"], item["longest"]) for item in alone}
    source = Source(script, Path(script).read_text("utf-8"))
    task = Task(
        source=source,
        faults=read_file(plain((EXAMPLES / "13_recovery" / "slips.yml").read_text("utf-8"))),
        variations=(read_variation(vary[1]),),
    )
    here = Runner(task).run(5)
    assert (here.world, here.values) == (world, json.loads(values))


@pytest.mark.parametrize("command", ["run", "sweep"])
def test_an_empty_scenario_file(
    folder: Path, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """The program must not run in place of the scenario."""
    (folder / "chances.yml").write_text("# nothing\n", "utf-8")
    assert main([command, "main.yml", "--mock", "chances.yml"]) == 1
    found = capsys.readouterr()
    assert found.out == ""
    assert "error[SM004]: this file is empty\n --> chances.yml:1:1\n" in found.err


@pytest.mark.parametrize(
    ("option", "path", "words"),
    [
        ("--output", ".", "--output . is a folder"),
        ("--junit", "none/a.xml", "--junit none/a.xml is in a folder that does not exist"),
        ("--seed", "1.5", "must be a whole number, not `1.5`"),
    ],
)
def test_wrong_options_are_found_before_the_runs(
    option: str, path: str, words: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        assert main([*MOCK, option, path]) == 2
    except SystemExit as ended:
        assert ended.code == 2  # noqa: PT017
    assert words in capsys.readouterr().err
