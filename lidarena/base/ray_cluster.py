"""Work spread over a Ray cluster: an item's result comes back as it ends, and a worker that dies costs a second try."""

import contextlib
import os
import socket
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from lidarena.base.errors import ConfigError

Item = TypeVar("Item")
Result = TypeVar("Result")
_PATIENCE = 5.0
"""A cluster's address must answer within this time [s]."""


class ClusterError(RuntimeError):
    """A worker, or its node, ended twice over the same item; the index of the item tells which.

    Args:
        index: Of the item.
        reason: Ray's.
    """

    def __init__(self, index: int, reason: str) -> None:
        super().__init__(reason)
        self.index = index


def ray_results(
    work: Callable[[Item], Result],
    items: Sequence[Item],
    address: str | None = None,
    cores: int | None = None,
    environment: Mapping[str, str] | None = None,
) -> Iterator[tuple[int, Result]]:
    """Do something for every item, one core each, and yield results as they end.

    Args:
        work: A function of a module that every node can import; what it raises ends everything.
        items: What it is done for.
        address: Of the cluster, as ``ray.init`` takes it: ``"auto"`` for the one that runs here, ``HOST:PORT``,
            ``ray://HOST:PORT``; None is ``RAY_ADDRESS``, and without that a cluster of this machine's own that ends
            with this function.
        cores: Of that cluster; Ray counts them if left out.
        environment: Variables of the workers' environment.

    Yields:
        Index of the item, and the result.

    Raises:
        ConfigError: Ray is not installed, or no cluster answers.
        ClusterError: A worker or node ended twice over the same item.
    """
    place = address or os.environ.get("RAY_ADDRESS")
    if place is not None:
        _offer_token()
    ray = _import_ray()
    with _connection(ray, place, cores, dict(environment or {})):
        remote = ray.remote(num_cpus=1, max_retries=1)(_call)
        waiting = {remote.remote(work, item): index for index, item in enumerate(items)}
        try:
            while waiting:
                ended, _ = ray.wait(list(waiting), num_returns=1)
                index = waiting.pop(ended[0])
                yield index, _result_of(ray, ended[0], index)
        finally:
            for one in waiting:
                ray.cancel(one, force=True)


def _call(work: Callable[[Item], Result], item: Item) -> Result:
    return work(item)


def _offer_token() -> None:
    """Show a cluster the token that there is: those that ``ray start`` begins ask for it, and Ray waits to be told."""
    names = ("RAY_AUTH_TOKEN", "RAY_AUTH_TOKEN_PATH")
    if (Path.home() / ".ray" / "auth_token").is_file() or any(os.environ.get(name) for name in names):
        os.environ.setdefault("RAY_AUTH_MODE", "token")


def _import_ray() -> Any:
    try:
        import ray
    except ImportError:
        raise ConfigError("Ray is not installed; it comes with: pip install 'lidarena[ray]'") from None
    return ray


@contextlib.contextmanager
def _connection(ray: Any, address: str | None, cores: int | None, environment: dict[str, str]) -> Iterator[None]:
    """Be connected to a cluster; one that was connected before is used and left as it is."""
    if ray.is_initialized():
        yield
        return
    paths = os.pathsep.join(path or os.getcwd() for path in sys.path)  # a policy of one's own lies beside the program
    options: dict[str, Any] = {"runtime_env": {"env_vars": {**environment, "PYTHONPATH": paths}}}
    if address is None:
        options |= {"address": "local", "num_cpus": cores, "include_dashboard": False}
    else:
        _check_address(address)
        options["address"] = address
    # Ray tells of a worker's end in many lines, which this package tells in one.
    options |= {"log_to_driver": False, "logging_level": "ERROR"}
    with _without_a_word_on_accelerators():
        try:
            ray.init(**options)
        except (ConnectionError, RuntimeError, TimeoutError, ValueError) as error:
            reason = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
            if "AuthToken" in str(error) or "uthentication" in str(error):
                reason = "it asks for a token; copy ~/.ray/auth_token from the machine on which it was started"
            raise ConfigError(f"no Ray cluster is to be had at {address!r}: {reason}") from None
    try:
        yield
    finally:
        ray.shutdown()


@contextlib.contextmanager
def _without_a_word_on_accelerators() -> Iterator[None]:
    """Ray warns of what it will change about CUDA_VISIBLE_DEVICES in its next version, unless it may change it now."""
    name = "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO"
    before = os.environ.get(name)
    os.environ.setdefault(name, "0")
    try:
        yield
    finally:
        if before is None:
            os.environ.pop(name, None)


def _check_address(address: str) -> None:
    """Refuse an address at which nobody listens, for which Ray itself waits a minute.

    Raises:
        ConfigError: It names the address.
    """
    if address in ("auto", "local"):
        return
    host, colon, port = address.removeprefix("ray://").rpartition(":")
    if not colon or not port.isdigit():
        raise ConfigError(f"the address {address!r} of a Ray cluster must be auto, HOST:PORT or ray://HOST:PORT")
    try:
        socket.create_connection((host, int(port)), _PATIENCE).close()
    except (OSError, OverflowError) as error:
        raise ConfigError(f"no Ray cluster answers at {address!r}: {error}") from None


def _result_of(ray: Any, reference: Any, index: int) -> Any:
    lost = (ray.exceptions.WorkerCrashedError, ray.exceptions.NodeDiedError, ray.exceptions.OutOfMemoryError)
    try:
        return ray.get(reference)
    except (*lost, ray.exceptions.ObjectLostError) as error:
        raise ClusterError(index, str(error).strip().splitlines()[0]) from error
