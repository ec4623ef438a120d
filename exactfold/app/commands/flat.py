"""`exactfold flat`: the flat-folded states of a sheet."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, REFUTED
from exactfold.app.options.branches import FlatOptions
from exactfold.app.pictures.flat_conflicts import conflict_picture
from exactfold.app.pictures.flat_states import state_picture
from exactfold.app.pictures.picture_files import ENDINGS, write_picture
from exactfold.app.shell.patterns import read_any
from exactfold.app.shell.shell import EXIT, Bar, name_of, say, wrote
from exactfold.app.verbs.chosen import DRAWN
from exactfold.errors import NotApplicableError, TooManyModesError, UsageError
from exactfold.layers.fold_frames import state_document
from exactfold.layers.folding import fold_flat
from exactfold.layers.states import FlatStates
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.opening import Opened, has_branches
from exactfold.pattern.writing.fold_writing import checked_target, document_text, write_text

if TYPE_CHECKING:
    from exactfold.layers.ends import WayEnd

FOLD: Final = ".fold"


class Asked(FlatOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Print the answer, and return the exit code: 1 if it is proved that there is no state.

        Raises the errors of `read_any`, and `UsageError` for letters that do not fit the folds.
        """
        if self.output is not None:
            checked_target(self.output, (*ENDINGS, FOLD), "a folded sheet")  # before the work
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose, doubted=False)
            found = fold_flat(opened, self._letters(opened), limit=self.limit, progress=bar)
            text, what = "", ""
            if self.output is not None:
                bar("drawing", 0, 0)
                text, what = self._drawn(found)
            ends = self._ends(opened, found, bar) if self.ways else None
            if self.certificate is not None:
                bar("certificate", 0, 0)
                self._write(found, self.certificate)
        if self.as_json:
            document = found.to_dict(name_of(self.file))
            if ends is not None:
                document["ways"] = [end.to_dict() for end in ends]
            print(json.dumps(document))
        else:
            from exactfold.app import report

            report.show(report.flat_report(found, ends, everything=self.everything))
        if self.output is not None and text:
            if self._is_fold:
                write_text(self.output, text)
            else:
                write_picture(text, self.output)
            if not self.as_json:
                wrote(self.output, what)
        return EXIT[found.status]

    def _ends(self, opened: Opened, found: FlatStates, bar: Bar) -> tuple[WayEnd, ...]:
        from exactfold.branches.counting.ways import decompose_opened
        from exactfold.layers.ends import way_ends

        if isinstance(opened.sheet, CreasePattern) and has_branches(opened.sheet):
            raise UsageError(
                "--ways is for sheets of rigid panels: this one is triangulated, and its ways are "
                "branches, which `exactfold fold` and `exactfold motions` follow"
            )
        answer = decompose_opened(opened, clock=Clock(self.limit), progress=bar)
        return way_ends(answer, found, limit=self.limit, progress=bar)

    def _write(self, found: FlatStates, path: Path) -> None:
        """Write the certificate, or say why there is none."""
        from exactfold.certificates.entries import write_certificate
        from exactfold.layers.certificate import states_certificate

        try:
            document = states_certificate(found, Clock(self.limit))
        except (NotApplicableError, TooManyModesError) as error:
            say(f"no certificate was written: {error}")
        else:
            write_certificate(document, path)

    def _drawn(self, found: FlatStates) -> tuple[str, str]:
        """What `output` is to hold, and what it shows in words; nothing if nothing is known.

        Raises `UsageError` for a state that is not listed, and `NotApplicableError` for layers that
        FOLD cannot say.
        """
        title = name_of(self.file)
        number = self.state or 0
        if found.as_written is PROVED or self.state is not None:
            state = found.state(number)
            if self._is_fold:
                text = document_text(state_document(state, title, number))
            else:
                text = state_picture(state, f"{title}, flat-folded state {number}")
            return text, f"state {number}, from 0, of {found.listed} listed"
        if found.as_written is not REFUTED or self._is_fold:
            say(f"{self.output} was not written: no flat-folded state is known")
            return "", ""
        from exactfold.app.report.flat import reasons

        shown = reasons(found, everything=self.everything)
        return conflict_picture(found, shown, f"{title}, no flat-folded state"), "why there is none"

    @property
    def _is_fold(self) -> bool:
        return self.output is not None and self.output.suffix.lower() == FOLD

    def _letters(self, opened: Opened) -> Mapping[Edge, str] | str | None:
        if self.free:
            return "any"
        if self.letters is None or self.letters == DRAWN:
            return self.letters
        from exactfold.app.options.choosing import given_letters

        return given_letters(opened.sheet, self.letters)
