"""No module imports itself by way of others. test_import.py has that what users install stands by itself."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from importlib.util import resolve_name

from workshop.project import ROOT

FILES = [path for floor in ("frictioncontact", "workshop") for path in sorted((ROOT / floor).rglob("*.py"))]
MODULES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path for path in FILES
}


def imported(node: ast.AST, package: str) -> set[str]:
    """Modules of ours that an import statement names."""
    if isinstance(node, ast.Import):
        return {alias.name for alias in node.names} & MODULES.keys()
    if not isinstance(node, ast.ImportFrom):
        return set()
    base = resolve_name("." * node.level + (node.module or ""), package)
    names = {f"{base}.{alias.name}" for alias in node.names}
    return (names if names <= MODULES.keys() else names | {base}) & MODULES.keys()


def at_import(node: ast.AST) -> Iterator[ast.AST]:
    """The statements that run when a module is imported: none of functions, none for type checkers alone."""
    for child in ast.iter_child_nodes(node):
        is_typing = isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING"
        if not isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)) and not is_typing:
            yield child
            yield from at_import(child)


def test_no_import_is_in_a_circle() -> None:
    graph = {}
    for name, path in MODULES.items():
        package = name if path.name == "__init__.py" else name.rpartition(".")[0]
        nodes = at_import(ast.parse(path.read_text(encoding="utf-8")))
        graph[name] = {target for node in nodes for target in imported(node, package)} - {name}
    assert len(graph) > 60 and "frictioncontact.fmu" in graph["frictioncontact.table2"]
    TopologicalSorter(graph).prepare()  # CycleError names the circle
