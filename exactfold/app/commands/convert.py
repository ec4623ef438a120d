"""`exactfold convert`: writes a drawing of any format as a FOLD file with exact coordinates."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Literal, TypedDict

from exactfold._support.documents import FieldName, FoldText
from exactfold._support.plurals import agreeing, counted
from exactfold.app.options.patterns import ConvertOptions
from exactfold.app.shell.patterns import located
from exactfold.app.shell.shell import Bar, apart, name_of, said, say, sheet_written, tell
from exactfold.certificates.entries import write_certificate
from exactfold.errors import FoldError, NotApplicableError, NotFoldError, PatternError, UsageError
from exactfold.interop.sheet_files import ENDINGS, FOLD_ENDINGS, write_sheet
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PanelsDocument, PatternDocument, described, described_panels
from exactfold.pattern.drawing.drawing import Steps
from exactfold.pattern.meant import MeantDocument
from exactfold.pattern.opening import Opened, ReadDocument, open_pattern
from exactfold.pattern.writing.fold_writing import checked_target, document_text, write_text
from exactfold.pattern.writing.panel_writing import Converted, converted


class Conversion(ConvertOptions):
    """The options of one call, and how they are answered."""

    def run(self) -> None:
        """Read the drawing, write the FOLD file to a file or to stdout, and say what was done.

        Raises the errors of `open_pattern` and `write_text`, and `UsageError`.
        """
        to_stdout = str(self.output) == "-"
        if to_stdout and self.as_json:
            raise UsageError("--json describes the file that is written: give it a name")
        fold = to_stdout or checked_sheet(self.output) in FOLD_ENDINGS
        apart(None if to_stdout else self.output, self.file, self.certificate)
        apart(self.certificate, self.file)
        with Bar("reading"):
            opened = self._opened()
            made = converted(opened, triangulate=self.triangulate)
            text = document_text(made.document()) if fold else ""
            if not fold:
                write_sheet(made.pattern, made.letters, self.output, name=self.file.stem)
            elif not to_stdout:
                write_text(self.output, text)
            self._certify(opened)
        lines = [*_lines(opened, said(self.file)), _written(made, name_of(self.output), fold)]
        if to_stdout:
            for line in lines[:-1]:
                say(line)
            sys.stdout.write(text)
        elif self.as_json:
            print(json.dumps(_summary(opened, made, name_of(self.file), name_of(self.output))))
        else:
            tell("\n".join(lines))

    def _certify(self, opened: Opened) -> None:
        if self.certificate is None:
            return
        if opened.meant is None:
            say("no certificate was written: no relation holds nearly, so nothing was inferred")
            return
        try:
            write_certificate(opened.meant.certificate(), self.certificate)
        except NotApplicableError as error:
            say(f"no certificate was written: {error}")

    def _opened(self) -> Opened:
        try:
            reading = replace(self.reading, steps=self._steps, merge=self.merge)
            return open_pattern(located(self.file), reading, name=said(self.file))
        except (FoldError, PatternError) as error:
            if not self.repair and not isinstance(error, NotFoldError):
                error.args = (f"{error}; --repair may mend it",)
            raise

    @property
    def _steps(self) -> Steps:
        if self.steps is not None:
            if self.repair is not None:
                raise UsageError("--steps names the steps: leave out --repair and --no-repair")
            return tuple(name.strip() for name in self.steps.split(",") if name.strip())
        if self.repair is None:
            return "least"
        from exactfold.pattern.drawing.repair import (
            STEPS,  # imported here: a usage error does not need it
        )

        return STEPS if self.repair else ()


def checked_sheet(path: Path) -> str:
    """The ending of a file for a sheet, before the work; raises `UsageError` for another one."""
    return checked_target(path, (*FOLD_ENDINGS, *ENDINGS), "a sheet")


def _lines(opened: Opened, name: str) -> list[str]:
    moved = f"; largest move {float(opened.snapped):.1g}" if opened.snapped else ""
    lines = opened.lines or (f"read {name}: FOLD, triangulated, as it stands{moved}",)
    doubt = [f"warning: {opened.doubt}"] if opened.doubt else []
    return [*lines, *doubt]


def _written(made: Converted, output: str, exact: bool) -> str:
    pattern = made.pattern
    field = f"in {pattern.field_name}" if exact else "as floats"
    added = ""
    if made.joins:
        is_ = agreeing(len(made.joins), "is")
        added = f"; {counted(len(made.joins), 'edge')} (J) {is_} added, which cut panels"
    return f"wrote {output}: {sheet_written(pattern)}, coordinates {field}{added}"


class ConvertDocument(TypedDict):
    """A drawing that was written as a FOLD file."""

    format: Literal["exactfold convert result"]
    version: Literal[1]
    pattern: PatternDocument | PanelsDocument
    output: str
    """The file that was written."""
    field: FieldName
    """That of the coordinates."""
    joins: list[FoldText]
    """Edges that --triangulate added."""
    read: ReadDocument | None
    meant: MeantDocument | None
    """The sheet that an inexact drawing means; null if no relation nearly holds."""


def _summary(opened: Opened, made: Converted, name: str, output: str) -> ConvertDocument:
    """The object that --json prints: `schema("convert")`."""
    sheet = opened.sheet
    return {
        "format": "exactfold convert result",
        "version": 1,
        "pattern": described(sheet, name, opened.snapped)
        if isinstance(sheet, CreasePattern)
        else described_panels(sheet, name),
        "output": output,
        "field": made.pattern.field_name,
        "joins": [f"{i}-{j}" for i, j in made.joins],
        "read": opened.read,
        "meant": None if opened.meant is None else opened.meant.to_dict(),
    }
