"""``lidarena list``: what there is by name, configurations, environments, policies, agents and maps."""

import argparse
from collections.abc import Callable, Iterator

from lidarena.cli.config_names import Kind, purpose, shipped_names

Line = tuple[str, str]
"""A name, and what is known of it in half a line."""


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's."""
    text = "List the configurations, environments, policies, agents and maps that there are by name."
    parser = commands.add_parser("list", help="what there is by name", description=text)
    parser.add_argument("what", nargs="?", choices=sorted(_KINDS), help="one kind alone")
    parser.add_argument("--names", action="store_true", help="names alone, one a line, for scripts")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the lists."""
    kinds = [options.what] if options.what else list(_KINDS)
    for place, kind in enumerate(kinds):
        lines = list(_KINDS[kind]())
        if options.names:
            print(*(name for name, _ in lines), sep="\n")
            continue
        print(f"{'' if place == 0 else chr(10)}{kind}")
        width = max((len(name) for name, _ in lines), default=0)
        for name, about in lines:
            print(f"  {name:{width}}  {about}".rstrip())
    return 0


def _configs() -> Iterator[Line]:
    kinds: tuple[tuple[Kind, str], ...] = (("train", "train"), ("compare", "evaluate"))
    for kind, command in kinds:
        yield from ((f"{command} {name}", purpose(kind, name)) for name in shipped_names(kind))


def _environments() -> Iterator[Line]:
    import gymnasium as gym

    from lidarena.envs.registration import families

    for family in families():
        for name, registered in family.ids.items():
            spec = gym.registry.get(name)
            limit = registered.max_episode_steps or (spec.max_episode_steps if spec else None)
            kinds = [] if registered.entry_point is not None else ["batches only"]
            yield name, ", ".join([family.name, *kinds, *([f"{limit} steps"] if limit else [])])


def _policies() -> Iterator[Line]:
    from lidarena import baselines
    from lidarena.baselines.registry import drives

    for name in baselines.names():
        yield name, drives(name) or "any environment"


def _agents() -> Iterator[Line]:
    import json

    from lidarena.agents.shipped import PREFIX, pretrained, resolve

    for name in pretrained():
        card = json.loads((resolve(PREFIX + name) / "policy.json").read_text(encoding="utf-8"))
        yield PREFIX + name, f"trained in {card['env']['id']}"


def _maps() -> Iterator[Line]:
    from lidarena.world.load import load_floorplan, names

    for name in names():
        low_x, low_y, high_x, high_y = load_floorplan(name).bounds
        yield name, f"{high_x - low_x:.1f} x {high_y - low_y:.1f} m"
    yield "maze:SEED", "a generated maze"
    yield "random:KIND", "a new plan every episode, see lidarena.world.random_plans"


_KINDS: dict[str, Callable[[], Iterator[Line]]] = {
    "configs": _configs,
    "environments": _environments,
    "policies": _policies,
    "agents": _agents,
    "maps": _maps,
}
