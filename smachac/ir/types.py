"""Types of userdata. `any` is what nothing is known of; it never complains.

The notation is grammars/type.lark; `str(type)` prints it and `parse_type` reads it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Type:
    """A type: its name and what it is applied to.

    `float<rad>` is `Type("float", ("rad",))`, `list[T]` is `Type("list", (T,))`, `T[7]` is
    `Type("array", (T, 7))`, `dict[str, T]` is `Type("dict", (T,))`, `T?` is
    `Type("optional", (T,))`, `one_of[a, b]` is `Type("one_of", ("a", "b"))`; anything else is a
    name alone (`bool`, `Pose`, `geometry_msgs/Pose`).
    """

    name: str
    args: tuple[Type | int | str, ...] = ()

    def __str__(self) -> str:
        match self.name, self.args:
            case "list", (item,):
                return f"list[{item}]"
            case "array", (item, size):
                return f"{item}[{size}]"
            case "dict", (item,):
                return f"dict[str, {item}]"
            case "optional", (item,):
                return f"{item}?"
            case "one_of", choices:
                return f"one_of[{', '.join(map(str, choices))}]"
            case name, (unit,):
                return f"{name}<{unit}>"
        return self.name


ANY = Type("any")
