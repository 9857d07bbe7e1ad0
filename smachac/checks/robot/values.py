"""Rules over literals: limits of interfaces, names of limbs, models and bodies, doubtful units."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from smachac.analysis.context import Context
from smachac.analysis.reaching_values import reaching_flows
from smachac.analysis.type_inference import Cell, TypeFlow
from smachac.analysis.type_lattice import inside, present, unit_of
from smachac.analysis.units import FULL_TURN, conversion, other_units
from smachac.checks.findings.help_text import calls, did_you_mean, other_place, own_name
from smachac.checks.findings.literals import literal_finding
from smachac.checks.findings.value_places import Part, parts_of, place_of_part, steps_to_number
from smachac.checks.robot.joint_limits import joint_faults
from smachac.checks.robot.literal_parts import moves_arm, names_in, part_named, role_of
from smachac.checks.robot.misnamed_bodies import misnamed_body
from smachac.checks.robot.simulated_world import is_simulated, loaded_too_late, uses_simulation
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import both, either, listed
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Data, Leaf, Limits, StateType, Struct, VariableType, is_number
from smachac.ir.types import Type
from smachac.records import replace

TYPE_CHECKING = False  # annotations only: few scripts have a robot
if TYPE_CHECKING:
    from smachac.ir.robot import Robot


@rule(
    "SM520",
    "out-of-limits",
    Severity.ERROR,
    effect="the number is used as it is",
)
def out_of_limits(context: Context) -> Iterator[Finding]:
    """A number is outside the limits that the interface of a state type gives.

    A speed of 0 never reaches its goal, and a negative waiting time has no meaning. The state
    fails, or the robot stays where it is until a time limit ends the task.

    Exactly: the limits are `min`, `max`, `exclusive` and `one_of` of a variable or an input key in
    the interface. The rule checks the literals that reach it, through userdata, params and
    remappings, and the defaults in the interface. In a list or mapping, each number is checked.

    Wrong:
        name: sm
        template: PyBulletBase
        outcomes: [done, failed]
        userdata: {home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}
        states:
          - MOVE:
              template: MoveToJointPositionsState
              speed: 0
              remapping: {positions: home}
              transitions: {succeeded: done, aborted: failed, preempted: failed}

    Right:
        name: sm
        template: PyBulletBase
        outcomes: [done, failed]
        userdata: {home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}
        states:
          - MOVE:
              template: MoveToJointPositionsState
              speed: 0.5
              remapping: {positions: home}
              transitions: {succeeded: done, aborted: failed, preempted: failed}
    """
    types = context.machine.state_types
    limits = {name: found for name, type_ in types.items() if (found := _limits(type_))}
    wrong = []
    for flow in context.types.constants if limits else ():
        held = limits.get(_type_name(context, flow.cell), {}).get((flow.cell.role, flow.cell.key))
        if held is not None and _outside(flow.value, held):
            wrong.append((flow, held))
    arriving = {flow.origin for flow in reaching_flows(flow for flow, _ in wrong)}
    for flow, held in wrong:
        if flow.origin in arriving:
            yield from _out_of(flow, held)
    for type_ in types.values():
        yield from _wrong_defaults(type_)


def _limits(type_: StateType) -> Mapping[tuple[str, str], Limits]:
    """The limits of a state type, by the role and the key of a cell."""
    variables = (
        (("variable", variable.name), variable.limits) for variable in type_.variables.values()
    )
    inputs = ((("input", key.name), key.limits) for key in type_.input_keys)
    return {cell: limits for cell, limits in (*variables, *inputs) if limits is not None}


def _type_name(context: Context, cell: Cell) -> str:
    return cell.node.type if cell.node is not None else context.machine.base


def numbers(data: Data) -> Iterator[int | float]:
    """The numbers in a literal, at any depth."""
    if is_number(data):
        yield data
    elif isinstance(data, tuple):
        for item in data:
            yield from numbers(item)
    elif isinstance(data, Struct):
        for _, item in data.entries:
            yield from numbers(item)


def _outside(data: Data, limits: Limits) -> list[int | float]:
    """The numbers in a literal that are outside of limits."""
    return [number for number in numbers(data) if not _is_within(number, limits)]


def _is_within(number: int | float, limits: Limits) -> bool:
    if limits.choices and number not in limits.choices:
        return False
    if limits.exclusive:
        return limits.least < number < limits.most
    return limits.least <= number <= limits.most


def _out_of(flow: TypeFlow, limits: Limits) -> Iterator[Finding]:
    """One finding for each number of a literal that is outside of limits."""
    origin, cell = flow.origin.cell, flow.cell
    kind = "variable" if cell.role == "variable" else "key"
    owner = f"`{cell.node.name}`" if cell.node is not None else "the base"
    unit = unit_of(_item(cell.declared))
    more: tuple[Related, ...] = ()
    place = flow.origin.span
    if cell is origin and place.source is cell.span.source and place.end <= cell.span.start:
        more = (Related(span=cell.span, message=f"`{cell.key}` of {owner} is set here"),)
    for number in dict.fromkeys(_outside(flow.value, limits)):
        held = "is" if number == flow.value else "contains"
        message = f"`{origin.key}` {held} {number}, but the {kind} `{cell.key}` of {owner} must be"
        help = f"write {'' if limits.choices else 'a number '}{in_words(limits)}"
        help += (f", in `{unit}`" if unit else "") + _converted(number, unit, limits)
        finding = literal_finding(
            flow,
            f"{message} {in_words(limits)}",
            help,
            (str(number),),
            part=Part(steps_to_number(flow.value, number)),
            more=more,
        )
        effect = f"the number is used as it is: {owner} works with {number} {unit}".rstrip()
        yield replace(finding, effect=effect)


def _converted(number: int | float, unit: str, limits: Limits) -> str:
    """The end of a help for a number that is within the limits if it is in another unit: 12 mm, or
    70 % of a ratio."""
    for other in other_units(unit):
        factor = conversion(other, unit)
        if factor is not None and _is_within(number * factor, limits):
            return f"; {number} `{other}` is `{number * factor:.6g}`"
    is_ratio = not unit and limits.least >= 0 and limits.most == 1
    if is_ratio and number > 1 and _is_within(number / 100, limits):
        return f"; {number} % is `{number / 100:.6g}`"
    return ""


def in_words(limits: Limits) -> str:
    """Limits as the end of a sentence: "greater than 0"."""
    if limits.choices:
        return f"one of {', '.join(f'`{choice}`' for choice in limits.choices)}"
    least, most = (f"{bound:g}" for bound in (limits.least, limits.most))
    if limits.most == math.inf:
        return f"greater than {least}" if limits.exclusive else f"{least} or greater"
    if limits.least == -math.inf:
        return f"less than {most}" if limits.exclusive else f"{most} or less"
    if limits.exclusive:
        return f"greater than {least} and less than {most}"
    return f"from {least} to {most}"


def _item(type_: Type) -> Type:
    """The innermost type of the items of lists and mappings."""
    while type_.name in ("optional", "list", "array", "dict") and type_.args:
        type_ = inside(type_)
    return type_


def _wrong_defaults(type_: StateType) -> Iterator[Finding]:
    """The defaults of an interface that are outside of its own limits."""
    for variable in type_.variables.values():
        if variable.default is None or variable.limits is None:
            continue
        for number in dict.fromkeys(_outside(variable.default.data, variable.limits)):
            words = in_words(variable.limits)
            yield Finding(
                span=variable.default.span,
                message=f"the default of `{variable.name}` is {number}, but it must be {words}",
                arguments=(variable.name, str(number)),
                help=f"write a default that is {words}, or remove it: then each state must set"
                f" `{variable.name}`",
            )


@rule(
    "SM521",
    "unknown-name",
    Severity.WARNING,
    effect="the state fails at its first visit",
)
def unknown_name(context: Context) -> Iterator[Finding]:
    """A value names a limb, a model or a body that does not exist, or a necessary limb is missing.

    The state fails at its first visit, often after the robot has moved other parts of the task.

    Exactly: `names: limb`, `names: model` and `names: body` of a variable or key in an interface
    declare that its values are such names. Limbs are those of a built-in robot. In the simulation,
    models are the built-in ones, unless the state names a file, and bodies are those that
    LoadModelState adds; there an unknown name is an error. So is a body that no path loads before a
    state of the simulation uses it, unless the state leads to the loading one when it fails. Where
    code of the user may add bodies, they are not checked. A state whose type has `role: grip` needs
    a limb whose description has a gripper. A variable with `names: limb` needs a value if the robot
    has more than one limb: null is the only arm. SM505 checks names of frames and joints.

    Wrong:
        name: sm
        template: PyBulletBase
        outcomes: [done, failed]
        userdata: {place: [0.5, 0.0, 0.02]}
        states:
          - LOAD:
              template: LoadModelState
              model_name: blok
              remapping: {pose: place}
              transitions: {succeeded: done, aborted: failed}

    Right:
        name: sm
        template: PyBulletBase
        outcomes: [done, failed]
        userdata: {place: [0.5, 0.0, 0.02]}
        states:
          - LOAD:
              template: LoadModelState
              model_name: block
              remapping: {pose: place}
              transitions: {succeeded: done, aborted: failed}
    """
    known = _known_things(context)
    wrong = []
    for flow in context.types.constants if known else ():
        role = role_of(flow.cell)
        if role == "model" and _names_a_file(flow.cell):
            continue
        if any(name not in known[role] for name in names_in(flow.value) if role in known):
            wrong.append(flow)
    severity = Severity.ERROR if is_simulated(context) else None
    arriving = [*reaching_flows(wrong)]
    misnamed = misnamed_body(context, arriving, known.get("body", frozenset()))
    if misnamed is not None:
        finding, about = misnamed
        yield replace(finding, severity=severity)
        arriving = [flow for flow in arriving if flow not in about]
    for flow in arriving:
        role = role_of(flow.cell)
        guess = guesser(sorted(known[role]))
        for name in dict.fromkeys(names_in(flow.value)):
            if name not in known[role]:
                near = guess(name)
                help = did_you_mean(near) or _things_in_words(role, known[role])
                message = f"there is no {role} `{name}`"
                places = _in_scene(context, near) if role == "body" else ()
                finding = literal_finding(flow, message, help, (name,), more=places)
                yield replace(finding, severity=severity)
    if is_simulated(context):
        yield from _late_bodies(context)
    yield from _missing_grippers(context, severity)
    yield from _missing_limbs(context, sorted(known.get("limb", ())), severity)


def _late_bodies(context: Context) -> Iterator[Finding]:
    """The bodies that are loaded only after the state that names them."""
    robot = context.machine.robot
    if robot is None or "body" not in _known_things(context):
        return
    given = robot.added | robot.scene
    flows = [
        flow
        for flow in context.types.constants
        if role_of(flow.cell) == "body" and uses_simulation(context, flow.cell)
    ]
    for flow in reaching_flows(flows):
        for name in dict.fromkeys(names_in(flow.value)):
            if name not in given:
                part = part_named(flow.value, name)
                help = f"remove `{name}`: the state names its own body"
                yield from loaded_too_late(context, flow, name, "body", help, part=part)


def _missing_grippers(context: Context, severity: Severity | None) -> Iterator[Finding]:
    """The states that open or close the gripper of an arm that has none."""
    robot = context.machine.robot
    without = [arm.name for arm in robot.arms if arm.limb.gripper is None] if robot else []
    if robot is None or not without:
        return
    for path, leaf in context.leaves_with_variables:
        held = variable_of(leaf, "grip")
        if held is None:
            continue
        limb = variable_of(leaf, "limb")
        named = limb.value.data if limb is not None else None
        if named is None and len(robot.arms) == 1:
            named = without[0]
        if named in without:
            yield Finding(
                span=limb.value.span if limb is not None and limb.value.data else leaf.span,
                message=f"`{leaf.name}` moves the gripper of the limb `{named}`, which has none",
                arguments=(leaf.name, str(named)),
                help=f"describe its `gripper` in `{robot.description}`, or remove the state",
                related=calls(leaf, leaf.span),
                severity=severity,
                node=path,
            )


def _missing_limbs(
    context: Context, limbs: Sequence[str], severity: Severity | None
) -> Iterator[Finding]:
    """The states that name no limb of a robot with several: no value means the only limb."""
    robot = context.machine.robot
    types = context.machine.state_types
    names = {name: variable for name, type_ in types.items() if (variable := _limb_of(type_))}
    if robot is None or len(limbs) < 2 or not names:
        return
    count = {2: "two", 3: "three", 4: "four"}.get(len(limbs), str(len(limbs)))
    for path, leaf in context.states:
        variable = names.get(leaf.type) if isinstance(leaf, Leaf) else None
        if not isinstance(leaf, Leaf) or variable is None:
            continue
        given = next((other for other in leaf.variables if other.name == variable.name), None)
        value = given.value if given is not None else variable.default
        if value is None or value.data is not None:
            continue
        span = given.value.span if given is not None else leaf.span
        yield Finding(
            span=span,
            message=f"`{leaf.name}` names no limb, but `{robot.name}` has {count}: {both(limbs)}",
            arguments=(own_name(leaf, span), variable.name),
            help=f"write {either(f'{variable.name}: {limb}' for limb in limbs)}",
            effect="the program stops with UnknownNameError when the state starts"
            if leaf.built_in
            else None,
            related=calls(leaf, span),
            severity=severity,
            node=path,
        )


def _limb_of(type_: StateType) -> VariableType | None:
    """The variable of a state type that names one limb."""
    held = (variable for variable in type_.variables.values() if variable.role == "limb")
    several = ("list", "array", "dict")
    return next((type_ for type_ in held if present(type_.type).name not in several), None)


def _known_things(context: Context) -> Mapping[str, frozenset[str]]:
    """The limbs, models and bodies that are known, by role; a role without an entry is not."""
    robot, simulated = context.machine.robot, is_simulated(context)
    known: dict[str, frozenset[str]] = {}
    if robot is not None and robot.limb_names and (simulated or len(robot.limb_names) > 1):
        known["limb"] = frozenset(robot.limb_names)
    bodies = context.bodies_loaded if simulated and robot is not None else None
    scene = any(
        variable.name == "scene" and variable.value.data for variable in context.machine.variables
    )
    if bodies is not None and robot is not None and (robot.scene or not scene):
        known["body"] = frozenset(bodies.values()) | robot.added | robot.scene
    if simulated:
        from smachac.ir.robot import MODELS

        known["model"] = frozenset(MODELS)
    return known


def _in_scene(context: Context, name: str | None) -> tuple[Related, ...]:
    """The place of a body in the file of the scene."""
    robot = context.machine.robot
    found = [body for body in (robot.bodies if robot is not None else ()) if body.text == name]
    return other_place(found[0].span, f"the scene has the body `{name}`") if found else ()


def _things_in_words(role: str, known: frozenset[str]) -> str:
    if known:
        names = sorted(known)
        return f"use one of {listed(names)}" if len(names) > 1 else f"write `{names[0]}`"
    return f"add a state that loads the {role} before this state"


def _names_a_file(cell: Cell) -> bool:
    """Whether the state of a cell names the file of its model."""
    held = variable_of(cell.node, "model_file") if isinstance(cell.node, Leaf) else None
    return held is not None and held.value.data is not None


FARTHEST = 10.0
"""In metres: no arm reaches so far, and no body of the simulation is so far from it."""

POINTS = frozenset(["Point", "Pose", "Transform"])


@rule(
    "SM522",
    "doubtful-unit",
    Severity.WARNING,
    effect="the arm stops at a limit, or cannot reach the point",
)
def doubtful_unit(context: Context) -> Iterator[Finding]:
    """A number is so large that it seems to be in degrees or millimetres.

    smachac counts in radians and metres. Ninety radians turn a joint fourteen times, and a point at
    500 metres is out of reach, so the arm stops at a limit or the skill fails.

    Exactly: reported are joint positions of more than a full turn that a state reads as
    `list[float<rad>]`, `float<rad>[N]` or, by joint names, `dict[str, float<rad>]`; whole numbers
    of more than 2 pi under any other type in `rad`, also in a field of a record, as the default of
    a variable in an interface, and where code compares them with a value in `rad`; and coordinates
    of more than 10 metres that a state that uses the simulated world, or claims an arm or a
    gripper, reads as `Point`, `Pose` or `Transform`. Where the robot is known, SM502 reports what
    is outside the limits of a joint, and this rule multiples of 5 rad for a joint without limits.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {home: [0, -45, 0, -135, 0, 90, 45]}
        states:
          - MOVE:
              template: ScriptedState
              input_keys: {joints: "float<rad>[7]"}
              remapping: {joints: home}
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}
        states:
          - MOVE:
              template: ScriptedState
              input_keys: {joints: "float<rad>[7]"}
              remapping: {joints: home}
              outcomes: [done]
              transitions: {done: done}
    """
    types = context.machine.state_types
    simulated = frozenset(name for name, type_ in types.items() if type_.simulation)
    large: dict[TypeFlow, bool] = {}
    wrong = []
    for constant in context.types.constants:
        origin = constant.origin
        if origin not in large:
            large[origin] = any(min(FULL_TURN, FARTHEST) < abs(x) for x in numbers(origin.value))
        if large[origin] and (_degrees(constant) or _millimetres(constant, simulated)):
            wrong.append(constant)
    flows: dict[Span, list[TypeFlow]] = {}
    for flow in reaching_flows(wrong):
        flows.setdefault(flow.origin.span, []).append(flow)
    for alike in flows.values():
        yield from _doubtful(alike, simulated, context.machine.robot)
    for type_ in types.values():
        yield from _doubtful_defaults(type_)
    if context.expression_faults:
        from smachac.checks.robot.units import doubtful_comparisons

        yield from doubtful_comparisons(context)
    if context.leaves_with_class:
        from smachac.checks.findings.class_value_types import wrong_operations

        yield from wrong_operations(context, "doubt")


def _doubtful_defaults(type_: StateType) -> Iterator[Finding]:
    """The defaults of an interface that seem to be in degrees; those outside of its own limits are
    reported by SM520."""
    for variable in type_.variables.values():
        default = variable.default
        if default is None or (variable.limits and [*_outside(default.data, variable.limits)]):
            continue
        for steps, angle in _large_angles(default.data, variable.type):
            yield Finding(
                span=place_of_part(default.span, steps),
                message=f"the default of `{variable.name}` {'contains' if steps else 'is'} {angle},"
                " which is read in radians: is it in degrees?",
                arguments=(variable.name, str(angle)),
                help=f"if it is in degrees, write {_radians(default.data, angle)}",
            )


def _doubtful(
    flows: list[TypeFlow], simulated: frozenset[str], robot: Robot | None
) -> Iterator[Finding]:
    """The finding for a literal that seems to be in another unit; `flows` lead to its readers."""
    flow = flows[0]
    degrees = _degrees(flow)
    joints = [flow for flow in flows if robot is not None and moves_arm(flow)]
    if degrees and joints:
        assert robot is not None
        # A joint without limits may turn several times, but hardly by 90 rad.
        faults = any(joint_faults(joint, robot) for joint in joints)
        degrees = [] if faults else [degree for degree in degrees if degree[1] % 5 == 0]
        if not degrees:
            return
    effect: str | None = None
    if degrees:
        part, value = degrees[0]
        effect = None if joints else "the angle is used as it is: it is more than a full turn"
        unit, meant = "radians", "degrees"
        help = f"if it is in degrees, write {_radians(flow.value, value)}"
    else:
        value, unit, meant = _millimetres(flow, simulated)[0], "metres", "millimetres"
        help = f"if it is in millimetres, write {_metres(flow.value, value)}"
        part = steps_to_number(flow.value, value)
    held = "is" if value == flow.value else "contains"
    message = f"`{flow.origin.cell.key}` {held} {value}, which is read in {unit}"
    message += f": is it in {meant}?"
    finding = literal_finding(flow, message, help, (str(value), unit), part=Part(part))
    yield replace(finding, effect=effect)


def _metres(data: Data, value: float) -> str:
    """A coordinate in millimetres in metres; the whole point if all its numbers are so large."""
    point = data[0] if isinstance(data, tuple) and data and isinstance(data[0], tuple) else data
    every = [number for number in point if is_number(number)] if isinstance(point, tuple) else []
    if len(every) != 3 or not all(number == 0 or 1 <= abs(number) < math.inf for number in every):
        return f"{value / 1000:g}"
    return f"the point as `[{', '.join(f'{number / 1000:g}' for number in every)}]`"


def _radians(data: Data, angle: float) -> str:
    """An angle in degrees in radians; a list of numbers that contains it as a whole."""
    if not isinstance(data, tuple):
        return f"`{math.radians(angle):.4f}`"
    angles = [number for number in data if isinstance(number, int | float)]
    if angle not in angles or len(angles) < len(data) or len(data) > 12:
        return f"`{math.radians(angle):.4f}`"
    return f"the list in radians: `[{', '.join(f'{math.radians(angle):.4g}' for angle in angles)}]`"


def _degrees(flow: TypeFlow) -> list[tuple[tuple[int | str, ...], int | float]]:
    """The angles in a literal that seem to be in degrees, each with the steps to it."""
    return [] if _in_other_unit(flow) else [*_large_angles(flow.value, flow.cell.declared)]


def _large_angles(
    data: Data, wanted: Type, steps: tuple[int | str, ...] = ()
) -> Iterator[tuple[tuple[int | str, ...], int | float]]:
    """The angles in radians of more than a full turn: any in a list or by joint names, otherwise
    whole numbers."""
    wanted = present(wanted)
    inner = _item(wanted)
    if inner.name == "record":
        for step, part, type_ in parts_of(data, wanted):
            yield from _large_angles(part, type_, (*steps, step))
    elif unit_of(inner) == "rad":
        joints = wanted.name in ("list", "array", "dict")
        for fromkey in dict.fromkeys(numbers(data)):
            if FULL_TURN < abs(fromkey) < math.inf and (joints or float(fromkey).is_integer()):
                yield (*steps, *steps_to_number(data, fromkey)), fromkey


def _in_other_unit(flow: TypeFlow) -> bool:
    """Whether the script declares another unit on the way of a literal, which SM504 reports."""
    before = flow.before
    while before is not None:
        if unit_of(_item(before.cell.declared)) not in ("", "rad"):
            return True
        before = before.before
    return False


def _millimetres(flow: TypeFlow, simulated: frozenset[str]) -> list[int | float]:
    """The coordinates in a literal that seem to be in millimetres. `simulated` are the state types
    that use the simulated world."""
    node, wanted = flow.cell.node, present(flow.cell.declared)
    if wanted.name not in POINTS or not isinstance(node, Leaf) or flow.cell.role == "output":
        return []
    value = flow.value
    point = value[0] if isinstance(value, tuple) and len(value) == 2 else value
    if not isinstance(point, tuple):
        return []
    large = [number for number in numbers(point) if FARTHEST < abs(number) < math.inf]
    if not large:
        return []
    parts = [claim.partition(".")[0] for claim in node.claims]
    in_reach = "arm" in parts or "gripper" in parts or role_of(flow.cell) == "goal_pose"
    return large if in_reach or node.type in simulated else []
