"""The house as it stands: imports run downwards only, files and functions can be held in the head."""

import ast
import re
import statistics
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

from tests.house import (
    FAMILIES,
    PACKAGE,
    ROOT,
    SOURCES,
    TEST_FILES,
    TESTS,
    definitions,
    family,
    has_behaviour,
    imports,
    is_documented,
    is_kernel,
    lines,
    mirrored,
    module_name,
    parameters,
    room,
    unannotated,
)

FLOORS = {"base": 0, "world": 1, "slam": 2, "planning": 2, "temporal": 2, "vision": 2, "envs": 3, "baselines": 4}
FLOORS |= {"agents": 5, "evaluation": 6, "cli": 7}
IN_ROOMS = [path for path in SOURCES if path.parent != PACKAGE]
FUNCTIONS = [one for one in definitions() if not isinstance(one.node, ast.ClassDef)]
MODULES = [path for path in SOURCES if path.name != "__init__.py"]


def shown(path: Path) -> str:
    return str(path.relative_to(ROOT))


def test_imports_run_downwards_only() -> None:
    upwards = []
    for path in IN_ROOMS:
        own, own_family = str(room(module_name(path))), family(module_name(path))
        for module, named in imports(path):
            there = room(module)
            if there in (None, own):
                continue
            if named and path.name == "__init__.py" and own_family and family(module) == own_family:
                continue  # a family tells where the upper storeys keep what belongs to it; it does not import it
            if FLOORS[str(there)] >= FLOORS[own]:
                upwards.append(f"{shown(path)} imports {module}")
    assert not upwards


def test_families_do_not_know_each_other() -> None:
    found = []
    for path in IN_ROOMS:
        own = family(module_name(path))
        others = {module for module, _ in imports(path) if family(module) not in (None, own)}
        found += [f"{shown(path)} imports {module}" for module in others if own is not None]
    assert not found


def test_every_room_of_the_package_has_a_floor() -> None:
    rooms = {path.name for path in PACKAGE.iterdir() if path.is_dir() and (path / "__init__.py").exists()}
    assert rooms <= set(FLOORS)


def test_importing_the_package_loads_neither_torch_nor_matplotlib() -> None:
    code = "import sys, lidarena; print(sorted({'torch', 'stable_baselines3', 'matplotlib'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_class_name_means_one_thing() -> None:
    places = defaultdict(list)
    for one in definitions():
        if isinstance(one.node, ast.ClassDef) and one.public:
            places[one.node.name].append(shown(one.path))
    assert not {name: where for name, where in places.items() if len(where) > 1}


def test_files_and_functions_can_be_held_in_the_head() -> None:
    assert not [shown(path) for path in [*SOURCES, *TEST_FILES] if lines(path) > 500]
    lengths = {
        str(one): (one.node.end_lineno or 0) - one.node.lineno + 1 for one in FUNCTIONS if not is_kernel(one.node)
    }
    assert not {name: length for name, length in lengths.items() if length > 60}


def test_a_file_is_one_idea_of_100_to_200_lines() -> None:
    assert 100 <= statistics.median(lines(path) for path in SOURCES) <= 200


def test_parameter_lists_are_short() -> None:
    """Options that a public function takes by keyword only do not count: an editor completes them."""
    counts = {str(one): len(parameters(one.node, not one.public)) for one in FUNCTIONS if not is_kernel(one.node)}
    assert not {name: count for name, count in counts.items() if count > 10}


def test_everything_is_annotated() -> None:
    assert not {str(one): unannotated(one.node) for one in FUNCTIONS if unannotated(one.node)}


def test_what_is_public_is_documented() -> None:
    public = [one for one in definitions() if one.public]
    bare = [str(one) for one in public if not is_documented(one)]
    assert len(bare) <= 0.02 * len(public), bare
    assert not [shown(path) for path in SOURCES if lines(path) and not ast.get_docstring(ast.parse(path.read_text()))]


def test_nothing_is_named_after_nothing() -> None:
    nothing = {"utils", "util", "helpers", "helper", "common", "misc", "tools"}
    assert not [
        shown(path) for path in [*SOURCES, *TEST_FILES] if nothing & set(path.relative_to(ROOT).with_suffix("").parts)
    ]


def test_kernels_are_compiled_in_one_way() -> None:
    """So that where their cache goes is decided in one place."""
    assert [shown(path) for path in SOURCES if "njit" in path.read_text()] == ["lidarena/base/jit.py"]


def test_tests_lie_where_the_module_lies() -> None:
    tests = [path for path in TEST_FILES if path.name.startswith("test_") and path.parent != TESTS]
    placed = {test for path in SOURCES for test in mirrored(path)}
    assert not [shown(path) for path in tests if path not in placed]


def test_every_module_with_behaviour_has_tests() -> None:
    assert not [shown(path) for path in MODULES if has_behaviour(path) and not mirrored(path)]


def test_there_are_enough_tests() -> None:
    assert sum(map(lines, TEST_FILES)) >= 0.65 * sum(map(lines, SOURCES))


GONE = (
    r"Refusal\b|ArenaBook|\bCourse\b|Landscape|feel_frontiers|point_needles|needles?\b|Scenery|\bSenses\b|\bRoads\b|roads_of"
    r"|\bclass Places\b|\bdisturb|\bdrag\b|\bswerv|look_along|\bcarrot|\bheirs?\b|\bloyal|hinder|\bclass Wheel\b"
    r"|GoalLedger|\bledger|rehears|\bFilm|how manyth|soon told|same breath|\bfellows?\b|\b[Tt]he paper\b"
    r"|\b(unto|whilst|lest|ere|thereof|thereby|hither|thither|betwixt|nigh|naught|aught|whence|thence)\b"
)
"""Earlier names and turns of phrase, for which the field has terms of its own."""
KEEPS_OLD_NAMES = {"lidarena/base/old_names.py", "tests/base/test_old_names.py", "tests/test_house.py"}


def test_no_earlier_term_is_left() -> None:
    texts = [*SOURCES, *TEST_FILES, *ROOT.glob("*.md"), *ROOT.glob("*.py")]
    for folder, ending in (("configs", "yaml"), ("benchmarks", "py"), ("examples", "py"), ("docs", "md")):
        texts += (ROOT / folder).rglob(f"*.{ending}")
    left = {
        shown(path): sorted({match.group() for match in re.finditer(GONE, path.read_text(encoding="utf-8"))})
        for path in texts
        if shown(path) not in KEEPS_OLD_NAMES
    }
    assert not {path: terms for path, terms in left.items() if terms}


def test_the_families_are_those_that_the_package_has() -> None:
    found = {family(module_name(path)) for path in SOURCES} - {None}
    assert found <= set(FAMILIES) and {path.name for path in (PACKAGE / "envs").iterdir()} & set(FAMILIES) == found
