"""Completion of commands, options and files in bash, zsh and fish, made from the parsers.

The script of a shell holds all words, so that completing starts no process. It is of the version of
gearcam that wrote it; what other packages add is in it if they were installed then.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.version import __version__

_FILES: Final = "*.toml"
"""Files that are offered, besides folders."""

_WIDTH: Final = 100
"""Largest length of a help text beside a word, characters."""

_TOP: Final = {"--help": "show the commands", "--version": "show the version"}
"""Options without a command."""


@dataclass(frozen=True, kw_only=True)
class _Word(ShortRepr):
    """An option or an operand of a command.

    Parameters
    ----------
    names : tuple of str
        ``-o`` and ``--output``; empty for an operand.
    help : str
        What it means, in one line.
    takes : str
        ``nothing``, ``file``, ``folder``, ``words`` or ``value``.
    words : tuple of str
        What may be its value.
    """

    names: tuple[str, ...]
    help: str
    takes: str
    words: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class _Completed(ShortRepr):
    """A command with its options and operands."""

    name: str
    help: str
    options: tuple[_Word, ...]
    operands: tuple[_Word, ...]


def script(shell: str, parsers: Iterable[argparse.ArgumentParser]) -> str:
    """Return the script that completes the commands of some parsers.

    Parameters
    ----------
    shell : str
        One of `SHELLS`.
    parsers : iterable of ArgumentParser
        One for each command, as of `gearcam.cli.parsers`.
    """
    commands = [_completed(one) for one in parsers]
    head = f"# Completion of gearcam {__version__} for {shell}; see `gearcam completion --help`."
    first = ["#compdef gearcam"] if shell == "zsh" else []
    return "\n".join([*first, head, *SHELLS[shell](commands)])


def _completed(parser: argparse.ArgumentParser) -> _Completed:
    words = [_word(parser, one) for one in parser._actions]
    return _Completed(
        name=parser.prog.rpartition(" ")[2],
        help=_line(parser.description or ""),
        options=tuple(one for one in words if one.names),
        operands=tuple(one for one in words if not one.names),
    )


def _word(parser: argparse.ArgumentParser, action: argparse.Action) -> _Word:
    suggested = vars(action).get("suggested", tuple)
    words = tuple(map(str, action.choices or suggested()))
    by_name = {"FILE": "file", "DIR": "folder"}
    takes = "words" if words else by_name.get(str(action.metavar), "value")
    if action.nargs == 0:
        takes = "nothing"
    shown = parser._get_formatter()._expand_help(action) if action.help else ""
    return _Word(names=tuple(action.option_strings), help=_line(shown), takes=takes, words=words)


def _line(text: str) -> str:
    """Return a help text in one line, cut where it is long."""
    text = " ".join(text.split()).removesuffix(".")
    return text if len(text) <= _WIDTH else f"{text[: _WIDTH - 3]}..."


def _quoted(text: str) -> str:
    """Return a text in the single quotes of bash and zsh."""
    return "'" + text.replace("'", "'\\''") + "'"


# --- bash -----------------------------------------------------------------------------------------

_BASH: Final = """\
_gearcam() {
    local current="${COMP_WORDS[COMP_CWORD]}" command="${COMP_WORDS[1]}" takes= words=
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        COMPREPLY=( $(compgen -W '@@names@@' -- "$current") )
        return
    fi
    case "$command ${COMP_WORDS[COMP_CWORD-1]}" in
@@values@@
    esac
    if [ -z "$takes" ]; then
        case "$command" in
@@options@@
        esac
        case "$current" in
            -*) takes=words ;;
            *)
                takes=file
                case "$command $COMP_CWORD" in
@@operands@@
                esac
                ;;
        esac
    fi
    local IFS=$'\\n'
    case "$takes" in
        words) IFS=$' \\t\\n'; COMPREPLY=( $(compgen -W "$words" -- "$current") ) ;;
        folder) compopt -o filenames 2>/dev/null; COMPREPLY=( $(compgen -d -- "$current") ) ;;
        file)
            compopt -o filenames 2>/dev/null
            COMPREPLY=( $(compgen -f -X '!@@files@@' -- "$current"; compgen -d -- "$current") )
            ;;
    esac
}
complete -F _gearcam gearcam"""


def _bash(commands: Sequence[_Completed]) -> Iterator[str]:
    """Yield the lines of the script for bash."""
    values, options, operands = [], [], []
    for one in commands:
        for word in one.options:
            if word.takes != "nothing":
                places = "|".join(f'"{one.name} {name}"' for name in word.names)
                values.append(f"        {places}) {_bash_value(word)} ;;")
        names = " ".join(name for word in one.options for name in word.names)
        options.append(f"            {one.name}) words={_quoted(names)} ;;")
        for place, word in enumerate(one.operands, start=2):
            if word.takes != "file":
                operands.append(f'                    "{one.name} {place}") {_bash_value(word)} ;;')
    texts = {
        "names": " ".join([*(one.name for one in commands), *_TOP]),
        "values": "\n".join(values),
        "options": "\n".join(options),
        "operands": "\n".join(operands),
        "files": _FILES,
    }
    text = _BASH
    for name, content in texts.items():
        text = text.replace(f"@@{name}@@", content)
    yield text


def _bash_value(word: _Word) -> str:
    words = f" words={_quoted(' '.join(word.words))}" if word.words else ""
    return f"takes={word.takes}{words}"


# --- zsh ------------------------------------------------------------------------------------------


def _zsh(commands: Sequence[_Completed]) -> Iterator[str]:
    """Yield the lines of the script for zsh."""
    yield "_gearcam() {"
    yield "  local -a commands"
    yield "  commands=("
    yield from (f"    {_quoted(f'{one.name}:{one.help}')}" for one in commands)
    yield "  )"
    yield "  if (( CURRENT == 2 )); then"
    yield "    _describe -t commands command commands"
    top = " ".join(_quoted(f"{name}[{words}]") for name, words in _TOP.items())
    yield f"    _arguments {top}"
    yield "    return"
    yield "  fi"
    yield "  local command=$words[2]"
    yield "  shift words"
    yield "  (( CURRENT-- ))"
    yield "  case $command in"
    for one in commands:
        yield f"    {one.name})"
        options = [_zsh_option(word) for word in one.options]
        operands = [
            f"{'*' if place == len(one.operands) else place}:{_zsh_text(word.help)}:"
            f"{_zsh_value(word)}"
            for place, word in enumerate(one.operands, start=1)
        ]
        yield "      _arguments \\"
        lines = [*options, *(_quoted(operand) for operand in operands)]
        yield " \\\n".join(f"        {line}" for line in lines)
        yield "      ;;"
    yield "  esac"
    yield "}"
    yield 'if [ "$funcstack[1]" = "_gearcam" ]; then'  # from a folder of fpath, at the first use
    yield '  _gearcam "$@"'
    yield "else"
    yield "  compdef _gearcam gearcam"
    yield "fi"


def _zsh_option(word: _Word) -> str:
    value = "" if word.takes == "nothing" else f":{_zsh_text(word.takes)}:{_zsh_value(word)}"
    told = _quoted(f"[{_zsh_text(word.help)}]{value}")
    if len(word.names) == 1:
        return f"{word.names[0]}{told}"
    return f"'({' '.join(word.names)})'{{{','.join(word.names)}}}{told}"


def _zsh_text(text: str) -> str:
    """Return a text in which no sign means anything to ``_arguments``."""
    for sign in "\\[]:":
        text = text.replace(sign, f"\\{sign}")
    return text


def _zsh_value(word: _Word) -> str:
    if word.words:
        return f"({' '.join(word.words)})"
    return {"file": f'_files -g "{_FILES}"', "folder": "_files -/"}.get(word.takes, " ")


# --- fish -----------------------------------------------------------------------------------------


def _fish(commands: Sequence[_Completed]) -> Iterator[str]:
    """Yield the lines of the script for fish."""
    yield "complete -c gearcam -f"
    for name, words in _TOP.items():
        yield f"complete -c gearcam -n __fish_use_subcommand -l {name[2:]} -d {_fish_text(words)}"
    for one in commands:
        told = _fish_text(one.help)
        yield f"complete -c gearcam -n __fish_use_subcommand -a {one.name} -d {told}"
    for one in commands:
        start = f"complete -c gearcam -n '__fish_seen_subcommand_from {one.name}'"
        for word in one.options:
            names = (
                f"-l {name[2:]}" if name[:2] == "--" else f"-s {name[1:]}" for name in word.names
            )
            yield f"{start} {' '.join(names)}{_fish_value(word)} -d {_fish_text(word.help)}"
        for word in one.operands:
            yield f"{start}{_fish_value(word).replace(' -x', '', 1)}"


def _fish_text(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def _fish_value(word: _Word) -> str:
    if word.words:
        return f" -x -a {_fish_text(' '.join(word.words))}"
    found = {
        "nothing": "",
        "file": " -x -k -a '(__fish_complete_suffix .toml)'",
        "folder": " -x -a '(__fish_complete_directories)'",
    }
    return found.get(word.takes, " -x")


SHELLS: Final[Mapping[str, Callable[[Sequence[_Completed]], Iterator[str]]]] = {
    "bash": _bash,
    "zsh": _zsh,
    "fish": _fish,
}
"""What yields the script of each shell."""

PLACES: Final = {
    "bash": "~/.local/share/bash-completion/completions/gearcam",
    "zsh": "~/.zfunc/_gearcam, a folder of fpath",
    "fish": "~/.config/fish/completions/gearcam.fish",
}
"""Where the script of each shell is looked for."""
