"""Clusters: findings with one cause. They are a view of a report, made when it is printed: the
report itself decides about severities, suppressions, baselines and exit codes."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.repair import Repair
from smachac.records import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Cluster:
    """A finding with its proven repair, and the other findings that the repair corrects too."""

    finding: Diagnostic
    repair: Repair
    explained: tuple[Diagnostic, ...] = ()
