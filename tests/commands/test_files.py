"""The disk: search folders, project files, outputs that are whole or not there."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.commands.files import changed_files, foreign_files, write_files
from smachac.diagnostics.diagnostic import Report, Severity
from smachac.driver import analyse_script
from smachac.frontend.files import disk_library, find_project, read_source


def codes(report: Report) -> list[str]:
    return [item.code for item in report]


def test_what_cannot_be_read_is_told(tmp_path: Path) -> None:
    report: Report = []
    (tmp_path / "binary.yml").write_bytes(b"name: sm\n\xff\xfe\x00")
    assert read_source(tmp_path / "missing.yml", report) is None
    assert read_source(tmp_path, report) is None
    assert read_source(tmp_path / "binary.yml", report) is None
    assert codes(report) == ["SM007"] * 3
    assert all(item.finding.help for item in report)
    assert read_source(tmp_path / "binray.yml", report) is None
    assert report.pop().finding.help == "did you mean `binary.yml`?"
    assert (report[2].span.line, report[2].span.column) == (2, 1)


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("abc.yml", None),  # only its ending is that of the others
        ("faults.yml", None),
        ("mian.yml", "main.yml"),
        ("main.yaml", "main.yml"),
        ("scenaro.yml", "scenario.yml"),
        ("arm.udrf", "arm.urdf"),
        ("main", "main.yml"),
        ("Main.yml", "main.yml"),
    ],
)
def test_the_near_name_of_a_file_has_a_near_stem(
    tmp_path: Path, name: str, near: str | None
) -> None:
    for other in ("main.yml", "scenario.yml", "arm.urdf", "arm.urdf.xacro", "a.yml"):
        (tmp_path / other).write_text("")
    report: Report = []
    assert read_source(tmp_path / name, report) is None
    help = report[0].finding.help
    assert help == (f"did you mean `{near}`?" if near else "check the path, and check that the"
                    " file is text in UTF-8")  # fmt: skip


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_encodings_of_yaml(tmp_path: Path, encoding: str) -> None:
    (tmp_path / "a.yml").write_bytes("name: \u00fc\n".encode(encoding))
    source = read_source(tmp_path / "a.yml", [])
    assert source is not None
    assert source.text == "name: \u00fc\n"


def test_search_order_and_bounds(tmp_path: Path) -> None:
    for name in ("main.yml", "own.yml", "lib/own.yml", "lib/shared.yaml", "outside.yml"):
        path = tmp_path / "p" / name if name != "outside.yml" else tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    main = tmp_path / "p" / "main.yml"
    library = disk_library(main, [], scripts=[tmp_path / "p" / "lib"])

    def text(name: str, caller: str = str(main)) -> str | None:
        source = library.script(name, caller)
        return source.text if source else None

    assert text("own") == "own.yml"
    assert text("own", str(tmp_path / "p" / "lib" / "shared.yaml")) == "lib/own.yml"
    assert text("shared") == "lib/shared.yaml"
    assert text("lib/shared") == "lib/shared.yaml"
    assert text("../outside") is None
    assert text(str(tmp_path / "outside.yml")) is None
    assert text("no\0name") is None
    assert text("x" * 5000) is None
    assert library.script("own", str(main)) is library.script("own.yml", str(main))
    assert "shared" in library.script_names(str(main))


def test_a_link_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "p").mkdir()
    (tmp_path / "secret.yml").write_text("secret")
    (tmp_path / "p" / "link.yml").symlink_to(tmp_path / "secret.yml")
    library = disk_library(tmp_path / "p" / "main.yml", [])
    assert library.script("link", str(tmp_path / "p" / "main.yml")) is None


def test_the_nearest_project_file_counts(tmp_path: Path) -> None:
    inner = tmp_path / "a" / "b"
    for folder in (inner, tmp_path / "far", tmp_path / "a" / "near"):
        folder.mkdir(parents=True)
    (tmp_path / "smachac.toml").write_text('scripts = ["far"]')
    (tmp_path / "a" / "pyproject.toml").write_text('[tool.smachac]\nscripts = ["near"]\n')
    report: Report = []
    assert find_project(inner / "main.yml", report).scripts == (tmp_path / "a" / "near",)
    (tmp_path / "a" / "pyproject.toml").write_text("[tool.other]\n")
    assert find_project(inner / "main.yml", report).scripts == (tmp_path / "far",)
    (tmp_path / "a" / ".git").mkdir()
    assert find_project(inner / "main.yml", report).scripts == ()
    assert report == []


@pytest.mark.parametrize("text", ["scripts = [no", "scripts = 'x'", "sripts = ['.']"])
def test_a_bad_project_file_is_told(tmp_path: Path, text: str) -> None:
    (tmp_path / "smachac.toml").write_text(text)
    report: Report = []
    find_project(tmp_path / "main.yml", report)
    assert codes(report) == ["SM007"]


CALL = """\
name: sm
template: Base
outcomes: [done]
states:
  - A: {script: part, transitions: {done: done}}
"""


@pytest.mark.parametrize("setting", ["scripts", "templates", "code"])
def test_a_search_folder_that_does_not_exist_is_a_warning_at_its_setting(
    tmp_path: Path, setting: str
) -> None:
    (tmp_path / "a" / "lib").mkdir(parents=True)
    settings = tmp_path / "smachac.toml"
    settings.write_text(f'exclude = ["a/libs"]\n{setting} = ["a", "a/libs", "other"]\n')
    report: Report = []
    disk_library(tmp_path / "main.yml", report)
    near, far = report
    assert (near.code, near.severity) == ("SM007", Severity.WARNING)
    assert near.message == f"the folder `a/libs` of `{setting}` does not exist"
    assert near.help == "did you mean `a/lib`?"
    assert (near.span.source.name, near.span.line) == (str(settings), 2)
    assert near.span.text == '"a/libs"'
    assert far.span.text == '"other"'
    assert far.help == "create it, or remove it from the setting"


def test_a_folder_that_does_not_exist_is_in_no_help(tmp_path: Path) -> None:
    (tmp_path / "smachac.toml").write_text('scripts = ["libs"]\n')
    script = tmp_path / "main.yml"
    script.write_text(CALL)
    found = analyse_script(script).report
    assert [item.code for item in found] == ["SM007", "SM011"]
    assert "libs" not in (found[1].help or "")


@pytest.mark.parametrize(
    ("text", "place", "words", "help"),
    [
        ('scripts = ["lib"', (1, 11), "`[` is not closed", "write the `]`"),
        ('scripts = ["lib"\nros = 2\n', (1, 11), "`[` is not closed", "write the `]`"),
        ('scripts = ["]", # ]\nros = 2\n', (1, 11), "`[` is not closed", "write the `]`"),
        ('scripts = ["lib"\n[severity]\nSM2 = "off"\n', (1, 11), "`[` is not", "write the `]`"),
        ('severity = {SM2 = "off"\nros = 2\n', (1, 12), "`{` is not closed", "write the `}`"),
        ('scripts = ["a" "b"]\n', (1, 16), "a `,` is missing", "between two texts"),
        ('scripts = "lib"\n', (1, 11), "`scripts` must be a list", 'scripts = ["..."]'),
    ],
)
def test_settings_that_cannot_be_read_are_reported_once_at_the_fault(
    tmp_path: Path, text: str, place: tuple[int, int], words: str, help: str
) -> None:
    (tmp_path / "smachac.toml").write_text(text)
    script = tmp_path / "main.yml"
    script.write_text(CALL)
    (item,) = analyse_script(script).report
    assert item.code == "SM007"
    assert (item.span.line, item.span.column) == place
    assert words in item.message
    assert help in (item.help or "")


def test_all_files_or_none(tmp_path: Path) -> None:
    (tmp_path / "b.py").mkdir()
    with pytest.raises(OSError):  # noqa: PT011 (the words are the system's)
        write_files(tmp_path, {"a.py": "a", "b.py": "b"})
    assert list((tmp_path / "b.py").iterdir()) == []
    assert [path.name for path in tmp_path.iterdir()] == ["b.py"]


def test_folders_made_in_vain_are_taken_away(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("not a folder", "utf-8")
    with pytest.raises((FileExistsError, NotADirectoryError)):
        write_files(tmp_path, {"include/deep/a.hpp": "a", "out/b.hpp": "b"})
    assert [path.name for path in tmp_path.rglob("*")] == ["out"]


def test_writing_is_exact(tmp_path: Path) -> None:
    files = {"\u00fc b/a.py": "x\r\n\u2713\n"}
    write_files(tmp_path, files)
    assert (tmp_path / "\u00fc b" / "a.py").read_bytes() == files["\u00fc b/a.py"].encode()
    assert changed_files(tmp_path, files) == []
    assert changed_files(tmp_path, {"\u00fc b/a.py": "y"}) == [tmp_path / "\u00fc b" / "a.py"]


def test_files_of_others_are_known(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text("print(1)")
    (tmp_path / "ours.py").write_text("# Made by smachac 0.1 from main.yml (sha256 0).\n")
    found = foreign_files(tmp_path, {"mine.py": "", "ours.py": "", "new.py": ""})
    assert found == [tmp_path / "mine.py"]


SCRIPT = """\
name: sm
template: Base
outcomes: [succeeded]
states:
- A: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
"""


@pytest.fixture
def linked(tmp_path: Path) -> Path:
    """A folder with a script, beside a file and a folder that it must not reach."""
    (tmp_path / "secret").mkdir()
    (tmp_path / "secret" / "own.yml").write_text(SCRIPT + "# password\n")
    (tmp_path / "secret" / "smachac.toml").write_text("password\n")
    folder = tmp_path / "p"
    folder.mkdir()
    (folder / "main.yml").write_text(SCRIPT)
    return folder


def test_links_in_a_folder_are_reported(linked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    secret = linked.parent / "secret" / "own.yml"
    before = secret.read_bytes()
    (linked / "link.yml").symlink_to(secret)
    assert main(["check", str(linked)]) == 1
    assert "link.yml" in (shown := capsys.readouterr().out)
    assert "leads out of the folder" in shown
    assert main(["check", "--fix", str(linked)]) == 1
    assert main(["fmt", str(linked)]) == 1
    assert secret.read_bytes() == before
    assert main(["check", str(linked / "link.yml")]) == 0
    assert main(["fmt", str(linked / "link.yml")]) == 0
    assert secret.read_bytes() != before


def test_links_inside_a_folder_are_followed(linked: Path) -> None:
    (linked / "link.yml").symlink_to("main.yml")
    assert main(["check", str(linked)]) == 0


@pytest.mark.parametrize("name", ["smachac.toml", "pyproject.toml"])
def test_a_project_file_that_is_a_link(linked: Path, name: str) -> None:
    (linked / name).symlink_to(linked.parent / "secret" / "smachac.toml")
    report: Report = []
    find_project(linked / "main.yml", report)
    assert codes(report) == ["SM007"]
    assert "password" not in str(report[0].message) + report[0].span.source.text


def test_folders_that_lead_out(linked: Path) -> None:
    (linked / "templates").symlink_to("../secret")
    report: Report = []
    library = disk_library(linked / "main.yml", report)
    assert library.template("own.yml") is None
    assert codes(report) == ["SM007"]
    named = disk_library(linked / "main.yml", [], templates=[linked.parent / "secret"])
    assert named.template("own.yml") is not None


@pytest.mark.parametrize("setting", ["scripts", "templates", "code"])
def test_a_project_file_names_no_folder_outside(linked: Path, setting: str) -> None:
    (linked / "sub").mkdir(exist_ok=True)
    (linked / "smachac.toml").write_text(f'{setting} = ["../secret", "sub"]\n')
    report: Report = []
    project = find_project(linked / "main.yml", report)
    assert getattr(project, setting) == (linked / "sub",)
    assert codes(report) == ["SM007"]
    (linked.parent / ".git").mkdir()
    assert len(getattr(find_project(linked / "main.yml", []), setting)) == 2


def test_a_pipe_or_a_device_is_not_read(linked: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(linked / "pipe.yml")
    (linked / "zero.yml").symlink_to("/dev/zero")
    (linked / "templates").mkdir()
    os.mkfifo(linked / "templates" / "Pipe.yml")
    main_script = linked / "main.yml"
    main_script.write_text(SCRIPT.replace("ScriptedState", "Pipe"))
    assert main(["check", str(linked)]) == 1
    assert "not a regular file" in capsys.readouterr().out
    for words in (["check"], ["fmt"], ["run", str(main_script), "--mock"]):
        for name in ("pipe.yml", "zero.yml", "/dev/zero"):
            assert main([*words, str(linked / name)]) == 1
    assert main(["check", str(main_script), "--baseline", str(linked / "pipe.yml")]) == 2
    assert main(["build", str(main_script), "-t", "json", "-o", str(linked / "pipe.yml")]) == 1
