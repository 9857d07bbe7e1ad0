"""Hostile input: damaged scripts, interfaces, templates and sub-scripts, one project an input.

    python bench/fuzz.py [count] [--seed N] [--jobs N] [--only INDEX]

Each input is read, judged by every rule and reported, one in four laid out; one in four that are
without error is printed by every target, one in eight interpreted. An exception that escapes
is a find, and so are more than 2 s of CPU time for one input, and more than 500 MB of memory for a
whole process.
Input `INDEX` of a seed is always the same text: `--only INDEX` shows it and what happens.
Ends with 1 if there is a find. Unix only.
"""

from __future__ import annotations

import argparse
import multiprocessing
import random
import re
import resource
import signal
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from smachac.diagnostics.diagnostic import Report, has_errors
from smachac.diagnostics.source import Source
from smachac.driver import CODES, analyse, build
from smachac.driver.batch import analyse_alone
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library, memory_library
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.refactor.formatter import format_script
from smachac.report.explain_code import explanation
from smachac.report.github import render_github
from smachac.report.json import render_json
from smachac.report.junit import render_junit
from smachac.report.sarif import render_sarif
from smachac.report.text import Layout, render_text
from smachac.targets import load_target, target_names

ROOT = Path(__file__).parents[1]
COUNT = 2000
SECONDS = 2.0
MEGABYTES = 500
BACKSTOP = 3_000_000_000
"""Bytes of address space: beyond them a process gets a MemoryError instead of the machine."""

Files = dict[str, str]


class TooLongError(BaseException):
    """An input took more CPU time than it may; nothing that catches exceptions catches this."""


def projects() -> list[Files]:
    """Real projects to damage: the examples, the cases, what `smachac explain` shows."""
    found: list[Files] = []
    for folder in ("examples", "tests/cases"):
        for main in sorted((ROOT / folder).glob("*/main.yml")):
            paths = [*sorted(main.parent.glob("*.yml")), *sorted(main.parent.glob("templates/*"))]
            files = {path.relative_to(main.parent).as_posix(): path.read_text() for path in paths}
            if sum(map(len, files.values())) < 8000:
                found.append(files)
    for code in CODES.values():
        shown = explanation(code)
        scripts = (item for item in (shown.wrong, shown.right) if item and "main.yml" in item)
        found += map(dict, scripts)
    return found


PROJECTS = projects()
WORDS = sorted(
    {
        word
        for files in PROJECTS
        for text in files.values()
        for word in text.replace(",", " ").replace(":", " ").split()
        if len(word) < 30
    }
)
WORD = re.compile(r"[\w.]+")
FEW = (1, 1, 1, 2, 4)
SIGNS = tuple("{}[]:,-?|>#&*!'\"`~%@")
PHRASES = (
    *(
        "null",
        "~",
        "yes",
        "<<",
        "<<: *a",
        "&a",
        "*a",
        "!!str",
        "!x",
        "1e999",
        ".nan",
        "0x" + "f" * 9,
    ),
    *("[params, x]", "[[x]]", "[[params, x], y]", "script: sub", "script: main", "initial: A"),
    *("outcome_map: {a: {}}", "timeout: 20s", "retry: {on: [aborted], max: 3}", "forever: true"),
    *("for_each: {item: a, in: b}", "`lambda ud: ud.x`", "lambda ud: ud.x[0]", "10**10**10"),
    *("{% if %}", "{{ x }}", "{% block x %}", "{{ super() }}", "{% extends 'Base.tpl.py' %}"),
    *("float<m>", "list[list[", "one_of[a]", "any?", "float[99999999]", "# smachac: allow SM201 x"),
    *("\n", "\t", "  ", "- ", "\r\n", "\x0c", "\x00", "\u2028", "\u202e", "\U0001f600", "\ud800"),
)
Damage = Callable[[random.Random, str], str]


def signs(draw: random.Random, text: str) -> str:
    """A few characters out, something else in."""
    for _ in range(draw.choice(FEW)):
        at = draw.randint(0, len(text))
        removed = draw.choice([0, 0, 1, 2, draw.randint(0, 30)])
        text = text[:at] + draw.choice([*SIGNS, *PHRASES]) + text[at + removed :]
    return text


def words(draw: random.Random, text: str) -> str:
    """Words of one script where another has others: most of the structure stays."""
    for _ in range(draw.choice(FEW)):
        found = list(WORD.finditer(text))
        if found:
            at = draw.choice(found)
            own = [word.group() for word in found]
            word = draw.choice([*PHRASES, *draw.choices(WORDS, k=90), *draw.choices(own, k=90)])
            text = text[: at.start()] + word + text[at.end() :]
    return text


def lines(draw: random.Random, text: str) -> str:
    """Lines doubled, dropped, swapped, moved sideways."""
    rows = text.split("\n")
    for _ in range(draw.choice(FEW)):
        at, other = draw.randrange(len(rows)), draw.randrange(len(rows))
        match draw.randrange(5):
            case 0:
                rows.insert(other, rows[at])
            case 1 if len(rows) > 1:
                del rows[at]
            case 2:
                rows[at], rows[other] = rows[other], rows[at]
            case 3:
                rows[at] = " " * draw.randint(0, 12) + rows[at].lstrip()
            case 4:
                size = draw.randint(1, 8)
                block = rows[at : at + size]
                rows[other:other] = [" " * draw.randint(0, 6) + row for row in block]
    return "\n".join(rows)


def splice(draw: random.Random, text: str) -> str:
    """The first part of one text, the last of another."""
    theirs = draw.choice(list(draw.choice(PROJECTS).values()))
    return text[: draw.randint(0, len(text))] + theirs[draw.randint(0, len(theirs)) :]


def much(draw: random.Random, text: str) -> str:
    """One piece very often, or nested very deep."""
    count = draw.choice([10, 100, 1000, 3000])
    at = draw.randint(0, len(text))
    piece = draw.choice(
        [*SIGNS, *PHRASES, text[at : at + 40], "a: ", "- ", "?", "[", "{a: ", "-1+"]
    )
    closing = {"[": "]", "{a: ": "}"}.get(piece, "") * draw.choice([0, count])
    return text[:at] + piece * count + closing + text[at:]


def soup(draw: random.Random, text: str) -> str:
    """A mapping of the language's words that nobody meant."""

    def node(depth: int) -> str:
        if not depth or draw.random() < 0.3:
            return draw.choice([*draw.choices(WORDS, k=20), *draw.choices(PHRASES, k=5), "1", "[]"])
        parts = [node(depth - 1) for _ in range(draw.randint(0, 3))]
        if draw.random() < 0.5:
            return f"[{', '.join(parts)}]"
        return "{" + ", ".join(f"{draw.choice(WORDS)}: {part}" for part in parts) + "}"

    return "\n".join(f"{draw.choice(LANGUAGE)}: {node(4)}" for _ in range(draw.randint(1, 9)))


LANGUAGE = ("name", "template", "outcomes", "states", "userdata", "params", "types", "transitions")


def noise(draw: random.Random, text: str) -> str:
    """Characters of any kind."""
    return "".join(
        chr(draw.choice([draw.randrange(128), draw.randrange(0x3000)])) for _ in range(60)
    )


KINDS: tuple[tuple[Damage, int], ...] = (
    *((signs, 35), (words, 30), (lines, 17), (splice, 8), (soup, 6), (much, 3), (noise, 1)),
)


def damaged(seed: int, index: int) -> tuple[str, Files]:
    """The kinds of damage, and the files, of one input."""
    draw = random.Random(f"{seed}/{index}")
    files = dict(draw.choice(PROJECTS))
    done = []
    for _ in range(draw.choice([1, 1, 1, 1, 2])):
        (kind,) = draw.choices([kind for kind, _ in KINDS], [weight for _, weight in KINDS])
        name = "main.yml" if draw.random() < 0.6 else draw.choice(list(files))
        files[name] = kind(draw, files.get(name, ""))
        done.append(kind.__name__)
    return "+".join(done), files


BUILT_IN = disk_library(ROOT / "main.yml", [])
TARGETS = [target for name in target_names() if (target := load_target(name)) is not None]
FORMATS: tuple[Callable[[Report], str], ...] = (
    render_json,
    render_sarif,
    render_github,
    lambda report: render_junit({"main.yml": report}, {"main.yml": report}),
    lambda report: render_text(report, Layout(colour=True, width=40, wraps=True)),
)


def tried(files: Mapping[str, str], index: int) -> str:
    """Do with a project what users do; raises nothing unless there is a bug. What became of it."""
    texts = {name: text for name, text in files.items() if name != "smachac.toml"}
    library = memory_library(texts, BUILT_IN)
    source = Source("main.yml", files["main.yml"])
    analysis = analyse(source, library, [])
    render_text(analysis.report)
    FORMATS[index % len(FORMATS)](analysis.report)
    if index % 4 == 2:
        arranged(source)
    for name in texts:
        if index % 8 == 0 and name.endswith(".yml") and "/" not in name:
            analyse_alone(Source(name, files[name]), library, [])
    if analysis.checked is None:
        assert analysis.report, "no machine, and nothing is said"
        return "refused"
    if index % 4 == 0:
        printed(analysis.checked, library, ours=not any(".tpl." in name for name in files))
    if index % 8 == 1:
        run(analysis.checked, builtin_behaviour(), max_steps=300)
    return "checked"


def arranged(source: Source) -> None:
    """Laid out: that is a text with nothing left to be laid out."""
    new = (
        format_script(source)
        if memory_library({}, BUILT_IN).parse(source, []) is not None
        else None
    )
    if new is not None:
        assert format_script(Source(source.name, new)) == new, "laid out twice is something else"


def printed(machine: Any, library: Library, ours: bool) -> None:
    """Every target; what is Python must compile, if it is all from templates of ours."""
    for target in TARGETS:
        report: Report = []
        made = build(machine, target, library, report)
        assert bool(made) != has_errors(report), "files and errors, or neither"
        render_text(report)
        if target.name == "python" and made and ours:
            compile("".join(made.values()), "generated.py", "exec")


def limited(files: Files, index: int) -> tuple[str, float, str]:
    """What became of one input, the CPU time it took, and the find, if it is one."""

    def stop(*_: object) -> None:
        raise TooLongError

    signal.signal(signal.SIGPROF, stop)
    begun = time.process_time()
    found, became = "", "find"
    try:
        signal.setitimer(signal.ITIMER_PROF, SECONDS)
        became = tried(files, index)
    except (Exception, TooLongError):
        found = traceback.format_exc(limit=-6)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    took = time.process_time() - begun
    if took > SECONDS and not found:
        found = f"took {took:.1f} s"
    return became, took, found


def peak() -> float:
    """The most memory this process had so far, in megabytes."""
    size = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return size / (1_000_000 if sys.platform == "darwin" else 1000)


def work(seed: int, indices: range, told: Any) -> None:
    """Try these inputs one after the other; each is told as it begins and as it ends."""
    resource.setrlimit(resource.RLIMIT_AS, (BACKSTOP, BACKSTOP))
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for index in indices:
        kind, files = damaged(seed, index)
        told.send((index, kind, None))
        became, took, found = limited(files, index)
        megabytes = peak()
        if megabytes > MEGABYTES:
            found += f"the process grew to {megabytes:.0f} MB"
        told.send((index, kind, (became, took, megabytes, found)))
        if megabytes > MEGABYTES:
            return  # the peak of a process never falls: a new one goes on


def part(seed: int, indices: range) -> Iterator[tuple[int, str, tuple[str, float, float, str]]]:
    """The results of these inputs, from processes of their own that may die."""
    while indices:
        ours, theirs = multiprocessing.Pipe(duplex=False)
        process = multiprocessing.Process(target=work, args=(seed, indices, theirs))
        process.start()
        theirs.close()
        index, kind, result = indices[0], "", None
        while True:
            try:
                index, kind, result = ours.recv()
            except EOFError:
                break
            if result is not None:
                yield index, kind, result
        process.join()
        if result is None:
            yield index, kind, ("find", 0.0, 0.0, f"the process ended with {process.exitcode}")
        indices = indices[indices.index(index) + 1 :]


def share(seed: int, indices: range, results: Any) -> None:
    """One job of several: hands its results on."""
    for result in part(seed, indices):
        results.put(result)
    results.put(None)


def main(arguments: list[str]) -> int:
    """Print every find as it comes, then what there was."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("count", nargs="?", type=int, default=COUNT)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", type=int)
    asked = parser.parse_args(arguments)
    if asked.only is not None:
        return show(asked.seed, asked.only)
    results: Any = multiprocessing.Queue(1000)
    jobs = [
        multiprocessing.Process(
            target=share, args=(asked.seed, range(job, asked.count, asked.jobs), results)
        )
        for job in range(asked.jobs)
    ]
    for job in jobs:
        job.start()
    became: Counter[str] = Counter()
    finds = running = 0
    slowest, largest = (0.0, 0), 0.0
    running = len(jobs)
    while running:
        result = results.get()
        if result is None:
            running -= 1
            continue
        index, kind, (end, took, megabytes, found) = result
        became[end] += 1
        slowest, largest = max(slowest, (took, index)), max(largest, megabytes)
        if found:
            finds += 1
            print(f"--only {index} ({kind})\n{found}", flush=True)
    ends = ", ".join(f"{count:,} {end}" for end, count in sorted(became.items()))
    print(f"{sum(became.values()):,} inputs of seed {asked.seed}: {ends}; {finds} finds")
    print(f"slowest {slowest[0]:.2f} s of CPU (input {slowest[1]}), largest {largest:.0f} MB")
    return 1 if finds else 0


def show(seed: int, index: int) -> int:
    """Print one input and what happens."""
    kind, files = damaged(seed, index)
    print(kind)
    for name, text in files.items():
        print(f"# --- {name}")
        print(text.encode("utf-8", "backslashreplace").decode())
    became, took, found = limited(files, index)
    print(f"{became}, {took:.2f} s, {peak():.0f} MB\n{found}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
