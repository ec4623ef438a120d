"""Makes commands: options from a dataclass, plain help, usage errors in one line."""

from __future__ import annotations

import re
from collections.abc import Callable
from inspect import Parameter, signature
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from exactfold._support.plurals import either
from exactfold.app.shell.shell import reported, say

_WRONG_USAGE: type[Exception] = typer.BadParameter.__bases__[0]  # typer does not export it


def taking(options: type[Any]) -> Callable[[Callable[..., int]], Callable[..., None]]:
    """A decorator that makes a command whose options are the fields of a dataclass.

    The decorated function returns the exit code. Each field is an option or argument of typer, and
    the help lists them in the order of the fields. The options of a base class with a `panel` stand
    under that heading.
    """

    def made(run: Callable[..., int]) -> Callable[..., None]:
        def command(**given: Any) -> None:
            raise typer.Exit(run(**given))

        command.__name__, command.__doc__ = run.__name__, run.__doc__
        taken_by = signature(options, eval_str=True)
        wrapped = reported(command)
        panels = {
            name: vars(base)["panel"]
            for base in options.__mro__
            if "panel" in vars(base)
            for name in base.__annotations__
        }
        taken = [
            _for_typer(field, panels.get(field.name, "")) for field in taken_by.parameters.values()
        ]
        wrapped.__signature__ = taken_by.replace(parameters=taken)  # type: ignore[attr-defined]
        return wrapped

    return made


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

    def get_help_option(self, ctx: Any) -> Any:
        """The option --help, or None if the command has none."""
        return _bare(super().get_help_option(ctx))

    def get_params(self, ctx: Any) -> Any:
        """All parameters; the help shows arguments without a type."""
        parameters = super().get_params(ctx)
        for parameter in parameters:
            if parameter.param_type_name == "argument":
                setattr(parameter, "display_type_rich", _no_type)  # noqa: B010 - typer's own name
        return parameters

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """The words of the usage line, such as PATTERN... instead of {PATTERN}..."""
        return [re.sub("[{}]", "", piece) for piece in super().collect_usage_pieces(ctx)]


PANELS = ("Ask", "See", "Fold", "Prove", "Files", "Studies")
"""The groups of commands in the help, in their order."""


class Group(TyperGroup):
    """The program with all its commands."""

    def list_commands(self, ctx: Any) -> list[str]:
        """The names of all commands, group by group."""
        return sorted(self.commands, key=lambda name: PANELS.index(self._panel(name)))

    def _panel(self, name: str) -> str:
        return str(getattr(self.commands[name], "rich_help_panel", PANELS[0]))

    def get_help_option(self, ctx: Any) -> Any:
        """The option --help, or None if the program has none."""
        return _bare(super().get_help_option(ctx))

    def get_params(self, ctx: Any) -> Any:
        """All options; the help shows the options for completion as flags, too."""
        parameters = super().get_params(ctx)
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
            if type(error).__name__ != "NoArgsIsHelpError":  # the help has been printed
                say(plain_usage(error))
            raise SystemExit(getattr(error, "exit_code", 2)) from None
        raise SystemExit(code if isinstance(code, int) else 0)


def plain_usage(error: Any) -> str:
    """What is wrong with a command line, in one line that points to the help of the command."""
    text = " ".join(error.format_message().split()).rstrip(".")
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


def _no_type(ctx: Any) -> None:
    return None


def _bare(option: Any) -> Any:
    if option is not None:
        option.metavar = ""
    return option
