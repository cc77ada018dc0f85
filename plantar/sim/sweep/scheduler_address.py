"""The address of a Dask scheduler: form and trust."""

from __future__ import annotations

import ipaddress
import os
import re
from collections.abc import Mapping

from plantar.errors import InputError

__all__ = ["check_address", "network_note", "tls_files"]

_ADDRESS = re.compile(r"(?:(?P<scheme>[a-z]+)://)?(?P<host>\[[0-9a-fA-F:.]+\]|[A-Za-z0-9_.-]+):(?P<port>\d{1,5})/?")
_THIS_PROCESS = re.compile(r"inproc://[0-9a-fA-F.:]+/\d+/\d+")  # as `LocalCluster(protocol="inproc://")` names itself
_ALLOWED = "allowed: tcp://HOST:PORT, or tls://HOST:PORT with certificates"
_FILES = {"ca_file": "CA_FILE", "client_cert": "CLIENT__CERT", "client_key": "CLIENT__KEY"}
_VARIABLE = "DASK_DISTRIBUTED__COMM__TLS__"


def check_address(address: str) -> str:
    """The address with its scheme; an InputError for other addresses.

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
    """Paths of the certificates of authority and client and of the client's key, from Dask's environment variables.

    Raises:
        InputError: If one is not named or not a file.
    """
    found = {}
    for key, name in _FILES.items():
        path = environment.get(_VARIABLE + name, "")
        if not os.path.isfile(path):
            what = f"{path[:200]!r} is no file" if path else "it is not set"
            raise InputError(f"tls:// needs certificates: {_VARIABLE}{name} has to name a PEM file ({what})")
        found[key] = path
    return found


def network_note(address: str) -> str:
    """A warning about a scheduler on a network without authentication, or an empty text.

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
