"""The class of a stepped machine, and the table of its states."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import walk
from smachac.targets.cpp.containers import Lines, all_results
from smachac.targets.cpp.plan import place
from smachac.targets.cpp.types import cpp_literal
from smachac.targets.cpp.user_classes import ClassCode, argument

RUN_BYTES = 160
"""An upper limit on the size of `smachac::step::Run` without its flags for requests, in bytes."""


def node_table(machine: Machine, paths: Mapping[str, str]) -> Lines:
    """The table of all states, for observers and failures. `paths` are the paths in the script of
    the states that have another one in the machine."""
    numbers: dict[str, int] = {}
    arrays: dict[tuple[str, ...], str] = {}
    rows = []
    for number, (path, node) in enumerate(walk(machine.root)):
        numbers[path] = number
        names = arrays.setdefault(all_results(node), f"outcomes_{len(arrays)}_")
        full = cpp_literal(path) if path in paths else "nullptr"
        around = numbers.get(path.rpartition("/")[0], 0)
        shown = cpp_literal(paths.get(path, path))
        outcomes = f"{names}, {len(all_results(node))}"
        rows.append(f"    {{{shown}, {full}, {cpp_literal(place(node))}, {outcomes}, {around}}},")
    return [
        *(
            f"inline constexpr const char *{name}[] = {{{', '.join(map(cpp_literal, names))}}};"
            for names, name in arrays.items()
        ),
        "inline constexpr smachac::step::Node table_[] = {",
        *rows,
        "};",
    ]


def machine_class(
    machine: Machine,
    classes: Mapping[str, ClassCode],
    parameters: Sequence[str],
    size: int,
    *,
    asks: bool,
) -> Lines:
    """The class of a machine. `parameters` are those of the constructor of its states, `size` an
    upper limit on the size of its containers without the objects of the user, in bytes. `asks`:
    some state can receive a request to stop."""
    count = sum(1 for _ in walk(machine.root))
    given = ", ".join(map(argument, parameters))
    explicit = ["explicit " if len(parameters) == most else "" for most in (1, 0)]
    alone = f"constexpr {explicit[0]}Machine({', '.join(parameters)})"
    head = f"constexpr {explicit[1]}Machine({', '.join([*parameters, 'Observer &observer'])})"
    nobody = ", ".join([*map(argument, parameters), "smachac::step::nobody"])
    states = f", states({given})" if given else ""
    most = size + RUN_BYTES + count
    limit = " + ".join([f"{most}U", *_objects(machine, classes)])
    of_user = " and the objects of your classes" if classes else ""
    nodes = str(count) if asks else f"smachac::step::detail::watches<Observer> ? {count} : 0"
    return [
        "/// The machine: its states, its userdata, and the states that run. Its size is at most",
        f"/// {most} bytes{of_user}.",
        "template <class Observer = smachac::step::NoObserver>",
        "class Machine {",
        "public:",
        f"  {alone} : Machine({nobody}) {{}}",
        f"  {head} : run_(observer){states} {{}}",
        "",
        "  /// Makes at most one transition in each active branch. `now` is the time in",
        "  /// nanoseconds of a clock that never goes back. After an outcome or a failure, the",
        "  /// next step starts the machine again, with its userdata as it is.",
        "  smachac::step::Result<Outcome> step(smachac::step::Nanoseconds now) {",
        "    run_.context.now = now;",
        "    if (Run::watches && states.idle()) {",
        "      run_.start();",
        "    }",
        "    const auto result = step_(states, userdata, run_);",
        "    run_.finish(result.code());",
        "    return result;",
        "  }",
        "  /// Sends a request to stop to all states that run; without an answer, the states after",
        "  /// them receive it. Call it between two steps, or in the step of a state.",
        "  void request_stop() {",
        "    run_.ask(0);",
        "    ask_running_(states, run_);",
        "  }",
        "  /// The failure of the last run that failed, and its state.",
        "  [[nodiscard]] const smachac::step::Failure &failure() const { return run_.failure; }",
        "  [[nodiscard]] const smachac::step::Node &failed_state() const {",
        "    return table_[run_.failure.node];",
        "  }",
        "",
        "private:",
        f"  using Run = smachac::step::Run<Observer, {nodes}, table_>;",
        "",
        "  Run run_; // the first member: its address is that of the machine",
        "",
        "public:",
        f"  States states{'' if given else '{}'};",
        "  Userdata userdata{};",
        "};",
        f"static_assert(sizeof(Machine<>) <= {limit},",
        '              "the machine is larger than expected");',
    ]


def _objects(machine: Machine, classes: Mapping[str, ClassCode]) -> list[str]:
    """The sizes of the objects of the user's classes in a machine, with the gaps after them."""
    counts: dict[str, int] = {}
    for _, node in walk(machine.root):
        if isinstance(node, Leaf) and node.type in classes:
            name = classes[node.type].name
            counts[name] = counts.get(name, 0) + 1
    return [f"{count}U * (sizeof({name}) + 8U)" for name, count in counts.items()]
