"""Compiling tasks: what is found, kept and warned of."""

import time
from pathlib import Path

import numpy as np
import pytest

from lidarena.envs.workshop.compiler.compiled import compile_task
from lidarena.envs.workshop.compiler.networks import CONTROLLABLE, INCONSISTENT, categorize
from lidarena.envs.workshop.task import load_task
from tests.envs.workshop.workshops import chain, loose


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("LIDARENA_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_the_pile_has_its_thirty_two_plans_in_every_category() -> None:
    compiled = compile_task(load_task("pile"))
    assert compiled.complete and len(compiled.plans) == 32
    assert (np.diff(compiled.makespans) >= 0.0).all()
    assert {int(one) for one in compiled.categories} == {0, 1, 2}
    assert categorize(compiled.network(3)) == compiled.categories[3]
    assert "32 plans" in str(compiled)


def test_a_task_of_many_plans_is_compiled_lazily() -> None:
    compiled = compile_task(load_task(loose(6)))
    assert not compiled.complete and 10 <= len(compiled.plans) <= 300
    assert compiled.categories[0] == CONTROLLABLE and "quickest of very many" in str(compiled)


def test_the_second_time_it_is_read_and_content_decides(own_cache: Path) -> None:
    first = compile_task(load_task(chain(3)))
    begin = time.perf_counter()
    again = compile_task(load_task(chain(3)))
    assert time.perf_counter() - begin < 1.0
    assert np.array_equal(first.plans, again.plans) and np.array_equal(first.motion.time, again.motion.time)
    compile_task(load_task(chain(3)), separation=0.5)
    compile_task(load_task(chain(3)), space=False)
    compile_task(load_task(chain(3) | {"deadline": 90}))
    assert len(list(own_cache.glob("*.npz"))) == 4


def test_a_torn_cache_is_made_anew(own_cache: Path) -> None:
    first = compile_task(load_task(chain(2)))
    (file,) = own_cache.glob("*.npz")
    for torn in (file.read_bytes()[:100], b""):
        file.write_bytes(torn)
        assert np.array_equal(compile_task(load_task(chain(2))).plans, first.plans)


def test_a_place_that_cannot_be_written_to_is_no_matter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("LIDARENA_CACHE", str(tmp_path / "file"))
    assert len(compile_task(load_task(chain(2)), progress=True).plans) == 4


def test_a_deadline_that_no_plan_meets_is_told() -> None:
    task = load_task(chain(2) | {"deadline": 3.0})
    with pytest.warns(UserWarning, match="no plan of task 'task' meets its deadline of 3 s"):
        compiled = compile_task(task)
    assert (compiled.categories == INCONSISTENT).all()
