"""The options become keys of a configuration, and those that were not given do not."""

import argparse

import pytest

from lidarena.cli.engine_options import add_engine, engine_overrides


@pytest.mark.parametrize(
    ("arguments", "overrides"),
    [
        ([], []),
        (["--engine", "ray"], ['engine="ray"']),
        (["--engine", "ray", "--ray-address", "10.0.0.1:6379"], ['engine="ray"', 'ray_address="10.0.0.1:6379"']),
    ],
)
def test_keys(arguments: list[str], overrides: list[str]) -> None:
    parser = argparse.ArgumentParser()
    add_engine(parser)
    assert engine_overrides(parser.parse_args(arguments)) == overrides
