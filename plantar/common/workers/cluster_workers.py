"""Workers of a Dask cluster, and allowed scheduler addresses."""

import ipaddress
import logging
import re
import time
from collections.abc import Sequence
from concurrent.futures import CancelledError, Future
from contextlib import suppress

from plantar.common.optional_library import optional_library
from plantar.common.workers.workers import Job, Row, Task, Workers
from plantar.errors import InputError, PlantarError, WorkerError

_ADDRESS = re.compile(r"(?:(?P<scheme>[a-z]+)://)?(?P<host>\[[0-9a-fA-F:.]+\]|[A-Za-z0-9_.-]+):(?P<port>\d{1,5})/?")
_THIS_PROCESS = re.compile(r"inproc://[0-9a-fA-F.:]+/\d+/\d+")  # as `LocalCluster(protocol="inproc://")` names itself
_ALLOWED = "allowed: tcp://HOST:PORT, or tls://HOST:PORT with certificates"


def check_address(address: str) -> str:
    """The address with its scheme; an InputError for others.

    Example:
        >>> check_address("192.0.2.1:8786")
        'tcp://192.0.2.1:8786'
        >>> check_address("ucx://192.0.2.1:8786")
        Traceback (most recent call last):
        plantar.errors.InputError: scheduler 'ucx://192.0.2.1:8786': allowed: tcp://HOST:PORT, or tls://HOST:PORT ...
    """
    if _THIS_PROCESS.fullmatch(address):  # a cluster in this process: no bytes leave it
        return address
    match = _ADDRESS.fullmatch(address)
    if match is None or match["scheme"] not in (None, "tcp", "tls") or not 0 < int(match["port"]) < 65536:
        raise InputError(f"scheduler {address[:200]!r}: {_ALLOWED}")
    return f"{match['scheme'] or 'tcp'}://{match['host']}:{match['port']}"


def network_note(address: str) -> str:
    """A warning about an unauthenticated scheduler on a network, or empty.

    Example:
        >>> network_note("tcp://127.0.0.1:8786")
        ''
    """
    host = address.rpartition("://")[2].rpartition(":")[0].strip("[]")
    try:
        alone = ipaddress.ip_address(host).is_loopback
    except ValueError:
        alone = host == "localhost"
    if alone or address.startswith("tls://"):
        return ""
    return (
        f"{address} is neither encrypted nor authenticated: all who reach it can run code on its workers and here; "
        "use tls:// where the network is not your own"
    )


_CONNECT = 4.0  # s until a scheduler that does not answer counts as none
_ALONE = 30.0  # s without a worker, or without a word of the scheduler, until the sweep gives up; a nanny needs about 5
_ANSWER = 1.0  # s for one answer; Ctrl-C waits for no longer one
_LOGS = ("distributed", "distributed.client", "tornado", "tornado.application", "asyncio")


class ClusterWorkers(Workers):
    """Workers of a Dask scheduler at an `address` such as tcp://host:8786; certificates are Dask's own settings.

    Two tasks fit a worker thread. Dask restarts a dead worker's run on another, as often as its setting
    `allowed-failures` allows.
    """

    def __init__(self, address: str, job: Job) -> None:
        super().__init__()
        self._job = job
        with optional_library("distributed", "cluster"):
            from distributed import Client, KilledWorker, Security
        for name in _LOGS:  # one line replaces what they report of a scheduler that is gone
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
        address = check_address(address)
        security = Security(require_encryption=True) if address.startswith("tls://") else None
        try:
            self._client = Client(address, timeout=_CONNECT, set_as_default=False, security=security)
        except (OSError, ValueError, RuntimeError, TypeError) as error:  # ssl's errors are OSErrors
            raise InputError(f"no Dask scheduler answers at {address}: {error}") from None
        self._executor = self._client.get_executor(pure=False)
        self._killed = KilledWorker
        self._scheduler = f"the Dask scheduler at {address}"
        self._threads = 0
        self._asked = time.monotonic()
        self._answered = self._asked
        self._manned = self._asked

    def close(self) -> None:
        with suppress(Exception):
            self._client.close(timeout=_ANSWER)

    def _capacity(self) -> int:
        return max(1, 2 * self._threads)

    def _begin(self, task: Task) -> Future[Row]:
        try:
            future: Future[Row] = self._executor.submit(self._job.run, task)
        except Exception as error:  # a client whose scheduler has just gone raises what it happens to meet
            raise WorkerError(f"{self._scheduler} takes no runs ({type(error).__name__})") from None
        return future

    def _outcome(self, task: Task, future: Future[Row]) -> Sequence[Row]:
        try:
            return [future.result()]
        except self._killed as error:
            return [self._job.failed(f"the worker died in this run, {error.allowed_failures + 1} times")]
        except CancelledError:
            raise WorkerError(f"{self._scheduler} went away") from None
        except PlantarError:
            raise
        except Exception as error:
            raise WorkerError(f"a worker cannot run Plantar ({type(error).__name__}: {error})") from None

    def _check(self) -> None:
        now = time.monotonic()
        if self._client.status != "running":
            raise WorkerError(f"{self._scheduler} went away")
        if now - self._asked < _ANSWER:
            return
        self._asked = now
        self._threads = 0
        with suppress(Exception):  # any error of a client whose scheduler is gone
            self._threads = sum(self._client.nthreads(callback_timeout=_ANSWER).values())
            self._answered = now
        if self._threads:
            self._manned = now
        if now - self._answered > _ALONE:
            raise WorkerError(f"{self._scheduler} has not answered for {_ALONE:g} s")
        if now - self._manned > _ALONE:
            raise WorkerError(f"{self._scheduler} has had no worker for {_ALONE:g} s")
