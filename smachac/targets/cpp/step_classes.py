"""Classes of the user for stepped machines, which have `step` in place of `execute`."""

from __future__ import annotations

from smachac.frontend.loader import Library
from smachac.ir.nodes import Leaf
from smachac.ir.traversal import walk
from smachac.ir.types import Bounds
from smachac.targets.cpp.declared_interface import class_method
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import Plan
from smachac.targets.cpp.types import UnportableError
from smachac.targets.cpp.user_classes import ClassCode, class_code, step_fields


def refuse_other_methods(plan: Plan, library: Library) -> None:
    """Refuses classes that have only the function of the other kind of machine, at the first state
    of each type, with the code to write."""
    types = plan.machine.state_types
    first: dict[str, Leaf] = {}
    for _, node in walk(plan.machine.root):
        if isinstance(node, Leaf) and node.type in types:
            first.setdefault(node.type, node)
    for name, leaf in first.items():
        code = class_code(types[name])
        method = class_method(code, library) if code is not None else None
        if code is None or not method:
            continue
        short = code.name.removeprefix("::")
        if plan.bounds is not None and method == "execute":
            text = f"`execute` of `{short}` blocks, and the class has no `step`"
            error = UnportableError(text, help=f"write `{_stub(code, plan.bounds)}`")
            plan.refuse(leaf.span, error, leaf.name, short)
        elif plan.bounds is None and method == "step":
            text = f"`{short}` has `step` for stepped machines, and no `execute`"
            help_ = "build with `--option mode=step`, or write a class with `execute`"
            plan.refuse(leaf.span, UnportableError(text, help=help_), leaf.name, short)


def _stub(code: ClassCode, bounds: Bounds) -> str:
    """The members to write in a class."""
    members, parameters = [], ["smachac::step::Context &context"]
    for part, name in (("In", "in"), ("Out", "out")):
        keys = code.type.input_keys if part == "In" else code.type.output_keys
        try:
            fields = step_fields(part, keys, bounds)
        except UnportableError:
            continue  # reported with its key
        if fields:
            inner = " ".join(f"{text} {identifier(field)};" for field, text in fields.items())
            members.append(f"struct {part} {{ {inner} }};".replace("& ", "&"))
            parameters.append(f"{part} {name}")
    step = f"smachac::step::Result<Outcome> step({', '.join(parameters)});"
    return " ".join([*members, step])
