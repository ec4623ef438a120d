"""Makes commands: options from a dataclass, plain help, usage errors in one line."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import wraps
from importlib import import_module
from inspect import Parameter, Signature, signature
from typing import Annotated, Any, TypeAlias, get_args

import typer
import typer.main
from typer.core import TyperCommand, TyperGroup

from exactfold._support.plurals import either
from exactfold.app.shell.shell import reported, say

_WRONG_USAGE: type[Exception] = typer.BadParameter.__bases__[0]  # typer does not export it


def taking(options: str) -> Callable[[Callable[..., int]], Callable[..., None]]:
    """A decorator that makes a command whose options are the fields of a dataclass.

    `options` names the dataclass in `exactfold.app.options`, such as "patterns.CountOptions". It is
    imported when the command is chosen, as one command needs no other's options.

    The decorated function returns the exit code. Each field is an option or argument of typer, and
    the help lists them in the order of the fields. The options of a base class with a `panel` stand
    under that heading.
    """

    def made(run: Callable[..., int]) -> Callable[..., None]:
        def command(**given: Any) -> None:
            raise typer.Exit(run(**given))

        command.__name__, command.__doc__ = run.__name__, run.__doc__
        wrapped = reported(command)
        wrapped.__signature__ = Signature()  # type: ignore[attr-defined]
        wrapped.taking = options  # type: ignore[attr-defined]
        return wrapped

    return made


def _with_options(command: Any) -> Callable[..., None]:
    """A command of `taking` with the parameters that its options make."""

    @wraps(command.__wrapped__)
    def whole(**given: Any) -> None:
        command.__wrapped__(**given)

    del whole.taking  # type: ignore[attr-defined]
    whole.__signature__ = _signature(command.taking)  # type: ignore[attr-defined]
    return whole


def _signature(options: str) -> Signature:
    """The parameters of the command that takes these options."""
    module, name = options.split(".")
    dataclass = getattr(import_module(f"exactfold.app.options.{module}"), name)
    taken_by = signature(dataclass, eval_str=True)
    panels = {
        name: vars(base)["panel"]
        for base in dataclass.__mro__
        if "panel" in vars(base)
        for name in base.__annotations__
    }
    taken = [
        _for_typer(field, panels.get(field.name, "")) for field in taken_by.parameters.values()
    ]
    return taken_by.replace(parameters=taken)


def _for_typer(field: Parameter, panel: str) -> Parameter:
    """The same parameter, shown in a panel of the help if one is named.

    Its type is `Any` if it has its own parser, as typer knows few types.
    """
    option = field.annotation.__metadata__[0]
    if panel:
        option.rich_help_panel = panel
    if option.parser is None:
        return field
    return field.replace(annotation=Annotated[Any, option])


class Command(TyperCommand):
    """A command whose help shows arguments and flags without types."""

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        if self.help:  # the lines of its paragraphs are broken anew
            self.help = re.sub(r"(?<!\n)\n(?!\n)", " ", self.help)

    @property
    def params(self) -> Any:
        """The options and arguments; those of a dataclass are made when they are asked for."""
        if hasattr(self.callback, "taking"):
            whole = typer.Typer(add_completion=False)
            whole.command()(_with_options(self.callback))
            made = typer.main.get_command(whole)
            self._params, self.callback = made.params, made.callback
        return self._params

    @params.setter
    def params(self, parameters: Any) -> None:
        self._params = parameters

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the arguments and options, panel by panel."""
        _write(formatter, _by_panel(self.get_params(ctx), ctx))

    def get_help_option(self, ctx: Any) -> Any:
        """The option --help, or None if the command has none."""
        return _bare(super().get_help_option(ctx))

    def get_params(self, ctx: Any) -> Any:
        """All parameters; the help shows arguments without a type."""
        parameters = _without_pydantic(super().get_params(ctx))
        for parameter in parameters:
            if parameter.param_type_name == "argument":
                setattr(parameter, "display_type_rich", _no_type)  # noqa: B010 - typer's own name
        return parameters

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """The words of the usage line, such as PATTERN... instead of {PATTERN}..."""
        return [re.sub("[{}]", "", piece) for piece in super().collect_usage_pieces(ctx)]


_FIRST_COLUMN = 22
"""The help of options that are longer begins on a line of its own."""

PANELS = ("Ask", "See", "Fold", "Prove", "Files", "Studies")
"""The groups of commands in the help, in their order."""


class Group(TyperGroup):
    """The program with all its commands."""

    def list_commands(self, ctx: Any) -> list[str]:
        """The names of all commands, group by group."""
        return sorted(self.commands, key=lambda name: PANELS.index(self._panel(name)))

    def _panel(self, name: str) -> str:
        return str(getattr(self.commands[name], "rich_help_panel", PANELS[0]))

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the options and the commands, each with the first sentence of its help."""
        panels = _by_panel(self.get_params(ctx), ctx)
        for name in self.list_commands(ctx):
            text = self.commands[name].get_short_help_str(limit=10_000)
            panels.setdefault(self._panel(name), []).append((name, text))
        _write(formatter, panels)

    def get_help_option(self, ctx: Any) -> Any:
        """The option --help, or None if the program has none."""
        return _bare(super().get_help_option(ctx))

    def get_params(self, ctx: Any) -> Any:
        """All options; the help shows the options for completion as flags, too."""
        parameters = _without_pydantic(super().get_params(ctx))
        for parameter in parameters:
            if parameter.name in ("install_completion", "show_completion"):
                _bare(parameter)
        return parameters

    def main(self, *args: Any, **more: Any) -> Any:
        """Run a command line; like every other error, wrong usage is one line on stderr."""
        alone = more.pop("standalone_mode", True)
        more["standalone_mode"] = False
        if not alone:
            return super().main(*args, **more)
        try:
            code = super().main(*args, **more)
        except _WRONG_USAGE as error:
            if type(error).__name__ == "NoArgsIsHelpError":
                typer.echo(_message(error), err=True)  # the help
            else:
                say(plain_usage(error))
            raise SystemExit(getattr(error, "exit_code", 2)) from None
        raise SystemExit(code if isinstance(code, int) else 0)


def _message(error: Any) -> str:
    """What an error of typer says."""
    return str(error.format_message())


def plain_usage(error: Any) -> str:
    """What is wrong with a command line, in one line that points to the help of the command."""
    text = " ".join(_message(error).split()).rstrip(".")
    text = re.sub(
        r"^Invalid value for (.+?): ", lambda match: match[1].replace("'", "") + ": ", text
    )
    text = re.sub(r"^(Missing|No such|Got unexpected)", lambda match: match[0].lower(), text)
    option = re.match(r"no such option: (--[\w-]+)", text)
    if option and option[1] in _RENAMED:
        text = f"{option[1]} is now {_RENAMED[option[1]]}"
    else:
        text = re.sub(
            r"[. ]+(?:\(Possible options: |Did you mean )([^)?]+)[)?]+$",
            lambda match: f": did you mean {either(match[1].replace(chr(39), '').split(', '))}?",
            text,
        )
    where = f"; see {error.ctx.command_path} --help" if getattr(error, "ctx", None) else ""
    return f"{text}{where}"


_RENAMED = {
    "--branch": "--way N, the number in the list of `count`, or --signs",
    "--component": "--way N, the number in the list of `count`",
    "--modes": "--way N, the number in the list of `count`, or --letters",
    "--branches": "--way N, --signs, --up or --letters, for one way",
    "--rim": "--boundary-heights",
    "--serve": "`exactfold serve PATTERN`",
}
"""Options of earlier versions, and what does the same now."""


_Rows: TypeAlias = list[tuple[str, str]]


def _by_panel(parameters: Sequence[Any], ctx: Any) -> dict[str, _Rows]:
    """The lines of the help by panel: parameters as they are typed, and what they mean."""
    panels: dict[str, _Rows] = {}
    for parameter in parameters:
        if record := parameter.get_help_record(ctx):
            usual = f"{parameter.param_type_name.capitalize()}s"
            panels.setdefault(parameter.rich_help_panel or usual, []).append(record)
    return panels


def _write(formatter: Any, panels: dict[str, _Rows]) -> None:
    """Write panels whose second columns begin at one place."""
    width = min(_FIRST_COLUMN, max(len(first) for rows in panels.values() for first, _ in rows))
    for panel, rows in panels.items():
        with formatter.section(panel):
            formatter.write_dl([(first.ljust(width), text) for first, text in rows], width)


class _Reader:
    """Makes the value of a parameter from its text, as typer does, but without pydantic.

    Pydantic takes longer to load than most commands take. No option here needs it: each has a
    parser, or is a path, a text, a flag, or a list of these.
    """

    def __init__(self, kind: Any, parser: Callable[[object], Any] | None) -> None:
        self._make = parser or (get_args(kind) or (kind,))[0]

    def __call__(self) -> _Reader:
        """This reader: typer asks a parameter for it."""
        return self

    def coerce(self, value: Any, param: Any, ctx: Any) -> Any:
        """The value of one text or of several; None or () if none was given."""
        if param.multiple or param.nargs == -1:
            return () if value is None else [self._make(text) for text in value]
        return None if value is None else self._make(value)


def _without_pydantic(parameters: list[Any]) -> list[Any]:
    """The same parameters, with readers of their own if typer would take pydantic for them."""
    for parameter in parameters:
        if hasattr(parameter, "get_runtime_param"):  # typer 0.29
            told = parameter.type_descriptor
            reader = _Reader(told.annotation, told.parameter_info.parser)
            parameter.get_runtime_param = reader
    return parameters


def _no_type(ctx: Any) -> None:
    return None


def _bare(option: Any) -> Any:
    if option is not None:
        option.metavar = ""
    return option
