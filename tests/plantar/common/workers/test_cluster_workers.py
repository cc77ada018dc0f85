"""Which schedulers are connected to, and what is reported of those that anybody may be."""

import time

import pytest

from plantar.common.workers.cluster_workers import ClusterWorkers, check_address, network_note
from plantar.common.workers.workers import Job
from plantar.errors import InputError

JOB = Job(str, str)


@pytest.mark.parametrize(
    "address", ["ucx://h:1", "file:///etc/passwd", "inproc://h:1", "tcp://h", "tcp://h:0", "tcp://h:99999", "", "h:1;x"]
)
def test_another_address_is_refused_at_once(address):
    begun = time.process_time()
    with pytest.raises(InputError, match=r"allowed: tcp://HOST:PORT, or tls://HOST:PORT"):
        ClusterWorkers(address, JOB)
    assert time.process_time() - begun < 5.0


def test_tls_without_certificates_is_one_line():
    pytest.importorskip("distributed")
    with pytest.raises(InputError, match=r"no Dask scheduler answers at tls://127\.0\.0\.1:8786: TLS"):
        ClusterWorkers("tls://127.0.0.1:8786", JOB)


def test_a_scheduler_that_anybody_may_be_is_reported():
    assert "neither encrypted nor authenticated" in network_note("tcp://192.0.2.1:8786")
    assert "neither encrypted nor authenticated" in network_note("scheduler:8786")
    assert (
        network_note("tls://192.0.2.1:8786") == network_note("tcp://localhost:1") == network_note("tcp://[::1]:1") == ""
    )
    assert check_address("tls://a.example:8786") == "tls://a.example:8786"
