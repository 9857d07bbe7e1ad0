"""Python files that would take much time or memory, or would never end, if they were run."""

from __future__ import annotations

from collections.abc import Mapping

_HEAD = "import smach\n\nsm = smach.StateMachine(outcomes=['done'])\n"
_ADD = """\
with sm:
    smach.StateMachine.add('A', smach.State(outcomes=['done']), {'done': 'done'})
"""


def _with(code: str) -> str:
    return f"{_HEAD}{code}\n{_ADD}"


def _many_states(count: int) -> str:
    lines = ["class Do(smach.State):", "    def __init__(self):",
             "        smach.State.__init__(self, outcomes=['ok', 'no'])", "",
             "    def execute(self, userdata):", "        return 'ok'", "",
             f"NAMES = [f'S{{n}}' for n in range({count})]", "with sm:",
             "    for at, name in enumerate(NAMES):",
             f"        after = NAMES[at + 1] if at + 1 < {count} else 'done'",
             "        smach.StateMachine.add(name, Do(), {'ok': after, 'no': 'done'})"]  # fmt: skip
    return _HEAD + "\n".join(lines) + "\n"


def _diamonds(count: int) -> str:
    lines = ["class T0(smach.State):", "    pass"]
    for n in range(count):
        lines += [f"class L{n}(T{n}):", "    pass", f"class R{n}(T{n}):", "    pass",
                  f"class T{n + 1}(L{n}, R{n}):", "    pass"]  # fmt: skip
    return "\n".join(lines)


def _nested_machines(count: int) -> str:
    lines = ["inner = smach.State(outcomes=['done'])"]
    for _ in range(count):
        lines += ["outer = smach.StateMachine(outcomes=['done'])", "with outer:",
                  "    smach.StateMachine.add('A', inner, {'done': 'B'})",
                  "    smach.StateMachine.add('B', inner, {'done': 'done'})",
                  "inner = outer"]  # fmt: skip
    return _HEAD + "\n".join(lines) + "\n"


HOSTILE: Mapping[str, str] = {
    "doubled list": _with("items = ['a']\n" + "items = items + items\n" * 40),
    "doubled text": _with("text = 'a'\n" + "text = text + text\n" * 60),
    "doubled tuple": _with("t = ('a',)\n" + "t = (t, t)\n" * 60 + "same = t == (t,)\nu = {t: 1}"),
    "long sum": _with("text = " + " + ".join(["'a'"] * 20_000)),
    "5000 states": _many_states(5_000),
    "6000 states": _many_states(6_000),
    "states under unknown conditions": _HEAD
    + "with sm:\n"
    + "".join(
        f"    if sm.flag: smach.StateMachine.add('S{n}', smach.State(outcomes=['a']), {{}})\n"
        for n in range(1_500)
    ),
    "mutual recursion": _with(
        "def f(n):\n    g(n)\n    g(n)\n\ndef g(n):\n    f(n)\n    f(n)\n\nf(0)"
    ),
    "recursion under a condition": _with(
        "def f(n):\n    if sm.flag:\n        f(n)\n        f(n)\n    return f(n)\n\nf(0)"
    ),
    "recursive lambda": _with("f = lambda n: f(n) + f(n)\nf(0)"),
    "recursive property": _with(
        "class A:\n    @property\n    def a(self):\n        return self.a\n\nA().a"
    ),
    "recursive constructor": _with(
        "class A:\n    def __init__(self):\n        A()\n        A()\n\nA()"
    ),
    "wide percent": _with(
        "text = '%1000000d' % 5\nother = '%*d' % (10**9, 5)\nb = b'%1000000000d' % 5"
    ),
    "wide format": _with(
        "a = '{:1000000000}'.format(5)\nb = '{:{w}}'.format('x', w='1000000000')\n"
        "c = f'{5:1000000000}'\nd = 'a'.zfill(10**9)"
    ),
    "regular expression": _with("text = '" + "{:" * 4_000 + "'.format(1)"),
    "long text": _with("text = 'x' * 10**9\nother = 10**9 * 'x'\nitems = ['a'] * 10**9"),
    "long range": _with("for n in range(10**9):\n    pass\nitems = list(range(10**9))"),
    "nested ranges": _with(
        "for n in range(10000):\n    for m in range(10000):\n        k = range(10000)"
    ),
    "long texts in a list": _with("x = 'a' * 99000\nitems = [x + str(n) for n in range(10000)]"),
    "long f-string": _with("x = 'a' * 99000\ny = f'" + "{x}" * 20_000 + "'"),
    "many percent": _with("x = 'a' * 9000\ny = '" + "%s" * 9_000 + "' % ((x,) * 9000)"),
    "many appends": _with(
        "items = []\nfor n in range(9999):\n    items.append(n)\n    items.append(n)"
    ),
    "changes of a large dict": _with(
        "d = {n: n for n in range(9999)}\nfor n in range(9999):\n    for m in range(9999):\n"
        "        d[m] = n"
    ),
    "large power": _with("n = 2 ** 10**9\nm = 1 << 10**9\nk = 10\n" + "k = k * k\n" * 40),
    "large number": _with("n = 0x" + "f" * 100_000 + "\ntext = str(n) + f'{n}' + '%d' % n"),
    "endless while": _with("while True:\n    pass"),
    "endless while with work": _with("n = 0\nwhile True:\n    n += 1\n    sm.userdata.n = n"),
    "nested unknown loops": _with(
        "".join(" " * n + f"for x{n} in sm.items:\n" for n in range(15)) + " " * 15 + "x0 = x1"
    ),
    "list in itself": _with(
        "items = []\nitems.append(items)\nt = ' '.join(items)\nu = items == items\n"
        "d = {}\nd['d'] = d\nf = '%s' % items"
    ),
    "machine in itself": _HEAD + "with sm:\n"
    "    smach.StateMachine.add('A', sm, {'done': 'done'})\n"
    "    smach.StateMachine.add('B', sm, {'done': 'done'})\n",
    "machines in each other": _HEAD + "other = smach.StateMachine(outcomes=['done'])\n"
    "top = smach.StateMachine(outcomes=['done'])\n"
    "with sm:\n    smach.StateMachine.add('A', other, {'done': 'done'})\n"
    "with other:\n    smach.StateMachine.add('B', sm, {'done': 'done'})\n"
    "with top:\n    smach.StateMachine.add('C', sm, {'done': 'done'})\n",
    "machines nested 40 times": _nested_machines(40),
    "machines nested 100 times": _nested_machines(100),
    "class of itself": _with("class A(smach.State):\n    pass\nclass A(A):\n    pass\nA()"),
    "diamonds": _with(_diamonds(40) + "\nsm.other = T40()"),
    "name of itself": _with("a = a\nb = c = b\ndef f(): return f\nx = f()()()()"),
    "generators": _with(
        "def g():\n    while True:\n        yield 1\n\nfor x in g():\n    pass\nlist(g())"
    ),
    "exec": _with("exec('sm = 1')\neval('2 ** 10 ** 9')\nglobals()['x'] = 1\nlocals().update(y=2)"),
    "deep calls": _with("x = " + "str(" * 90 + "1" + ")" * 90),
    "long attribute": _with("x = sm" + ".a" * 900),
    "long chain of calls": _with("x = sm" + ".a()" * 450),
    "deep lambda": _with("f = " + "lambda: " * 90 + "1"),
    "deep else": _with(
        "".join(
            "    " * n + "if sm.a:\n" + "    " * (n + 1) + "pass\n" + "    " * n + "else:\n"
            for n in range(19)
        )
        + "    " * 19
        + "pass"
    ),
    "many elif": _with(
        "if sm.a == 0:\n    pass\n"
        + "".join(f"elif sm.a == {n}:\n    x = {n}\n" for n in range(900))
    ),
    "many conditions": _with("".join(f"if sm.f{n}:\n    x{n} = {n}\n" for n in range(3_000))),
    "many functions with loops": "import smach\n"
    + "".join(
        f"def f{n}():\n    sm = smach.StateMachine(outcomes=['a'])\n    while True:\n        pass\n"
        for n in range(900)
    ),
    "nested tuples": _with(
        "t = ()\nfor n in range(9000):\n    t = (t,)\nsame = t == t\nd = {1: t}\n"
        "x = t if sm.a else (t,)\nx = 'a'.join(t)\nfor y in sm.a:\n    t = (t,)"
    ),
    "nested partials": _with(
        "from functools import partial\nf = len\nfor n in range(9000):\n    f = partial(f, 1)\nf()"
    ),
    "nested alternatives": _with(
        "".join(f"x{n} = {n} if sm.a else 'b{n}'\n" for n in range(8))
        + "y = "
        + " + ".join(f"str(x{n})" for n in range(8))
    ),
    "a chain of 3000 classes": _with(
        "class C0(smach.State):\n    pass\n"
        + "".join(f"class C{n}(C{n - 1}):\n    pass\n" for n in range(1, 3_000))
        + "C2999().missing"
    ),
    "a class with 500 bases": _with(
        "".join(f"class B{n}(smach.State):\n    pass\n" for n in range(500))
        + f"class D({', '.join(f'B{n}' for n in range(500))}):\n    pass\nD()"
    ),
    "names with many open parts": _HEAD + "def tour(x):\n"
    "    sm = smach.StateMachine(outcomes=['ok'])\n"
    "    y = '{' + x + '}'\n"
    "    for n in range(12):\n        y = '%s%s' % (y, y)\n"
    "    with sm:\n        for n in range(1000):\n"
    "            sm.add(f'A{n}{y}', smach.State(outcomes=['ok']), {'ok': f'A{y}{y}'})\n"
    "            sm.add(f'{x}{n}', smach.State(outcomes=['ok']), {'ok': f'Q{n}'})\n",
    "empty": "",
    "only a comment": "# smach StateMachine",
}
"""Texts by name."""
