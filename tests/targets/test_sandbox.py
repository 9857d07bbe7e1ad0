"""Templates that do harm: each ends in an error at its line, soon, and nothing is written."""

# ruff: noqa: E501
from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library, read_source
from smachac.targets import load_target

MAIN = """\
name: sm
template: Base
outcomes: [done]
states:
  - A: {template: Bad, outcomes: [done], given: word, transitions: {done: done}}
"""

NO_END = "the template does not end, or prints too much text"
CALLS = "macros, blocks or includes call one another endlessly"
ITSELF = "the template extends, includes or calls itself endlessly"

BITS = "an integer has more than 10,000 binary digits"
SHARED = (
    "{% set ns = namespace(a=[1], b=[1]) %}{% for i in range(40) %}"
    "{% set ns.a = [ns.a, ns.a] %}{% set ns.b = [ns.b, ns.b] %}{% endfor %}"
)

HARMFUL = {
    "nested loops": ("{% for a in range(90000) %}{% for b in range(90000) %}x{% endfor %}{% endfor %}", NO_END),
    "a long range": ("{% for a in range(10**9) %}x{% endfor %}", "Range too big"),
    "a product": ("{{ 'x' * 10**10 }}", NO_END),
    "a product of bytes": ("{{ 'x'.encode() * 10**14 }}", NO_END),
    "a wide % of bytes": ("{{ 'x%99999999999999d'.encode() % 1 }}", NO_END),
    "a product of variables": ("{% set n = 10**9 %}{{ given * n }}", NO_END),
    "a power": ("{{ 9 ** (9 ** 9) }}", NO_END),
    "squares": ("{% set ns = namespace(n=7) %}{% for i in range(60) %}{% set ns.n = ns.n * ns.n %}{% endfor %}{{ ns.n }}", BITS),
    "doubling by ~": ("{% set ns = namespace(s='x') %}{% for i in range(60) %}{% set ns.s = ns.s ~ ns.s %}{% endfor %}", NO_END),
    "doubling by +": ("{% set ns = namespace(s='x') %}{% for i in range(60) %}{% set ns.s = ns.s + ns.s %}{% endfor %}", NO_END),
    "doubling by join": ("{% set ns = namespace(s='x') %}{% for i in range(60) %}{% set ns.s = [ns.s, ns.s] | join %}{% endfor %}", NO_END),
    "lists in lists": ("{% set ns = namespace(s=['x']) %}{% for i in range(60) %}{% set ns.s = [ns.s, ns.s] %}{% endfor %}{{ ns.s }}", NO_END),
    "a list that grows": ("{% set l = [1] %}{% for i in range(60) %}{% do l.extend(l) %}{% endfor %}", NO_END),
    "a wide format": ("{{ '%999999999d' | format(1) }}", NO_END),
    "a wide %": ("{{ '%999999999d' % 1 }}", NO_END),
    "a wide str.format": ("{{ '{:999999999}'.format(1) }}", NO_END),
    "a wide str.format by argument": ("{{ '{:{w}}'.format(1, w=999999999) }}", NO_END),
    "a wide center": ("{{ given | center(10**9) }}", NO_END),
    "a wide indent": ("{{ given | indent(10**9, true) }}", NO_END),
    "ljust": ("{{ given.ljust(10**9) }}", NO_END),
    "zfill": ("{{ given.zfill(10**9) }}", NO_END),
    "replace": ("{% set s = 'x' * 100000 %}{{ s | replace('x', s) }}", NO_END),
    "str.replace": ("{% set s = 'x' * 100000 %}{{ s.replace('x', s) }}", NO_END),
    "str.join": ("{% set s = 'x' * 100000 %}{{ s.join(s) }}", NO_END),
    "join": ("{% set s = 'x' * 100000 %}{{ s | join(s) }}", NO_END),
    "translate": ("{% set s = 'x' * 100000 %}{{ s.translate({120: s}) }}", NO_END),
    "expandtabs": ("{{ '\t'.expandtabs(10**9) }}", NO_END),
    "batch": ("{{ [1] | batch(10**9, 0) | list }}", NO_END),
    "slice": ("{{ [1] | slice(10**9) | list }}", NO_END),
    "tojson": ("{{ [[1]] | tojson(10**9) }}", NO_END),
    "searching long lists": ("{% set l = range(90000) | list %}{% for i in range(90000) %}{% if -1 in l %}{% endif %}{% endfor %}", NO_END),
    "slices": ("{% set l = range(90000) | list %}{% set k = [] %}{% for i in range(90000) %}{% do k.append(l[:]) %}{% endfor %}", NO_END),
    "equality of shared lists": (SHARED + "{{ ns.a == ns.b }}", NO_END),
    "membership in shared lists": (SHARED + "{{ ns.a in [ns.b] }}", NO_END),
    "equality of shared dicts": (SHARED.replace("[ns.a, ns.a]", "{1: ns.a, 2: ns.a}") + "{{ ns.a == ns.b }}", NO_END),
    "a hash of shared tuples": (SHARED.replace("[ns.a, ns.a]", "(ns.a, ns.a)") + "{{ {ns.a: 1} }}", NO_END),
    "a look-up of a long tuple": ("{% set t = (1,) * 90000 %}{% set d = {t: 1} %}{% for i in range(90000) %}{% if d[t] %}{% endif %}{% endfor %}", NO_END),
    "equality of views": ("{% set l = range(90000) | list %}{% set d = {1: l} %}{% for i in range(90000) %}{% if d.items() == d.items() %}{% endif %}{% endfor %}", NO_END),
    "a test for equality": ("{% set l = range(90000) | list %}{% set k = l[:] %}{% for i in range(90000) %}{% if l is eq(k) %}{% endif %}{% endfor %}", NO_END),
    "sums of lists": ("{% set l = [[1] * 100] * 5000 %}{{ l | sum(start=[]) }}", NO_END),
    "literal of shared lists": (SHARED + "{{ ns.a | literal }}", NO_END),
    "literal of a deep list": ("{% set ns = namespace(a=['x' * 9000]) %}{% for i in range(90) %}{% set ns.a = [ns.a] %}{% endfor %}{{ ns.a | literal }}", NO_END),
    "sort of shared lists": (SHARED + "{{ [ns.a, ns.b] | sort }}", NO_END),
    "a division of large numbers": ("{{ 9 ** 200000 // 7 ** 100000 }}", BITS),
    "numbers of any base": ("{{ ('f' * 100000) | int(base=16) }}", BITS),
    "bytes of a number": ("{{ (5).to_bytes(10**9, 'big') }}", "access to attribute 'to_bytes' of 'int' object is unsafe"),
    "a method of bytes": ("{{ given.encode().ljust(10**9) }}", "access to attribute 'ljust' of 'bytes' object is unsafe"),
    "format_map": ("{{ '{:{w}}'.format_map({'w': 10**9}) }}", NO_END),
    "a width in a list": ("{{ '{:{w[0]}}'.format(1, w=[10**9]) }}", NO_END),
    "a width in a text": ("{{ '{:{w}}'.format(1, w='999999999') }}", NO_END),
    "many fields": ("{{ ('{0}' * 20000).format('x' * 20000) }}", NO_END),
    "many fields of %": ("{{ ('%(x)s' * 20000) % {'x': 'x' * 20000} }}", NO_END),
    "many fields of the filter": ("{{ ('%(x)s' * 20000) | format(x='x' * 20000) }}", NO_END),
    "an indent of text": ("{{ ('x\\n' * 20000) | indent('x' * 20000) }}", NO_END),
    "a wrap with text": ("{{ ('x' * 20000) | wordwrap(1, wrapstring='x' * 20000) }}", NO_END),
    "a wrap of a long word": ("{{ ('x' * 90000) | wordwrap(1) }}", NO_END),
    "a list that grows in its loop": ("{% set l = [1] %}{% for i in range(90) %}{% do l.extend(l) %}{% endfor %}", NO_END),
    "pops from the start": ("{% set l = range(90000) | list %}{% for i in range(90000) %}{% do l.pop(0) %}{% endfor %}", NO_END),
    "a search in a range": ("{% for i in range(90000) %}{% if 1.5 in range(90000) %}{% endif %}{% endfor %}", NO_END),
    "deep json": ("{% set ns = namespace(a=[1]) %}{% for i in range(300) %}{% set ns.a = [ns.a] %}{% endfor %}{{ ns.a | tojson(900) }}", NO_END),
    "a macro that calls itself": ("{% macro m() %}{{ m() }}{% endmacro %}{{ m() }}", CALLS),
    "macros that branch": ("{% macro m(n) %}{% if n %}{{ m(n - 1) }}{{ m(n - 1) }}{% endif %}{% endmacro %}{{ m(100) }}", NO_END),
    "a block that prints itself": ("{{ self.body() }}", CALLS),
    "an include of itself": ("{% include 'Bad.tpl.py' %}", CALLS),
    "insides of Python": ("{{ ''.__class__.__mro__ }}", "access to attribute '__class__' of 'str' object is unsafe"),
    "globals of a function": ("{{ range.__globals__ }}", "access to attribute '__globals__'"),
    "insides by attr": ("{{ '' | attr('__class__') }}", "access to attribute '__class__' of 'str' object is unsafe"),
    "insides by format": ("{{ '{0.__class__}'.format(1) }}", "access to attribute '__class__' of 'int' object is unsafe"),
    "insides of a cycler": ("{{ cycler.__init__.__globals__ }}", "access to attribute '__init__'"),
    "a path upwards": ("{% include '../secret.txt' %}", "there is no template `../secret.txt`"),
    "a path from the root": ("{% include '/etc/hostname' %}", "there is no template `/etc/hostname`"),
    "an import from outside": ("{% from '../secret.txt' import x %}", "there is no template `../secret.txt`"),
    "chance": ("{{ [1, 2] | random }}", "there is no filter `random`"),
    "a text of nothing": ("{{ lipsum(n=10**6) }}", "the template uses `lipsum`, which is not defined"),
    "a missing variable": ("{{ nowhere }}", "the template uses `nowhere`, which is not defined"),
    "a part of what is missing": ("{{ nowhere.x }}", "the template uses `nowhere`, which is not defined"),
    "division by nothing": ("{{ 1 / 0 }}", "division by zero"),
}  # fmt: skip


def failed(folder: Path, template: str) -> Report:
    """What building says of a template whose `body` is the text."""
    (folder / "templates").mkdir()
    (folder / "secret.txt").write_text("secret")
    (folder / "main.yml").write_text(MAIN)
    (folder / "templates" / "Bad.tpl.py").write_text(template)
    path = folder / "main.yml"
    report: Report = []
    source = read_source(path, report)
    assert source is not None
    library = disk_library(path, report)
    analysis = analyse(source, library, report)
    assert analysis.checked is not None, analysis.report
    target = load_target("python")
    assert target is not None
    found: Report = []
    assert build(analysis.checked, target, library, found) == {}
    return found


@pytest.mark.parametrize("harm", HARMFUL)
def test_harm_ends_in_an_error_at_its_line(harm: str, tmp_path: Path) -> None:
    body, words = HARMFUL[harm]
    report = failed(tmp_path, f"{{% block body %}}\n{body}\n{{% endblock %}}\n")
    (found,) = report
    assert found.code == "SM605"
    assert words in found.finding.message
    assert found.span.source.name.endswith("Bad.tpl.py")
    assert found.span.line == 2
    assert [item.span.text for item in found.finding.related] == ["A"]


@pytest.mark.parametrize(
    ("template", "words"),
    [
        ("{% extends 'Bad.tpl.py' %}", "the template extends, includes or calls itself endlessly"),
        ("{% include 'Bad.tpl.py' %}{% block body %}{% endblock %}", ITSELF),
        ("{% from 'Bad.tpl.py' import m %}{% macro m() %}{% endmacro %}{% block body %}{% endblock %}", ITSELF),
        ("{% block body %}{% endblock %}{{ 'x' * 10**10 }}{% set a = 1 %}", NO_END),
        ("{% block body %}" + "(" * 500, ""),
        ("{% block body %}{{ " + "(" * 5000 + "1" + ")" * 5000 + " }}{% endblock %}",
         "the template has more than 50 levels of nesting"),
        ("{% block body %}{{ given" + ".x" * 10_000 + " }}{% endblock %}",
         "the template has more than 100 operations in one expression"),
        ("{% for a in [1] %}" * 30 + "{% endfor %}" * 30 + "{% block body %}{% endblock %}", ""),
        ("{% block body %}smach.add(\n{% endblock %}", "the block `body` does not print valid Python"),
        ("{% block class_defs %}class A\n{% endblock %}{% block body %}pass{% endblock %}",
         "the block `class_defs` does not print valid Python"),
    ],
)  # fmt: skip
def test_templates_that_are_wrong_as_a_whole(template: str, words: str, tmp_path: Path) -> None:
    (found,) = failed(tmp_path, template)
    assert found.code == "SM605"
    assert words in found.finding.message


def test_all_faulty_templates_are_told_at_once(tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    states = "".join(
        f"  - S{n}: {{template: Bad{n % 3}, outcomes: [done], transitions: {{done: done}}}}\n"
        for n in range(6)
    )
    for n in range(3):
        text = f"{{% block body %}}{{{{ missing_{n} }}}}{{% endblock %}}"
        (tmp_path / "templates" / f"Bad{n}.tpl.py").write_text(text)
    path = tmp_path / "main.yml"
    path.write_text(f"name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n{states}")
    report: Report = []
    source = read_source(path, report)
    library = disk_library(path, report)
    assert source is not None
    machine = analyse(source, library, report)
    target = load_target("python")
    assert target is not None
    assert machine.machine is not None
    found: Report = []
    target.emit(machine.machine, _context(library), found)  # type: ignore[arg-type]
    assert [item.finding.message for item in found] == [
        f"the template uses `missing_{n}`, which is not defined" for n in range(3)
    ]


def _context(library: object) -> object:
    from smachac.targets import BuildContext

    return BuildContext(library=library)  # type: ignore[arg-type]


def test_what_templates_may_do(tmp_path: Path) -> None:
    from smachac.diagnostics.source import Source
    from smachac.targets.templates.engine import Blocks

    text = (
        "{% block body %}{% set d = {'b': 1, 'a': 2} %}{% do d.update({'c': 3}) %}"
        "{% for k, v in d.iteritems() | sort %}{{ k }}={{ v }}{% if not loop.last %},{% endif %}"
        "{% endfor %};{{ loop is defined }};{{ 'a' ~ 1 }};{{ [3, 1] | sort | join(' ') }};"
        "{{ '%s-%d' | format('x', 2) }};{% if nowhere %}yes{% endif %};{{ nowhere | default('d') }}"
        "{% for x in range(5) %}{{ loop.index }}/{{ loop.length }} {% endfor %}{% endblock %}"
    )
    blocks = Blocks({"T.tpl.py": Source("T.tpl.py", text)}.get)
    assert blocks.render("T.tpl.py", "body", {}) == (
        "a=2,b=1,c=3;False;a1;1 3;x-2;;d1/5 2/5 3/5 4/5 5/5"
    )
