"""The command `view`: the picture of a machine in a browser, live; and the view of a run."""

from __future__ import annotations

import argparse
import gc
import os
import sys
import threading
import time
from argparse import Namespace
from contextlib import contextmanager, suppress
from functools import partial

from smachac.commands.arguments import (
    SCRIPT,
    as_path,
    colour,
    generated_states,
    machine_name,
    search_folders,
)
from smachac.commands.output import OK, print_report, usage
from smachac.commands.python_files import MachineError, is_python, one_analysis

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from pathlib import Path

    from smachac.diagnostics.diagnostic import Report
    from smachac.diagnostics.source import Source
    from smachac.frontend.files import Stamp
    from smachac.ir.nodes import Machine
    from smachac.view.control import Control
    from smachac.view.edits import Edits
    from smachac.view.feed import Feed
    from smachac.view.live import LiveTrace
    from smachac.view.picture import Picture
    from smachac.view.ros_topic import Topic
    from smachac.view.server import Do, Film, ViewServer
    from smachac.view.simulation import Simulation
    from smachac.view.statuses import StatusEvents
    from smachac.view.trace_file import TraceText

EXAMPLES = """\
examples:
  smachac view main.yml                        the picture, drawn again when a file changes;
                                               edit it, simulate it, save scenarios
  smachac view machine.py                      the machine in a Python file
  smachac view main.yml --generated            with the states that fields as `retry` add
  smachac view main.yml --attach run.jsonl     replay a trace; follow it while it is written
  smachac view main.yml --attach run.jsonl --film film.mp4   with the film of `run --record`
  smachac run main.yml --view                  watch a run, and control it
  smachac run main.yml --view=8123 --view-paused   wait before the first state
  smachac view main.yml --attach ros:/patrol   the machine that runs in a ROS node
  smachac view --attach 8123                   open the page of a run at this port

exit codes: 0 the page of a run was found, 2 wrong usage, 70 a bug in smachac, 130 interrupted
(the usual end: Ctrl-C)
"""

PAUSE = 0.2
"""Seconds between two looks at the files."""

CHUNK = 1_000_000
"""The most bytes of a trace that are read at a time."""


ROS = "ros:"
"""What the name of a ROS topic follows in `--attach`."""


class FilmError(Exception):
    """A file that is no film, or cannot be read; the message gives the reason."""


class PortError(Exception):
    """A port that cannot be used; the message gives the reason."""


def view_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", type=as_path, nargs="?", help=SCRIPT)
    parser.add_argument("--attach", metavar="TRACE|PORT|ros:NAME",
                        help="show the events of this trace, or the run of the ROS node whose"
                        " status has this topic, or open the page of the run with --view=PORT"
                        )  # fmt: skip
    parser.add_argument("--film", type=as_path, metavar="FILE",
                        help="the film of the run with this trace (.gif or .mp4 of `run --record`)"
                        )  # fmt: skip
    parser.add_argument("--port", type=port, default=0, metavar="PORT",
                        help="the port of the page (default: one that is free)")  # fmt: skip
    browser(parser)
    generated_states(parser)
    machine_name(parser)
    search_folders(parser)
    colour(parser)


def browser(parser: argparse.ArgumentParser) -> None:
    """`--no-browser`."""
    parser.add_argument("--no-browser", action="store_true",
                        help="only print the address of the page")  # fmt: skip


def port(text: str) -> int:
    """A port, or 0."""
    if not text.isdecimal() or len(text) > 5 or int(text) > 65535:
        raise argparse.ArgumentTypeError(f"must be a port, 0 to 65535, not `{text[:40]}`")
    return int(text)


def view_command(arguments: Namespace) -> int:
    """Serve the view of a script until Ctrl-C; the exit code."""
    attach: str | None = arguments.attach
    if attach is not None and attach.isdecimal():
        return _open_run(int(attach), arguments)
    ros = attach.removeprefix(ROS) if attach is not None and attach.startswith(ROS) else None
    if arguments.script is None:
        return usage("a script is needed: smachac view main.yml" + (
            f" --attach {attach}" if attach is not None else ""))  # fmt: skip
    if not os.path.lexists(arguments.script):
        return usage(f"there is no file {arguments.script}")
    if arguments.script.is_dir():
        return usage(f"{arguments.script} is a folder: name a script")
    if arguments.machine is not None and not is_python(arguments.script):
        return usage("--machine is for Python files")
    trace = as_path(attach) if attach is not None and ros is None else None
    if trace is not None and not trace.is_file():
        return usage(f"there is no trace {trace}, and it is no port")
    film = None
    if arguments.film is not None:
        if trace is None:
            return usage("--film needs the trace of the run: --attach TRACE")
        try:
            film = _film(arguments.film)
        except FilmError as error:
            return usage(str(error))
    if trace is not None and (reason := _no_trace(trace)):
        return usage(reason)
    if ros is not None:
        return _serve_node(arguments, ros)
    return _serve(arguments, trace, film)


def _serve_node(arguments: Namespace, name: str) -> int:
    """Serve the picture of a script and the run of a ROS node until Ctrl-C."""
    from smachac.view.ros_topic import RosError, open_topic

    try:
        topic = open_topic(name)
    except RosError as error:
        return usage(str(error))
    try:
        return _serve(arguments, topic)
    except RosError as error:
        return usage(str(error))
    finally:
        topic.close()


def _no_trace(path: Path) -> str:
    """The reason why a file cannot be shown as a trace; empty if it can, or may become one: it has
    no whole line yet."""
    from smachac.targets.html.trace import read_event

    try:
        with path.open("rb") as stream:
            head = stream.read(CHUNK)
    except OSError as error:
        return f"the trace {path} cannot be read: {error.strerror}"
    if head.startswith(b"SQLite"):
        return f"{path} is the database of a sweep, which has no events: use `smachac stats`"
    whole = [line for line in head.split(b"\n")[:-1] if line.strip()]
    if whole and not any(map(read_event, whole)):
        return f"{path} is no trace: none of its lines is an event; `run --trace` writes a trace"
    return ""


def _film(path: Path) -> Film:
    """The film in a file. Raises FilmError."""
    from smachac.view.server import Film

    try:
        with path.open("rb") as stream:
            head = stream.read(12)
    except OSError as error:
        raise FilmError(f"the film {path} cannot be read: {error.strerror}") from None
    if head[:6] in (b"GIF87a", b"GIF89a"):
        return Film("image/gif", path.read_bytes)
    if head[4:8] == b"ftyp":
        return Film("video/mp4", path.read_bytes)
    raise FilmError(f"{path} is no film: --film takes a .gif or .mp4 that `run --record` has made")


def _serve(arguments: Namespace, attached: Path | Topic | None, film: Film | None = None) -> int:
    """Serve the picture of a script, and a trace with its film or a ROS topic, until Ctrl-C.
    Raises RosError."""
    from smachac.ir.recursion import deep_recursion
    from smachac.ir.written import generated, written
    from smachac.sim.video import RATE, SPEED
    from smachac.targets.html.page import FILM_ID
    from smachac.view.feed import Feed
    from smachac.view.picture import Picture
    from smachac.view.simulation import Simulation

    feed = Feed()
    is_script = attached is None and not is_python(arguments.script)
    is_edited = is_script and not arguments.generated
    data = None if film is None else {FILM_ID: {"type": film.type, "rate": RATE, "speed": SPEED}}
    view = generated if arguments.generated else written
    picture = Picture(
        feed,
        arguments.script.stem,
        editable=is_edited,
        simulated=is_script,
        data=data,
        view=view,
    )
    simulation = None
    if is_script:
        save = partial(save_scenario, arguments.script)
        simulation = Simulation(feed, str(arguments.script), save, view)
    script = ViewedScript(arguments, picture, simulation)
    edits = edits_of_script(script) if is_edited else None
    try:
        script.check()
        server = _server(
            arguments.port, picture, feed, edits=edits, simulation=simulation, film=film
        )
    except MachineError as error:
        return usage(str(error), error.word, error.known)
    except PortError as error:
        return usage(str(error))
    run = None if attached is None else _run_of(attached, feed, picture)
    if run is not None:
        run.read()
    with deep_recursion():  # for all threads, so that none of them ends it for another one
        server.start()
        announce(server.url, open_page=not arguments.no_browser)
        while True:
            gc.collect()  # automatic collection is off
            while not script.has_changed():
                time.sleep(PAUSE)
                if run is not None:
                    run.read()
            try:
                script.check()
            except MachineError as error:  # the last machine stays
                print(error, file=sys.stderr)


def _run_of(attached: Path | Topic, feed: Feed, picture: Picture) -> _TraceFile | _NodeRun:
    """The run in a trace or on a ROS topic."""
    from pathlib import PurePath

    from smachac.view.statuses import StatusEvents
    from smachac.view.trace_file import TraceText

    if isinstance(attached, PurePath):
        return _TraceFile(attached, TraceText(feed), picture)
    return _NodeRun(attached, StatusEvents(), feed, picture)


def edits_of_script(script: ViewedScript) -> Edits:
    """The edits of a script, which write its files as the refactorings do."""
    from smachac.view.edits import Edits

    arguments = script.arguments
    return Edits(arguments.script, arguments.scripts, arguments.templates, script.write)


def save_scenario(script: Path, name: str, text: Callable[[str], str]) -> str:
    """Write a scenario into the folder `scenarios` beside a script, unless another one has that
    name; its path. `text` makes its text from the path. Raises ActionError."""
    from smachac.commands.files import changed_files, present_files, write_files
    from smachac.commands.writing import PartlyWrittenError
    from smachac.view.server import ActionError

    place = f"scenarios/{name}"
    path = str(script.parent / place)
    files = {place: text(path)}
    try:
        if present_files(script.parent, files):
            if changed_files(script.parent, files):
                raise ActionError(f"{path} exists and is another scenario: choose another name")
            return path
        write_files(script.parent, files)
    except (OSError, PartlyWrittenError) as error:
        raise ActionError(f"cannot write {path}: {error}") from None
    return path


def _simulated(machine: Machine | None, report: Report) -> Machine | None:
    """The machine if it can be simulated: its errors, if any, are those of the code of states."""
    from smachac.diagnostics.diagnostic import has_errors
    from smachac.driver import without_class_errors

    return None if has_errors(without_class_errors(report)) else machine


class ViewedScript:
    """A script on disk: checked again when one of its files changes, and after each edit."""

    def __init__(
        self, arguments: Namespace, picture: Picture, simulation: Simulation | None = None
    ) -> None:
        from smachac.frontend.files import Disk

        self._simulation = simulation
        self.arguments = arguments
        self._picture = picture
        self._disk = Disk()
        self._known: dict[str, Stamp] = {}
        self._lock = threading.Lock()

    def check(self) -> None:
        """Check it, and publish the result. Errors are also printed, and why there is no machine.
        Raises MachineError."""
        with self._lock:
            self._check()

    def write(self, texts: Mapping[str, str], before: Mapping[str, Source]) -> Mapping[str, object]:
        """Write an edit over the texts before it and check the script; the model of the machine
        that is shown then. Raises ActionError."""
        from smachac.commands.files import ChangedError, not_written, rewrite_files
        from smachac.commands.writing import PartlyWrittenError
        from smachac.view.server import ActionError

        with self._lock:
            try:
                rewrite_files(texts, before)
            except (OSError, ChangedError, PartlyWrittenError) as error:
                raise ActionError(not_written(error)) from None
            self._picture.edited()
            self._check()
            return self._picture.model

    def has_changed(self) -> bool:
        """Whether a file has changed, or one that was searched has come into being."""
        from smachac.frontend.files import stamps

        return stamps(self._known) != self._known

    def _check(self) -> None:
        from smachac.diagnostics.diagnostic import Severity
        from smachac.frontend.files import stamps

        disk, path = self._disk, self.arguments.script
        disk.refresh()
        disk.searched.clear()
        machine, report = self._read()
        self._known = stamps({str(path), *disk.searched_files()})
        self._picture.update(machine, report)
        if self._simulation is not None:
            self._simulation.use(_simulated(machine, report))
        shown = [item for item in report if machine is None or item.severity is Severity.ERROR]
        print_report(shown, self.arguments, sys.stderr)

    def _read(self) -> tuple[Machine | None, Report]:
        """The machine and its findings. Raises MachineError."""
        from smachac.driver import CODES, analyse
        from smachac.frontend.files import disk_library

        arguments, disk, path = self.arguments, self._disk, self.arguments.script
        if is_python(path):
            found = one_analysis(path, disk, arguments.machine)
            return found.machine, found.report
        report: Report = []
        source = disk.read(path, report)
        if source is None:
            return None, report
        library = disk_library(
            path,
            report,
            scripts=arguments.scripts,
            templates=arguments.templates,
            disk=disk,
            codes=CODES,
        )
        analysis = analyse(source, library, report)
        return analysis.machine, analysis.report


class _TraceFile:
    """A trace on disk that may grow, or begin anew."""

    def __init__(self, path: Path, text: TraceText, picture: Picture) -> None:
        self._path, self._text, self._picture = path, text, picture
        self._position = self._wrong = 0
        self._unknown = ""

    def read(self) -> None:
        """Publish what is new."""
        with suppress(OSError), self._path.open("rb") as stream:
            if stream.seek(0, os.SEEK_END) < self._position:
                self._position = 0
                self._text.restart()
            stream.seek(self._position)
            while data := stream.read(CHUNK):
                self._position += len(data)
                self._text.add(data)
        if self._text.wrong > self._wrong:
            self._wrong = self._text.wrong
            words = "1 line is" if self._wrong == 1 else f"{self._wrong} lines are"
            print(f"{self._path}: {words} no event of a trace", file=sys.stderr)
        unknown = _unknown_place(self._text.places, self._picture)
        if unknown and not self._unknown:
            print(f"{self._path}: {unknown}", file=sys.stderr)
        self._unknown = unknown


def _unknown_place(places: Iterable[str], picture: Picture) -> str:
    """What shows that the run is of another machine, or of another version; else empty."""
    from smachac.diagnostics.wording import quote

    model = picture.model
    nodes = model["nodes"]
    known = {node.get("shown", node["path"]) for node in nodes} | {node["path"] for node in nodes}
    place = next((place for place in places if place not in known), "")
    machine = place.partition("/")[0]
    if not place:
        return ""
    if machine != model["root"]:
        return f"this is the trace of the machine {quote(machine)}, not of `{model['root']}`"
    return f"the script has no state {quote(place)}: it is not the version that ran"


class _NodeRun:
    """The run of a ROS node, from the statuses on a topic."""

    def __init__(self, topic: Topic, statuses: StatusEvents, feed: Feed, picture: Picture) -> None:
        self._topic, self._statuses = topic, statuses
        self._feed, self._picture = feed, picture
        self._known: dict[str, None] = {}
        self._shown: str | None = None
        self._unknown = ""

    def read(self) -> None:
        """Publish what is new. Raises RosError."""
        from smachac.view.statuses import report_of
        from smachac.view.trace_file import publish

        reports = list(filter(None, map(report_of, self._topic.read())))
        self._show_topic()
        self._statuses.use(self._picture.machine)
        events = self._statuses.events(reports)
        publish(self._feed, events)
        self._known |= dict.fromkeys(event["path"] for event in events)
        unknown = _unknown_place(self._known, self._picture)
        if unknown and not self._unknown:
            print(f"{self._topic.topic}: {unknown}", file=sys.stderr)
        self._unknown = unknown

    def _show_topic(self) -> None:
        """Print whether the topic exists; the page shows it too."""
        if self._topic.topic == self._shown:
            return
        self._shown = self._topic.topic
        waits = "" if self._shown else f"waits for the ROS topic {self._topic.awaited}"
        self._feed.publish({"kind": "source", "waits": waits})
        print(waits or f"shows the ROS topic {self._shown}", file=sys.stderr, flush=True)


def _open_run(number: int, arguments: Namespace) -> int:
    """Open the page of a run on this computer, without its token: the page only shows."""
    import json
    from http.client import HTTPConnection, HTTPException

    from smachac.view.server import HOST

    if number > 65535:
        return usage(f"{number} is no port: it is larger than 65535")
    connection = HTTPConnection(HOST, number, timeout=5)
    status = None
    try:
        connection.request("GET", "/status")
        status = json.loads(connection.getresponse().read(10_000))
    except (OSError, HTTPException, ValueError):
        pass
    finally:
        connection.close()
    if not isinstance(status, dict) or status.get("program") != "smachac":
        return usage(f"no run with --view={number} answers on this computer")
    announce(f"http://{HOST}:{number}/", open_page=not arguments.no_browser)
    return OK


def _server(
    number: int,
    picture: Picture,
    feed: Feed,
    control: Control | None = None,
    edits: Edits | None = None,
    simulation: Simulation | None = None,
    film: Film | None = None,
) -> ViewServer:
    """A server for a picture and, with a control, for a run; with edits or a simulation, for those;
    with a film. Raises PortError."""
    from smachac.view.control import ControlError
    from smachac.view.server import ActionError, ViewServer

    def act(body: Mapping[str, object]) -> object:
        if control is None:
            raise ActionError("nothing runs here")
        words = [body.get(name) for name in ("action", "path", "outcome", "round")]
        action, *place = (word if isinstance(word, str) else None for word in words)
        try:
            control.act(action or "", *place)
        except ControlError as error:
            raise ActionError(str(error)) from None
        return control.status()

    actions: dict[str, Do] = {"/control": act}
    if edits is not None:
        actions |= {"/edit": edits.edit, "/undo": edits.undo, "/types": edits.types}
    if simulation is not None:
        actions["/simulate"] = simulation.act
    try:
        return ViewServer(number, picture.page, feed, actions, name=picture.name, film=film)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise PortError(f"port {number} cannot be used: {reason}") from None


def announce(url: str, *, open_page: bool) -> None:
    """Print the address of a page, and open it in a browser where there is one."""
    print(f"view: {url}", file=sys.stderr, flush=True)
    if open_page and (
        sys.platform in ("darwin", "win32") or os.environ.keys() & {"DISPLAY", "WAYLAND_DISPLAY"}
    ):
        _open(url)


def _open(url: str) -> None:
    """Open a page through a file that only the user can read: the address has the token, and the
    arguments of a process can be seen by all users of a computer."""
    import atexit
    import json
    import tempfile
    import webbrowser
    from pathlib import Path

    handle, name = tempfile.mkstemp(prefix="smachac-", suffix=".html")
    with open(handle, "w", encoding="utf-8") as stream:  # noqa: PTH123 (a file descriptor)
        stream.write(f"<!DOCTYPE html><script>location.replace({json.dumps(url)})</script>")
    atexit.register(Path(name).unlink, missing_ok=True)
    with suppress(webbrowser.Error):
        webbrowser.open(Path(name).as_uri())


# The view of a run


class RunView:
    """The view of one run: a sink for its events, a gate for its states."""

    def __init__(self, server: ViewServer, trace: LiveTrace, control: Control) -> None:
        self.trace, self.control = trace, control
        self._server = server

    def stay(self, code: int) -> int:
        """After the run: where a person is at the terminal, serve the page until Ctrl-C, unless
        SIGTERM or SIGHUP ended the run. The exit code: `code`, that of the run, or that of the
        signal."""
        import signal

        from smachac.commands.interrupts import interrupts_raise
        from smachac.runtime.signals import exit_code, received

        self.control.ended()
        if not sys.stdin or not sys.stdin.isatty() or set(received) - {signal.SIGINT}:
            return code
        print("the run has ended; the view stays until Ctrl-C", file=sys.stderr, flush=True)
        with interrupts_raise(), suppress(KeyboardInterrupt):
            while True:
                time.sleep(3600)
        return exit_code(code)


@contextmanager
def run_view(arguments: Namespace, machine: Machine, report: Report) -> Iterator[RunView]:
    """The view of a run with `--view`. Raises PortError."""
    from smachac.ir.written import generated, written
    from smachac.view.control import Control
    from smachac.view.feed import Feed
    from smachac.view.live import LiveTrace
    from smachac.view.picture import Picture

    feed = Feed()
    trace = LiveTrace(feed)
    states = generated if arguments.generated else written
    control = Control(states(machine), trace.send, paused=arguments.view_paused)
    picture = Picture(feed, machine.root.name, view=states)
    picture.update(machine, report)
    server = _server(arguments.view, picture, feed, control)
    trace.send(control.status())
    trace.start()
    server.start()
    on_terminal = bool(sys.stdin) and sys.stdin.isatty()
    announce(server.url, open_page=on_terminal and not arguments.no_browser)
    try:
        yield RunView(server, trace, control)
    finally:
        trace.close()
        server.stop()
