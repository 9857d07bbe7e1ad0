"""The memory limit of a process, as a last resort against scripts and templates that exhaust it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

DEFAULT = 4096
"""In MB. The largest scripts that are accepted take less than 1,000 MB."""


@contextmanager
def limited_memory(megabytes: int) -> Iterator[None]:
    """Memory beyond so much address space raises MemoryError inside a `with` block.

    0 is no limit. A lower limit of the process stays. Windows has no such limit, and macOS ignores
    it.
    """
    try:
        import resource
    except ImportError:
        yield
        return
    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    known = [number for number in (soft, hard) if number != resource.RLIM_INFINITY]
    wanted = [megabytes * 1_000_000] if megabytes else []
    limit = min([*known, *wanted], default=resource.RLIM_INFINITY)
    resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
