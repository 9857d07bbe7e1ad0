"""The page on machines that exist already: its example gives the output that it shows."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.driver import CODES
from tests.pysource.machines import test_flexbe, test_yasmin

PAGE = Path(__file__).parents[2] / "docs" / "existing.md"


def test_the_example(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = PAGE.read_text("utf-8")
    monkeypatch.chdir(tmp_path)
    (code, *_) = re.findall(r"^```python\n# parcels\.py\n(.*?)^```", text, re.M | re.S)
    Path("parcels.py").write_text(f"# parcels.py\n{code}")
    (session, *_) = re.findall(r"^```console\n\$ smachac (.*?)\n(.*?)^```", text, re.M | re.S)
    assert main(session[0].split()) == 1
    assert capsys.readouterr().out == session[1]
    for words in (["build", "parcels.py", "--target", "html"], ["explain", "parcels.py", "WEIGH"]):
        main(words)
    assert Path("sm.html").is_file()


@pytest.mark.parametrize("file", ["picking.py", "delivery_sm.py"])
def test_the_examples_for_other_frameworks(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = PAGE.read_text("utf-8")
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(rf"^```python\n# {file}\n(.*?)^```", text, re.M | re.S)
    Path(file).write_text(f"# {file}\n{code}")
    (session,) = re.findall(
        rf"^```console\n\$ smachac (check {file})\n(.*?)^```", text, re.M | re.S
    )
    assert main(session[0].split()) == 1
    assert capsys.readouterr().out == session[1]


KINDS = {"YASMIN": test_yasmin.KINDS, "FlexBE": test_flexbe.KINDS}


@pytest.mark.parametrize("framework", KINDS)
def test_the_tables_of_faults_have_the_kinds_that_are_tested(framework: str) -> None:
    (table,) = re.findall(rf"^fault \| smachac \| {framework}\n-.*?\n(.*?)\n\n",
                          PAGE.read_text("utf-8"), re.M | re.S)  # fmt: skip
    codes = [row.split("|")[1].split()[0] for row in table.split("\n")]
    assert codes == [kind.split()[0] for kind in KINDS[framework]][:10]


def test_the_files_of_the_import(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = PAGE.read_text("utf-8")
    monkeypatch.chdir(tmp_path)
    (tmp_path / ".git").mkdir()
    projects = {"parcels": "project", "picking": "picking", "delivery_sm": "delivery"}
    for name, folder in projects.items():
        (code, *_) = re.findall(rf"^```python\n# {name}\.py\n(.*?)^```", text, re.M | re.S)
        Path(f"{name}.py").write_text(f"# {name}.py\n{code}")
        main(["import", f"{name}.py", "-o", folder])
    shown = re.findall(r"^```yaml\n# (\S+)\n(.*?)^```", text, re.M | re.S)
    names = ["project/main.yml", "project/templates/Weigh.yml", "picking/templates/Grasp.yml",
             "delivery/main.yml"]  # fmt: skip
    assert [name for name, _ in shown] == names
    for name, content in shown:
        assert Path(name).read_text("utf-8").partition("\n")[2] == content


def test_the_table_of_codes_is_complete() -> None:
    from smachac.driver.python_machines import CANNOT_WORK

    (table,) = re.findall(r"^code \| fault\n(.*?)\n\n", PAGE.read_text("utf-8"), re.M | re.S)
    shown = set(re.findall(r"SM\d{3}", "\n".join(row.split("|")[0] for row in table.split("\n"))))
    assert shown == CANNOT_WORK | {code for code in CODES if code.startswith("SM80")}
