"""Write requirements.lock: the packages that the Makefile installs, with versions and hashes.

All packages are resolved together, for every supported Python and platform, with one version of
each, so that all machines use the same type stubs and the same numpy. A section lists the packages
that its target needs in addition to the sections before it. The section `lowest` is independent:
the lowest versions that pyproject.toml allows, with the tools of the tests.

For `make lock`. If a package cannot be resolved, the file is not changed.
"""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
LOCK = ROOT / "requirements.lock"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
SECTIONS = {
    "run": ["pyproject.toml"],
    "install": ["--group", "install"],
    "step": ["pyproject.toml", "--extra", "step"],
    "plot": ["pyproject.toml", "--extra", "plot"],
    "sweep": ["pyproject.toml", "--extra", "sweep"],
    "optimize": ["pyproject.toml", "--extra", "optimize"],
    "stress": ["pyproject.toml", "--extra", "stress"],
    "dynamics": ["pyproject.toml", "--extra", "dynamics"],
    "test": ["--group", "test"],
    "lint": ["--group", "lint"],
    "bench": ["--group", "bench"],
    "docs": ["--group", "docs"],
    "lock": ["--group", "lock"],
}
TOOLS = ["--group", "install", "--group", "test"]
_MORE = [word for name in ("sweep", "optimize", "stress", "dynamics") for word in ("--extra", name)]
HEAD = """\
# Written by `make lock`; installed by the Makefile, section by section.
"""


def resolve(*wanted: str) -> list[str]:
    """Return the locked packages of a resolution, each with its hashes."""
    oldest = PROJECT["project"]["requires-python"].removeprefix(">=")
    options = "--universal --fork-strategy fewest --only-binary :all: --generate-hashes"
    told = f"{options} --no-annotate --no-header --quiet --python-version {oldest}"
    command = [sys.executable, "-m", "uv", "pip", "compile", *told.split(), *wanted]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode:
        sys.exit(f"{LOCK.name} was not changed")  # uv has printed the reason
    return re.split(r"^(?=\w)", done.stdout, flags=re.MULTILINE)[1:]


def has(known: list[str], package: str) -> bool:
    """Return whether a package is already listed for every platform that needs it."""
    pin, marked = package.split()[0], ";"
    same = [one for one in known if one.split()[0] == pin]
    return package in same or any(one.split()[1] != marked for one in same)


def hold(folder: Path, packages: list[str]) -> list[str]:
    """Return the options that fix these versions in a resolution."""
    held = folder / "held.txt"
    held.write_text("".join(packages), encoding="utf-8")
    return ["--constraints", str(held)]


def sections(folder: Path) -> dict[str, list[str]]:
    """Return the packages of each section."""
    everything = resolve(*(word for wanted in SECTIONS.values() for word in wanted))
    held = hold(folder, everything)
    made: dict[str, list[str]] = {}
    for name, wanted in SECTIONS.items():
        known = [package for packages in made.values() for package in packages]
        made[name] = [package for package in resolve(*wanted, *held) if not has(known, package)]
    held = hold(folder, made["install"] + made["test"])
    lowest = [*SECTIONS["step"], "--extra", "plot", *_MORE, *TOOLS, "--resolution", "lowest-direct"]
    return made | {"lowest": resolve(*lowest, *held)}


def main() -> None:
    """Write the complete file, or leave it unchanged."""
    with TemporaryDirectory() as folder:
        made = sections(Path(folder))
    parts = [f"\n# for {name}\n{''.join(packages)}" for name, packages in made.items()]
    fresh = LOCK.with_suffix(".new")
    fresh.write_text(HEAD + "".join(parts), encoding="utf-8")
    fresh.replace(LOCK)
    print(f"{LOCK.name}: {sum(map(len, made.values()))} packages")


if __name__ == "__main__":
    main()
