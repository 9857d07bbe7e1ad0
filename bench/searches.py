"""The searches written by hand in `analysis/` against networkx doing the same, inside one check.

    python bench/searches.py [rounds [states ...]]

Each script is a chain of states with 1 or 10 faults at its end; a search for one passes all states.
Figures are CPU time in ms, the least of several rounds in turn: the whole check, the search in it,
and the same search with networkx, which first builds the graph of the places and key states.
Results must be equal. The last line is the import of networkx, which a check without faults in its
control flow does not need.
"""

from __future__ import annotations

import gc
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from itertools import product
from pathlib import Path
from typing import Any

from smachac.analysis import def_use, lost_outputs, reaching_values
from smachac.analysis.def_use import KeyState, Reached
from smachac.ir.graph import START, edges

SIZES = (1_000, 10_000)

HEAD = "name: sm\ntemplate: Base\noutcomes: [done]\n"
LINK = "- S%d: {T: ScriptedState, o: [a, b], t: {a: S%d, b: S%d}}\n"
CODE = "T: CallbacksState, callbacks: {%s}, t: {succeeded: %s}"


def script(which: str, states: int, faults: int) -> str:
    """A chain of states with two outcomes each. Its end reads keys that nothing sets, that the
    first state keeps to itself, or that the first state sets to another type."""
    keys = [f"k{number}" for number in range(faults)]
    read = CODE % (", ".join(f'n{key}: "lambda ud: ud.{key}"' for key in keys), "done")
    typed = ", ".join(f"{key}: float" for key in keys)
    outputs = ", ".join(f"n{key}" for key in keys)
    last = f"- S{states}: {{{read}, input_keys: {{{typed}}}, output_keys: [{outputs}]}}\n"
    links = [LINK % (n, n + 1, min(n + 2, states)) for n in range(1, states)]
    code = ", ".join(f"{key}: \"lambda ud: 'x'\"" for key in keys)
    if which == "def_use.search":
        head, first = "", "- S0: {T: ScriptedState, o: [a], t: {a: S1}}\n"
    elif which == "reaching_values.search":
        head = ""
        typed = ", ".join(f"{key}: str" for key in keys)
        first = f"- S0: {{{CODE % (code, 'S1')}, output_keys: {{{typed}}}}}\n"
    else:
        head = f"userdata: {{{', '.join(f'{key}: 1.0' for key in keys)}}}\n"
        inner = f"{{{CODE % (code, 'a')}, output_keys: [{', '.join(keys)}]}}"
        first = f"- S0: {{T: StateMachine, o: [a], t: {{a: S1}}, s: [{{IN: {inner}}}]}}\n"
    return f"{HEAD}{head}states:\n{first}{''.join(links)}{last}"


Search = Callable[..., Any]


def search_in_product(flow: Any, scope: Any, key: str, states: Any, *, stops: bool = False) -> Any:
    """`def_use.search` in the product graph of the vertices and the states of the key."""
    import networkx as nx

    beside = def_use._found_beside(flow, scope, key)
    graph = nx.DiGraph()
    origin = Reached("", "unset")
    graph.add_edges_from((origin, Reached(START, state)) for state in states)
    key_states: tuple[KeyState, ...] = ("unset", "reported", "set")
    for vertex in scope.steps:
        for key_state in key_states:
            here = Reached(vertex, key_state)
            for step, after in def_use._following(scope, key, here, stops):
                every: tuple[KeyState, ...] = (after,)
                if step.target in beside and after != "set":
                    every = ("set", after)
                for item in every:
                    target = Reached(step.target, item)
                    if not graph.has_edge(here, target):
                        graph.add_edge(here, target, outcome=step.outcome)
    if scope.path in flow.repeated:
        exits = [item for item in graph if def_use.is_exit(item.vertex) and item.state == "set"]
        graph.add_edges_from((exit_, Reached(START, "set")) for exit_ in exits)
    found: dict[Any, Any] = {}
    for before, here in nx.bfs_edges(graph, origin):
        starts = here.vertex == START
        found[here] = None if starts else (before, graph.edges[before, here]["outcome"])
    return found


def read_after_graph(scope: Any, start: str, key: str) -> Any:
    """`lost_outputs._read_after` in the graph of the steps that do not write the key."""
    import networkx as nx

    graph = nx.DiGraph()
    graph.add_node(start)
    for vertex, steps in scope.steps.items():
        graph.add_edges_from(
            (vertex, step.target)
            for step in steps
            if key not in step.writes.trusted and not step.writes.anything
        )
    found = (vertex for _, vertex in nx.bfs_edges(graph, start))
    return next((vertex for vertex in found if key in scope.reads.get(vertex, ())), None)


def sources_graph(self: Any, container: Any, path: str, key: str, goal: str | None) -> Any:
    """`reaching_values.search` in the graph of the steps that do not write the key."""
    import networkx as nx

    children = {child.name: child for child in container.children}
    graph, writers = nx.DiGraph(), list[tuple[Any, Any]]()
    for edge in edges(container):
        here = edge.source
        if here == START or reaching_values.replaces(children[str(here)], key, edge.outcome):
            writers.append((here, edge.target))
        else:
            graph.add_edge(here, edge.target)
    goals = [goal] if goal is not None else [item for item in graph if isinstance(item, tuple)]
    seen = {*goals}.union(*(nx.ancestors(graph, item) for item in goals if item in graph))
    return tuple(dict.fromkeys(here for here, target in writers if target in seen))


SEARCHES: dict[str, tuple[object, str, Search]] = {
    "def_use.search": (sys.modules["smachac.analysis.unset_reads"], "search", search_in_product),
    "lost_outputs._read_after": (lost_outputs, "_read_after", read_after_graph),
    "reaching_values.search": (reaching_values._Searches, "search", sources_graph),
}


@contextmanager
def replaced(owner: object, name: str, function: Search) -> Iterator[None]:
    old = getattr(owner, name)
    setattr(owner, name, function)
    try:
        yield
    finally:
        setattr(owner, name, old)


def measure(which: str, path: Path) -> tuple[float, float, float]:
    """The time of a check, of the search in it, and of the same with networkx, in ms."""
    from smachac import check

    owner, name, other = SEARCHES[which]
    ours = getattr(owner, name)
    spent = [0.0, 0.0]

    def both(*given: Any, **more: Any) -> Any:
        results = []
        for number, function in enumerate((ours, other)):
            began = time.process_time()
            results.append(function(*given, **more))
            spent[number] += time.process_time() - began
        first, second = results
        assert first == second or set(first) == set(second), which
        return first

    with replaced(owner, name, both):
        began = time.process_time()
        check(path)
        whole = time.process_time() - began
    assert spent[0], f"{which} was not called"
    return 1e3 * (whole - spent[1]), 1e3 * spent[0], 1e3 * spent[1]


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    sizes = [int(word) for word in sys.argv[2:]] or SIZES
    import_module("networkx")
    gc.disable()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "main.yml")
        for which in SEARCHES:
            path.write_text(script(which, 10, 1), "utf-8")
            code = "import sys; from smachac import check; check(sys.argv[1]);"
            loaded = cpu(f"{code} assert 'networkx' not in sys.modules", str(path))
            print(f"{which}: the check of 10 states takes {loaded:.0f} ms, without networkx")
        print(f"{'ms':<26}{'states':>8}{'faults':>8}{'check':>10}{'ours':>10}{'networkx':>10}")
        for which in SEARCHES:
            for size, faults in product(sizes, (1, 10)):
                path.write_text(script(which, size, faults), "utf-8")
                found = [measure(which, path) for _ in range(rounds)]
                best = [min(column) for column in zip(*found, strict=True)]
                times = "".join(f"{item:>10.2f}" for item in best)
                print(f"{which:<26}{size:>8}{faults:>8}{times}")
    print(f"import of networkx: {min(cpu('import networkx') for _ in range(rounds)):.0f} ms")


def cpu(code: str, *arguments: str) -> float:
    """The CPU time of some code in a process of its own, after the start of Python, in ms."""
    timed = f"import time; began = time.process_time(); {code}\nprint(time.process_time() - began)"
    command = [sys.executable, "-c", timed, *arguments]
    ended = subprocess.run(command, stdout=subprocess.PIPE, check=True)
    return 1e3 * float(ended.stdout)


if __name__ == "__main__":
    main()
