"""The JSON schema of design files, for editors that complete and check TOML while it is typed.

It derives from the tables that also validate files, so that both agree on keys, types and ranges.
Other rules, such as increasing knots and valid formulas, are checked only when a file is read.
"""

from __future__ import annotations

from collections import ChainMap
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

from gearcam.base.inches import UNITS, key_in, spellings_in, text_in, value_in
from gearcam.base.quantities import NONE, REQUIRED
from gearcam.base.rules import Field, Fields, Rule
from gearcam.designs.faults import description
from gearcam.designs.kind import KINDS, OF_MANY, DesignKind, Variants, variant_of
from gearcam.designs.nodes import Choice, Either, Keys, Many, Node
from gearcam.designs.table import Key, Table
from gearcam.parts.fits import HOLE

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"

Schema = dict[str, Any]

_TYPES: Final = {float: "number", int: "integer", str: "string", bool: "boolean"}
_BOUNDS: Final = {
    "gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"
}  # fmt: skip

_TURNED: Final = {"minimum": "maximum", "maximum": "minimum"}

_NAME_PATTERN: Final = r"^[A-Za-z0-9_\u00aa-\uffff]([A-Za-z0-9_.\-\u00aa-\uffff]*[^.])?$"
"""An approximation for editors; the reader distinguishes letters of all scripts from symbols."""


def schema() -> Schema:
    """Return the schema of design files.

    Returns
    -------
    dict
        JSON schema, draft 2020-12, with a branch for each kind of design, law and phase.
    """
    definitions: Schema = {}
    for kind in KINDS.values():
        kind.take_brought()
        parts: Schema = {}
        for title in (*kind.tree, "limits"):
            home = title if title in kind.nodes else f"{kind.name}-{title}"
            made, own = _node(kind.node(title), home)
            definitions |= own
            if title in kind.nodes:
                parts[title] = made
            else:
                definitions[home] = made
                parts[title] = {"$ref": f"#/$defs/{home}"}
        definitions[kind.name] = _branch(kind, parts)
    return {
        "$schema": DIALECT,
        "title": "gearcam design file",
        "type": "object",
        "required": ["kind"],
        "properties": {"kind": {"enum": list(KINDS), "description": "kind of design"}},
        "allOf": [_when("kind", name, _of_units(_meant(kind))) for name, kind in KINDS.items()],
        "$defs": definitions
        | {f"inch-{name}": _in_inches(one) for name, one in definitions.items()},
    }


def _of_units(made: Schema) -> Schema:
    """Return the schema of a file in mm as that of one in mm or in inches."""
    return _when("units", UNITS[1], _in_inches(made)) | {"else": made}


def _in_inches(part: Any, key: str = "") -> Any:
    """Return a part of a schema for files in inches; below the `key` of a length it is in mm."""
    if isinstance(part, list):
        return [_in_inches(one, key) for one in part]
    if not isinstance(part, Mapping):
        return part
    made = dict(_word_in(word, value, key) for word, value in part.items())
    needed = (spellings_in(one) for one in part.get("required", ()))
    either = [{"anyOf": [{"required": [name]} for name in one]} for one in needed if one[1:]]
    return made | ({"allOf": [*made.get("allOf", []), *either]} if either else {})


def _word_in(word: str, value: Any, key: str) -> tuple[str, Any]:
    """Return a word of a schema and its value for files in inches."""
    if word == "required":
        return word, [one for one in value if not spellings_in(one)[1:]]
    if word == "properties":
        return word, value | {key_in(name): _in_inches(one, name) for name, one in value.items()}
    if word == "propertyNames":
        return word, {"enum": [name for one in value["enum"] for name in spellings_in(one)]}
    if word == "description":
        return word, text_in(value)
    if word == "$ref":
        return word, value.replace("/$defs/", "/$defs/inch-")
    if word in ("default", "const", "enum", *_BOUNDS.values()):
        turned = key_in(key) == "diametral_pitch"  # of a small module it is large
        return _TURNED.get(word, word) if turned else word, value_in(key, value)
    return word, _in_inches(value, key)


def _meant(kind: DesignKind) -> Schema:
    """Return the schema of a kind, or of another one for some variants."""
    made: Schema = {"$ref": f"#/$defs/{kind.name}"}
    variants = kind.variants
    for value, name in variants.elsewhere.items() if variants else ():
        chosen = {"properties": {variants.key: {"const": value}}, "required": [variants.key]}  # pyright: ignore
        given = {"properties": {variants.title: chosen}, "required": [variants.title]}  # pyright: ignore
        made = {"if": given, "then": {"$ref": f"#/$defs/{name}"}, "else": made}
    return made


def _names(kind: DesignKind) -> list[str]:
    """Return the words for a kind in files: its name, and the kind of which it is a variant."""
    found = variant_of(kind)
    return [kind.name, found[0].name] if found else [kind.name]


def _when(key: str, value: str, then: Schema) -> Schema:
    """Return a condition: `then` holds if a key has a value."""
    return {"if": {"properties": {key: {"const": value}}, "required": [key]}, "then": then}


def _node(node: Node, home: str) -> tuple[Schema, Schema]:
    """Return the schema of a node, and the definitions in it, whose names begin with `home`."""
    if isinstance(node, Either):
        return _either(node, home)
    if isinstance(node, Many):
        made, own = _node(node.item, home)
        many: Schema = {"minItems": node.least} if node.least else {}
        return {"type": "array", "items": made} | many, own
    if isinstance(node, Choice):
        return _choice(node, home, {}, {})
    return _keys(node, node.table, ()), {}


def _choice(
    node: Choice, home: str, above: Mapping[str, str], keys: Mapping[str, Key]
) -> tuple[Schema, Schema]:
    """Return the schema of a choice, below the words `above` of tables with further `keys`."""
    own: Schema = {}
    keys = {**keys, **(node.own.entries if node.own else {})}
    for word in node.entries:
        below, name, words = node.node(word), f"{home}-{word}", {**above, node.tag: word}
        if isinstance(below, Choice):
            made, more = _choice(below, name, words, keys)
            own |= {name: made, **more}
        else:
            known = Table(node.title, None, {**keys, **below.table.entries})
            own[name] = _keys(below, known, node.needed, **words)
    meanings = "; ".join(f"{word}: {node.about(word)}" for word in node.entries)
    chosen = {
        "required": [node.tag],
        "properties": {node.tag: {"enum": list(node.entries), "description": meanings}},
        "allOf": [
            _when(node.tag, word, {"$ref": f"#/$defs/{home}-{word}"}) for word in node.entries
        ],
    }
    return {"type": "object", **({"description": node.doc} if node.doc else {}), **chosen}, own


def _either(node: Either, home: str) -> tuple[Schema, Schema]:
    """Return the schema of one of several nodes, in the order of their cases."""
    made: Schema = {}
    own: Schema = {}
    for number, case in reversed([*enumerate(node.cases)]):
        one, more = _node(case.node(), home)
        own |= more
        if isinstance(case.node(), Keys):
            own[f"{home}-{number}"], one = one, {"$ref": f"#/$defs/{home}-{number}"}
        if isinstance(case.node(), Many):
            rest = {"if": {"type": one.pop("type")}, "else": made}
            made = one | rest  # what is said of items holds for lists only
        else:
            made = {"if": dict(case.schema), "then": one, "else": made} if case.schema else one
    return {"description": node.doc, **made}, own


def _keys(node: Keys, known: Table, needed: Collection[str], **words: str) -> Schema:
    """Return the schema of a table with the keys that are `known`, and fixed `words`."""
    either: dict[str, list[Key]] = {}  # of each field the keys in opposite circumstances
    for entry in known.entries.values():
        if entry.param.when:
            either.setdefault(entry.name, []).append(entry)
    rules = [
        {"oneOf": [{"required": [one.key]} for one in keys]}
        if name in needed or keys[0].default is REQUIRED
        else {"not": {"required": [one.key for one in keys]}}
        for name, keys in either.items()
    ]
    made = table_schema(known, node.doc, **words) | dict(node.rule)
    return made | _all_of([*made.get("allOf", []), *rules])


def table_schema(table: Table, doc: str = "", **words: str) -> Schema:
    """Return the schema of a table.

    Parameters
    ----------
    table : Table
        The table.
    doc : str
        Its description.
    **words : str
        Additional keys with fixed values.

    Returns
    -------
    dict
    """
    entries = table.entries.items()
    required = [*words, *(name for name, key in entries if key.required)]
    return {
        "type": "object",
        **({"description": doc} if doc else {}),
        "additionalProperties": False,
        **({"required": required} if required else {}),
        "properties": {name: {"const": word} for name, word in words.items()}
        | {name: _property(key) for name, key in entries},
        **_all_of(_rules_of(table)),
    }


def _branch(kind: DesignKind, parts: Schema) -> Schema:
    fields = [_fields(kind.table(title), title) for title in kind.tables]
    return {
        "type": "object",
        "description": kind.doc,
        "additionalProperties": False,
        # the schema of all designs requires the kind; where one is nested its key says it
        "required": list(kind.required),
        "properties": {
            "kind": {"enum": _names(kind), "description": kind.doc},
            "name": {
                "type": "string",
                "pattern": _NAME_PATTERN,
                "maxLength": 100,
                "description": "names the output folder; default: the name of the design file",
            },
            "units": {"enum": list(UNITS), "description": "of lengths: keys end in _mm or in _in"},
            **parts,
        }
        | {title: {"type": "object", "description": doc} for title, doc in OF_MANY.items()},
        **_all_of(
            [*_rules(kind.rules, ChainMap(*fields)), *_variants(kind.variants, kind.several)]
        ),
    }


def _variants(variants: Variants | None, several: Sequence[str]) -> Iterator[Schema]:
    """Yield what tables may have and must have, for each variant; of `several` each of them."""
    if variants is None:
        return
    for value in variants.entries:
        rest = {} if value == variants.default else {"required": [variants.key]}
        chosen = {"properties": {variants.key: {"const": value}}, **rest}
        tables, required = {}, []
        for title in variants.titles:
            table = variants.table(title, value)
            needed = [key for key, entry in table.entries.items() if entry.required]
            keys = {"propertyNames": {"enum": [*table.entries]}, "required": needed}
            rule = {**keys, **_all_of(_rules_of(table))}
            tables[title] = {"items": rule} if title in several else rule
            required += [title] if needed and title not in several else []
        yield {
            "if": {"properties": {variants.title: chosen}, "required": [variants.title]},
            "then": {"properties": tables, "required": required},
        }


def _fields(table: Table, title: str = "") -> dict[str, Field]:
    """Return the keys of a table for rules, those of a `title` with dotted names."""
    start, above = (f"{title}.", (title,)) if title else ("", ())
    return {
        start + entry.name: Field(
            path=(*above, key),
            default=entry.usual,
            none=(NONE if entry.base is str else 0,) if entry.param.zero_is_none else (),
            both=entry.param.both,
        )
        for key, entry in table.entries.items()
    }


def _all_of(schemas: list[Schema]) -> Schema:
    return {"allOf": schemas} if schemas else {}


def _rules(rules: Iterable[Rule], keys: Fields) -> list[Schema]:
    """Return the schemas of `rules`, as far as a schema can say them."""
    return [schema for rule in rules if (schema := rule.schema(keys))]


def _rules_of(table: Table) -> list[Schema]:
    """Return the schemas of the rules between the keys of a table."""
    return _rules(getattr(table.owner, "rules", ()), _fields(table))


def _property(key: Key) -> Schema:
    words: Schema = {"description": description(key)}
    if key.default not in (None, REQUIRED):
        words["default"] = key.outward(key.default)
    single = _single(key)
    if key.length is None:
        return single | words
    alone = key.param.both or key.param.alone
    counts = {"minItems": key.length or key.param.min_length, "maxItems": key.length}
    many = {"type": "array", "items": single} | {name: n for name, n in counts.items() if n}
    return words | {"anyOf": [single, many]} if alone else many | words


def _single(key: Key) -> Schema:
    param = key.param
    if param.nested:
        designs = ({"$ref": f"#/$defs/{name}"} for name in param.nested)
        return {"anyOf": [{"type": "string"}, *designs]}
    if param.choices:
        single: Schema = {"enum": list(param.choices)}
    else:
        bounds = {word: getattr(param, name) for name, word in _BOUNDS.items()}
        bounds |= {"minimum": param.least} if param.least else {}
        single = {"type": _TYPES[key.base]}
        single |= {word: bound for word, bound in bounds.items() if bound is not None}
    other = key.literal or (0 if param.least else None)
    more = [] if other is None else [{"const": other}]
    more += [{"type": "string", "pattern": HOLE}] if param.fit else []
    return {"anyOf": [single, *more]} if more else single
