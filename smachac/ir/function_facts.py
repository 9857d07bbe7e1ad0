"""Facts about functions of the user that a script names as code."""

from __future__ import annotations

from dataclasses import dataclass

from smachac.diagnostics.source import Word


@dataclass(frozen=True, slots=True, kw_only=True)
class FunctionFacts:
    """A function in a module or template of the user.

    `word` is its name at the definition. It accepts from `least` to `most` positional arguments;
    `most` is None if it accepts any number. `parameters` are the names of these. `silent`: no path
    returns a value. `texts` are the texts that it returns, at their places, if it returns nothing
    but constant texts that are not empty. `used` are the parameters that its body reads. `reads`
    and `writes` are the userdata keys that it accesses if its first argument is the userdata.
    """

    word: Word
    parameters: tuple[str, ...]
    least: int
    most: int | None
    silent: bool
    texts: tuple[Word, ...] = ()
    reads: tuple[Word, ...] = ()
    writes: tuple[Word, ...] = ()
    used: tuple[str, ...] = ()

    def accepts(self, count: int) -> bool:
        """Whether a call can pass that number of positional arguments."""
        return self.least <= count and (self.most is None or count <= self.most)
