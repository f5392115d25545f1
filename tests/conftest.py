"""The files that take longest begin first, or one process would be busy with them while the other has nothing to do."""

from pathlib import Path

import pytest

LONGEST = (
    "test_docs.py",
    "test_examples.py",
    "test_notebooks.py",
    "test_wheel.py",
    "test_ray_engine.py",
    "test_base_vector_env.py",
    "test_base_env.py",
    "test_training_resumption.py",
    "test_rewards.py",
)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Order the files; the tests of a file stay as they are."""
    ranks = {name: rank for rank, name in enumerate(LONGEST)}
    items.sort(key=lambda item: ranks.get(Path(item.path).name, len(ranks)))
