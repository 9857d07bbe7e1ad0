"""The code of Jinja templates, compiled once for all tests of a process."""

from __future__ import annotations

from types import CodeType

from jinja2 import BytecodeCache, Environment
from jinja2.bccache import Bucket

MOST = 500


class CompiledTemplates(BytecodeCache):
    """Codes by the name, the text, and the filters and tests that the compiler looks up."""

    def __init__(self) -> None:
        self.codes: dict[tuple[object, ...], CodeType] = {}

    def get_bucket(
        self, environment: Environment, name: str, filename: str | None, source: str
    ) -> Bucket:
        known = frozenset(environment.filters), frozenset(environment.tests)
        bucket = _Bucket(environment, name, source)
        bucket.place = (name, filename, source, *known)
        bucket.code = self.codes.get(bucket.place)
        return bucket

    def set_bucket(self, bucket: Bucket) -> None:
        assert isinstance(bucket, _Bucket)
        if len(self.codes) < MOST and bucket.code is not None:
            self.codes[bucket.place] = bucket.code


class _Bucket(Bucket):
    place: tuple[object, ...] = ()

    def __init__(self, environment: Environment, key: str, checksum: str) -> None:
        self.environment, self.key, self.checksum = environment, key, checksum
        self.reset()
