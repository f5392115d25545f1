"""Rewards as a stranger would write them, in a module of its own."""

from lidarena.envs.rewards import Step


def curious(step: Step) -> float:
    """What exploring, an arena and a robot of a team tell alike: metres driven, and what an accident costs."""
    return step.info["path_length"] - step.previous["path_length"] - 3.0 * step.info["collision"]


def in_parts(step: Step) -> dict[str, float]:
    """Two terms: one of the family's, and one that looks at the action, which a robot in another place pays dearer."""
    effort = abs(step.action) if isinstance(step.action, int) else float(abs(step.action).sum())
    return {"family": sum(step.terms.values()), "effort": -0.01 * effort * (1 + step.robot)}


class Careful:
    """A reward with a parameter."""

    def __init__(self, price: float = 2.0) -> None:
        self.price = price

    def __call__(self, step: Step) -> float:
        return -self.price * step.info["collision"] - 0.1 * step.info["time"]


def of_two_things(step: Step, other: int) -> float:
    """Takes more than a step."""
    return float(other)


NUMBER = 3.0
