"""The bits of whole episodes stay what they were, whatever is rebuilt."""

import json

import pytest

from tests.golden import CASES, RECORDED, arithmetic

GOLDEN = json.loads(RECORDED.read_text(encoding="utf-8"))


def test_every_case_is_recorded() -> None:
    assert list(GOLDEN["digests"]) == list(CASES)


@pytest.mark.filterwarnings("ignore")  # what warns is tested elsewhere
@pytest.mark.parametrize("name", CASES)
def test_episodes_come_out_the_same_to_the_bit(name: str) -> None:
    here = arithmetic()
    other = [
        f"{key} {here[key]} (recorded: {value})" for key, value in GOLDEN["arithmetic"].items() if here[key] != value
    ]
    if other:
        pytest.skip(f"another machine rounds otherwise: {', '.join(other)}")
    assert CASES[name]() == GOLDEN["digests"][name], "run python -m tests.golden if bits had to change, and say why"
