"""What users install stands by itself, and no module imports itself by way of others."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter

from workshop.project import ROOT

FILES = [path for floor in ("frictioncontact", "workshop") for path in sorted((ROOT / floor).rglob("*.py"))]
MODULES = {
    ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path for path in FILES
}


def imported(node: ast.AST, package: str) -> Iterator[str]:
    """Modules that an import statement names; those of neither floor by their first name."""
    if isinstance(node, ast.Import):
        names = [alias.name for alias in node.names]
    elif isinstance(node, ast.ImportFrom):
        above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
        base = ".".join([*above, *([node.module] if node.module else [])])
        names = [full if (full := f"{base}.{alias.name}") in MODULES else base for alias in node.names]
    else:
        return
    yield from (name if name in MODULES else name.split(".")[0] for name in names)


def at_import(node: ast.AST) -> Iterator[ast.AST]:
    """The statements that run when a module is imported: none of functions, none for type checkers alone."""
    for child in ast.iter_child_nodes(node):
        is_typing = isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING"
        if not isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)) and not is_typing:
            yield child
            yield from at_import(child)


def edges(only_at_import: bool) -> dict[str, set[str]]:
    """Each module and what it imports."""
    found = {}
    for name, path in MODULES.items():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        package = name if path.name == "__init__.py" else name.rpartition(".")[0]
        nodes = at_import(tree) if only_at_import else ast.walk(tree)
        found[name] = {target for node in nodes for target in imported(node, package)} - {name}
    return found


def test_what_users_install_imports_nothing_of_the_workshop_or_the_tests() -> None:
    found = {(name, target) for name, targets in edges(only_at_import=False).items() for target in targets}
    ours = {
        pair for pair in found if pair[0].startswith("frictioncontact") and pair[1].startswith("workshop")
    }
    assert ours | {pair for pair in found if pair[1].split(".")[0] == "tests"} == set()


def test_no_import_is_in_a_circle() -> None:
    graph = edges(only_at_import=True)
    assert len(graph) > 60 and "frictioncontact.fmu" in graph["frictioncontact.table2"]
    TopologicalSorter(graph).prepare()  # CycleError names the circle
