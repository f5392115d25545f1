"""The package as its house rules see it: files, what they import, their classes, functions and tests."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parent.parent
PACKAGE, TESTS = ROOT / "lidarena", ROOT / "tests"
FAMILIES = ("exploration", "corridor", "arena", "workshop", "seabed")
SOURCES = sorted(PACKAGE.rglob("*.py"))
TEST_FILES = sorted(TESTS.rglob("*.py"))

_JIT = {"kernel", "leaf", "inlined", "merged", "njit", "jit", "intrinsic"}
_MODULE = re.compile(r"lidarena(\.\w+)+(:\w+)?")


class Import(NamedTuple):
    """What a file imports, and whether it only names it in a string."""

    module: str
    named: bool


class Definition(NamedTuple):
    """A class or function, where it stands, and whether others may use it."""

    path: Path
    node: ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    name: str
    public: bool

    def __str__(self) -> str:
        return f"{self.path.relative_to(ROOT)}: {self.name}"


@cache
def tree(path: Path) -> ast.Module:
    """A file, parsed."""
    return ast.parse(path.read_text(encoding="utf-8"))


def lines(path: Path) -> int:
    """How many lines a file has."""
    return path.read_text(encoding="utf-8").count("\n")


def module_name(path: Path) -> str:
    """The dotted name of a file of the package."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports(path: Path) -> set[Import]:
    """All modules of the package that a file imports: at its top, in a function, relatively, or by name in a string."""
    package = module_name(path).split(".")
    package = package if path.name == "__init__.py" else package[:-1]
    found = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.Import):
            found |= {Import(alias.name, False) for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            origin = ".".join([*base, *([node.module] if node.module else [])])
            found |= {Import(origin, False), *(Import(f"{origin}.{alias.name}", False) for alias in node.names)}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and _MODULE.fullmatch(node.value):
            found.add(Import(node.value.partition(":")[0], True))
    return {one for one in found if one.module.startswith("lidarena.")}


def room(module: str) -> str | None:
    """The storey of a module of the package; None of the package itself."""
    parts = module.split(".")
    known = len(parts) > 1 and ((PACKAGE / parts[1]).is_dir() or (PACKAGE / f"{parts[1]}.py").exists())
    return parts[1] if known else None


def family(module: str) -> str | None:
    """The family in whose folder a module lies, None for one that serves all."""
    parts = module.split(".")
    folders = parts[1:] if (PACKAGE.joinpath(*parts[1:])).is_dir() else parts[1:-1]
    is_measure = parts[1:3] == ["evaluation", "measures"]
    names = [part for part in (parts[1:] if is_measure else folders) if part in FAMILIES]
    return names[0] if names else None


def definitions() -> Iterator[Definition]:
    """Every class and function of the package, those in functions included."""
    for path in SOURCES:
        yield from _definitions(path, tree(path), "", True)


def _definitions(path: Path, node: ast.AST, prefix: str, public: bool) -> Iterator[Definition]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            shown = public and (not child.name.startswith("_") or child.name == "__init__")
            yield Definition(path, child, f"{prefix}{child.name}", shown)
            inside = shown and isinstance(child, ast.ClassDef)
            yield from _definitions(path, child, f"{prefix}{child.name}.", inside)
        else:
            yield from _definitions(path, child, prefix, public)


def is_kernel(node: ast.AST) -> bool:
    """Whether a function is compiled."""
    decorators = getattr(node, "decorator_list", [])
    return any(_JIT & set(re.findall(r"\w+", ast.unparse(decorator))) for decorator in decorators)


def is_documented(one: Definition) -> bool:
    """Whether a docstring says what something is, and of a constructor what it takes: there or in the class's.

    An overload's is that of the function.
    """
    if ast.get_docstring(one.node) or any(ast.unparse(name) == "overload" for name in one.node.decorator_list):
        return True
    if not one.name.endswith(".__init__") or isinstance(one.node, ast.ClassDef):
        return False
    owner = one.name.removesuffix(".__init__").rpartition(".")[2]
    classes = (node for node in ast.walk(tree(one.path)) if isinstance(node, ast.ClassDef) and node.name == owner)
    told = ast.get_docstring(next(classes)) or ""
    return all(re.search(rf"\b{parameter.arg}\b", told) for parameter in parameters(one.node, by_keyword=True))


def parameters(node: ast.FunctionDef | ast.AsyncFunctionDef, by_keyword: bool) -> list[ast.arg]:
    """A function's parameters except ``self`` and ``cls``."""
    given = [*node.args.posonlyargs, *node.args.args, *(node.args.kwonlyargs if by_keyword else [])]
    return [one for one in given if one.arg not in ("self", "cls")]


def unannotated(node: ast.FunctionDef | ast.AsyncFunctionDef) -> list[str]:
    """What of a function has no type."""
    rest = [one for one in (node.args.vararg, node.args.kwarg) if one is not None]
    missing = [one.arg for one in [*parameters(node, by_keyword=True), *rest] if one.annotation is None]
    return missing if node.returns is not None else [*missing, "return"]


def mirrored(path: Path) -> list[Path]:
    """The test files of a module: ``test_<module>.py`` or ``test_<module>_<what>.py`` in the same folder of tests."""
    folder = TESTS / path.parent.relative_to(PACKAGE)
    stem = path.stem.strip("_")
    return sorted({*folder.glob(f"test_{stem}.py"), *folder.glob(f"test_{stem}_*.py")})


def has_behaviour(path: Path) -> bool:
    """Whether there is something to test in a module: a function that is not just declared by a protocol."""
    declared = {
        id(function)
        for node in ast.walk(tree(path))
        if isinstance(node, ast.ClassDef) and any("Protocol" in ast.unparse(base) for base in node.bases)
        for function in node.body
    }
    functions = (node for node in ast.walk(tree(path)) if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef))
    return any(id(node) not in declared for node in functions)
