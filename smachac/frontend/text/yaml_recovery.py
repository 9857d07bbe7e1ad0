"""Repairs of a lost or wrong sign in YAML: a bracket, a quote, a comma, a colon, its space.

Many such texts are YAML all the same, with another meaning: `{done READY}` is a key without a
value. One sign is written, removed or replaced in the lines of the fault, for trial; a repair is
taken if these lines, and the text as a whole, then have the form of a script. The finding is about
the sign, and the rest of the script is checked as repaired.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.source import Source, Span
from smachac.frontend.errors.script import yaml_syntax
from smachac.frontend.schema import KEY_FACTS, LONG, OUTCOME_FACTS, VARIABLE_FACTS, VARIABLES
from smachac.frontend.text.fields import PRESET_FIELDS
from smachac.frontend.text.yaml_errors import (
    CONFLICT,
    SPACE_MISSING,
    line_end,
    lost_of_block_text,
)
from smachac.frontend.text.yaml_indents import best_move, move_finding, moved_text
from smachac.frontend.text.yaml_tree import (
    Entry,
    Map,
    OffsetMap,
    ParseAnomalies,
    Scalar,
    Seq,
    Tree,
    parse,
)

MOST_CHANGES, MOST_CHARACTERS = 5, 50_000
"""The most repairs of a text, and the longest text that is repaired."""

_MOST_LINES, _LONGEST, _MOST_TRIALS, _MOST_WHOLE = 30, 1_500, 400, 4
"""Limits of the lines of one repair, of their characters, of the repairs that are tried in them,
and of those that are tried in the whole text."""


class _Lines(NamedTuple):
    """Lines of a text that belong together, from the index `start` to `end`."""

    start: int
    end: int


class _Change(NamedTuple):
    """A repair: at the index `at`, `written` takes the place of `removed`."""

    at: int
    removed: str
    written: str

    def apply(self, text: str) -> str:
        return text[: self.at] + self.written + text[self.at + len(self.removed) :]

    def moved(self, by: int) -> _Change:
        return self._replace(at=self.at + by)


def recovered(
    source: Source, tree: Tree | None, found: Report, anomalies: ParseAnomalies, report: Report
) -> Tree | None:
    """The tree of a text without a lost or wrong sign. `tree`, `found` and `anomalies` are those of
    the text as it is."""
    if len(source.text) > MOST_CHARACTERS:
        report.extend(found)
        return tree
    if anomalies.stops and CONFLICT.search(source.text) is not None:
        report.extend(found)
        return tree
    text, offsets, sure = source.text, OffsetMap(source.text, ()), True
    reports: Report = []
    tried: set[int] = set()
    while len(offsets.changes) < MOST_CHANGES:
        best = _best_change(text, anomalies, tried)
        if best is None:
            moved = _moved(source, text, offsets, anomalies, reports)
            if moved is None:
                break
            text, offsets, anomalies = moved
            continue
        change, is_only = best
        sure = sure and is_only
        repaired = change.apply(text)
        reports.append(_finding(source, offsets, text, repaired, change, bool(anomalies.stops)))
        size = (change.at, len(change.removed), len(change.written))
        text, offsets = repaired, OffsetMap(repaired, (*offsets.changes, size))
        anomalies = ParseAnomalies([], [], [])
        parse(Source(source.name, text), [], anomalies)
    if not reports:
        report.extend(found)
        return tree
    report.extend(reports)
    if anomalies.stops or not sure:
        return None
    return parse(source, report, None, offsets)


def _moved(
    source: Source, text: str, offsets: OffsetMap, anomalies: ParseAnomalies, reports: Report
) -> tuple[str, OffsetMap, ParseAnomalies] | None:
    """The text in which a wrong indentation is corrected, which is reported, the changes up to it,
    and the anomalies that are left; None without one."""
    for index in (*anomalies.stops, *(() if anomalies.stops else anomalies.steps)):
        move = best_move(text, index, stops=bool(anomalies.stops))
        if move is None:
            continue
        repaired, changed = moved_text(text, move, offsets)
        left = ParseAnomalies([], [], [])
        parse(Source(source.name, repaired), [], left)
        if not left.stops or (anomalies.stops and min(left.stops) > max(anomalies.stops) + _BEYOND):
            reports.append(move_finding(source, text, offsets, move, stops=bool(anomalies.stops)))
            return repaired, changed, left
    return None


def _best_change(
    text: str, anomalies: ParseAnomalies, tried: set[int]
) -> tuple[_Change, bool] | None:
    """The best change for the first anomaly, and whether no other is as good; None if none repairs
    it. `tried` are the beginnings of the lines in which none did."""
    stops = bool(anomalies.stops)
    best: tuple[float, _Change] | None = None
    costs: list[float] = []
    seen: set[_Lines] = set()
    for index in [*anomalies.stops, *(() if stops else anomalies.places)]:
        colon = _lost_colon(text, index) if stops else None
        if colon is not None and _holds(colon.apply(text), _lines(text, colon.at), stops):
            return colon, True
        lines = _lines(text, index)
        if stops and lost_of_block_text(text, index) is not None:
            continue
        if lines.start in tried or lines in seen or lines.end - lines.start > _LONGEST:
            continue
        seen.add(lines)
        for cost, change in _ranked(text, lines)[:_MOST_WHOLE]:
            if not _holds(change.apply(text), lines, stops):
                continue
            costs.append(cost)
            if best is None or cost < best[0]:
                best = (cost, change)
        if best is None:
            tried.add(lines.start)
        elif not stops:
            break
    return (best[1], costs.count(best[0]) == 1) if best is not None else None


_KEY_ALONE = re.compile(r"( *)(?:- +)*[A-Za-z_][\w-]* *\n(?=\1 +(?:- +)*[\w-]+:(?: |\n))")


def _lost_colon(text: str, index: int) -> _Change | None:
    """The colon of a key that is alone on the line of an index, with entries below it."""
    found = _KEY_ALONE.match(text, text.rfind("\n", 0, index) + 1)
    return _Change(len(found[0].rstrip()) + found.start(), "", ":") if found is not None else None


def _holds(text: str, lines: _Lines, stops: bool) -> bool:
    """Whether a repaired text is YAML up to the end of the repaired lines and some lines more."""
    anomalies = ParseAnomalies([], [], [])
    parse(Source("", text), [], anomalies)
    if not stops:
        return not anomalies.stops
    return all(stop > lines.end + _BEYOND for stop in anomalies.stops)


_BEYOND = 2
"""How far from the repaired lines the next fault is, in characters."""

_GOES_ON = (",", "[", "{")


def _lines(text: str, index: int) -> _Lines:
    """The lines around an index that belong to one value in brackets."""
    start = text.rfind("\n", 0, index) + 1
    for _ in range(_MOST_LINES):
        above = text[: max(0, start - 1)]
        begin = above.rfind("\n") + 1
        if not start or not above[begin:].rstrip().endswith(_GOES_ON):
            break
        start = begin
    end = line_end(text, index)
    for _ in range(_MOST_LINES):
        line = text[text.rfind("\n", 0, end) + 1 : end].rstrip()
        if end >= len(text) or not line.endswith(_GOES_ON):
            break
        end = line_end(text, end + 1)
    return _Lines(start, end)


def _ranked(text: str, lines: _Lines) -> list[tuple[float, _Change]]:
    """The repairs of lines after which they have the form of a script, the best first."""
    part = text[lines.start : lines.end]
    if part.rstrip().endswith(_GOES_ON):
        return []  # it is still being written
    before = _cost(part, text)
    most = 1.0 if before is None else min(1.0, before - 0.3)
    ranked: list[tuple[float, _Change]] = []
    made = {change.apply(part): change for change in islice(_changes(part), _MOST_TRIALS)}
    for repaired, change in made.items() if most > 0 else ():
        cost = _cost(repaired, text)
        if cost is not None and cost < most:
            ranked.append(
                (cost + 0.1 * bool(change.removed.strip(" =")), change.moved(lines.start))
            )
    return sorted(ranked, key=lambda pair: (pair[0], _order(pair[1])))


def _order(change: _Change) -> int:
    """The order of repairs that are equally good: a bracket is closed as late as possible."""
    return -change.at if change.written in ("]", "}") else change.at


_QUOTED = re.compile(r"""(?<![^\s\[{,:(])(?:"(?:[^"\\]|\\.)*"|'(?:[^']|'')*')(?!\w)""")
_COMMENT = re.compile(r"(?:^|\s)#.*", re.M)
_START = re.compile(
    r"(?:[\[{,(]|(?<![:\w]):(?= )|(?<=\w):(?= )|^\s*-(?= )) *(?=[^\s,\]}])|^\s*(?=\S)", re.M
)
_END = re.compile(r"(?<=\{)(?=,)|(?<=[^\s\[{,])(?=\s*(?:[,\]}]|$))|(?<=\w)(?=: )", re.M)
_EQUALS = re.compile(r"(?<=[\w\"'\0]) ?(?<![=<>!])=(?!=) ?(?=[\w\[{\"'.\0-])")
_NO_SPACE = re.compile(r"(?<=\w):(?=[\w\[{\"'.\0-])(?<!::)")
_GAP = re.compile(r"(?<=[\w\]})>?\"'\0])(?= +[\w\[{\"'.\0-])")

_LISTED = ("on", "one_of", "outcomes", "loop_outcomes", "input_keys", "output_keys", "claims")
_NUMBER = r"[-+]?\d*\.?\d+"
_NUMBER_LIST = re.compile(rf"(?<=\w: )({_NUMBER}(?:, +{_NUMBER})+)(?=,? *[}}]|, *\w+:)")
_NAME_LIST = re.compile(rf"\b(?:{'|'.join(_LISTED)}): (\w+(?:, *\w+)+)(?=,? *}}|, *\w+:)")
"""A list without its brackets in a mapping in braces: `{value: 0.9, 1.2}`."""


def _changes(part: str) -> Iterator[_Change]:
    """The repairs of a part of a text that are possible."""
    plain = _QUOTED.sub(lambda found: "\0" * len(found[0]), part)
    comment = _COMMENT.search(plain)
    if comment is not None and "\n" not in plain:
        plain = plain[: comment.start()]
    quotes = [quote for quote in "\"'" if quote in plain]
    for quote in quotes:
        yield from _with_sign(part, quote, quote)
    for opening, closing in (("{", "}"), ("[", "]")):
        surplus = plain.count(opening) - plain.count(closing)
        if surplus:
            missing, much = (closing, opening) if surplus > 0 else (opening, closing)
            yield from _with_sign(plain, missing, much)
    for found in (*_NUMBER_LIST.finditer(plain), *_NAME_LIST.finditer(plain)):
        yield _Change(found.start(1), found[1], f"[{found[1]}]")
    if quotes:
        return
    for found in _EQUALS.finditer(plain):
        yield _Change(found.start(), found[0], ": ")
    for found in _NO_SPACE.finditer(plain):
        yield _Change(found.end(), "", " ")
    for found in _GAP.finditer(plain):
        if plain.endswith("lambda", 0, found.start()) or " in " in plain:
            continue  # code without quotes, or a loop in the words of Python
        yield _Change(found.start(), "", ":")
        yield _Change(found.start(), "", ",")


def _with_sign(part: str, missing: str, much: str) -> Iterator[_Change]:
    """The repairs that write a sign where a value begins or ends, or remove one."""
    if missing not in "]}":
        for found in _START.finditer(part):
            yield _Change(found.end(), "", missing)
    if missing in "[{":
        for found in re.finditer(rf": (?=\{much})", part):  # of `{}` or `[]`
            yield _Change(found.end(), "", missing)
    if missing not in "[{":
        for found in _END.finditer(part):
            yield _Change(found.start(), "", missing)
    for found in re.finditer(re.escape(much), part):
        yield _Change(found.start(), much, "")
        if missing != much:
            other = {"}": "]", "]": "}", "{": "[", "[": "{"}[much]
            yield _Change(found.start(), much, other)


def _cost(part: str, text: str) -> float | None:
    """How far lines of a text are from the form of a script; 0 if they have it, None if they are
    not YAML."""
    found: Report = []
    anomalies = ParseAnomalies([], [], [])
    tree = parse(Source("", part), found, anomalies)
    if tree is None or anomalies.stops or found:
        return None
    if isinstance(tree, Scalar):
        return 2.0
    return _cost_of(tree, "", text)


_KEY = re.compile(r"[\w./<$~:-]+(?:\[\d*\])?")
_ENTRY_INSIDE = re.compile(r", *\w+: |^\s*[,\]}]|[\[{,]\s*$")
_WORDS = re.compile(r"([A-Za-z_]\w*) ([A-Za-z_]\w*)")
_NUMBERS = re.compile(r"-?\d*\.?\d+ -?\d*\.?\d+")
_FACTS = frozenset({*OUTCOME_FACTS, *KEY_FACTS, *VARIABLE_FACTS, *PRESET_FIELDS} - {"names"})
"""What a mapping states about one name. A mapping of names has none of them."""

_NAME_LISTS = ("outcomes", "input_keys", "output_keys", "claims", "tags")


def _cost_of(tree: Tree, owner: str, text: str) -> float:
    """The sum of what is wrong or unusual in a tree. `owner` is the key with the tree."""
    if isinstance(tree, Scalar):
        return _cost_of_scalar(tree)
    if isinstance(tree, Seq):
        inside = sum(_cost_of(item, owner, text) for item in tree.items)
        return inside + _cost_of_items(tree, owner, text)
    flow = tree.span.text.startswith("{")
    facts = sum(entry.key.value in _FACTS for entry in tree.entries)
    mixed = 0.2 * (flow and 0 < facts < len(tree.entries))
    return mixed + sum(_cost_of_entry(entry, owner, flow, text) for entry in tree.entries)


def _cost_of_items(tree: Seq, owner: str, text: str) -> float:
    """1 for names and entries mixed in a list, for each item that is two, and for a look-up of a
    param that has not two items."""
    items = tree.items
    first = items[0] if items else None
    if isinstance(first, Scalar) and first.plain and first.value == "params" and len(items) != 2:
        return 1.0
    pairs = sum(isinstance(item, Map) and not item.span.text.startswith("{") for item in items)
    texts = [item.value for item in items if isinstance(item, Scalar) and item.plain]
    words = [text for text in texts if isinstance(text, str)]
    two = sum(_NUMBERS.fullmatch(word) is not None for word in words)
    if LONG.get(owner, owner) in _NAME_LISTS:
        two += pairs
    if LONG.get(owner, owner) in _NAME_LISTS and len(texts) == len(items):
        two += sum(_are_two(word, text) for word in words)
    numbers = sum(isinstance(text, int | float) for text in texts)
    mixed = 0.2 * (0 < numbers < len(items) and any(isinstance(item, Seq) for item in items))
    return float((0 < pairs < len(items)) + two) + mixed


def _are_two(name: str, text: str) -> bool:
    """Whether a name with a space is in a text only once, each of its words twice at least."""
    found = _WORDS.fullmatch(name)
    if found is None or text.count(name) > 1:
        return False
    return all(len(re.findall(rf"(?<!\w){word}(?!\w)", text)) > 1 for word in found.groups())


_NAMES_ONLY = ("transitions", "remapping", "outcomes", "input_keys", "output_keys")


def _cost_of_entry(entry: Entry, owner: str, flow: bool, text: str) -> float:
    key, value = entry.key, entry.value
    name = LONG.get(str(key.value), str(key.value))
    if name == "doc":
        return 0.0
    cost = 0.0
    if key.plain and _KEY.fullmatch(str(key.value)) is None:
        cost += 1
    if flow and isinstance(value, Scalar) and value.value is None and not value.span.text:
        cost += 1
    above = LONG.get(owner, owner)
    if above in _NAMES_ONLY and name in VARIABLES:
        cost += 0.2
    elif above in _NAMES_ONLY and isinstance(value, Seq):
        cost += 1
    elif above not in _NAMES_ONLY and flow and name.isupper() and isinstance(value, Scalar):
        cost += 0.05
    return cost + _cost_of(value, name, text)


_INNER_BRACKET = re.compile(r""", *[\[{]|""$|''$""")


def _cost_of_scalar(tree: Scalar) -> float:
    text = tree.value
    if not isinstance(text, str):
        return 0.0
    if not tree.plain:
        flag = 0.2 * (text in ("true", "false"))
        return flag + 0.5 * (_ENTRY_INSIDE.search(text) is not None) + 0.3 * (not _is_even(text))
    return float(not _is_even(text)) + 0.3 * (_INNER_BRACKET.search(text) is not None)


_PAIRS = (("[", "]"), ("{", "}"), ("(", ")"))


def _is_even(text: str) -> bool:
    """Whether each bracket and quote of a text has its counterpart. An apostrophe is no quote."""
    if any(text.count(opening) != text.count(closing) for opening, closing in _PAIRS):
        return False
    edges = text[:1] == "'" or text[-1:] == "'"
    return text.count('"') % 2 == 0 and not (edges and text.count("'") % 2)


_OTHER_MEANING = "YAML reads the parts beside this place as one name or text"
"""The effect of a sign that is missing in a text which is YAML without it."""


def _finding(
    source: Source, before: OffsetMap, text: str, repaired: str, change: _Change, stops: bool
) -> Diagnostic:
    """SM001 for a repair."""
    at, sign = change.at, change.written
    end = at + len(change.removed)
    edit = Edit(span=Span(source, before.back(at), before.back(end)), text=sign)
    repair = Repair(edits=(edit,), certainty=Certainty.LIKELY, operator="write a sign")
    left, right, piece = _word_before(text, at), _word_after(text, end), _piece(repaired, change)
    effect = None if stops else _OTHER_MEANING
    if sign == f"[{change.removed}]":
        effect = "YAML reads the values after the first one as fields without a value"
        message = f"the brackets around `{change.removed}` are missing"
    elif sign == ": ":
        message = f"a `:` is due after `{left}`, not `=`"
        at += change.removed.index("=")
        end = at + 1
    elif change.removed:
        message = f"this `{change.removed}` is one too many"
        if sign:
            message = f"this `{change.removed}` must be `{sign}`"
    elif sign == " ":
        message, at = SPACE_MISSING, at - len(left) - 1
    elif sign in "[{" or (sign in "\"'" and _starts(text, at)):
        message, end = f"a `{sign}` is missing before `{right}`", at + len(right)
    elif sign == ":" and not text[at : line_end(text, at)].strip():
        message, at = "a `:` is missing after this key", at - len(left)
        piece = repaired[repaired.rfind("\n", 0, change.at) + 1 : change.at + 1].strip()
    elif not text[at : line_end(text, at)].strip():
        message, at = f"a `{sign}` is missing at the end of this line", at - 1
    else:
        message, at = f"a `{sign}` is missing after `{left}`", at - len(left)
    span = Span(source, before.back(at), before.back(max(end, at + 1)))
    return yaml_syntax(
        span,
        message,
        f"write `{piece}`",
        arguments=("sign", sign, str(change.at)),
        effect=effect,
        repairs=(repair,),
    )


def _starts(text: str, at: int) -> bool:
    """Whether a value begins at an index, and none ends there."""
    return text[at : at + 1] not in ("", "\n", ",", "]", "}", ":") and (
        text[at - 1 : at] in (" ", "[", "{", ",", "(") or at == 0
    )


_LONGEST_WORD = 40


def _word_before(text: str, at: int) -> str:
    found = re.search(r"([\w.:/<>-]+|\S)\s*$", text[max(0, at - _LONGEST_WORD) : at].rstrip(" ="))
    return found[1].rstrip(":") or found[1] if found is not None else ""


def _word_after(text: str, at: int) -> str:
    found = re.match(r"\s*([\w./<>-]+|\S)", text[at : at + _LONGEST_WORD])
    return found[1] if found is not None else ""


_LONGEST_PIECE = 110


def _piece(text: str, change: _Change) -> str:
    """The smallest entry of a repaired text that has the sign, or the words around the sign if that
    is long."""
    start, end = change.at, change.at + len(change.written)
    lines = _lines(text, change.at)
    tree = parse(Source("", text[lines.start : lines.end]), [])
    best = ""
    todo: list[Tree] = [tree] if tree is not None else []
    while todo:
        node = todo.pop()
        places = [(node.span.start, node.span.end)]
        if isinstance(node, Map):
            todo += [entry.value for entry in node.entries if not isinstance(entry.value, Scalar)]
            places = [(entry.key.start, entry.value.span.end) for entry in node.entries]
        elif isinstance(node, Seq):
            todo += [item for item in node.items if isinstance(item, Map | Seq)]
            places = [(item.span.start, item.span.end) for item in node.items]
        for first, last in places:
            piece = text[lines.start + first : lines.start + last]
            if first <= start - lines.start and end - lines.start <= last:
                short = len(piece) <= _LONGEST_PIECE and "\n" not in piece
                best = piece if short and ":" in piece else best
    after = _word_after(text, end)
    beside = " " if after and change.written in (":", ",") else ""
    return best or f"{_word_before(text, start)}{text[start:end]}{beside}{after}"
