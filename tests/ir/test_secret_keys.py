"""Secret keys: the same key has other names in other states, and all of them are secret."""

from __future__ import annotations

from collections.abc import Mapping, Set
from pathlib import Path

import pytest

import smachac
from smachac.driver import analyse_script
from smachac.ir.nodes import Machine
from smachac.ir.secret_keys import secret_keys
from smachac.runtime.tracing.writer import SECRET
from smachac.targets.html.model import machine_model

VALUE = "4711-0815"
"""The value of the secret key, which nothing may show."""

DEEP = """\
name: sm
template: Base
outcomes: [done]
userdata: {{a: {top}, plain: hello}}
states:
  - OUTER:
      template: StateMachine
      outcomes: [done]
      input_keys: [b]
      output_keys: [b]
      remapping: {{b: a}}
      userdata: {{c: {middle}}}
      states:
        - COPY:
            template: {type}
            input_keys: [x]
            output_keys: [y]
            remapping: {{x: b, y: c}}
            callbacks: {{y: 'lambda ud: ud.x'}}
            transitions: {{succeeded: INNER}}
        - INNER:
            template: Iterator
            outcomes: [done]
            input_keys: [c]
            it: c
            it_label: each
            exhausted_outcome: done
            loop_outcomes: [succeeded]
            states:
              - EACH:
                  template: CallbacksState
                  input_keys: [each]
                  output_keys: [each]
                  callbacks: {{each: 'lambda ud: ud.each'}}
      transitions: {{done: done}}
"""

PLAIN = {"top": f"[{VALUE}]", "middle": "[none]", "type": "CallbacksState"}


def machine_of(path: Path) -> Machine:
    checked = analyse_script(path).checked
    assert checked is not None
    return checked


def declared(value: str) -> str:
    return f"{{type: 'list[str]', value: {value}, secret: true}}"


def found(folder: Path, **parts: str) -> Mapping[str, Set[str]]:
    path = folder / "main.yml"
    path.write_text(DEEP.format(**PLAIN | parts), "utf-8")
    return secret_keys(machine_of(path))


def test_no_key_is_secret_without_a_declaration(tmp_path: Path) -> None:
    assert found(tmp_path) == {}


def test_a_secret_of_a_container_is_one_inside_under_each_name(tmp_path: Path) -> None:
    assert found(tmp_path, top=declared(f"[{VALUE}]")) == {
        "sm": {"a"},
        "sm/OUTER": {"b"},
        "sm/OUTER/COPY": {"x"},
    }


def test_the_items_of_a_secret_list_are_secret(tmp_path: Path) -> None:
    assert found(tmp_path, middle=declared("[none]")) == {
        "sm/OUTER": {"c"},
        "sm/OUTER/COPY": {"y"},
        "sm/OUTER/INNER": {"c", "each"},
        "sm/OUTER/INNER/EACH": {"c", "each"},
    }


def test_a_secret_of_an_interface_is_one_in_the_containers_around(tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    interface = (
        "name: Copy\noutcomes: {succeeded: {}}\nvariables: {callbacks: {role: callbacks}}\n"
        "input_keys: {x: {type: 'list[str]', secret: true}}\noutput_keys: {y: {}}\n"
        "stand_in: true\n"
    )
    (tmp_path / "templates/Copy.yml").write_text(interface, "utf-8")
    assert found(tmp_path, type="Copy") == {
        "sm": {"a"},
        "sm/OUTER": {"b"},
        "sm/OUTER/COPY": {"x"},
    }


@pytest.mark.parametrize("place", ["top", "middle"])
def test_nothing_shows_the_value_of_a_secret_key(tmp_path: Path, place: str) -> None:
    values = {"top": "[none]", "middle": "[none]"} | {place: declared(f"[{VALUE}]")}
    # The state does not copy one key to the other: a computed value is a secret of its own.
    script = DEEP.format(**PLAIN | values).replace("lambda ud: ud.x", "lambda ud: [str(1)]")
    path = tmp_path / "main.yml"
    path.write_text(script, "utf-8")
    machine = machine_of(path)
    events: list[dict[str, object]] = []
    assert smachac.run(path, observe=events.append).outcome == "done"
    assert VALUE not in str(events)
    shown = {event["value"] for event in events if event.get("key") == "each"}
    assert (shown == {SECRET}) == (place == "middle")
    assert VALUE not in str(machine_model(machine))
    assert VALUE in script


def test_pages_mark_secret_keys_and_hide_their_values(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text(DEEP.format(**PLAIN | {"top": declared(f"[{VALUE}]")}), "utf-8")
    root, outer, copy, *_ = machine_model(machine_of(path))["nodes"]
    assert root["userdata"][0]["value"] == SECRET
    assert root["userdata"][1]["value"] == "hello"
    assert outer["inputs"][0]["secret"] is True
    assert [key.get("secret") for key in (*copy["inputs"], *copy["outputs"])] == [True, None]


def test_the_lines_of_the_script_in_a_page_hide_the_value(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    script = DEEP.format(**PLAIN | {"middle": declared(f"[{VALUE},\n        é, {VALUE}]")})
    path.write_text(script, "utf-8")
    _, outer, *_ = machine_model(machine_of(path))["nodes"]
    assert VALUE not in outer["snippet"]
    assert f"value: {SECRET}" in outer["snippet"]
    assert f"{SECRET}, secret: true" in outer["snippet"]


@pytest.mark.parametrize("flag", ["yes", "1", "[true]", "null"])
def test_a_flag_that_is_not_true_or_false_is_reported(tmp_path: Path, flag: str) -> None:
    path = tmp_path / "main.yml"
    secret = f"{{type: 'list[str]', value: [none], secret: {flag}}}"
    path.write_text(DEEP.format(**PLAIN | {"top": secret}), "utf-8")
    (item,) = (item for item in smachac.check(path) if item.code == "SM004")
    assert item.span.text == flag
    templates = tmp_path / "templates"
    templates.mkdir()
    (templates / "A.yml").write_text(
        f"name: A\noutcomes: {{done: {{}}}}\ninput_keys: {{k: {{secret: {flag}}}}}\n"
        "stand_in: true\n",
        "utf-8",
    )
    path.write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nuserdata: {k: 1}\n"
        "states: [A: {template: A, transitions: {done: done}}]\n",
        "utf-8",
    )
    report = [item for item in analyse_script(path).report if item.code == "SM004"]
    assert [item.span.source.name.rpartition("/")[2] for item in report] == ["A.yml"]
