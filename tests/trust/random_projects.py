"""Random projects that are correct by construction, with everything the language has.

A container is built from its first state to its last. What is set when a state is entered is the
intersection over the ways to it; only that is read. Failures lead to outcomes of failure, or to a
recovery that does; every outcome of a container is the target of something.
"""

from __future__ import annotations

from tests.trust.project_text import MAIN, Data, Project
from tests.trust.random_leaves import BAD, GOOD, Body, Known, Leaves, State


class Builder(Leaves):
    """Draws a project: containers of leaves and of one another."""

    def project(self) -> Project:
        exits = [GOOD, BAD]
        body: Body = {
            "name": "sm",
            "template": "Base",
            "outcomes": exits,
            "params": {"arm": "left"},
        }
        self.files[MAIN] = body
        inside = self.machine(body, self.draw.choice([1, 2, 2, 3]), exits, {})
        outputs = sorted(inside.writes())
        if outputs:
            body["output_keys"] = outputs
        body["doc"] = ["The arm is ", ["params", "arm"], "."]
        return self.files

    def machine(
        self, body: Body, depth: int, exits: list[str], around: Known, inside: str = ""
    ) -> State:
        """Give a container its states; what they read, and have set at its outcomes.

        `around` is what is set when it is entered; presets go into `body`.
        """
        self.presets.append(body.setdefault("userdata", {}))
        count = self.draw.randint(2, 4)
        names = [self.state_name() for _ in range(count)]
        arriving: dict[str, list[Known]] = {name: [] for name in [*names, *exits]}
        arriving[names[0]] = [around]
        recoveries: list[str] = []
        states: list[Data] = []
        whole = State("", body)
        queue = list(names)
        while queue:
            name = queue.pop(0)
            known = common(arriving[name])
            following = queue[0] if queue and name not in recoveries else None
            state = self.state(name, depth, known)
            steps: dict[str, str] = {}
            for outcome, sets in state.sets.items():
                if outcome == GOOD:
                    target = following if following not in (None, *recoveries) else GOOD
                    target = exits[1] if name in recoveries else target
                elif outcome == "skipped":
                    ahead = [item for item in queue if item not in recoveries]
                    target = self.draw.choice([*ahead, GOOD])
                elif name not in recoveries and self.may_recover(depth, inside):
                    target = self.state_name()
                    recoveries.append(target)
                    queue.append(target)
                    arriving[target] = []
                else:
                    target = exits[1]
                steps[outcome] = str(target)
                arriving[str(target)].append({**known, **sets})
            if inside == "Sequence" and steps.get(GOOD) == following:
                del steps[GOOD]
            state.body["transitions"] = steps
            states.append({name: state.body})
            whole.reads |= state.reads
            whole.perhaps |= state.writes()
        if not arriving[exits[1]]:
            states.insert(0, self.failing(names[0], exits))
            arriving[exits[1]].append(around)
        self.close(body)
        body["states"] = states
        whole.sets = {exit: common(arriving[exit]) for exit in exits}
        for key in around:
            whole.perhaps.pop(key, None)
        return whole

    def may_recover(self, depth: int, inside: str) -> bool:
        return depth > 0 and self.chance(0.15) and inside != "Sequence"

    def failing(self, following: str, exits: list[str]) -> Data:
        """A first state that can fail: somebody has to, or the outcome is impossible."""
        body: Body = {"template": "ScriptedState", "outcomes": [GOOD, BAD]}
        body["transitions"] = {GOOD: following, BAD: exits[1]}
        return {self.state_name(): body}

    def close(self, body: Body) -> None:
        self.presets.pop()
        if not body["userdata"]:
            del body["userdata"]

    def state(self, name: str, depth: int, known: Known) -> State:
        """A state that reads some of what is set, and sets something."""
        kinds = [
            self.scripted,
            self.skill,
            self.printing,
            self.changing,
            self.deciding,
            self.waiting,
        ]
        if depth > 0:
            kinds += [self.nested, self.nested, self.both, self.each, self.called]
        state = self.draw.choice(kinds)(name, depth, known)
        if self.chance(0.1) and "script" not in state.body:
            state.body["doc"] = "What it is for."
        return state

    def interface(self, state: State, known: Known, taken: Known, inside: State) -> None:
        """Keys of a container: those it takes in, those it hands out, some of them renamed."""
        outputs = {key: type_ for key, type_ in inside.writes().items() if key not in known}
        remaps = {}
        if taken:
            state.body["input_keys"] = self.listed(taken)
        if outputs:
            state.body["output_keys"] = self.listed(outputs)
        for key in outputs:
            if self.chance(0.3):
                remaps[key] = self.key_name()
        if remaps:
            state.body["remapping"] = remaps
        state.reads |= set(taken)
        state.perhaps = {remaps.get(key, key): type_ for key, type_ in outputs.items()}
        state.sets = {
            outcome: {remaps.get(key, key): t for key, t in each.items() if key in outputs}
            for outcome, each in inside.sets.items()
        }

    def nested(self, name: str, depth: int, known: Known) -> State:
        kind = self.draw.choice(["StateMachine", "StateMachine", "Sequence"])
        body: Body = {"template": kind, "outcomes": [GOOD, BAD]}
        if kind == "Sequence":
            body["connector_outcome"] = GOOD
        inner = self.some(known)
        inside = self.machine(body, depth - 1, [GOOD, BAD], inner, kind)
        state = State(name, body)
        taken = {key: type_ for key, type_ in inner.items() if key in inside.reads}
        self.interface(state, known, taken, inside)
        return state

    def called(self, name: str, depth: int, known: Known) -> State:
        """A sub-script with a param, called once or, later, again."""
        file = f"sub_{self.number()}"
        inside = self.nested(self.state_name(), min(depth, 2), known)
        inside.body["doc"] = ["Works with ", [["tool"]], "."]
        remaps = inside.body.pop("remapping", {})
        self.files[f"{file}.yml"] = [{inside.name: inside.body}]
        body: Body = {"script": file, "params": {"tool": "gripper"}}
        if remaps:
            body["remapping"] = remaps
        return State(name, body, inside.sets, inside.reads, inside.perhaps)

    def both(self, name: str, depth: int, known: Known) -> State:
        """A concurrence: branches read what is set, and write keys of their own."""
        body: Body = {"template": "Concurrence", "outcomes": ["ready", "failed"]}
        self.presets.append(body.setdefault("userdata", {}))
        branches: list[State] = []
        for _ in range(self.draw.randint(2, 3)):
            make = self.state if branches else self.deciding
            branch = make(self.state_name(), min(depth - 1, 1), known)
            if branch.body["template" if "template" in branch.body else "script"] in LEAVES:
                branch.body["claims"] = [f"tool.n{self.number()}"]
            branches.append(branch)
        self.close(body)
        body["default_outcome"] = "failed"
        body["outcome_map"] = {"ready": {branch.name: GOOD for branch in branches}}
        if self.chance(0.3) and len(branches) > 2:
            body["outcomes"] = ["ready", "half", "failed"]
            first, *others = branches
            rule = {first.name: BAD, **{branch.name: GOOD for branch in others}}
            body["outcome_map"] = {**body["outcome_map"], "half": rule}
        body["states"] = [{branch.name: branch.body} for branch in branches]
        state, inside = State(name, body), State(name, body)
        inside.sets = {outcome: {} for outcome in body["outcomes"]}
        for branch in branches:
            inside.sets["ready"] |= branch.sets[GOOD]
            inside.perhaps |= branch.writes()
        taken = {key: known[key] for branch in branches for key in branch.reads if key in known}
        self.interface(state, known, taken, inside)
        return self.as_machine(state)

    def as_machine(self, state: State) -> State:
        """A container with outcomes of its own names, in a machine with the usual ones."""
        inner = State(self.state_name(), state.body, state.sets, state.reads)
        good, *others = state.sets
        inner.body["transitions"] = {good: GOOD, **dict.fromkeys(others, BAD)}
        body: Body = {"template": "StateMachine", "outcomes": [GOOD, BAD]}
        if state.reads:
            body["input_keys"] = sorted(state.reads)
        if state.writes():
            body["output_keys"] = sorted(state.writes())
        body["states"] = [{inner.name: inner.body}]
        sets = {GOOD: state.sets[good], BAD: {}}
        return State(state.name, body, sets, state.reads, state.perhaps)

    def each(self, name: str, depth: int, known: Known) -> State:
        """An iterator over a list, or over a key that holds one."""
        lists = [key for key, type_ in known.items() if type_ == "list[int]"]
        item = self.key_name()
        body: Body = {"template": "Iterator", "outcomes": ["all", BAD], "it_label": item}
        body["it"] = self.draw.choice(lists) if lists else [1, 2, 3]
        body |= {"exhausted_outcome": "all", "loop_outcomes": [GOOD]}
        body["final_outcome_map"] = {GOOD: BAD}
        inside: Body = {"template": "StateMachine", "outcomes": [GOOD, BAD]}
        within = self.machine(inside, depth - 1, [GOOD, BAD], {item: "int"})
        if item in within.reads:
            inside["input_keys"] = [item]
        outputs = {key: type_ for key, type_ in within.writes().items() if key != item}
        if outputs:
            inside["output_keys"] = body["output_keys"] = sorted(outputs)
        body["states"] = [{self.state_name(): inside}]
        reads = {str(body["it"])} if lists else set()
        if lists:
            body["input_keys"] = sorted(reads)
        return self.as_machine(State(name, body, {"all": {}, BAD: {}}, reads, outputs))


LEAVES = ("ScriptedState", "PrintUserdataState", "CallbacksState", "SleepState")


def common(arriving: list[Known]) -> Known:
    """What is set on every way."""
    if not arriving:
        return {}
    first, *others = arriving
    return {key: type_ for key, type_ in first.items() if all(key in other for other in others)}


def correct_project(seed: int) -> Project:
    """The project of a seed; the same each time."""
    return Builder(seed).project()
