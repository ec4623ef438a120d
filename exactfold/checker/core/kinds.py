"""What a kind of certificate is: how its files are read and checked, and what is said of them.

Each theory defines its kinds beside what it proves. `command` has the table of all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from .parts import Engine
from .reading import FormatError, keys, read_json

Claims = TypeVar("Claims", bound=Mapping[str, Any])


@dataclass(frozen=True, kw_only=True)
class Kind(Generic[Claims]):
    """A kind of certificate.

    The writer takes `format` and a version from here, and the types of what it writes from the
    module of the kind. `names` are the keys of the object, or of the first line of a file of lines.
    `claims` is the type of verified claims, and `summary` says them in one line.
    """

    format: str
    versions: tuple[int, ...]
    names: str
    claims: type[Claims]
    summary: Callable[[Claims], str]

    @property
    def version(self) -> int:
        """The newest."""
        return self.versions[-1]

    def read(self, data: Any) -> dict[str, Any]:
        """`data` if it is an object of this kind, of a version that is read, with its keys.

        Raises `FormatError`.
        """
        if not isinstance(data, dict) or data.get("format") != self.format:
            raise FormatError(f'the object has no "format": "{self.format}"')
        version = data.get("version")
        if type(version) is not int or version not in self.versions:
            raise FormatError(f"version {version!a} is not known to this checker")
        keys(data, self.names, "the object", FormatError)
        return data


@dataclass(frozen=True, kw_only=True)
class DocumentKind(Kind[Claims]):
    """A kind whose files are one JSON object each.

    `check` verifies every claim of an object that was read, and returns the claims; it raises
    `CertificateError` at the first that is not supported. Kinds with the same format are told apart
    by `named`: what their objects have under "kind", None if they have no such key.
    """

    check: Callable[[dict[str, Any]], Claims]
    named: str | None = None


@dataclass(frozen=True, kw_only=True)
class LineKind(Kind[Claims]):
    """A kind whose files are JSON objects line by line, which `lines` reads.

    `check(lines, workers, engine)` verifies every claim of a file and returns the claims. The parts
    of the file are verified by `engine` if no other is asked for.
    """

    check: Callable[[Iterator[str], int, Engine], Claims]
    engine: Engine

    def header(self, text: str) -> dict[str, Any]:
        """The first line of a file, if it is one of this kind; raises `FormatError`."""
        return self.read(read_json(text))


@dataclass(frozen=True, eq=False, repr=False)
class Verified(Mapping[str, Any], Generic[Claims]):
    """The claims of one file, all of them verified, and the kind that says what they mean."""

    kind: Kind[Claims]
    claims: Claims

    def __getitem__(self, name: str) -> Any:
        return self.claims[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.claims)

    def __len__(self) -> int:
        return len(self.claims)

    def __repr__(self) -> str:
        return f"Verified({self.kind.format!r}, {dict(self.claims)!r})"
