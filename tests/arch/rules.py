"""The rules of the house that no linter knows, read from the syntax tree.

Each rule takes a file and returns its faults as sentences; an empty list is a pass. The tests
beside this module apply them to the package and show, on planted samples, that each can fail.
"""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src" / "gearcam"
Function = ast.FunctionDef | ast.AsyncFunctionDef


def python_files(*folders: Path) -> list[Path]:
    return sorted(path for folder in folders for path in folder.rglob("*.py"))


def parse(path: Path) -> ast.Module:
    """The tree of a file, which nobody changes."""
    return _tree(path.read_text(encoding="utf-8"), str(path))


@cache
def _tree(text: str, name: str) -> ast.Module:
    return ast.parse(text, filename=name)


# --- imports -------------------------------------------------------------------------------------


def imports_of(*paths: Path, root: Path) -> dict[str, set[str]]:
    """The modules under `root` that each file imports anywhere in it, for types too, by name."""
    names = {
        path: ".".join((root.name, *path.relative_to(root).with_suffix("").parts)) for path in paths
    }
    modules = {name.removesuffix(".__init__") for name in names.values()}
    return {
        name.removesuffix(".__init__"): {
            inner if (inner := f"{node.module}.{alias.name}") in modules else node.module or ""
            for node in ast.walk(parse(path))
            if isinstance(node, ast.ImportFrom)
            for alias in node.names
        }
        & modules
        for path, name in names.items()
    }


# --- docstrings ---------------------------------------------------------------------------------


def promised_methods(*paths: Path) -> frozenset[str]:
    """Names of the methods of protocols: described there, once for all who keep the promise."""
    return frozenset(
        item.name
        for path in paths
        for node in ast.walk(parse(path))
        if isinstance(node, ast.ClassDef) and "Protocol" in map(ast.unparse, node.bases)
        for item in node.body
        if isinstance(item, Function)
    )


def docstring_faults(path: Path, promised: frozenset[str] = frozenset()) -> list[str]:
    """Public names without a docstring, or with one that leaves out what numpydoc asks for.

    A function of two parameters or more names each under Parameters, or in its one paragraph, or
    defers with "(see `Name`)"; one that returns says so, under Returns or by a first sentence
    "Return ..." or "Yield ..."; what it raises itself is named. Every field of a dataclass is named
    in the docstring of its class, or carries its own `doc=`. Private names, magic methods and
    overloads are free; properties, and functions of one parameter that state in one line what they
    are, need that line; so do commands (their options carry help), registered checks (all are
    called alike) and methods that a protocol has promised.
    """
    tree = parse(path)
    faults = [] if ast.get_docstring(tree) else ["the module has no docstring"]
    faults += _body_faults(tree.body, "", promised)
    return [f"{path.name}: {fault}" for fault in faults]


def _body_faults(body: list[ast.stmt], owner: str, promised: frozenset[str]) -> list[str]:
    faults: list[str] = []
    for node in body:
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            faults += _class_faults(node, owner + node.name)
            faults += _body_faults(node.body, f"{owner}{node.name}.", promised)
        elif isinstance(node, Function) and not node.name.startswith("_"):
            brief = bool(owner) and node.name in promised
            faults += _function_faults(node, owner + node.name, method=bool(owner), brief=brief)
    return faults


def _class_faults(node: ast.ClassDef, name: str) -> list[str]:
    doc = ast.get_docstring(node)
    if not doc:
        return [f"class {name} has no docstring"]
    if not any("dataclass" in ast.unparse(mark) for mark in node.decorator_list):
        return []
    fields = [
        item.target.id
        for item in node.body
        if isinstance(item, ast.AnnAssign)
        and isinstance(item.target, ast.Name)
        and not item.target.id.startswith("_")
        and "ClassVar" not in ast.unparse(item.annotation)
        and not (item.value is not None and "doc=" in ast.unparse(item.value))
    ]
    return [
        f"class {name}: field {field} is not described"
        for field in fields
        if not _named(field, doc)
    ]


def _function_faults(node: Function, name: str, *, method: bool, brief: bool) -> list[str]:
    marks = [ast.unparse(mark) for mark in node.decorator_list]
    if any(mark.endswith(("overload", ".setter")) for mark in marks):
        return []
    doc = ast.get_docstring(node)
    if not doc:
        return [f"{name} has no docstring"]
    checks = ("check(", "pair_check(")
    registered = any(".command(" in mark or mark.startswith(checks) for mark in marks)
    if brief or registered or any(mark.endswith("property") for mark in marks):
        return []
    static = any(mark.endswith("staticmethod") for mark in marks)
    parameters = _parameters(node, skip_first=method and not static)
    faults = _parameter_faults(parameters, doc, name)
    plain = "\n" not in doc and len(parameters) < 2
    silent = {"None", "NoReturn", "Never"}
    returns = node.returns is not None and ast.unparse(node.returns) not in silent and not plain
    if returns and not (_section(doc, "(?:Returns|Yields)") or re.match("(Return|Yield)s? ", doc)):
        faults.append(f"{name}: what it returns is not described")
    raises = _section(doc, "Raises")
    faults += [
        f"{name}: raises {error}, not described"
        for error in sorted(_raised(node))
        if not _named(error, raises)
    ]
    return faults


def _parameters(node: Function, *, skip_first: bool) -> list[str]:
    arguments = node.args
    names = [item.arg for item in (*arguments.posonlyargs, *arguments.args)][int(skip_first) :]
    names += [item.arg for item in arguments.kwonlyargs]
    names += [item.arg for item in (arguments.vararg, arguments.kwarg) if item is not None]
    return [name for name in names if not name.startswith("_")]


def _parameter_faults(parameters: list[str], doc: str, name: str) -> list[str]:
    section = _section(doc, "Parameters")
    if not section and (len(parameters) < 2 or re.search(r"\(see `\w[\w.]*`\)", doc)):
        return []
    if "\n\n" not in doc:
        section = doc
    return [
        f"{name}: parameter {parameter} is not described"
        for parameter in parameters
        if not _named(parameter, section)
    ]


def _section(doc: str, title: str) -> str:
    found = re.search(rf"^{title}\n-+\n(.*?)(?=^\w[^\n]*\n---|\Z)", doc, re.MULTILINE | re.DOTALL)
    return found.group(1) if found else ""


def _named(word: str, text: str) -> bool:
    return word in _words(text)


@cache
def _words(text: str) -> frozenset[str]:
    return frozenset(re.findall(r"\w+", text))


def _raised(node: ast.AST) -> set[str]:
    """Names of the errors that a function raises itself (nested functions aside)."""
    found: set[str] = set()
    for child in ast.iter_child_nodes(node):
        if isinstance(child, Function | ast.Lambda | ast.ClassDef):
            continue
        if isinstance(child, ast.Raise) and isinstance(child.exc, ast.Call):
            name = ast.unparse(child.exc.func).split(".")[-1]
            if name[0].isupper():
                found.add(name)
        found |= _raised(child)
    return found
