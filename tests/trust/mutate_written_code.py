"""Mutations of functions in scripts: SM016, SM019, SM311, SM316, SM317 and SM318."""

from __future__ import annotations

import re
from collections.abc import Callable

from tests.trust.mutants import Mutant, Subject, mutation
from tests.trust.project_text import Quoted, Site

LAMBDA = re.compile(r"lambda ud: (.+)", re.DOTALL)
READ = re.compile(r"\bud\.(\w+)")


def lambdas(subject: Subject, template: str = "", reads: str = "") -> list[tuple[Site, str, str]]:
    """The functions of callbacks and conditions that read a key: the state, the name, the body."""
    found = []
    for site in subject.sites():
        for name, code in site.pairs("callbacks").items():
            written = LAMBDA.fullmatch(str(code))
            if written is None or "#" in written[1] or READ.search(written[1]) is None:
                continue
            if template in ("", site.template) and (not reads or reads in written[1]):
                found.append((site, name, written[1]))
    return found


def rewritten(
    subject: Subject, codes: tuple[str, ...], change: Callable[[str], str], template: str = ""
) -> Mutant | None:
    """One function of a script with another text; `change` takes its body."""
    found = lambdas(subject, template)
    if not found:
        return None
    site, name, body = subject.draw.choice(found)
    site.body["callbacks"][name] = Quoted(change(body))
    return Mutant(codes=codes, places=((site.file, (*site.path, "callbacks", name)),))


@mutation
def forget_the_lambda(subject: Subject) -> Mutant | None:
    return rewritten(subject, ("SM316",), lambda body: body)


@mutation
def name_the_argument_otherwise(subject: Subject) -> Mutant | None:
    return rewritten(subject, ("SM019",), lambda body: f"lambda data: {body}")


@mutation
def forget_the_argument(subject: Subject) -> Mutant | None:
    return rewritten(subject, ("SM317",), lambda body: f"lambda: {body}")


@mutation
def add_an_argument(subject: Subject) -> Mutant | None:
    return rewritten(subject, ("SM317",), lambda body: f"lambda ud, item: {body}")


@mutation
def read_a_bare_key(subject: Subject) -> Mutant | None:
    return rewritten(subject, ("SM019",), lambda body: "lambda ud: " + READ.sub(r"\1", body))


@mutation
def write_words_of_another_language(subject: Subject) -> Mutant | None:
    word = subject.draw.choice(["true", "false", "null"])
    return rewritten(subject, ("SM019",), lambda body: f"lambda ud: [{body}, {word}]")


@mutation
def write_signs_of_another_language(subject: Subject) -> Mutant | None:
    change = subject.draw.choice(["({}) && 1", "({}) || 0", "!({})", "({}) === 1", "({}) ? 1 : 0"])
    return rewritten(subject, ("SM016",), lambda body: f"lambda ud: {change.format(body)}")


@mutation
def assign_in_a_condition(subject: Subject) -> Mutant | None:
    def assigning(body: str) -> str:
        return re.sub(r"==|[<>]", "=", f"lambda ud: {body}", count=1)

    found = [
        lambda_ for lambda_ in lambdas(subject, "ConditionalOutcomeState") if "ud." in lambda_[2]
    ]
    found = [item for item in found if re.search(r"==|[<>](?!=)", item[2])]
    if not found:
        return None
    site, name, body = subject.draw.choice(found)
    site.body["callbacks"][name] = Quoted(assigning(body))
    return Mutant(codes=("SM016",), places=((site.file, (*site.path, "callbacks", name)),))


@mutation
def divide_by_zero(subject: Subject) -> Mutant | None:
    return rewritten(subject, ("SM311",), lambda body: f"lambda ud: len(str({body})) / 0")


@mutation
def return_the_result_of_a_change(subject: Subject) -> Mutant | None:
    def changing(body: str) -> str:
        return f"lambda ud: list(str({body})).sort()"

    return rewritten(subject, ("SM318",), changing)


@mutation
def write_a_function_as_text(subject: Subject) -> Mutant | None:
    """The time of a SleepState, without backticks."""
    found = [site for site in subject.sites() if site.template == "SleepState"]
    site = subject.pick(site for site in found if "time" in site.body)
    if site is None:
        return None
    site.body["time"] = Quoted("lambda ud: 0.1")
    return Mutant(codes=("SM316",), places=((site.file, (*site.path, "time")),))


@mutation
def read_beyond_the_end_of_a_list(subject: Subject) -> Mutant | None:
    """The first state of the machine reads the sixth item of a list of three."""
    main = subject.project["main.yml"]
    if "initial" in main or "states" not in main:
        return None
    first = next(iter(main["states"][0]))
    main.setdefault("userdata", {})["three"] = [1, 2, 3]
    state = {
        "template": "CallbacksState",
        "input_keys": ["three"],
        "output_keys": ["sixth"],
        "callbacks": {"sixth": Quoted("lambda ud: ud.three[5]")},
        "transitions": {"succeeded": first},
    }
    main["states"].insert(0, {"SIXTH": state})
    place = ("states", 0, "SIXTH", "callbacks", "sixth")
    return Mutant(codes=("SM311",), places=(("main.yml", place),))
