"""What every result offers (`Result`), and what only some results offer (`Ways`, `Certified`).

The `status` of a result says how much is known, its `reason` says why, and `to_dict` returns
everything as one document. Some results are sequences of ways (`Ways`). For some results a
certificate can be written (`Certified`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import Any, ClassVar, Generic, Protocol, TypeAlias, TypeVar, overload, runtime_checkable

from exactfold._support.verdict import Verdict

Certificate: TypeAlias = "dict[str, Any] | tuple[str, ...]"
"""What `exactfold.check` takes: one JSON object, or the texts of several lines."""

W_co = TypeVar("W_co", covariant=True)


@runtime_checkable
class Result(Protocol):
    """What a verb such as `count` returns.

    >>> import exactfold
    >>> result = exactfold.count("two-vertex")
    >>> isinstance(result, exactfold.Result), result.status, result.to_dict()["status"]
    (True, <Verdict.PROVED: 'proved'>, 'proved')
    >>> result.reason
    '4 solutions isolated; by refined Bezout there are no others'
    """

    @property
    def status(self) -> Verdict:
        """PROVED, REFUTED or UNDECIDED."""

    @property
    def reason(self) -> str:
        """What was proved, or what is missing for a proof; empty if `status` says it all."""

    def to_dict(self) -> Mapping[str, object]:
        """The document that the command prints with `--json`."""


class Ways(Generic[W_co]):
    """A result that is a sequence of ways: it has a length, an order, and a way at each place.

    In a condition the result is true, even if it lists no way. Indices start at 0, as in any
    sequence. The argument `way` of a verb starts at 1: `way=3` is the way at index 2.
    """

    def listed(self) -> tuple[W_co, ...]:
        """All listed ways, in their order."""
        raise NotImplementedError

    def __len__(self) -> int:
        return len(self.listed())

    def __iter__(self) -> Iterator[W_co]:
        return iter(self.listed())

    def __bool__(self) -> bool:
        return True

    @overload
    def __getitem__(self, which: int) -> W_co: ...
    @overload
    def __getitem__(self, which: slice) -> tuple[W_co, ...]: ...
    def __getitem__(self, which: int | slice) -> W_co | tuple[W_co, ...]:
        return self.listed()[which]


class Certified:
    """A result for which a certificate can be written.

    `WRITER` names the function that writes it, as "module:function". It is imported only when
    it is called, as the modules of the writers import those of the results.
    """

    WRITER: ClassVar[str]

    def certificate(self) -> Certificate:
        """The certificate of what is proved, for `exactfold.check` and `write_certificate`.

        Raises `NotApplicableError` where nothing is proved that a certificate could state.

        >>> import exactfold
        >>> exactfold.check(exactfold.count("two-vertex").certificate()).status
        <Verdict.PROVED: 'proved'>
        """
        module, _, name = self.WRITER.partition(":")
        certificate: Certificate = getattr(import_module(module), name)(self)
        return certificate
