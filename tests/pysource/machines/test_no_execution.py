"""Reading a machine never runs its code."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.driver.python_machines import PythonProject
from smachac.frontend.files import Disk

CODE = {
    "import": "{mark}",
    "constructor": "class A:\n    def __init__(self):\n        {mark}\nA()",
    "new": "class A:\n    def __new__(cls):\n        {mark}\nA()",
    "decorator": "def d(f):\n    {mark}\n    return f\n@d\ndef f():\n    pass",
    "decorator of a class": "def d(f):\n    {mark}\n    return f\n@d\nclass A:\n    pass",
    "metaclass": "class M(type):\n    def __new__(m, *a):\n        {mark}\n        return type(*a)"
    "\nclass A(metaclass=M):\n    pass",
    "default argument": "def f(a={mark}):\n    pass",
    "class item": "class A:\n    def __class_getitem__(cls, key):\n        {mark}\nA[1]",
    "f-string": "x = f'{{{mark}}}'",
    "format": "x = '{{0}}'.format({mark})\ny = '%s' % {mark}",
    "subclass": "class A:\n    def __init_subclass__(cls):\n        {mark}\nclass B(A):\n    pass",
    "attribute": "class A:\n    def __getattr__(self, name):\n        {mark}\nA().x",
    "property": "class A:\n    @property\n    def x(self):\n        {mark}\nA().x",
    "comparison": "class A:\n    def __eq__(self, other):\n        {mark}\nA() == A()",
    "length and truth": "class A:\n    def __bool__(self):\n        {mark}\nif A():\n    pass",
    "text": "class A:\n    def __str__(self):\n        {mark}\nstr(A())\n'%s' % A()\nf'{{A()}}'",
    "context": "class A:\n    def __enter__(self):\n        {mark}\nwith A():\n    pass",
    "assertion": "assert {mark}",
    "annotation": "x: {mark} = 1\ndef f(a: {mark}) -> {mark}:\n    pass",
    "comprehension": "[{mark} for n in range(3)]",
    "lambda": "(lambda: {mark})()",
    "exec": "exec('{mark}'.replace('#', ''))\neval('{mark}')",
    "import function": "__import__('other')\nimport importlib\nimportlib.import_module('other')",
    "another module": "import other",
    "getattr": "getattr(__builtins__, 'open')({file}, 'w')\n__builtins__.open({file}, 'w')",
    "key": "d = dict()\nd[{mark}] = 1\nsorted([1], key=lambda n: {mark})",
    "execute": "class A(smach.State):\n    def execute(self, userdata):\n        {mark}\n"
    "A().execute(None)",
}

MACHINE = """
sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", smach.State(outcomes=["done"]), {"done": "done"})
sm.execute()
"""


@pytest.mark.parametrize("name", CODE)
def test_no_file_is_written(name: str, tmp_path: Path) -> None:
    trace = tmp_path / "trace"
    mark = f'open("{trace}", "w")'
    code = CODE[name].format(mark=mark, file=f'"{trace}"')
    path = tmp_path / "machine.py"
    path.write_text(f"import smach\n{code}\n{MACHINE}", "utf-8")
    (tmp_path / "other.py").write_text(f"import smach\n{mark}\n", "utf-8")
    (tmp_path / "smach.py").write_text(f"{mark}\n", "utf-8")
    found = PythonProject(Disk()).read(path)
    assert found.source is not None
    assert not trace.exists()
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "machine.py",
        "other.py",
        "smach.py",
    ]
