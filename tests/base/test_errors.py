import pytest

from lidarena.base import errors
from lidarena.base.errors import ConfigError, KeywordError, LidarenaError, WriteError, suggest

KINDS = [one for one in vars(errors).values() if isinstance(one, type) and issubclass(one, LidarenaError)]


@pytest.mark.parametrize("kind", KINDS)
def test_every_error_is_one_that_a_caller_of_lidarena_catches(kind: type[LidarenaError]) -> None:
    with pytest.raises(ValueError, match="a sentence"):
        raise kind("a sentence")


def test_a_keyword_that_there_is_not_is_a_type_error_too() -> None:
    assert issubclass(KeywordError, TypeError) and issubclass(KeywordError, ConfigError)


def test_what_cannot_be_written_is_an_os_error_that_reads_as_a_sentence() -> None:
    assert issubclass(WriteError, OSError) and str(WriteError("cannot write 'a'")) == "cannot write 'a'"


def test_a_misspelt_word_gets_the_nearest_and_all_that_are_allowed() -> None:
    assert suggest("rewart", ["reward", "map"]) == "; did you mean 'reward'? Allowed: map, reward"


def test_a_word_like_no_other_gets_all_that_are_allowed() -> None:
    assert suggest("xyz", ["reward", "map"]) == "; Allowed: map, reward"
