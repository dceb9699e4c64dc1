"""How the code is written, by measure."""

import ast
import statistics
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src" / "isomould"


def bodies():
    """Lines of every function's body, its docstring apart."""
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                documented = ast.get_docstring(node) is not None
                body = node.body[1:] if documented else node.body
                yield path.name, node.name, (body[-1].end_lineno - body[0].lineno + 1) if body else 0


def test_functions_are_small():
    sizes = [size for _, _, size in bodies()]
    assert statistics.median(sizes) <= 5
    assert [(file, name, size) for file, name, size in bodies() if size > 45] == []


def test_files_are_small():
    sizes = {path.name: len(path.read_text(encoding="utf-8").splitlines()) for path in SOURCE.rglob("*.py")}
    assert statistics.median(sizes.values()) <= 150
    assert {name: size for name, size in sizes.items() if size > 400} == {}
