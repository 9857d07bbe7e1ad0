"""URDF, the robot description of ROS: joints with their limits, and links, from XML.

The parser is expat. A document type is refused, because it can expand a small file to a huge one or
refer to other files; size, depth and number of elements are bounded.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from xml.parsers import expat

from smachac.diagnostics.diagnostic import did_you_mean
from smachac.diagnostics.source import Source, Span
from smachac.ir.robot import Joint, Robot
from smachac.robots.description import UrdfJoint

MAX_CHARACTERS = 5_000_000
MAX_ELEMENTS = 100_000
MAX_DEPTH = 100

TURNING = frozenset(["revolute", "continuous"])
MOVING = TURNING | {"prismatic", "planar", "floating"}
KINDS = MOVING | {"fixed"}

JointChain = tuple[Joint, ...]
"""Consecutive joints, each a child of the previous one."""

XACRO = "expand the macro file with `xacro`, and name the resulting file"
TOO_LARGE = "name a smaller URDF file: one robot, without its meshes in the text"


_LOWER = re.compile(r"""\blower\s*=\s*(?:"[^"]*"|'[^']*')""")


class UrdfError(Exception):
    """A text that is not a robot description: the message, its span, and a line of help."""

    def __init__(self, message: str, span: Span, help: str) -> None:
        super().__init__(message)
        self.message, self.span, self.help = message, span, help


@dataclass(slots=True)
class _Link:
    """A joint of the file; `follows`: another joint moves it (`<mimic>`)."""

    joint: Joint
    kind: str
    parent: str = ""
    child: str = ""
    follows: bool = False
    limits: dict[str, str] = field(default_factory=dict)


def read_urdf(source: Source) -> Robot:
    """The robot that a text describes. Raises UrdfError."""
    name, joints, links = _read(source)
    turning = tuple(each.joint for each in joints.values() if each.kind in TURNING)
    return Robot(name=name, joints=turning, limbs=_limbs(joints, links), frames=links)


def read_joints(source: Source) -> tuple[dict[str, UrdfJoint], dict[str, Joint], frozenset[str]]:
    """All movable joints of a text with their limits, the joints that turn, and the links.

    Raises UrdfError.
    """
    _, joints, links = _read(source)
    known = {
        name: UrdfJoint(each.joint.lower, each.joint.upper, each.kind in TURNING)
        for name, each in joints.items()
        if each.kind in MOVING
    }
    turning = {name: each.joint for name, each in joints.items() if each.kind in TURNING}
    return known, turning, links


def joints_to(source: Source, link: str) -> tuple[str, ...]:
    """The movable joints from the root to a link. Raises UrdfError."""
    _, joints, _ = _read(source)
    above = {each.child: (name, each) for name, each in joints.items()}
    found: list[str] = []
    for _ in joints:
        name, joint = above.pop(link, ("", None))
        if joint is None:
            break
        link = joint.parent
        if joint.kind in MOVING:
            found.append(name)
    return tuple(reversed(found))


def _read(source: Source) -> tuple[str, dict[str, _Link], frozenset[str]]:
    """The name, the joints and the links of a text. Raises UrdfError."""
    reader = _Reader(source)
    reader.read()
    links = frozenset(reader.links)
    for each in reader.joints.values():
        for link in (each.parent, each.child):
            if link not in links:
                message = f"joint `{each.joint.name}` names the link `{link}`, which does not exist"
                near = did_you_mean(link, links) or f'add `<link name="{link}"/>` to the file'
                raise UrdfError(message, each.joint.span, near)
    joints = {name: replace(each, joint=_limited(each)) for name, each in reader.joints.items()}
    return reader.name, joints, links


class _Reader:
    """Receives the elements from expat."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.name = ""
        self.links: dict[str, None] = {}
        self.joints: dict[str, _Link] = {}
        self._open: list[str] = []
        self._starts: list[tuple[int, int]] = []  # of the open elements: line, column
        self._count = 0
        self._joint: _Link | None = None
        self._parser = expat.ParserCreate("utf-8")

    def read(self) -> None:
        text = self.source.text
        if len(text) > MAX_CHARACTERS:
            message = f"the file has {len(text):,} characters, more than {MAX_CHARACTERS:,}"
            raise self.error(message, help=TOO_LARGE)
        parser = self._parser
        parser.StartElementHandler = self.start
        parser.EndElementHandler = self.end
        parser.StartDoctypeDeclHandler = self.refuse
        parser.EntityDeclHandler = self.refuse
        try:
            parser.Parse(text.encode("utf-8", "replace"), True)
        except expat.ExpatError as error:
            words = expat.ErrorString(error.code)
            place = self.at(error.lineno, error.offset)
            if self._open and words == expat.errors.XML_ERROR_TAG_MISMATCH:
                raise self.mismatch(place) from None
            if self._open and words == expat.errors.XML_ERROR_NO_ELEMENTS:
                raise self.not_closed() from None
            raise UrdfError(
                f"the file is not valid XML: {words}",
                place,
                help="correct the tags there: each `<link>` needs its `</link>`, or `<link/>`",
            ) from None

    def mismatch(self, end: Span) -> UrdfError:
        """The error for an end tag whose name is at `end`, and not that of the innermost open
        element. Where an element around it has this name, the innermost one is not closed."""
        found = re.compile(r"[^\s<>]+").match(self.source.text, end.start)
        name = found.group() if found is not None else ""
        if not name or name in self._open:
            return self.not_closed()
        tag = self._open[-1]
        span = Span(self.source, end.start, end.start + len(name))
        message = f"`</{name}>` ends no element: `<{tag}>` in line {self._starts[-1][0]} is open"
        return UrdfError(message, span, help=f"write `</{tag}>`, or remove `</{name}>`")

    def not_closed(self) -> UrdfError:
        """The error that the innermost open element has no end tag."""
        tag = self._open[-1]
        start = self.at(*self._starts[-1]).start
        end = self.source.text.find(">", start)
        span = Span(self.source, start, end + 1)
        help = f"write `/>` at the end of this tag, or add `</{tag}>` after its content"
        return UrdfError(f"`<{tag}>` is not closed", span, help=help)

    def at(self, line: int, column: int) -> Span:
        starts = self.source.line_starts
        start = starts[min(line, len(starts)) - 1] + column
        start = min(start, len(self.source.text))
        return Span(self.source, start, min(start + 1, len(self.source.text)))

    def here(self, name: str = "") -> Span:
        """The span of the name in the current tag, or of the tag."""
        span = self.at(self._parser.CurrentLineNumber, self._parser.CurrentColumnNumber)
        text = self.source.text
        end = text.find(">", span.start)
        found = text.find(f'"{name}"', span.start, end if end > 0 else len(text)) if name else -1
        return span if found < 0 else Span(self.source, found + 1, found + 1 + len(name))

    def error(self, message: str, name: str = "", *, help: str) -> UrdfError:
        return UrdfError(message, self.here(name), help)

    def refuse(self, *_: object) -> None:
        message = "it has a document type, which can expand to a huge text"
        raise self.error(message, help="remove the lines with `<!DOCTYPE` and `<!ENTITY`")

    def start(self, tag: str, given: dict[str, str]) -> None:
        self._count += 1
        depth = len(self._open)
        if self._count > MAX_ELEMENTS or depth > MAX_DEPTH:
            message = f"it has more than {MAX_ELEMENTS:,} elements, or more than {MAX_DEPTH} levels"
            raise self.error(message, help=TOO_LARGE)
        if tag.startswith("xacro:"):
            raise self.error(f"`<{tag}>` is not an element of URDF", help=XACRO)
        above = self._open[-1] if self._open else ""
        self._open.append(tag)
        parser = self._parser
        self._starts.append((parser.CurrentLineNumber, parser.CurrentColumnNumber))
        if depth == 0:
            if tag != "robot":
                message = f"the outermost element is `<{tag}>`, not `<robot>`"
                help = "name a URDF file: its first tag is `<robot name=...>`"
                raise self.error(message, help=help)
            self.name = given.get("name", "")
        elif depth == 1 and tag in ("link", "joint"):
            self.part(tag, given)
        elif depth == 2 and above == "joint" and self._joint is not None:
            self.detail(tag, given, self._joint)

    def part(self, tag: str, given: dict[str, str]) -> None:
        name = given.get("name", "")
        known: Mapping[str, object] = self.links if tag == "link" else self.joints
        if not name:
            raise self.error(f"this {tag} has no name", help=f'write `<{tag} name="...">`')
        if name in known:
            help = "give one of the two another name, or remove one of them"
            raise self.error(f"there are two {tag}s `{name}`", name, help=help)
        if tag == "link":
            self.links[name] = None
            return
        kind = given.get("type", "")
        if kind not in KINDS:
            message = (
                f"joint `{name}` has the unknown type `{kind}`"
                if kind
                else f"joint `{name}` has no type"
            )
            help = did_you_mean(kind, KINDS) or f"the types are {', '.join(sorted(KINDS))}"
            raise self.error(message, name, help=help)
        self._joint = self.joints[name] = _Link(Joint(name=name, span=self.here(name)), kind)

    def detail(self, tag: str, given: dict[str, str], joint: _Link) -> None:
        match tag:
            case "parent":
                joint.parent = given.get("link", "")
            case "child":
                joint.child = given.get("link", "")
            case "mimic":
                joint.follows = True
            case "limit":
                joint.limits = given

    def end(self, tag: str) -> None:
        self._open.pop()
        self._starts.pop()


def _limited(link: _Link) -> Joint:
    """The joint with its limits; a missing attribute of `<limit>` is 0, by the URDF standard."""
    joint = link.joint
    if link.kind != "revolute" and not (link.kind == "prismatic" and link.limits):
        return replace(joint, velocity=_speed(link))
    if not link.limits:
        message = f"the revolute joint `{joint.name}` has no `<limit>`"
        raise UrdfError(
            message,
            joint.span,
            "add its limits, or use the type `continuous` for a joint without limits",
        )
    numbers = []
    for name in ("lower", "upper"):
        word = link.limits.get(name, "0")
        try:
            number = float(word)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            message = f"the {name} limit of joint `{joint.name}` is `{word}`, which is not a number"
            help = XACRO if "${" in word else f'write a number: `{name}="0.5"`'
            raise UrdfError(message, joint.span, help)
        numbers.append(number)
    low, high = numbers
    if low > high:
        message = f"the lower limit {low} of joint `{joint.name}` is above its upper limit {high}"
        given = link.limits.get("upper", "0"), link.limits.get("lower", "0")
        help = f'write `lower="{given[0]}" upper="{given[1]}"`: are the two'
        raise UrdfError(message, _limit_span(joint.span), f"{help} swapped?")
    return replace(joint, lower=low, upper=high, velocity=_speed(link))


def _limit_span(joint: Span) -> Span:
    """The place of the lower limit in a joint, by the place of its name; that of the name if the
    text has another form."""
    text = joint.source.text
    end = text.find("</joint>", joint.end)
    found = _LOWER.search(text, joint.end, end if end >= 0 else joint.end)
    return Span(joint.source, *found.span()) if found is not None else joint


def _speed(link: _Link) -> float:
    """The largest speed of a joint; infinite where the file has no positive number."""
    try:
        speed = float(link.limits.get("velocity", "0"))
    except ValueError:
        return math.inf
    return speed if speed > 0 else math.inf


def _limbs(joints: Mapping[str, _Link], links: Iterable[str]) -> tuple[tuple[Joint, ...], ...]:
    """The groups of joints that a list of angles may command: each part of the tree without a fork,
    alone or with the joints from the base to it. Joints that follow others are left out.
    """
    below: dict[str, list[_Link]] = {}
    for each in joints.values():
        below.setdefault(each.parent, []).append(each)
    children = {each.child for each in joints.values()}
    moving = _moving(joints.values())
    found: dict[tuple[Joint, ...], None] = {}
    todo: list[tuple[str, JointChain, JointChain]] = [
        (link, (), ()) for link in sorted(links) if link not in children
    ]
    seen: set[str] = set()
    while todo:
        link, chain, before = todo.pop()
        ways = [each for each in below.get(link, ()) if each.child in moving]
        if link in seen:
            continue
        seen.add(link)
        if len(ways) == 1:
            todo.append((ways[0].child, chain + _commanded(ways[0]), before))
            continue
        if chain:
            found |= {chain: None, (*before, *chain): None}
        todo += [(each.child, _commanded(each), (*before, *chain)) for each in reversed(ways)]
    return tuple(found)


def _commanded(link: _Link) -> tuple[Joint, ...]:
    return (link.joint,) if link.kind in TURNING and not link.follows else ()


def _moving(joints: Iterable[_Link]) -> set[str]:
    """The links that move relative to their parent, or that have such links below them."""
    above = {each.child: each for each in joints}
    found: set[str] = set()
    for each in above.values():
        link = each if each.kind in MOVING else None
        while link is not None and link.child not in found:
            found.add(link.child)
            link = above.get(link.parent)
    return found
