"""Run folders: which one a training gets, and whether an old one can go on."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from lidarena.agents import checkpoint
from lidarena.agents.learning_curve import FILE as CURVE_FILE
from lidarena.agents.training_config import CONFIG_FILE, TrainingConfig
from lidarena.base.errors import ConfigError
from lidarena.base.files import next_free
from lidarena.base.yaml_config import check_config, read_yaml
from lidarena.envs.registration import keywords_of_version_0_1

POLICY_FILES = ("policy.safetensors", "policy.json")
"""What `lidarena.agents.load` reads."""
_MAY_CHANGE = ("total_steps", "checkpoint_every", "torch_threads", "out", *checkpoint.MAY_CHANGE)
"""Keys that may differ when a training goes on: no world or update is another for them, except that a learning rate
with a start and an end falls over ``total_steps``, anew from where the training is when they are raised, and that a
training may end without the entropy bonus that made it try enough."""
_NEWER = {"algorithm": "PPO", "normalize_observation": False}
"""Keys that the first version did not know, with what it did; where nothing else is asked for they are left out."""


def claim(out: str | Path, exact: bool = False) -> Path:
    """Make the folder of a new training; nothing that lies in another one is touched.

    Args:
        out: The wish.
        exact: Whether a folder that already holds something is refused; else ``NAME-2``, ``NAME-3``, … is taken.

    Returns:
        A folder that exists and is empty.

    Raises:
        ConfigError: The folder is taken or cannot be made.
    """
    wish = Path(out)
    candidate = wish
    number = 1
    try:
        while not _take(candidate):
            if exact:
                raise ConfigError(
                    f"the folder {str(wish)!r} already holds files; choose another one, or go on with --resume {wish}"
                )
            number += 1
            candidate = wish.with_name(f"{wish.name}-{number}")
    except OSError as error:
        raise ConfigError(f"cannot make the run folder {str(candidate)!r}: {error.strerror}") from None
    return candidate


def config_of(folder: str | Path, overrides: Sequence[str] = ()) -> TrainingConfig:
    """Read the configuration of a run folder.

    A run of version 0.1, which had one algorithm and so did not name it, gets the environment that it had under the
    keywords of today.

    Args:
        folder: Of the run.
        overrides: ``key.sub=value`` each, see `load_config`.

    Raises:
        ConfigError: The folder does not exist or is no run folder.
    """
    path = Path(folder)
    if not path.is_dir():
        raise ConfigError(f"there is no run folder {str(path)!r} to go on with")
    if not (path / CONFIG_FILE).exists():
        raise ConfigError(f"the folder {str(path)!r} lacks {CONFIG_FILE}, so it is no run folder")
    content = read_yaml(path / CONFIG_FILE)
    env = content.get("env")
    if "algorithm" not in content and isinstance(env, dict) and isinstance(env.get("keywords"), dict):
        content["env"] = {**env, "keywords": keywords_of_version_0_1(str(env.get("id")), env["keywords"])}
    return check_config(content, TrainingConfig, overrides, origin=str(path / CONFIG_FILE))


def checkpoint_to_resume(folder: str | Path, config: TrainingConfig) -> Path | None:
    """Find the checkpoint from which a training goes on.

    Args:
        folder: Of the run.
        config: With which it is to go on.

    Returns:
        The newest one; None if the training ended before its first, and so begins anew.

    Raises:
        ConfigError: The folder is no run folder, or was made with another configuration.
    """
    old, new = fixed_part(config_of(folder)), fixed_part(config)
    for key in sorted(old.keys() | new.keys()):
        if old.get(key) != new.get(key):
            raise ConfigError(
                f"the run {str(folder)!r} was trained with {key} = {old.get(key, _NEWER.get(key))!r}, so it cannot go "
                f"on with {new.get(key, _NEWER.get(key))!r}; only {', '.join(_MAY_CHANGE)} may change"
            )
    return checkpoint.newest(Path(folder))


def fixed_part(config: TrainingConfig) -> dict[str, Any]:
    """Return the keys, as ``--set`` spells them, that must stay the same when a training goes on, with their values."""
    flat = _flat(config.model_dump(mode="json", by_alias=True))
    kept = {key: value for key, value in flat.items() if key not in _MAY_CHANGE}
    return {key: value for key, value in kept.items() if key not in _NEWER or value != _NEWER[key]}


def keep_policy(folder: Path) -> Path | None:
    """Move policy and curve of a run that has no checkpoint into a folder of their own, before it begins anew.

    Returns:
        That folder, None if there was nothing to keep.
    """
    kept = [folder / name for name in (*POLICY_FILES, CURVE_FILE) if (folder / name).exists()]
    if not kept:
        return None
    aside = next_free(folder / "before_")
    aside.mkdir()
    for file in kept:
        file.rename(aside / file.name)
    return aside


def _take(folder: Path) -> bool:
    """Make a folder, or take one that is there and empty."""
    try:
        folder.mkdir(parents=True)
    except FileExistsError:
        return folder.is_dir() and not any(folder.iterdir())
    return True


def _flat(content: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Keys as ``--set`` spells them."""
    flat: dict[str, Any] = {}
    for key, value in content.items():
        if isinstance(value, dict) and value:
            flat |= _flat(value, f"{prefix}{key}.")
        else:
            flat[f"{prefix}{key}"] = value
    return flat
