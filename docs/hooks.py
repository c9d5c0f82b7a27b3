"""Writes the page "Every field" from the types themselves whenever the site is built, so that it cannot go stale."""

from __future__ import annotations

import json
import re
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

from mdlcad.flow.schemas import ARTEFACTS, schema


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add artefacts.md to the pages."""
    files.append(File.generated(config, "artefacts.md", content=fields_page()))
    return files


def fields_page() -> str:
    """Every artefact with the fields of every type in it."""
    parts = [
        "# Every field",
        "",
        "Made from the types when these pages are built; `mdlcad schema NAME` prints the same as a JSON schema. Files",
        "that hold them are told in [Files and formats](formats.md). Types that several share stand in each.",
    ]
    for name in sorted(ARTEFACTS):
        rules = json.loads(schema(name))
        parts += ["", f"## {name}.json", ""]
        top = rules.get("$ref", "").rpartition("/")[2]
        if not top:
            parts += [f"A JSON value of type {_type(rules)}.", ""]
        kinds = rules.get("$defs", {})
        for kind in sorted(kinds, key=lambda item: (item != top, item)):
            parts += _kind(kind, kinds[kind])
    return "\n".join(parts) + "\n"


def _kind(kind: str, rules: dict[str, Any]) -> list[str]:
    about, meanings = _docstring(rules.get("description", ""))
    lines = [f"**{kind}**: {_safe(about)}" if about else f"**{kind}**", ""]
    if "enum" in rules:
        return [*lines, "One of " + ", ".join(f"`{value}`" for value in rules["enum"]) + ".", ""]
    if rules.get("type") == "array":
        return [*lines, f"{_type(rules)}.", ""]
    lines += ["| field | type | |", "|---|---|---|"]
    for field, item in rules.get("properties", {}).items():
        lines.append(f"| `{field}` | {_type(item)} | {_safe(meanings.get(field, ''))} |")
    return [*lines, ""]


def _docstring(text: str) -> tuple[str, dict[str, str]]:
    """The first paragraph, and what the list of attributes says of each."""
    head, _, tail = text.partition("Attributes:")
    about = " ".join(head.split("\n\n")[0].split())
    meanings: dict[str, str] = {}
    current: list[str] = []
    for line in tail.splitlines():
        found = re.match(r"\s*((?:\w+, )*\w+): (.*)", line)
        if found:
            current = found.group(1).split(", ")
            for name in current:
                meanings[name] = found.group(2).strip()
        else:
            for name in current:
                meanings[name] = f"{meanings[name]} {line.strip()}".strip()
    return about, meanings


def _type(rules: dict[str, Any]) -> str:
    if "$ref" in rules:
        return str(rules["$ref"].rpartition("/")[2])
    if "anyOf" in rules:
        return " or ".join(_type(item) for item in rules["anyOf"])
    if "enum" in rules:
        return "one of " + ", ".join(f"`{value}`" for value in rules["enum"])
    kind = rules.get("type", "any")
    if kind == "array":
        if "prefixItems" in rules:
            return "[" + ", ".join(_type(item) for item in rules["prefixItems"]) + "]"
        return f"list of {_type(rules['items'])}" if rules.get("items") else "list"
    if kind == "object" and isinstance(rules.get("additionalProperties"), dict):
        return f"{_type(rules['additionalProperties'])} by name"
    return str(kind)


def _safe(text: str) -> str:
    """Text that a table of Markdown takes as it is."""
    return text.replace("|", "\\|").replace("<", "&lt;").replace("_", "\\_").replace("*", "\\*").replace("[", "\\[")
