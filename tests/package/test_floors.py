"""What users install stands by itself, and no module imports itself by way of others."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

from workshop.project import ROOT

FLOORS = ("frictioncontact", "workshop")


def modules() -> dict[str, Path]:
    """Name of each module of both floors -> its file."""
    found = {}
    for floor in FLOORS:
        for path in sorted((ROOT / floor).rglob("*.py")):
            parts = path.relative_to(ROOT).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(node: ast.AST, package: str, known: dict[str, Path]) -> Iterator[str]:
    """Modules that an import statement names; those of neither floor by their first name."""
    if isinstance(node, ast.Import):
        names = [alias.name for alias in node.names]
    elif isinstance(node, ast.ImportFrom):
        above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
        base = ".".join([*above, *([node.module] if node.module else [])])
        names = [full if (full := f"{base}.{alias.name}") in known else base for alias in node.names]
    else:
        return
    yield from (name if name in known else name.split(".")[0] for name in names)


def at_import(node: ast.AST) -> Iterator[ast.AST]:
    """The statements that run when a module is imported: none of functions, none for type checkers alone."""
    for child in ast.iter_child_nodes(node):
        is_typing = isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING"
        if not isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef)) and not is_typing:
            yield child
            yield from at_import(child)


def edges(only_at_import: bool) -> dict[str, set[str]]:
    """Each module and what it imports."""
    known = modules()
    found = {}
    for name, path in known.items():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        package = name if path.name == "__init__.py" else name.rpartition(".")[0]
        nodes = at_import(tree) if only_at_import else ast.walk(tree)
        found[name] = {target for node in nodes for target in imported(node, package, known)} - {name}
    return found


def test_what_users_install_imports_nothing_of_the_workshop_or_the_tests() -> None:
    wrong = {
        f"{name} -> {target}"
        for name, targets in edges(only_at_import=False).items()
        for target in targets
        if (name.startswith("frictioncontact") and target.startswith("workshop"))
        or target.split(".")[0] == "tests"
    }
    assert wrong == set()


def test_no_import_is_in_a_circle() -> None:
    graph = edges(only_at_import=True)
    assert len(graph) > 60 and "frictioncontact.fmu" in graph["frictioncontact.table2"]
    TopologicalSorter(graph).prepare()  # CycleError names the circle


def test_no_module_that_one_system_lacks_is_imported_for_all() -> None:
    lacking = {"fcntl", "grp", "pwd", "resource", "termios", "msvcrt", "winreg"}
    found = {
        f"{name} -> {', '.join(targets & lacking)}"
        for name, targets in edges(only_at_import=True).items()
        if name.startswith("frictioncontact") and targets & lacking
    }
    assert found == set()
