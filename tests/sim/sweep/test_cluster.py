"""Which schedulers are connected to, and what is reported of those that anybody may be."""

import time
from pathlib import Path

import pytest

from plantar.errors import InputError
from plantar.sim.sweep.cluster import ClusterWorkers, check_address, network_note, tls_files

_VARIABLES = [f"DASK_DISTRIBUTED__COMM__TLS__{name}" for name in ("CA_FILE", "CLIENT__CERT", "CLIENT__KEY")]


@pytest.mark.parametrize(
    "address", ["ucx://h:1", "file:///etc/passwd", "inproc://h:1", "tcp://h", "tcp://h:0", "tcp://h:99999", "", "h:1;x"]
)
def test_another_address_is_refused_at_once(address):
    begun = time.monotonic()
    with pytest.raises(InputError, match=r"allowed: tcp://HOST:PORT, or tls://HOST:PORT"):
        ClusterWorkers(address)
    assert time.monotonic() - begun < 5.0


def test_tls_without_certificates_is_refused_by_name(tmp_path, monkeypatch):
    for name in _VARIABLES:
        monkeypatch.delenv(name, raising=False)
    with pytest.raises(InputError, match=r"CA_FILE has to name a PEM file \(it is not set\)"):
        ClusterWorkers("tls://127.0.0.1:8786")
    files = {name: str(tmp_path / f"{i}.pem") for i, name in enumerate(_VARIABLES)}
    with pytest.raises(InputError, match="is no file"):
        tls_files(files)
    for path in files.values():
        Path(path).write_text("no certificate")
    assert list(tls_files(files).values()) == list(files.values())
    for name, path in files.items():
        monkeypatch.setenv(name, path)
    with pytest.raises(InputError, match=r"no Dask scheduler answers|certificate"):
        ClusterWorkers("tls://127.0.0.1:8786")


def test_a_scheduler_that_anybody_may_be_is_reported():
    assert "neither encrypted nor authenticated" in network_note("tcp://192.0.2.1:8786")
    assert "neither encrypted nor authenticated" in network_note("scheduler:8786")
    assert (
        network_note("tls://192.0.2.1:8786") == network_note("tcp://localhost:1") == network_note("tcp://[::1]:1") == ""
    )
    assert check_address("tls://a.example:8786") == "tls://a.example:8786"
