"""Would the tests notice? Breaks `robot_agent/safety.py` in every small way and runs its tests against each.

    .venv/bin/python tests/safety/mutation_run.py

Prints every change the tests let pass and ends with 1 if there is one. Each runs in a process of its own, forked after
the imports, so a few hundred take a minute.
"""

from __future__ import annotations

import ast
import copy
import io
import os
import sys
import types
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import pytest
from hypothesis import Phase, settings
from tqdm import tqdm

import robot_agent.safety as original

FOLDER = Path(__file__).resolve().parent
COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Eq: (ast.NotEq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
}
ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {ast.Add: ast.Sub, ast.Sub: ast.Add}
ACTIONS = ("ALLOW", "HOLD", "SIT", "CUT")
Change = tuple[str, Callable[[ast.AST], ast.AST]]


def changes(node: ast.AST) -> Iterator[Change]:
    """What can be broken at this node: a description and how."""
    match node:
        case ast.Compare(ops=[op]):
            for other in COMPARISONS.get(type(op), ()):
                yield f"{type(op).__name__} becomes {other.__name__}", _with(ops=[other()])
        case ast.BoolOp(op=op):
            other_op = ast.Or() if isinstance(op, ast.And) else ast.And()
            yield f"{type(op).__name__} becomes {type(other_op).__name__}", _with(op=other_op)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield "not is left out", lambda _: operand
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            yield "a minus is left out", lambda _: operand
        case ast.BinOp(op=op) if type(op) in ARITHMETIC:
            yield f"{type(op).__name__} is turned round", _with(op=ARITHMETIC[type(op)]())
        case ast.Constant(value=float() | int() as value) if not isinstance(value, bool):
            yield f"{value} becomes {value + 1}", _with(value=value + 1)
        case ast.Constant(value=str() as text) if text:
            yield f"{text!r:.40} becomes empty", _with(value="")
        case ast.Attribute(value=ast.Name(id="SafetyAction"), attr=name) if name in ACTIONS:
            for other_name in ACTIONS:
                if other_name != name:
                    yield f"{name} becomes {other_name}", _with(attr=other_name)
        case ast.Expr(value=ast.YieldFrom()):
            yield "the findings are left out", lambda _: ast.Pass()


def _with(**fields: object) -> Callable[[ast.AST], ast.AST]:
    def change(node: ast.AST) -> ast.AST:
        changed = copy.copy(node)
        for name, value in fields.items():
            setattr(changed, name, value)
        return changed

    return change


class _Replace(ast.NodeTransformer):
    def __init__(self, target: ast.AST, change: Callable[[ast.AST], ast.AST]) -> None:
        self._target, self._change = target, change

    def visit(self, node: ast.AST) -> ast.AST:
        return self._change(node) if node is self._target else self.generic_visit(node)


def mutants(source: str) -> Iterator[tuple[str, str]]:
    """Every change with its place, and the changed source; docstrings and messages' formats are left alone."""
    tree = ast.parse(source)
    spared = {id(part) for part in _spared(tree)}
    for node in ast.walk(tree):
        if id(node) in spared:
            continue
        for text, change in changes(node):
            copied = ast.parse(source)
            twin = next(b for a, b in zip(ast.walk(tree), ast.walk(copied), strict=True) if a is node)
            changed = ast.fix_missing_locations(_Replace(twin, change).visit(copied))
            yield f"line {getattr(node, 'lineno', 0)}: {text}", ast.unparse(changed)


def _spared(tree: ast.AST) -> Iterator[ast.AST]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            yield node.value
        if isinstance(node, ast.Dict):  # the ranks of severity: only their order counts, which every comparison tests
            yield from ast.walk(node)
        if isinstance(node, ast.FormattedValue | ast.AnnAssign | ast.keyword) or (
            isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "dataclass"
        ):
            yield from (part for part in ast.walk(node) if isinstance(part, ast.Constant))


def noticed(source: str) -> bool:
    """Whether the tests fail with this source in the place of the supervisor's."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
                module = types.ModuleType(original.__name__)
                sys.modules[original.__name__] = module
                sys.modules["robot_agent"].safety = module  # type: ignore[attr-defined]
                exec(compile(source, original.__file__ or "", "exec"), module.__dict__)
                code = int(
                    pytest.main(["-x", "-q", "--noconftest", "-W", "default", "-p", "no:cacheprovider", str(FOLDER)])
                )
        finally:
            os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) != 0


def main() -> int:
    settings.register_profile("mutation", database=None, phases=(Phase.explicit, Phase.generate))  # no shrinking
    settings.load_profile("mutation")
    source = Path(original.__file__ or "").read_text(encoding="utf-8")
    if noticed(source):
        print("the tests fail on the unchanged supervisor")
        return 1
    everything = list(mutants(source))
    survivors = [text for text, changed in tqdm(everything, unit="mutant") if not noticed(changed)]
    print(f"{len(everything) - len(survivors)} of {len(everything)} changes are noticed")
    print("\n".join(survivors))
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
