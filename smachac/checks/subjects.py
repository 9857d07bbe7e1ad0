"""Subjects of rules: whether a machine has what a group of rules is about.

A group finds nothing in a machine without its subject, so its modules are not imported for one.
"""

from __future__ import annotations

from smachac.analysis.context import Context
from smachac.ir import nodes
from smachac.ir.nodes import DEFINITION_KINDS, Concurrence, Leaf, is_number
from smachac.ir.traversal import values


def every_machine(_: Context) -> bool:
    return True


def branches(context: Context) -> bool:
    """Concurrences, or loops, which have rules over outcomes as well."""
    return any(isinstance(node, Concurrence | nodes.Iterator) for _, node in context.containers)


def classes(context: Context) -> bool:
    """Classes in Python that were read."""
    return bool(context.leaves_with_class)


def texts(context: Context) -> bool:
    """Values that are no numbers, such as code, texts and lists; state types of the user, whose
    interfaces, classes and templates can contain some."""
    machine = context.machine
    if machine.variables or classes(context):
        return True
    if any(not type_.built_in for type_ in machine.state_types.values()):
        return True
    return any(
        (isinstance(node, Leaf) and (node.open or not node.built_in))
        or any(not is_number(value.data) for value in values(node))
        for _, node in context.states
    )


def userdata(context: Context) -> bool:
    """Keys, or code that can use some; declarations of the script that are not used."""
    return texts(context) or bool(context.machine.unused) or any(
        node.inputs or node.outputs or node.remaps
        or (not isinstance(node, Leaf) and node.userdata)
        or isinstance(node, nodes.Iterator)
        for _, node in context.states
    )  # fmt: skip


def robots(context: Context) -> bool:
    """A robot or the simulated world; poses, lists and units in values."""
    types = context.machine.state_types.values()
    has_robot = context.machine.robot is not None or any(type_.simulation for type_ in types)
    return has_robot or userdata(context)


def messages(context: Context) -> bool:
    """Messages of ROS: their types, keys that hold one, or code that can use one."""
    return (
        bool(context.machine.definitions)
        or bool(context.code_slots)
        or classes(context)
        or any(_has_messages(node) for _, node in context.states if isinstance(node, Leaf))
    )


def _has_messages(leaf: Leaf) -> bool:
    return any(held.role in DEFINITION_KINDS for held in leaf.variables) or any(
        key.role == "message" for key in leaf.inputs
    )


def properties(context: Context) -> bool:
    """Properties that the script declares."""
    return bool(context.machine.properties)


def user_code(context: Context) -> bool:
    """Classes and templates of the user."""
    from smachac.pysource.templates.template_sources import uses_own_templates

    project = context.project
    if classes(context):
        return True
    if project is None:
        return False
    facts = context.code_facts
    found = facts.classes or facts.faults or facts.bodies
    return bool(found) or uses_own_templates(context.machine, project.library)
