"""Classes that do not load or cannot run are errors of a check, and stop no other use of the
script."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.diagnostic import Severity
from tests.trust.project_text import analysed

FILES = {
    "main.yml": """\
name: sm
template: Base
outcomes: [done]
states:
  - GRASP: {template: Grasp, transitions: {done: LOOK}}
  - LOOK: {template: Look, transitions: {done: done}}
""",
    "templates/Grasp.yml": 'outcomes: {done: {}}\ncode: {python: "cell.grasp:Grasp"}\n',
    "templates/Look.yml": 'outcomes: {done: {}}\ncode: {python: "cell.look:Look"}\n',
    "cell/__init__.py": "",
    "cell/grasp.py": """\
from smachac.runtime import smach


class Grasp(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
        return "done"
""",
}
FILES["cell/look.py"] = FILES["cell/grasp.py"].replace("Grasp", "Look")
HEAD = "from smachac.runtime import smach\n"


def errors(files: dict[str, str]) -> list[tuple[str, str, str]]:
    return [
        (item.code, Path(item.span.source.name).name, item.span.text)
        for item in analysed(files).report
        if item.severity is Severity.ERROR
    ]


def imports(**lines: str) -> dict[str, str]:
    """The project with more imports at the top of modules, and modules of its own."""
    files = dict(FILES)
    for name, text in lines.items():
        file = f"cell/{name}.py"
        files[file] = files[file].replace(HEAD, HEAD + text) if file in files else text
    return files


def starts(files: dict[str, str], folder: Path, monkeypatch: pytest.MonkeyPatch) -> bool:
    """Whether Python imports the classes in the order of the program."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    program = "import cell.grasp, cell.look"
    done = subprocess.run([sys.executable, "-c", program], cwd=folder, check=False, timeout=100,
                          capture_output=True)  # fmt: skip
    return done.returncode == 0


UNLOADABLE = [
    ("cell/grasp.py", "class Grasp(smach.State):", "class Grasp(smach.State)", "SM608"),
    ("templates/Grasp.yml", "cell.grasp", "cell.grip", "SM608"),
    ("templates/Grasp.yml", ":Grasp", ":Grip", "SM608"),
    ("cell/grasp.py", HEAD, HEAD + "from cell.look import Loook\n", "SM608"),
    ("cell/grasp.py", HEAD, HEAD + "from cell.lok import Look\n", "SM608"),
    ("cell/grasp.py", "def execute", "def excute", "SM609"),
    ("cell/grasp.py", "(self, userdata)", "(self)", "SM609"),
    ("cell/grasp.py", "Grasp(smach.State)", "Grasp", "SM609"),
    ("cell/grasp.py", "def __init__(self):", "def __init__(self, force):", "SM609"),
]


@pytest.mark.parametrize(("file", "old", "new", "code"), UNLOADABLE)
def test_a_class_that_does_not_load_or_run_is_an_error(
    file: str, old: str, new: str, code: str
) -> None:
    assert not errors(FILES)
    found = errors(FILES | {file: FILES[file].replace(old, new)})
    assert [item[0] for item in found] == [code]


def test_only_the_program_needs_the_class(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(text.replace("def execute", "def excute"))
    Path("s.yml").write_text("states: {}\n")
    assert main(["check", "main.yml"]) == 1
    assert main(["build", "main.yml", "-t", "python"]) == 1
    assert main(["run", "main.yml"]) == 1
    capsys.readouterr()
    assert main(["build", "main.yml", "-t", "html", "-o", "out"]) == 0
    assert main(["run", "main.yml", "--mock", "s.yml"]) == 0
    assert main(["rename", "main.yml", "GRASP", "GRIP"]) == 0
    shown = capsys.readouterr()
    assert "error[" not in shown.out + shown.err
    assert "warning[SM609]" in shown.err


CIRCULAR = [
    # grasp loads look, which needs Grasp
    (imports(grasp="from cell.look import Look\n", look="from cell.grasp import Grasp\n"), "Grasp"),
    # through a third module, and a package
    (
        imports(
            grasp="from .tools import close\n",
            tools="from .limits import FORCE\n\n\ndef close():\n    return FORCE\n",
            limits="from .grasp import Grasp\n\nFORCE = 2.0\n",
        ),
        "Grasp",
    ),
    (
        imports(
            grasp="import cell.tools\n", tools="from cell.grasp import Grasp as Other\nclose = 1\n"
        ),
        "Grasp",
    ),
    # the package imports the module before it defines what that needs
    (
        imports(grasp="from cell import SPEED\n")
        | {"cell/__init__.py": "from .grasp import Grasp\nSPEED = 1\n"},
        "SPEED",
    ),
]

RIGHT = [
    imports(grasp="from cell.look import Look\n"),
    imports(grasp="import cell.look\n", look="import cell.grasp\n"),
    imports(grasp="from cell import look\n", look="from cell import grasp\n"),
    imports(grasp="from cell.tools import close\n",
            tools="def close():\n    from cell.grasp import Grasp\n    return Grasp\n"),
    imports(grasp="FORCE = 2.0\nfrom cell.tools import close\n",
            tools="from cell.grasp import FORCE\nclose = FORCE\n"),
    imports(grasp="from cell import SPEED\n")
    | {"cell/__init__.py": "SPEED = 1\nfrom .grasp import Grasp\n"},
    imports(grasp="from cell.tools import close\n",
            tools="try:\n    from cell.grasp import Grasp\nexcept ImportError:\n    Grasp = None\n"
            "close = 1\n"),
    # the order counts: tools has defined close before grasp begins
    imports(tools="close = 1\nfrom cell.grasp import Grasp\n",
            grasp="from cell.tools import close\n")
    | {"templates/Grasp.yml": FILES["templates/Grasp.yml"].replace("cell.grasp", "cell.tools")},
]  # fmt: skip


@pytest.mark.parametrize(("files", "name"), CIRCULAR)
def test_a_circular_import(
    files: dict[str, str], name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = errors(files)
    assert [(code, place) for code, _, place in found] == [("SM608", name)]
    assert not starts(files, tmp_path, monkeypatch)


@pytest.mark.parametrize("files", RIGHT)
def test_an_import_that_is_not_circular(files: dict[str, str]) -> None:
    assert errors(files) == []


@pytest.mark.parametrize("files", RIGHT[:-1])
def test_python_starts_with_it(
    files: dict[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert starts(files, tmp_path, monkeypatch)


UNDEFINED = [
    ("return gripper.close()", ["gripper"]),
    ("x = speed\n        return wheels(x)", ["speed", "wheels"]),
    ("return [y for y in items if z]", ["items", "z"]),
    ("print(count)\n        count = 1\n        return 'done'", ["count"]),
    ("def inner():\n            return later\n        return inner()", ["later"]),
    ("try:\n            return json.loads('1')\n        except Error:\n            return 'done'",
     ["json", "Error"]),
    ("x: Unknown = 1\n        return str(x)", []),  # Python does not read the annotation
    ("del y\n        return 'done'", ["y"]),
    ("global ready\n        ready = 1\n        return ready", []),
    ("if (n := 3) > 2:\n            return str(n)", []),
    ("match userdata:\n            case {'a': b, **rest}:\n                return b or rest", []),
    ("return (lambda a, *b, **c: a or b or c)(1) or __file__ or __class__", []),
    ("try:\n            unicode\n        except NameError:\n            return 'done'", []),
]  # fmt: skip


@pytest.mark.parametrize(("body", "names"), UNDEFINED)
def test_undefined_names_are_those_of_pyflakes(body: str, names: list[str]) -> None:
    files = FILES | {"cell/look.py": FILES["cell/look.py"].replace('return "done"', body)}
    found = [item for item in analysed(files).report if item.code == "SM609"]
    assert sorted(item.span.text for item in found) == sorted(names)
    assert all(item.span.source.name.endswith("cell/look.py") for item in found)
