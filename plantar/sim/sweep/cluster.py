"""Workers of a Dask cluster, and allowed scheduler addresses."""

import ipaddress
import itertools
import logging
import os
import re
import threading
import time
import uuid
from collections.abc import Mapping, Sequence
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import Any

from plantar.common.optional_library import optional_library
from plantar.errors import InputError, PlantarError, WorkerError
from plantar.sim.sweep.task import Row, Task, failed, run_task
from plantar.sim.sweep.workers import Workers

_ADDRESS = re.compile(r"(?:(?P<scheme>[a-z]+)://)?(?P<host>\[[0-9a-fA-F:.]+\]|[A-Za-z0-9_.-]+):(?P<port>\d{1,5})/?")
_THIS_PROCESS = re.compile(r"inproc://[0-9a-fA-F.:]+/\d+/\d+")  # as `LocalCluster(protocol="inproc://")` names itself
_ALLOWED = "allowed: tcp://HOST:PORT, or tls://HOST:PORT with certificates"
_FILES = {"tls_ca_file": "CA_FILE", "tls_client_cert": "CLIENT__CERT", "tls_client_key": "CLIENT__KEY"}
_VARIABLE = "DASK_DISTRIBUTED__COMM__TLS__"


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


def tls_files(environment: Mapping[str, str] = os.environ) -> dict[str, str]:
    """Paths of authority and client certificates and key, from Dask's environment variables."""
    found = {}
    for key, name in _FILES.items():
        path = environment.get(_VARIABLE + name, "")
        if not os.path.isfile(path):
            what = f"{path[:200]!r} is no file" if path else "it is not set"
            raise InputError(f"tls:// needs certificates: {_VARIABLE}{name} has to name a PEM file ({what})")
        found[key] = path
    return found


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
    """Workers of a Dask scheduler at an `address` such as tcp://host:8786.

    Two tasks fit a worker thread. Dask restarts a dead worker's run on another, as often as its setting
    `allowed-failures` allows.
    """

    def __init__(self, address: str) -> None:
        with optional_library("distributed", "cluster"):
            from distributed import Client, KilledWorker, Security
        for name in _LOGS:  # one line replaces what they report of a scheduler that is gone
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
        address = check_address(address)
        files = tls_files() if address.startswith("tls://") else {}
        security = Security(**files, require_encryption=True) if files else None
        try:
            self._client = Client(address, timeout=_CONNECT, set_as_default=False, security=security)
        except (OSError, ValueError, RuntimeError, TypeError) as error:  # ssl's errors are OSErrors
            raise InputError(f"no Dask scheduler answers at {address}: {error}") from None
        self._killed = KilledWorker
        self._scheduler = f"the Dask scheduler at {address}"
        self._names = (f"plantar-{uuid.uuid4().hex}-{i}" for i in itertools.count())
        self._tasks: dict[Any, Task] = {}
        self._ended: SimpleQueue[Any] = SimpleQueue()
        self._error: PlantarError | None = None
        self._threads = 0
        self._answered = time.monotonic()
        self._manned = self._answered
        self._closed = threading.Event()
        threading.Thread(target=self._watch, daemon=True).start()

    @property
    def room(self) -> int:
        return max(1, 2 * self._threads) - len(self._tasks)

    def submit(self, task: Task) -> None:
        try:
            future = self._client.submit(run_task, task, key=next(self._names), pure=False)
        except Exception as error:  # a client whose scheduler has just gone raises what it happens to meet
            raise WorkerError(f"{self._scheduler} takes no runs ({type(error).__name__})") from None
        self._tasks[future] = task
        future.add_done_callback(self._ended.put)

    def finished(self, timeout: float) -> Sequence[tuple[Task, Row]]:
        rows: list[tuple[Task, Row]] = []
        with suppress(Empty):
            future = self._ended.get(timeout=timeout)
            while True:
                rows += self._outcome(future)
                future = self._ended.get_nowait()
        if not rows:
            self._check()
        return rows

    def close(self) -> None:
        self._closed.set()
        with suppress(Exception):
            self._client.close(timeout=_ANSWER)

    def _outcome(self, future: Any) -> list[tuple[Task, Row]]:
        task = self._tasks[future]
        try:
            row: Row = future.result(timeout=_ANSWER)
        except TimeoutError:  # of the asking; its worker may have died since, and Dask runs it again
            self._ended.put(future)
            return []
        except self._killed as error:
            row = failed(f"the worker died in this run, {error.allowed_failures + 1} times")
        except PlantarError as error:
            self._error = error
            return []
        except Exception as error:
            if future.status == "error":
                self._error = WorkerError(f"a worker cannot run Plantar ({type(error).__name__}: {error})")
            else:
                self._error = WorkerError(f"{self._scheduler} went away")
            return []
        del self._tasks[future]
        return [(task, row)]

    def _check(self) -> None:
        now = time.monotonic()
        if self._error is not None:
            raise self._error
        if self._client.status != "running":
            raise WorkerError(f"{self._scheduler} went away")
        if now - self._answered > _ALONE:
            raise WorkerError(f"{self._scheduler} has not answered for {_ALONE:g} s")
        if now - self._manned > _ALONE:
            raise WorkerError(f"{self._scheduler} has had no worker for {_ALONE:g} s")

    def _watch(self) -> None:
        while not self._closed.is_set():
            try:
                self._threads = sum(self._client.nthreads().values())
                self._answered = time.monotonic()
                if self._threads:
                    self._manned = self._answered
            except Exception:  # any error of a client whose scheduler is gone; `_check` reports it
                self._threads = 0
            self._closed.wait(1.0)
