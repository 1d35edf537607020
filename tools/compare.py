"""Compares the results of an older commit with those of this tree, for random designs and profiles.

    make compare BASE=13c2b87 N=200 SEED=7
    python tools/compare.py 13c2b87 --only cam/17 --keep /tmp/apart

Each side is a separate process that uses the public interface of gearcam. Designs are drawn until
the base has built N of each kind. Outlines, findings, refusals and files are compared. The exit
code is 1 if something differs, and 2 if nothing can be compared.
"""

from __future__ import annotations

import argparse
import fnmatch
import json
import shutil
import sys
import tempfile
import tomllib
from collections import Counter, deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from compare_files import MORE, Difference, called, folders, told
from compare_sides import GALLERY, ROOT, Side, tree_of
from gearcam.designs.writing import toml_text
from random_designs.designs import MAKERS, design

SHOWN: Final = 30
"""Largest number of places listed."""

OUT: Final = "out of time"
"""The outcome of a design that is not compared."""

_AHEAD: Final = 3
"""Number of designs queued for the sides."""

_DRAWN: Final = 3
"""Largest number of designs drawn for each one to be built."""


@dataclass(frozen=True)
class Task:
    """A design for both sides: its kind, its name, and the file of each side."""

    kind: str
    name: str
    files: tuple[Path, Path]


@dataclass
class Report:
    """Statistics of outcomes and differences.

    Parameters
    ----------
    allowed : sequence of str
        Patterns of places that may differ.
    more : bool
        Whether summaries of the tree may have additional keys.
    counts : mapping of str to Counter
        Numbers of outcomes by kind.
    found : mapping of str to list
        Names of designs with their largest difference, by pattern of its place.
    """

    allowed: Sequence[str] = ()
    more: bool = False
    counts: dict[str, Counter[str]] = field(default_factory=dict)
    found: dict[str, list[tuple[str, Difference]]] = field(default_factory=dict)

    def take(self, task: Task, end: str, differences: Iterable[Difference]) -> bool:
        """Record a design and its differences; return whether it differs.

        Parameters
        ----------
        task : Task
            The design.
        end : str
            Outcome of both sides.
        differences : iterable of Difference
            All differences, also those that are allowed.
        """
        kept = [one for one in differences if not self._may(one)]
        counts = self.counts.setdefault(task.kind, Counter())
        counts[end] += 1
        counts["differ" if kept else "same"] += 1
        for pattern in dict.fromkeys(one.pattern for one in kept):
            worst = max((one for one in kept if one.pattern == pattern), key=lambda one: one.size)
            self.found.setdefault(pattern, []).append((task.name, worst))
        return bool(kept)

    def _may(self, one: Difference) -> bool:
        if self.more and one.words == MORE:
            return True
        return any(fnmatch.fnmatchcase(one.place, pattern) for pattern in self.allowed)

    def lines(self) -> Iterator[str]:
        """Yield the lines of the printed statistics."""
        ends = ("built", "refused", "out of time", "one side only")
        head = ("designs", "same", "differ", *ends)
        yield f"{'':<12}" + "".join(f"{one:>15}" for one in head)
        for kind, counts in self.counts.items():
            row = (counts["same"] + counts["differ"], *(counts[one] for one in head[1:]))
            yield f"{kind:<12}" + "".join(f"{one:>15}" for one in row)
        ranked = sorted(self.found.items(), key=lambda item: -len(item[1]))
        for pattern, cases in ranked[:SHOWN]:
            name, worst = max(cases, key=lambda case: case[1].size)
            yield f"\n{pattern}: {len(cases)} design{'s' * (len(cases) > 1)}"
            yield f"    largest {worst.size:.3g} in {name}, {worst.place}: {worst.words[:300]}"
        if len(ranked) > SHOWN:
            yield f"\nand {len(ranked) - SHOWN} more places"


def renamed(text: str, renames: Mapping[str, str]) -> str:
    """Return a design file of the tree with the keys and words of the base.

    Parameters
    ----------
    text : str
        The design file.
    renames : mapping of str to str
        Dotted keys, or words without a dot, of the base by those of the tree.
    """
    document = tomllib.loads(text)
    for new, old in renames.items():
        if "." not in new:
            for table in filter(lambda one: isinstance(one, dict), document.values()):
                table |= {key: old for key, value in table.items() if value == new}
            continue
        (title, key), (old_title, old_key) = new.split("."), old.split(".")
        if key in document.get(title, {}):
            document.setdefault(old_title, {})[old_key] = document[title].pop(key)
            if not document[title]:
                del document[title]
    return toml_text(document)


def differences(
    files: tuple[Path, Path],
    ends: tuple[Mapping[str, Any], ...],
    *,
    limit: float,
    messages: bool,
    names: Mapping[str, str],
) -> tuple[str, list[Difference]]:
    """Return the outcome of a design on both sides, and the differences.

    Parameters
    ----------
    files : tuple of Path
        The design file of each side; its output is in the folder ``NAME.out`` beside it.
    ends : tuple of mapping
        The answer of each side.
    limit : float, s
        CPU time allowed for each.
    messages : bool
        Whether to compare the words of messages.
    names : mapping of str to str
        Names of the base by those of the tree (see `called`).
    """
    ends = (json.loads(called(json.dumps(ends[0]), names)), ends[1])
    one, two = (end["end"] for end in ends)
    if OUT in (one, two) and (one == two or min(end["seconds"] for end in ends) > 0.5 * limit):
        return OUT, []
    found: list[Difference] = []
    end = "built" if one == "built" else "refused"
    if one != two:
        words = " | ".join(f"{end['end']} {end.get('text', '')[:120]}".strip() for end in ends)
        end, found = "one side only", [Difference(f"end:{one} | {two}", float("inf"), words)]
    elif one != "built":
        found += told("refusal", ends[0].get("refusal", []), ends[1].get("refusal", []),
                      messages=messages)  # fmt: skip
    else:
        found += told("finding", ends[0]["findings"], ends[1]["findings"], messages=messages)
    if one == two:
        first, second = (path.with_suffix(".out") for path in files)
        tolerance = tolerance_of(files[0]) if one == "built" else 0.0  # it may be no TOML
        found += folders(first, second, tolerance, names)
    return end, found


def tolerance_of(file: Path) -> float:
    """Return the chord tolerance of a design file, mm, or the default one."""
    document = tomllib.loads(file.read_text(encoding="utf-8"))
    module = document.get("pair", {}).get("module_mm", 1.0)
    return document.get("output", {}).get("chord_tolerance_mm", min(1e-3, 1e-3 * module))


class Comparison:
    """A comparison of two trees.

    Parameters
    ----------
    given : Namespace
        The command line.
    trees : tuple of Path
        Base and tree.
    folder : Path
        Folder for designs and their output.
    """

    def __init__(self, given: argparse.Namespace, trees: tuple[Path, Path], folder: Path) -> None:
        self.given, self.trees = given, trees
        names = ("base", "tree")
        made = [Side(tree, folder / name, given.limit)
                for tree, name in zip(trees, names, strict=True)]  # fmt: skip
        self.sides = (made[0], made[1])
        self.renames = dict(pair.split("=")[::-1] for pair in given.rename)
        self.names = dict(pair.split("=")[::-1] for pair in given.called)
        self.report = Report(given.allow, given.more)
        self.waiting: deque[Task] = deque()
        self.built = 0

    def run(self) -> Report:
        """Run the comparison and return its statistics."""
        try:
            if not self.given.only and not self.given.no_gallery:
                self._each(self._gallery())
            for kind in self.given.kind or MAKERS:
                self.built = 0
                self._each(self._drawn(kind))
        finally:
            for side in self.sides:
                side.stop()
        return self.report

    def _gallery(self) -> Iterator[Task]:
        names = [{path.name for path in (tree / GALLERY).iterdir()} for tree in self.trees]
        for side, tree in zip(self.sides, self.trees, strict=True):
            for path in filter(Path.is_file, (tree / GALLERY).iterdir()):
                shutil.copy(path, side.folder)
        for name in sorted(names[0] | names[1]):
            if name.endswith(".toml"):
                yield Task(
                    "gallery", name, (self.sides[0].folder / name, self.sides[1].folder / name)
                )

    def _drawn(self, kind: str) -> Iterator[Task]:
        if self.given.only:
            wanted = [int(one.partition("/")[2]) for one in self.given.only if one.startswith(kind)]
        else:
            wanted = range(_DRAWN * self.given.count)
        for index in wanted:
            if self.built >= self.given.count:
                return
            drawn = design(kind, self.given.seed, index)
            file = drawn.write(self.sides[1].folder)
            for name, text in drawn.files.items():
                text = (
                    renamed(text, self.renames)
                    if name == file.name and self.renames and not drawn.broken
                    else text
                )
                (self.sides[0].folder / name).write_text(text, encoding="utf-8")
            yield Task(kind, f"{kind}/{index}", (self.sides[0].folder / file.name, file))

    def _each(self, tasks: Iterator[Task]) -> None:
        for task in tasks:
            self.waiting.append(task)
            for side, file in zip(self.sides, task.files, strict=True):
                side.ask(file, file.with_suffix(".out"))
            if len(self.waiting) > _AHEAD:
                self._take()
        while self.waiting:
            self._take()

    def _take(self) -> None:
        task = self.waiting.popleft()
        ends = tuple(side.answer() for side in self.sides)
        self.built += ends[0]["end"] == "built"
        end, found = differences(
            task.files, ends,
            limit=self.given.limit, messages=self.given.messages, names=self.names,
        )  # fmt: skip
        differs = self.report.take(task, end, found)
        if differs and self.given.keep:
            for side, file in zip(self.sides, task.files, strict=True):
                kept = self.given.keep / side.folder.name
                kept.mkdir(parents=True, exist_ok=True)
                shutil.copy(file, kept)
                if file.with_suffix(".out").exists():
                    shutil.copytree(file.with_suffix(".out"), kept / file.stem, dirs_exist_ok=True)
        for file in task.files:
            shutil.rmtree(file.with_suffix(".out"), ignore_errors=True)


def arguments() -> argparse.Namespace:
    """Return the arguments of the command line."""
    parser = argparse.ArgumentParser(description="Compare a commit with this tree.")
    parser.add_argument("base", help="a commit, or a folder with src and profiles")
    parser.add_argument("--tree", type=Path, default=ROOT, help="tree instead of this one")
    parser.add_argument("--kind", action="append", choices=[*MAKERS])
    parser.add_argument("--count", type=int, default=50, help="designs built of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--only", action="append", metavar="KIND/NUMBER", help="compare this design only"
    )
    parser.add_argument("--no-gallery", action="store_true", help="random designs only")
    words = "ignore differences at this place, such as 'summary.json:accuracy.*' or 'finding:tip-*'"
    parser.add_argument("--allow", action="append", default=[], metavar="PATTERN", help=words)
    words = "allow additional keys in summaries of this tree"
    parser.add_argument("--more", action="store_true", help=words)
    words = "key or word of designs with another name in the base: helix.steps=steps.count"
    parser.add_argument("--rename", action="append", default=[], metavar="OLD=NEW", help=words)
    words = "name in files and findings that differs in the base: u_mm=travel_mm"
    parser.add_argument("--called", action="append", default=[], metavar="OLD=NEW", help=words)
    parser.add_argument("--messages", action="store_true", help="compare the words of messages too")
    parser.add_argument("--limit", type=float, default=20.0, help="CPU time for a design, s")
    parser.add_argument("--keep", type=Path, help="folder in which to keep designs that differ")
    return parser.parse_args()


def main() -> int:
    """Run the command and return its exit code."""
    given = arguments()
    with tree_of(given.base) as base, tempfile.TemporaryDirectory(prefix="compare-") as folder:
        comparison = Comparison(given, (base, given.tree.resolve()), Path(folder).resolve())
        report = comparison.run()
    print("\n".join(report.lines()))
    print("\nCPU seconds " + " | ".join(f"{side.seconds:.1f}" for side in comparison.sides))
    if report.found:
        print(
            f"Repeat one with: tools/compare.py {given.base} --seed {given.seed} --only KIND/NUMBER"
        )
    return 1 if report.found else 0


if __name__ == "__main__":
    sys.exit(main())
