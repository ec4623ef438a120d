"""A kind of certificate: how its files are read, checked, and summed up in one line.

Each theory defines its kinds beside what it proves. `command` has the table of all kinds.
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

    The program that writes such files takes `format` and a version from here, and the types of the
    documents from the module that defines the kind. `names` are the keys of the object, or of the
    first line if the file is written in lines. `claims` is the type of the verified claims, and
    `summary` states them in one line.
    """

    format: str
    versions: tuple[int, ...]
    names: str
    claims: type[Claims]
    summary: Callable[[Claims], str]

    @property
    def version(self) -> int:
        """The newest version."""
        return self.versions[-1]

    def read(self, data: Any) -> dict[str, Any]:
        """Return `data` if it is an object of this kind, in a known version, with the right keys.

        Raises `FormatError` if it is not.
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
    """A kind with one JSON object in each file.

    `check` verifies every claim of an object that was read, and returns the claims. It raises
    `CertificateError` at the first claim that is not supported. Several kinds may share a format:
    `named` tells them apart. It is the value of "kind" in their objects, or None if they have no
    such key.
    """

    check: Callable[[dict[str, Any]], Claims]
    named: str | None = None

    def read(self, data: Any) -> dict[str, Any]:
        """Return `data` if it is an object of this kind; raises `FormatError` if it is not."""
        document = super().read(data)
        if document.get("kind") != self.named:
            raise FormatError(f"the kind {document.get('kind')!a} is not {self.named!a}")
        return document


@dataclass(frozen=True, kw_only=True)
class LineKind(Kind[Claims]):
    """A kind whose files have one JSON object on each line; `lines` reads them.

    `check(lines, workers, engine)` verifies every claim of a file and returns the claims. The field
    `engine` is the engine that verifies the parts of the file, unless the caller passes another.
    """

    check: Callable[[Iterator[str], int, Engine], Claims]
    engine: Engine

    def header(self, text: str) -> dict[str, Any]:
        """Read the first line of a file; raises `FormatError` if it is not of this kind."""
        return self.read(read_json(text))


@dataclass(frozen=True, eq=False, repr=False)
class Verified(Mapping[str, Any], Generic[Claims]):
    """The claims of one file, all verified, and the kind that says what they mean."""

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
