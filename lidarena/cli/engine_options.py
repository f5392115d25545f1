"""The options that say on what machines a command works."""

import argparse
import json


def add_engine(parser: argparse.ArgumentParser) -> None:
    """Add ``--engine`` and ``--ray-address``."""
    engine_help = "where it runs: processes of this machine (default), or a Ray cluster (pip install 'lidarena[ray]')"
    parser.add_argument("--engine", choices=("processes", "ray"), help=engine_help)
    address_help = "of the cluster: auto, HOST:PORT; RAY_ADDRESS if left out, and without that this machine's cores"
    parser.add_argument("--ray-address", metavar="ADDRESS", help=address_help)


def engine_overrides(options: argparse.Namespace) -> list[str]:
    """The options as keys of a configuration."""
    given = {"engine": options.engine, "ray_address": options.ray_address}
    return [f"{key}={json.dumps(value)}" for key, value in given.items() if value is not None]
