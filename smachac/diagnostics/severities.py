"""Severities of a project, and the selection of findings by code."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from smachac.diagnostics.diagnostic import Diagnostic, Report, Severity
from smachac.records import dataclass, field, replace


@dataclass(frozen=True, slots=True, kw_only=True)
class Policy:
    """Severities by code or prefix of codes; None disables them."""

    severities: Mapping[str, Severity | None] = field(default_factory=dict)


def is_firm(item: Diagnostic) -> bool:
    """Whether a finding is an error that cannot be disabled: no program can be generated from such
    a machine."""
    return item.kind.unsuppressible and item.severity is Severity.ERROR


def apply_severities(report: Report, policy: Policy) -> Report:
    """A report with the severities of a project. The longest matching prefix applies."""
    if not policy.severities:
        return report
    found = []
    for item in report:
        name = _longest(item.code, policy.severities)
        level = item.severity if name is None else policy.severities[name]
        if name is None or is_firm(item):
            found.append(item)
        elif level is not None:
            found.append(replace(item, severity=level))
    return found


def select_findings(report: Report, select: Sequence[str], ignore: Sequence[str]) -> Report:
    """The findings whose code begins with one of `select` (empty: all) and none of `ignore`.

    The longer prefix wins. Firm errors are always kept, because other findings may follow from
    them.
    """

    def wanted(code: str) -> bool:
        more, less = _longest(code, select), _longest(code, ignore)
        if more is None or less is None:
            return less is None and (more is not None or not select)
        return len(more) > len(less)

    return [item for item in report if is_firm(item) or wanted(item.code)]


def _longest(code: str, beginnings: Iterable[str]) -> str | None:
    return max((name for name in beginnings if code.startswith(name)), key=len, default=None)
