"""The shape of the repository: where things are, how big they may grow, who may touch the disk."""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Iterator, Set
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

LINKS = ("ir", "targets", "grammars")
"""The table of contents at the root: links to the parts of the compiler."""

LONGEST_FUNCTION = 70
"""In lines, without the docstring. A longer function does two things."""


TOUCHES = {
    "smachac/driver/python_cache.py": "keeps what is known of Python files in the cache folder",
    "smachac/frontend/files.py": "reads scripts, templates and project files",
    "smachac/frontend/messages/standard_messages.py": "reads the common packages of ROS",
    "smachac/runtime/signals.py": "replaces the streams of a terminal that was closed",
    "smachac/targets/python/runner.py": "runs what was built, and keeps its output",
    "smachac/verify/players/python.py": "runs what was built, and keeps its output off the report",
    "smachac/verify/players/flexbe.py": "writes the generated packages to a temporary folder",
    "smachac/verify/players/python_file.py": "runs what a file builds, as python.py does",
    "smachac/verify/players/cpp_file.py": "writes headers of stand-ins to a temporary folder",
    "smachac/runtime/tracing/writer.py": "reports that a trace broke off",
    "smachac/runtime/smach/log.py": "prints what SMACH prints",
    "smachac/runtime/smach_ros2/program.py": "prints why ROS refuses to start",
    "smachac/runtime/yasmin/smachac_yasmin.py": "prints the outcome of a program",
    "smachac/__main__.py": "reports Ctrl-C before the command line is imported",
    "smachac/robots/files.py": "reads descriptions of robots and scenes",
    "smachac/robots/xacro_process.py": "reads macro files of robots, as a program of its own",
    "smachac/sim/loading.py": "writes the texts for the physics engine to a temporary folder",
    "smachac/sim/robot_file.py": "reads the URDF files of robots and bodies",
    "smachac/sim/trial.py": "reports its progress, as a program of its own",
    "smachac/sim/video.py": "writes films",
    "smachac/sweep/local.py": "drops what the runs print",
    "smachac/sim/physics.py": "keeps the physics engine's banner off the streams",
}
"""The modules outside commands/ that may use files and streams, each with its reason."""

DISK_NAMES = {"open", "print", "input", "breakpoint"}
DISK_METHODS = {"read_text", "read_bytes", "write_text", "write_bytes", "mkdir", "unlink", "touch"}
STREAMS = {"stdin", "stdout", "stderr", "__stdin__", "__stdout__", "__stderr__"}

TEXTS = (
    *("", ".cfg", ".dot", ".hpp", ".html", ".json", ".jsonl", ".lark", ".md", ".mmd", ".py"),
    *(".sh", ".smir", ".svg", ".toml", ".txt", ".yaml", ".yml"),
)
"""Endings of the files that are read for paths of somebody's machine."""

ABSOLUTE = re.compile(r"(?<![\w.<])/(?:home|mnt|root|tmp|work|Users)/\w")


def modules() -> list[Path]:
    """The modules of the package: a name with a dot in it, as `Name.tpl.py`, is a template. The
    parsers that scripts/parsers.py writes are not among them."""
    found = [path for path in sorted((ROOT / "smachac").rglob("*.py")) if "." not in path.stem]
    return [path for path in found if path.parent.name != "standalone"]


parsed = functools.cache(ast.parse)


def name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def functions(tree: ast.AST) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node


def disk_faults(text: str) -> Iterator[str]:
    """Each use of files or streams, as `line: what`. Data of the package itself may be read."""
    for node in ast.walk(parsed(text)):
        match node:
            case ast.Call(func=ast.Name(id=called)) if called in DISK_NAMES:
                yield f"{node.lineno}: {called}"
            case ast.Call(func=ast.Attribute(value=owner, attr=called)):
                if called in DISK_METHODS and not is_package_data(owner):
                    yield f"{node.lineno}: {called}"
                if called == "open" and opens_a_file(node, owner):
                    yield f"{node.lineno}: open"
            case ast.Attribute(value=ast.Name(id="sys"), attr=stream) if stream in STREAMS:
                yield f"{node.lineno}: sys.{stream}"
            case ast.ImportFrom(module="sys", names=names):
                yield from (f"{node.lineno}: sys.{n.name}" for n in names if n.name in STREAMS)


def is_package_data(owner: ast.expr) -> bool:
    """Whether a value comes from `importlib.resources.files(...)`."""
    calls = (node.func for node in ast.walk(owner) if isinstance(node, ast.Call))
    return any(ast.unparse(func) in {"files", "resources.files"} for func in calls)


def opens_a_file(call: ast.Call, owner: ast.expr) -> bool:
    """Whether `x.open(...)` is that of a path or of `io`: a container of SMACH has one too."""
    return bool(call.args or call.keywords) or ast.unparse(owner) in {"io", "os"}


def asserting(text: str) -> set[str]:
    """The functions with an `assert`."""
    return {body.name for body in functions(parsed(text)) if any_node(body, ast.Assert)}


def silent_tests(text: str, shared: Set[str] = frozenset()) -> list[str]:
    """The tests that cannot fail: no `assert`, nothing of pytest's, no function that has one.

    `shared` are functions of other modules that have one.
    """
    bodies = list(functions(parsed(text)))
    able = {"raises", "warns", "fail", "importorskip"} | shared | asserting(text)
    return [
        f"{body.lineno}: {body.name}"
        for body in bodies
        if body.name.startswith("test_") and not any_node(body, ast.Assert)
        if not called(body) & able
    ]


def any_node(tree: ast.AST, kind: type[ast.AST]) -> bool:
    return any(isinstance(node, kind) for node in ast.walk(tree))


def called(body: ast.AST) -> set[str]:
    """The last word of every name that is called."""
    calls = (node for node in ast.walk(body) if isinstance(node, ast.Call))
    return {ast.unparse(call.func).rpartition(".")[2] for call in calls}


@pytest.mark.parametrize("link", LINKS)
def test_links_at_the_root_lead_into_the_package(link: str) -> None:
    assert (ROOT / link).resolve() == ROOT.resolve() / "smachac" / link
    assert (ROOT / link).is_dir()


def test_examples_are_numbered_and_explained() -> None:
    folders = [path for path in sorted((ROOT / "examples").glob("[!._]*")) if path.is_dir()]
    numbered = [folder for folder in folders if (folder / "main.yml").is_file()]
    for folder in folders:  # the others: make test-ros2 and tests/cpp/test_step_example.py
        prefix = r"\d\d" if folder in numbered else "(ros2|cpp)"
        assert re.fullmatch(rf"{prefix}_[a-z0-9_]+", folder.name), folder
        assert (folder / "README.md").read_text("utf-8").strip(), folder
    numbers = [folder.name[:2] for folder in numbered]
    assert len(set(numbers)) == len(numbers), numbers


def test_package_says_that_it_is_typed() -> None:
    assert (ROOT / "smachac" / "py.typed").is_file()


@pytest.mark.slow
def test_functions_fit_a_screen() -> None:
    faults = []
    for path in modules():
        text = path.read_text("utf-8")
        for function in functions(parsed(text)):
            last = function.end_lineno or function.lineno
            lines = last - function.lineno + 1 - (ast.get_docstring(function) or "").count("\n")
            if lines > LONGEST_FUNCTION:
                faults.append(f"{name(path)}:{function.lineno}: {function.name}, {lines} lines")
    assert faults == []


def test_public_modules_say_what_they_are() -> None:
    public = [p for p in modules() if p.stem == "__init__" or not p.stem.startswith("_")]
    trees = {name(path): parsed(path.read_text("utf-8")) for path in public}
    assert [path for path, tree in trees.items() if not ast.get_docstring(tree)] == []


def test_only_the_listed_modules_touch_files_and_streams() -> None:
    paths = [path for path in modules() if path.parent.name != "commands"]
    faults = {name(path): list(disk_faults(path.read_text("utf-8"))) for path in paths}
    assert {p: found for p, found in faults.items() if found and p not in TOUCHES} == {}


@pytest.mark.slow
def test_every_test_can_fail() -> None:
    paths = sorted((ROOT / "tests").rglob("test_*.py"))
    support = (ROOT / "tests" / "support").glob("*.py")
    shared = {name for path in support for name in asserting(path.read_text("utf-8"))}
    silent = {name(path): silent_tests(path.read_text("utf-8"), shared) for path in paths}
    assert {path: found for path, found in silent.items() if found} == {}


def test_no_file_names_a_path_of_a_machine() -> None:
    folders = ("smachac", "tests", "docs", "examples", "bench", "scripts", ".ci")
    paths = [path for path in ROOT.iterdir() if path.is_file() and path.name != ".git"]
    paths += [path for folder in folders for path in (ROOT / folder).rglob("*")]
    found = []
    for path in paths:
        if path.is_dir() or path.suffix not in TEXTS or "__pycache__" in path.parts:
            continue
        for number, line in enumerate(path.read_text("utf-8", "replace").splitlines(), 1):
            if ABSOLUTE.search(line):
                found.append(f"{name(path)}:{number}: {line.strip()}")
    assert found == []


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("open('x')", "1: open"),
        ("def f():\n    print(1)", "2: print"),
        ("path.write_text('')", "1: write_text"),
        ("Path('x').read_bytes()", "1: read_bytes"),
        ("path.open('w')", "1: open"),
        ("import io\nio.open", None),
        ("import sys\nsys.stdout.write('')", "2: sys.stdout"),
        ("from sys import stderr", "1: sys.stderr"),
        ("container.open()", None),
        ("resources.files('smachac').joinpath('x').read_text()", None),
        ("files(__package__).joinpath('x').read_text()", None),
    ],
)
def test_uses_of_files_and_streams_are_found(text: str, fault: str | None) -> None:
    assert list(disk_faults(text)) == ([fault] if fault else [])


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("def test_a():\n    f()", ["1: test_a"]),
        ("def f():\n    pass\ndef test_a():\n    f()", ["3: test_a"]),
        ("def f():\n    assert x\ndef test_a():\n    f()", []),
        ("def test_a():\n    with pytest.raises(E):\n        f()", []),
        ("class TestIt:\n    def test_a(self):\n        for x in y:\n            assert x", []),
    ],
)
def test_tests_that_cannot_fail_are_found(text: str, found: list[str]) -> None:
    assert silent_tests(text) == found


@pytest.mark.parametrize("folder", ["home", "root", "tmp", "work"])
def test_paths_of_a_machine_are_found(folder: str) -> None:
    assert ABSOLUTE.search(f"see /{folder}/x/notes.txt")
    assert not ABSOLUTE.search(f"see out/{folder}/x, ./{folder}/x and sm/{folder}")
