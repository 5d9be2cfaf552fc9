"""What `gcode check` can say, read from the source: each finding and its remedy, with … for what is filled in."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "gcode"

#: Modules with findings, in the order of the table, and what theirs are about.
MODULES = {
    "check_file": "the whole file",
    "trace": "wording",
    "check_lines": "checksums",
    "check_dialect": "brackets, case, asterisks",
    "check_commands": "commands, Marlin",
    "check_settings": "limits, Marlin",
    "check_grbl": "commands, GRBL",
    "check_waits": "waits",
    "check": "moves and ink",
    "check_balance": "prime and retract",
    "check_blob": "prime and retract",
    "check_height": "heights",
    "check_ink": "wet ink",
    "check_bead": "the bead",
    "check_mould": "the mould",
    "check_wall": "the mould",
}

#: Where a call has the finding's words; the remedy is the argument behind it.
_CALLS = {"Finding": 1, "Rule": 2, "_fault": 1}


def findings() -> list[tuple[str, str, str]]:
    """Of each finding: what it is about, its words, its remedy."""
    found: dict[tuple[str, str], tuple[str, str, str]] = {}
    for module, about in MODULES.items():
        tree = ast.parse((SOURCE / f"{module}.py").read_text(encoding="utf-8"))
        for scope in tree.body:
            for what, remedy in _told(scope):
                remedies = " / ".join(dict.fromkeys(_texts(remedy, scope)))
                for words in _texts(what, scope):
                    if words != "…":  # handed on from where it is said
                        found[about, words] = (about, words, remedies)
    return list(found.values())


def modules_with_findings() -> set[str]:
    """Every module that makes a `Finding` or a `Rule` for one."""
    return {
        file.stem
        for file in SOURCE.glob("*.py")
        if any(isinstance(node, ast.Call) and _name(node.func) in ("Finding", "Rule") for node in ast.walk(ast.parse(file.read_text())))
    }


def _told(scope: ast.AST) -> Iterator[tuple[ast.expr, ast.expr]]:
    for node in ast.walk(scope):
        if isinstance(node, ast.Call) and (at := _CALLS.get(_name(node.func))) is not None and len(node.args) > at + 1:
            yield node.args[at], node.args[at + 1]
        elif isinstance(node, ast.Return | ast.Yield):
            value = node.value.body if isinstance(node.value, ast.IfExp) else node.value
            if isinstance(value, ast.Tuple) and len(value.elts) == 2 and _is_text(value.elts[0]):
                yield value.elts[0], value.elts[1]


def _is_text(expression: ast.expr) -> bool:
    return isinstance(expression, ast.JoinedStr) or (isinstance(expression, ast.Constant) and isinstance(expression.value, str))


def _name(function: ast.expr) -> str:
    return function.id if isinstance(function, ast.Name) else function.attr if isinstance(function, ast.Attribute) else ""


def _texts(expression: ast.expr, scope: ast.AST) -> list[str]:
    """What an expression can say."""
    return [re.sub(r"(…[^\w\s]*)+…|\{\w+\}", "…", text) for text in _parts(expression, scope)]


def _parts(expression: ast.expr, scope: ast.AST) -> list[str]:
    if isinstance(expression, ast.Constant) and isinstance(expression.value, str):
        return [expression.value]
    if isinstance(expression, ast.IfExp):
        return [*_parts(expression.body, scope), *_parts(expression.orelse, scope)]
    if isinstance(expression, ast.BinOp) and isinstance(expression.op, ast.Add):
        return [a + b for a in _parts(expression.left, scope) for b in _parts(expression.right, scope)]
    if isinstance(expression, ast.JoinedStr):
        return ["".join(_filled_in(part, scope) for part in expression.values)]
    if isinstance(expression, ast.Name):
        return [text for value in _set_to(expression, scope) for text in _parts(value, scope)] or ["…"]
    return ["…"]


def _filled_in(part: ast.expr, scope: ast.AST) -> str:
    """Words that are chosen between stay as all of them; numbers and what a file says become …."""
    if isinstance(part, ast.Constant):
        return str(part.value)
    value = part.value if isinstance(part, ast.FormattedValue) and part.format_spec is None else None
    words = _parts(value, scope) if isinstance(value, ast.Name) else ["…"]
    return "…" if "…" in words else "/".join(words)


def _set_to(name: ast.Name, scope: ast.AST) -> list[ast.expr]:
    """What a name was set to beside its use, or else anywhere in the same function."""
    beside: list[ast.expr] = []
    anywhere: list[ast.expr] = []
    for node in ast.walk(scope):
        blocks = [block for field in ("body", "orelse") if isinstance(block := getattr(node, field, None), list)]
        for block in blocks:
            for statement in block:
                if isinstance(statement, ast.Assign) and any(isinstance(t, ast.Name) and t.id == name.id for t in statement.targets):
                    anywhere.append(statement.value)
                    if any(inner is name for other in block for inner in ast.walk(other) if not isinstance(other, ast.If)):
                        beside.append(statement.value)
    return beside or anywhere
