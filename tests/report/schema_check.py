"""A JSON Schema validator of our own for the parts of the standard that the artefacts' schemas use (draft 2020-12:
$ref, type, enum, const, properties, required, additionalProperties, items, prefixItems, min/maxItems, anyOf). It shares
nothing with the library that wrote the schemas, and refuses a keyword that it does not know."""

from typing import Any

_TYPES = {
    "object": dict,
    "array": list,
    "string": str,
    "boolean": bool,
    "null": type(None),
}
_NOTES = {"title", "description", "default", "$defs", "$schema", "discriminator", "format", "contentEncoding"}


def problems(value: Any, schema: dict[str, Any] | bool, root: dict[str, Any], at: str = "$") -> list[str]:
    """What of ``value`` is not as ``schema`` says, in words; empty if all is."""
    if schema is True:
        return []
    if schema is False:
        return [f"{at}: nothing is allowed here"]
    found: list[str] = []
    for key, rule in schema.items():
        if key == "$ref":
            found += problems(value, _resolve(rule, root), root, at)
        elif key == "type":
            found += [] if _is(value, rule) else [f"{at}: {value!r} is no {rule}"]
        elif key == "enum":
            found += [] if value in rule else [f"{at}: {value!r} is none of {rule}"]
        elif key == "const":
            found += [] if value == rule else [f"{at}: {value!r} is not {rule!r}"]
        elif key == "anyOf":
            tried = [problems(value, item, root, at) for item in rule]
            found += [] if any(not item for item in tried) else min(tried, key=len)
        elif key == "required" and isinstance(value, dict):
            found += [f"{at}: lacks {name}" for name in rule if name not in value]
        elif key == "properties" and isinstance(value, dict):
            for name, item in rule.items():
                found += problems(value[name], item, root, f"{at}.{name}") if name in value else []
        elif key == "additionalProperties" and isinstance(value, dict):
            for name in sorted(set(value) - set(schema.get("properties", {}))):
                found += problems(value[name], rule, root, f"{at}.{name}")
        elif key == "prefixItems" and isinstance(value, list):
            for index, (part, item) in enumerate(zip(value, rule, strict=False)):
                found += problems(part, item, root, f"{at}[{index}]")
        elif key == "items" and isinstance(value, list):
            for index, part in enumerate(value[len(schema.get("prefixItems", [])) :]):
                found += problems(part, rule, root, f"{at}[{index}]")
        elif key == "minItems" and isinstance(value, list):
            found += [] if len(value) >= rule else [f"{at}: fewer than {rule}"]
        elif key == "maxItems" and isinstance(value, list):
            found += [] if len(value) <= rule else [f"{at}: more than {rule}"]
        elif key not in _NOTES | {"required", "properties", "additionalProperties", "items", "prefixItems"} | {
            "minItems",
            "maxItems",
        }:
            found.append(f"{at}: the schema has the unknown keyword {key}")
    return found


def _resolve(reference: str, root: dict[str, Any]) -> Any:
    schema: Any = root
    for name in reference.removeprefix("#/").split("/"):
        schema = schema[name]
    return schema


def _is(value: Any, kind: str) -> bool:
    if kind in ("integer", "number"):
        number = isinstance(value, int | float) and not isinstance(value, bool)
        return number and (kind == "number" or float(value).is_integer())
    return isinstance(value, _TYPES[kind])
