"""The command `run`: run the generated Python program, or play a scenario on the interpreter."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from argparse import Namespace
from contextlib import ExitStack, contextmanager, suppress
from functools import partial

from smachac.commands.arguments import (
    SCRIPT,
    as_path,
    colour,
    count,
    names,
    search_folders,
    seed,
)
from smachac.commands.interrupts import end_at_stop_signals
from smachac.commands.output import FINDINGS, OK, print_report, usage, without_notes
from smachac.commands.swapped import swapped_option
from smachac.commands.terminal import wants_colour
from smachac.commands.view import PortError, browser, port, run_view

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from pathlib import Path
    from typing import Any

    from smachac.commands.view import RunView
    from smachac.diagnostics.diagnostic import Report
    from smachac.diagnostics.source import Span
    from smachac.driver import Analysis
    from smachac.frontend.text.yaml_tree import Tree
    from smachac.interpreter.result import InterpreterResult
    from smachac.interpreter.scenario import Scenario, ScenarioProblem
    from smachac.ir.nodes import Machine
    from smachac.robots.faults import Fault
    from smachac.runtime.tracing.gate import Gate
    from smachac.runtime.tracing.progress import Sugar
    from smachac.view.control import Control
    from smachac.view.live import LiveTrace

    Event = dict[str, Any]
    Go = Callable[[Callable[[Event], None], Control | None], str]

EXAMPLES = """\
examples:
  smachac run main.yml                           run it, on the simulated arm if it moves one
  smachac run main.yml --record film.gif         make a film of the arm
  smachac run main.yml --trace trace.jsonl -q    write the trace, print only the outcome
  smachac run main.yml --mock scenario.yml       play a scenario, without robot and simulation
  smachac run main.yml --mock scenario.yml --orders 100   try 100 orders of concurrent branches
  smachac run main.yml --faults faults.yml       inject faults into the simulation
  smachac run main.yml --seed 7 --set userdata.speed=0.2   with another value
  smachac run main.yml --view                    watch and control it in a browser
  smachac run main.yml --expect succeeded        fail if the outcome is another one (CI)
  smachac run main.yml --ros                     run it as a ROS node, without writing a program
  smachac run main.yml --ros --ros-args -p speed:=0.2 -r __ns:=/robot_1

exit codes: 0 the machine ended with an outcome (the one of --expect), 1 the run failed or the
script has errors, 2 wrong usage, 70 a bug in smachac, 130 after Ctrl-C, 143 after SIGTERM,
129 after SIGHUP, whatever the outcome
"""


def run_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("script", type=as_path, help=SCRIPT)
    parser.add_argument("--gui", action="store_true", help="show the simulated arm in a window")
    parser.add_argument("--record", type=as_path, metavar="FILE",
                        help="make a film of the simulated arm: .gif or .mp4")  # fmt: skip
    parser.add_argument("--trace", type=as_path, metavar="FILE",
                        help="write every event to FILE, as JSON lines")  # fmt: skip
    parser.add_argument("--ros", action="store_true", help="run it as a ROS node")
    parser.add_argument("--ros-args", nargs=argparse.REMAINDER, metavar="...",
                        help="with --ros: the arguments of the node, at the end")  # fmt: skip
    parser.add_argument("--seed", type=seed, default=0,
                        help="seed of the simulation and random states (default: 0)")  # fmt: skip
    parser.add_argument("--faults", type=as_path, metavar="FILE",
                        help="inject the faults in FILE into the simulation")  # fmt: skip
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE",
                        help="another value: userdata.KEY, params.NAME, scene.BODY.x"
                        " (repeatable)")  # fmt: skip
    parser.add_argument("--mock", type=as_path, metavar="FILE",
                        help="play the scenario in FILE, do not run the program")  # fmt: skip
    parser.add_argument("--schedule", type=names, metavar="A,B,...",
                        help="with --mock: the turns of concurrent branches")  # fmt: skip
    parser.add_argument("--orders", type=count, metavar="N",
                        help="with --mock: try N orders of turns; fail if the results"
                        " differ")  # fmt: skip
    max_steps(parser)
    parser.add_argument("--view", type=port, nargs="?", const=0, metavar="PORT",
                        help="show the run in a browser (default of PORT: one that is"
                        " free)")  # fmt: skip
    parser.add_argument("--view-paused", action="store_true",
                        help="with --view: wait before the first state")  # fmt: skip
    parser.add_argument("--generated", action="store_true",
                        help="with --view: also show the states that `timeout`, `retry` and"
                        " `for_each` add")  # fmt: skip
    browser(parser)
    parser.add_argument("--expect", metavar="OUTCOME",
                        help="fail if the outcome is another one")  # fmt: skip
    parser.add_argument("--quiet", "-q", action="store_true",
                        help="print only the outcome, no progress")  # fmt: skip
    search_folders(parser)
    colour(parser)


def max_steps(parser: argparse.ArgumentParser) -> None:
    """`--max-steps`."""
    parser.add_argument("--max-steps", type=count, metavar="N",
                        help="with --mock: fail after N states (default: 10000)")  # fmt: skip


MAX_STEPS_NEEDS = "--max-steps needs --mock: a program runs until its machine ends"


def run_command(arguments: Namespace) -> int:
    """Run a script; the exit code."""
    from smachac.ir.traversal import outcome_names

    end_at_stop_signals()
    record: Path | None = arguments.record
    if record is not None and record.suffix.lower() not in (".gif", ".mp4"):
        return usage(f"--record writes .gif and .mp4, not `{record}`")
    if arguments.mock is None and arguments.max_steps:
        return usage(MAX_STEPS_NEEDS)
    if arguments.mock is None and (arguments.schedule or arguments.orders):
        return usage("--schedule and --orders need --mock: the turns of threads cannot be chosen")
    if arguments.mock is not None and (record is not None or arguments.gui or arguments.faults):
        return usage(NO_ARM)
    if arguments.mock is not None and arguments.ros:
        return usage("--ros runs a node, --mock plays a scenario: choose one")
    if arguments.ros_args is not None and not arguments.ros:
        return usage("--ros-args needs --ros")
    if arguments.view is None and arguments.view_paused:
        return usage("--view-paused needs --view")
    if arguments.view is None and arguments.generated:
        return usage("--generated needs --view")
    if arguments.view is not None and arguments.orders is not None:
        return usage("--view shows one run, --orders tries many: choose one")
    for option, path, is_ours in (
        ("trace", arguments.trace, _is_trace),
        ("record", record, _is_film),
    ):
        if path is not None and in_the_way(path, is_ours):
            what = "is a file of another kind: it was not overwritten"
            return usage(f"--{option} {path} {what}")
    if right := swapped_option(arguments, "mock", "faults"):
        return usage(right)
    analysis = _analysis(arguments)
    if isinstance(analysis, str):
        return usage(analysis)
    machine = analysis.checked or _playable(analysis)
    expected = arguments.expect
    if machine is not None and expected is not None:
        known = outcome_names(machine.root)
        if expected not in known:
            return usage(f"the machine has no outcome `{expected}`", expected, known)
    if arguments.mock is not None:
        return _run_scenario(arguments, analysis)
    return _run_program(arguments, analysis)


def _analysis(arguments: Namespace) -> Analysis | str:
    """The analysis of the script with the values of `--set`, or what is wrong with these.
    `arguments.poses` becomes those of the scene."""
    from smachac.driver import analyse_script

    folders = arguments.scripts, arguments.templates
    analysis = analyse_script(arguments.script, *folders)
    arguments.poses = {}
    if not arguments.set or analysis.machine is None:
        return analysis
    from smachac.frontend.files import module_folders
    from smachac.frontend.text.yaml_tree import parse
    from smachac.sweep.inputs import scene_bodies
    from smachac.sweep.variation import VariationError, edited, fixed, poses

    source = analysis.machine.root.span.source
    tree = parse(source, [])
    bodies = scene_bodies(analysis.machine, module_folders(arguments.script))
    try:
        values = fixed(arguments.set, tree, bodies)
    except VariationError as error:
        return f"--set: {error}"
    arguments.poses = poses(values)
    return analyse_script(edited(source, tree, values), *folders)


def in_the_way(path: Path, is_ours: Callable[[bytes], bool]) -> bool:
    """Whether a file must not be overwritten: it has content, and that is not of the kind to write.
    A trace may be written to a pipe or a device."""
    from smachac.frontend.files import TooBigError, read_bytes

    if not path.is_file():
        return is_ours is _is_film and os.path.lexists(path)  # a film replaces what is there
    try:
        head = read_bytes(path)[:2000]
    except (OSError, TooBigError):
        return False
    return bool(head) and not is_ours(head)


def _is_trace(head: bytes) -> bool:
    return head.startswith(b'{"seq": ') and b'"event": ' in head.partition(b"\n")[0]


def _is_film(head: bytes) -> bool:
    return head[:6] in (b"GIF87a", b"GIF89a") or head[4:8] == b"ftyp"


NO_ARM = "--record, --gui and --faults need a program that uses the simulated arm; this does not"


def _run_program(arguments: Namespace, analysis: Analysis) -> int:
    """Generate the Python program and run it; the exit code."""
    from importlib.util import find_spec

    from smachac.driver import compile_script
    from smachac.targets.python import TARGET
    from smachac.targets.python.ros import is_node, may_be_node

    files, report = compile_script(analysis, TARGET)
    print_report(without_notes(report), arguments, sys.stderr)
    machine, library = analysis.checked, analysis.library
    if machine is None or library is None or not files:
        return FINDINGS
    simulated = any(type_.simulation for type_ in machine.state_types.values())
    if (arguments.gui or arguments.record or arguments.faults) and not simulated:
        return usage(NO_ARM)
    node = is_node(machine, library, library.ros)
    if node and not arguments.ros:
        return usage("this script is a ROS node: --ros runs it, --mock plays a scenario")
    if arguments.ros and not may_be_node(machine, library, library.ros):
        return usage("this script is no ROS node: run it without --ros")
    if arguments.ros_args is not None and library.ros == 1:
        return usage("--ros-args passes arguments of ROS 2, and the project has `ros = 1`")
    package = {1: "rospy", 2: "rclpy"}[library.ros]
    if arguments.ros and find_spec(package) is None:
        return usage(f"--ros needs {package}: start smachac with the Python of ROS {library.ros}")
    arguments.node = ["--ros-args", *(arguments.ros_args or [])] if node else None
    faults: tuple[Fault, ...] | None = ()
    if arguments.faults is not None:
        found: Report = []
        faults = read_fault_file(arguments.faults, machine, found)
        print_report(found, arguments, sys.stderr)
    if faults is None:
        return FINDINGS
    ((name, text),) = files.items()
    go = partial(perform, name, text, machine, arguments, faults)
    return _observed(arguments, machine, report, go)


def _run_scenario(arguments: Namespace, analysis: Analysis) -> int:
    """Play a scenario; the exit code."""
    from smachac.driver import without_class_errors
    from smachac.interpreter.interpreter import MAX_STEPS
    from smachac.runtime.signals import StopSignals, end_now
    from smachac.sweep.play import SHOWN_STATES, FailedError, play
    from smachac.view.control import Control

    report = without_class_errors(analysis.report)
    print_report(without_notes(report), arguments, sys.stderr)
    machine = analysis.checked or _playable(analysis)
    if machine is None:
        return FINDINGS
    found: Report = []
    scenario, last_steps = read_scenario_file(arguments.mock, machine, found)
    print_report(found, arguments, sys.stderr)
    if scenario is None:
        return FINDINGS
    seed, most = arguments.seed, arguments.max_steps or MAX_STEPS
    if arguments.orders is not None:
        text, agree = play_orders(machine, scenario, seed, arguments.orders, max_steps=most)
        print(text)
        return OK if agree else FINDINGS

    def go(observe: Callable[[Event], None], gate: Control | None) -> str:
        control = gate or Control()
        schedule = arguments.schedule
        try:
            with StopSignals(partial(_stop, control), end_now):
                return play(machine, scenario, seed, schedule, observe, control, max_steps=most)
        except FailedError as error:
            places = [last_steps[path] for path in error.cycle if path in last_steps]
            repeats = "".join(
                f"\n  --> {span}: this step repeats" for span in places[:SHOWN_STATES]
            )
            raise FailedError(f"{error}{repeats}") from None

    return _observed(arguments, machine, analysis.report, go)


def _stop(control: Control) -> None:
    """Send a stop request to the machine of a control."""
    _print_stop()
    control.act("stop")


def _playable(analysis: Analysis) -> Machine | None:
    """The machine of a script whose only errors are properties that fail: their counterexamples can
    be played."""
    from smachac.diagnostics.diagnostic import Severity
    from smachac.driver import without_class_errors

    report = without_class_errors(analysis.report)
    errors = [item.code for item in report if item.severity is Severity.ERROR]
    return analysis.machine if errors and set(errors) == {"SM701"} else None


def _observed(arguments: Namespace, machine: Machine, report: Report, go: Go) -> int:
    """Run a machine, with a view if the arguments require one; the exit code."""
    from smachac.runtime.signals import exit_code

    if arguments.view is None:
        return exit_code(_traced(arguments, machine, go, None))
    try:
        with run_view(arguments, machine, report) as view:
            return view.stay(exit_code(_traced(arguments, machine, go, view)))
    except PortError as error:
        return usage(str(error))


def _traced(arguments: Namespace, machine: Machine, go: Go, view: RunView | None) -> int:
    """Run a machine with trace and progress, and print its outcome; the exit code."""
    from smachac.sweep.play import FailedError

    try:
        with watching(arguments, machine, view.trace if view else None) as (observe, errors):
            try:
                outcome = go(observe, view.control if view else None)
            except FailedError as error:
                sys.stdout.flush()
                print(f"the run failed{_where(errors)}\n{error}", file=sys.stderr)
                return FINDINGS
    except OSError as error:
        print(f"cannot write the trace: {error.strerror or error}", file=sys.stderr)
        return FINDINGS
    print(f"outcome: {outcome}")
    if arguments.expect is not None and outcome != arguments.expect:
        print(f"expected: {arguments.expect}", file=sys.stderr)
        return FINDINGS
    return OK


def _where(errors: list[dict[str, Any]]) -> str:
    """The state that failed first, and its line in the script."""
    if not errors:
        return ""
    source = f" ({errors[0]['src']})" if "src" in errors[0] else ""
    return f" in {errors[0]['path']}{source}"


def sugar_of(machine: Machine) -> Sugar:
    """The parts of states in traces, for the progress of a run."""
    from smachac.ir.written import written
    from smachac.runtime.tracing.progress import Repeated, Sugar

    states: dict[str, str] = {}
    repeated: dict[str, Repeated] = {}
    limits: dict[str, str] = {}
    added: set[str] = set()
    catching: set[str] = set()
    words = {"try": "attempt", "item": "item"}
    for state in written(machine).states.values():
        badges = {badge.field: badge for badge in state.badges}
        around = ""
        for part in state.parts:
            if part.role in ("timer", "pause"):
                added.add(part.shown)
                continue
            if part.role != "state":
                states[part.shown] = state.path
            if part.begins is not None:
                count = badges["retry" if part.begins == "try" else "for_each"].number
                of = "" if count is None else str(count)
                repeated[around] = Repeated(part.shown, words[part.begins], of)
            if part.role == "timeout":
                limits[part.shown] = badges["timeout"].limit
            around = part.shown
        if state.catches:
            catching.add(state.path)
    return Sugar(states, repeated, limits, frozenset(added), frozenset(catching))


def play_orders(
    machine: Machine, scenario: Scenario, seed: int, most: int, *, max_steps: int
) -> tuple[str, bool]:
    """Play a scenario with up to `most` orders of turns of concurrent branches.

    The results as text, and whether all results are the same.
    """
    from itertools import islice

    from smachac.interpreter.explore import explore
    from smachac.interpreter.userdata import trace_value
    from smachac.ir.script_paths import script_paths
    from smachac.ir.secret_keys import secret_keys
    from smachac.runtime.tracing.writer import SECRET, shown_path
    from smachac.sweep.play import played_behaviour

    paths = script_paths(machine.root)
    secret = secret_keys(machine).get(machine.root.name, ())
    ends: dict[str, list[InterpreterResult]] = {}
    orders = explore(
        machine,
        lambda: played_behaviour(machine, scenario, seed),
        max_steps=max_steps,
    )
    for result in islice(orders, most):
        end = f"outcome: {result.outcome}"
        if result.error:
            end = f"error: {shown_path(result.error.path, paths)}: {result.error.message}"
        held = (
            f"{key}={SECRET if key in secret else repr(trace_value(result.userdata[key]))}"
            for key in sorted(result.userdata)
        )
        ends.setdefault(" ".join([end, *held]), []).append(result)
    tried = sum(map(len, ends.values()))
    more = next(orders, None) is not None
    which = "not all" if more else "all there are" if tried > 1 else "the only one"
    lines = [f"{tried} order{'s' * (tried > 1)} of branches tried, {which}:"]
    for end, results in ends.items():
        turns = ",".join(_short_turns(results[0], paths))
        lines.append(
            f"{len(results):>6}  {end}" + (f"\n        --schedule {turns}" if turns else "")
        )
    if len(ends) > 1:
        lines.append("a race: the result depends on which branch is first")
    return "\n".join(lines), len(ends) == 1


def _short_turns(result: InterpreterResult, paths: Mapping[str, str]) -> Iterator[str]:
    """The turns of a run in the form of `--schedule`: names, or paths of the script where names are
    ambiguous."""
    for choice in result.choices:
        name = choice.taken.rpartition("/")[2]
        alike = [path for path in choice.ready if path.endswith(f"/{name}")]
        yield name if len(alike) == 1 else paths.get(choice.taken, choice.taken)


def perform(
    name: str,
    text: str,
    machine: Machine,
    arguments: Namespace,
    faults: tuple[Fault, ...],
    observe: Callable[[Event], None],
    gate: Gate | None = None,
) -> str:
    """Run the generated module; the outcome. Raises FailedError, and SystemExit after a line with
    the reason if the arguments of a node are not valid."""
    from pathlib import Path

    from smachac.frontend.files import module_folders
    from smachac.runtime.ros2_errors import ParameterError
    from smachac.sweep.play import FailedError
    from smachac.targets.python.output_check import output_check
    from smachac.targets.python.runner import (
        PythonProgram,
        Simulation,
        execute,
        failure_text,
    )

    check = output_check(machine)

    def watched(event: Event) -> None:
        observe(event)
        for sentence in check(event) if not arguments.quiet else ():
            print(f"warning: {sentence}", file=sys.stderr)

    gc.enable()  # from here on the user's program runs
    # The program may change the working folder.
    folders = [Path(os.path.realpath(folder)) for folder in module_folders(arguments.script)]
    try:
        outcome = execute(
            PythonProgram(name=name, text=text, machine=machine, folders=folders),
            watched,
            seed=arguments.seed,
            simulation=Simulation(
                gui=arguments.gui,
                record=arguments.record,
                faults=faults,
                poses=arguments.poses,
            ),
            arguments=arguments.node,
            gate=gate,
            on_preempt=_print_stop,
        ).outcome
    except ParameterError as error:
        print(error, file=sys.stderr)
        raise SystemExit(FINDINGS) from None
    except Exception as error:
        raise FailedError(failure_text(error)) from error
    if outcome is None:
        raise FailedError("the machine ended without an outcome")
    return outcome


def _print_stop() -> None:
    text = "preemption requested: the states stop; Ctrl-C again ends at once"
    print(text, file=sys.stderr, flush=True)


@contextmanager
def watching(
    arguments: Namespace, machine: Machine, view: LiveTrace | None = None
) -> Iterator[tuple[Callable[[Event], None], list[Event]]]:
    """An observer that writes the trace, shows progress and feeds the view, and the error events it
    received."""
    from smachac.commands.files import make_folders
    from smachac.runtime.tracing.progress import Progress
    from smachac.runtime.tracing.writer import TraceWriter

    recorders: list[TraceWriter | LiveTrace] = [] if view is None else [view]
    with ExitStack() as stack:
        if arguments.trace is not None:
            make_folders(arguments.trace.parent)
            stream = stack.enter_context(arguments.trace.open("wb", buffering=0))
            failures: list[OSError] = []
            recorders.append(TraceWriter(partial(_write_lines, stream.fileno(), failures)))
            stack.callback(_raise_first, failures)
        if arguments.quiet and len(recorders) == 1:
            (recorder,) = recorders
            yield recorder, recorder.errors
            return
        sinks: list[Callable[[Event], None]] = [*recorders]
        if not arguments.quiet:
            colour = wants_colour(arguments, sys.stdout)
            sinks.append(Progress(sys.stdout, sugar_of(machine), colour=colour))
        errors: list[Event] = []

        def observe(event: Event) -> None:
            if event["event"] == "error":
                errors.append(event)
            for sink in sinks:
                sink(event)

        yield observe, errors


def _write_lines(handle: int, failures: list[OSError], data: bytes) -> int:
    """Write lines of a trace. After an error, which is noted, the file ends with a whole line."""
    done = 0
    try:
        while done < len(data):
            done += os.write(handle, data[done:])
    except OSError as error:
        failures.append(error)
        if done:
            with suppress(OSError):  # a pipe has no size
                os.ftruncate(handle, os.fstat(handle).st_size - done)
        raise
    return done


def _raise_first(failures: list[OSError]) -> None:
    if failures:
        raise failures[0]


NO_FAULTS = "the faults cannot be injected, so nothing is run"
NO_SCENARIO = "the scenario cannot be played, so nothing is run"
"""What the findings in a file of faults or a scenario have as their effect."""


def read_fault_file(path: Path, machine: Machine, report: Report) -> tuple[Fault, ...] | None:
    """The faults of a file; None, with findings in the report, if it has mistakes, such as a state
    that the machine does not have. A simulation knows states by their full paths."""
    from smachac.frontend.errors.script import wrong_shape
    from smachac.frontend.text.data_files import plain, span_at
    from smachac.interpreter.scenario import leaves_named
    from smachac.records import replace
    from smachac.robots.faults import read_file
    from smachac.robots.fields import DataError

    tree = _read_tree(path, report, NO_FAULTS)
    if tree is None:
        return None
    try:
        faults = [*read_file(plain(tree))]
    except DataError as error:
        place = span_at(tree, error.place)
        report.append(wrong_shape(place, error.message, error.help, effect=NO_FAULTS))
        return None
    for number, fault in enumerate(faults):
        paths, problem = ([], None) if fault.state is None else leaves_named(fault.state, machine)
        if problem is not None:
            place = span_at(tree, ("faults", number, "state"))
            report.append(wrong_shape(place, problem.message, problem.help, effect=NO_FAULTS))
        elif len(paths) == 1:
            faults[number] = replace(fault, state=paths[0])
    return None if report else (*faults,)


def read_scenario_file(
    path: Path, machine: Machine, report: Report
) -> tuple[Scenario | None, Mapping[str, Span]]:
    """The scenario of a file, and the places of the last steps of its states, by full path; None,
    with findings in the report, if it has faults."""
    from smachac.frontend.errors.script import wrong_shape
    from smachac.frontend.text.data_files import plain
    from smachac.frontend.text.yaml_tree import Map, Seq
    from smachac.interpreter.scenario import read_scenario

    tree = _read_tree(path, report, NO_SCENARIO)
    if tree is None:
        return None, {}
    scenario, found = read_scenario(plain(tree), machine)
    for problem in found:
        place = _place(problem, tree)
        report.append(wrong_shape(place, problem.message, problem.help, effect=NO_SCENARIO))
    if report:
        return None, {}
    states = tree.get("states") if isinstance(tree, Map) else None
    assert states is not None
    assert isinstance(states.value, Map)
    last = (
        entry.value.items[-1] if isinstance(entry.value, Seq) else entry.value
        for entry in states.value.entries
    )
    return scenario, {path: step.span for path, step in zip(scenario.steps, last, strict=True)}


def _read_tree(path: Path, report: Report, effect: str) -> Tree | None:
    """The YAML of a file that is no script; None if it cannot be read. Its findings have the effect
    of such a file."""
    from smachac.diagnostics.source import Span
    from smachac.frontend.errors.script import wrong_shape
    from smachac.frontend.files import read_source
    from smachac.frontend.text.yaml_tree import parse
    from smachac.records import replace

    source = read_source(path, report)
    tree = parse(source, report) if source is not None else None
    if tree is None and not report and source is not None:
        report.append(wrong_shape(Span(source, 0, 0), "this file is empty"))
    report[:] = [replace(item, finding=replace(item.finding, effect=effect)) for item in report]
    return tree


def _place(problem: ScenarioProblem, tree: Tree) -> Span:
    """The place of a fault in the text of a scenario: a step, the name of a state, or all of it."""
    from smachac.frontend.text.yaml_tree import Map, Seq

    states = tree.get("states") if isinstance(tree, Map) else None
    if states is None or not isinstance(states.value, Map):
        return tree.span
    for entry in states.value.entries:
        if str(entry.key.value) != problem.state:
            continue
        if problem.step is None:
            return entry.key.span
        items = entry.value.items if isinstance(entry.value, Seq) else ()
        # Another key can have the same text: 1 and "1".
        return items[problem.step - 1].span if problem.step <= len(items) else entry.value.span
    return tree.span
