"""Sources without hardware: a pseudo-terminal, UDP on this machine, a file that grows, and hostile senders of each."""

import os
import socket
import subprocess
import sys
import threading
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from plantar import InputError, grid_layout, write_layout
from plantar.formats import read_recording
from plantar.live import open_live
from plantar.live.line_reading import line_of
from plantar.live.record import record
from plantar.live.sink import open_sink
from plantar.recordings.recording import read_mcap
from plantar.sensing.reading import Reading

ROOT = Path(__file__).resolve().parents[3]
SOLE = grid_layout([[-0.1, -0.05], [0.1, -0.05], [0.1, 0.05], [-0.1, 0.05]], pitch=(0.05, 0.05), side="left")


def line(time_s, force=2.0):
    return line_of("left", Reading(time_s, np.full(len(SOLE), force)))


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@pytest.fixture
def sending():
    """Starts a sender of lines, every 5 ms until it is stopped."""
    over = threading.Event()
    threads = []

    def start(send):
        def loop():
            for k in count():
                if over.wait(0.005):
                    return
                send(line(0.005 * k))

        threads.append(threading.Thread(target=loop))
        threads[-1].start()

    def stop():
        over.set()
        for thread in threads:
            thread.join()

    start.stop = stop
    yield start
    stop()


def hostile(random):
    """Rubbish of all kinds: bytes, long lines, wrong numbers, times from elsewhere."""
    kinds = (
        lambda: random.bytes(200),
        lambda: b"\n\n\n",
        lambda: b"left," * 5000 + b"\n",
        lambda: b"left,1e308," + b"1," * len(SOLE) + b"\n",
        lambda: b"left,inf\nright,nan,1,2\n\0\0\0\n",
        lambda: line(float(random.uniform(-1e9, 1e9))),
    )
    return lambda k: kinds[random.integers(len(kinds))]()


def test_packets_of_a_device_and_a_hostile_sender(tmp_path, sending):
    port = free_port()
    stream = open_live(f"udp:{port}", SOLE)
    device = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    other = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    rubbish = hostile(np.random.default_rng(0))

    def flood(packet):
        device.sendto(packet, ("127.0.0.1", port))
        for k in range(20):
            other.sendto(rubbish(k), ("127.0.0.1", port))

    with device, other:
        sending(flood)
        found = record(stream, tmp_path / "run.mcap", 1.0)
        sending.stop()
    stream.close()
    assert found["feet"]["left"]["frames"] >= 195
    assert found["faults"]["stranger"] > 100
    assert found["faults"]["garbled"] > 100
    assert read_recording(tmp_path / "run.mcap").rate_hz == pytest.approx(200.0, rel=0.1)
    recorded = read_mcap(tmp_path / "run.mcap")
    assert recorded.metadata["live"]["faults"] == found["faults"]


def test_udp_listens_on_this_machine_alone():
    port = free_port()
    stream = open_live(f"udp:{port}", SOLE)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.2", port))  # would be taken if all addresses were listened at
    stream.close()


def test_what_is_sent_on_is_received():
    port = free_port()
    stream = open_live(f"udp:{port}", SOLE)
    send = open_sink(f"udp:{port}")
    send("right", Reading(0.25, np.arange(8.0)))
    side, reading = next(stream.readings)
    stream.close()
    assert (side, reading.time, reading.force.tolist()) == ("right", 0.25, list(range(8)))


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals")
def test_a_serial_port_that_is_unplugged_and_plugged_in_again(tmp_path):
    path = tmp_path / "port"
    master, slave = os.openpty()
    os.symlink(os.ttyname(slave), path)
    stream = open_live(f"serial:{path}@921600", SOLE)
    os.close(slave)
    os.write(master, b"?" * 7 + line(0.0) + line(0.01) + line(0.02))
    readings = stream.readings
    assert [next(readings)[1].time for _ in range(2)] == [0.01, 0.02]
    os.close(master)
    path.unlink()
    master, slave = os.openpty()
    os.symlink(os.ttyname(slave), path)
    times = iter(0.01 * k for k in count())
    over = threading.Event()

    def device():
        while not over.wait(0.01):
            os.write(master, line(next(times), 3.0))

    sender = threading.Thread(target=device)
    sender.start()
    again = [next(readings)[1].time for _ in range(5)]
    over.set()
    sender.join()
    stream.close()
    os.close(master)
    os.close(slave)
    assert (np.diff(again) > 0.0).all()
    assert again[0] > 0.02
    assert stream.faults["garbled"] == stream.faults["lost"] == stream.faults["restart"] == 1


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals")
@pytest.mark.parametrize(
    ("address", "words"),
    [("", "allowed: serial:DEVICE"), ("/dev/null@12345", "allowed: .*115200"), ("/dev/null", "no serial port")],
)
def test_a_serial_port_that_cannot_be(address, words):
    with pytest.raises(InputError, match=words):
        open_live(f"serial:{address}", SOLE)


def test_a_file_that_grows_and_is_replaced(tmp_path):
    path = tmp_path / "log.csv"
    path.write_bytes(line(0.0) + line(0.01) + b"left,0.0")
    stream = open_live(f"file:{path}", SOLE)
    readings = stream.readings
    assert [next(readings)[1].time for _ in range(2)] == [0.0, 0.01]
    with path.open("ab") as log:
        log.write(line(0.02).removeprefix(b"left,0.0"))
    assert next(readings)[1].time == 0.02
    (tmp_path / "next.csv").write_bytes(b"".join(line(0.001 * k) for k in range(1, 6)))
    os.replace(tmp_path / "next.csv", path)
    assert [next(readings)[1].force[0] for _ in range(5)] == [2.0] * 5
    stream.close()
    assert stream.faults["restart"] == 1


@pytest.mark.parametrize("source", ["udp", "udp:0", "udp:99999", "udp:host:name", "file", "file:/none", "serial:/none"])
def test_a_source_that_cannot_be_opened_is_named(source):
    with pytest.raises(InputError):
        open_live(source, SOLE)
    with pytest.raises(InputError, match="--layout"):
        open_live("udp:9870")


@pytest.mark.skipif(sys.platform != "linux", reason="peak memory of a process")
def test_a_hostile_program_on_a_pipe_harms_nothing(tmp_path):
    """40 MB of rubbish around 2000 readings: all of them are recorded, in memory that does not grow with it."""
    write_layout(SOLE, tmp_path / "sole.json")
    rubbish = hostile(np.random.default_rng(1))
    code = (
        "import atexit, re, sys; from plantar.__main__ import main; "  # not ru_maxrss, which a child begins with
        "peak = lambda: re.search(r'VmHWM:\\s+(\\d+)', open('/proc/self/status').read())[1]; "
        "atexit.register(lambda: print(peak(), file=sys.stderr)); "
        "sys.exit(main())"
    )
    words = ("live", "lines", "--layout", "sole.json", "-o", "run.mcap", "--json")
    env = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", code, *words]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, cwd=tmp_path, env=env, **pipes) as process:
        process.stdin.write(b"\xff" * 20_000_000 + b"\n")
        for k in range(2000):
            process.stdin.write(line(0.01 * k) + (rubbish(k).replace(b"left,-", b"x").rstrip(b"\n") + b"\n"))
        process.stdin.write(b"\0" * 20_000_000)
        out, err = process.communicate()
    assert process.returncode == 0, err
    assert b'"faults"' in out
    assert len(read_mcap(tmp_path / "run.mcap").topics["/skin/left"]) >= 2000
    assert int(err.split()[-1]) < 250_000  # kB


@pytest.mark.skipif(sys.platform == "win32", reason="pseudo-terminals")
def test_a_port_a_foot_whose_boards_do_not_wait_for_each_other():
    ends = [os.openpty() for _ in range(2)]
    for master, _ in ends:
        os.write(master, line(7.0) * 3)  # what was sent before anybody listened is no reading
    stream = open_live("serial:" + ",".join(os.ttyname(slave) for _, slave in ends), SOLE)
    came = {"left": [], "right": []}
    readings = stream.readings
    for k in range(60):
        for (master, _), side in zip(ends, came, strict=True):
            if side == "left" or k % 3 == 0:  # one board is three times as fast
                os.write(master, line_of(side, Reading(0.01 * k, np.full(len(SOLE), 2.0))))
    while len(came["left"]) < 60 or len(came["right"]) < 20:
        side, reading = next(readings)
        came[side].append(reading.time)
    os.write(ends[1][0], line(0.9) + line_of("right", Reading(0.9, np.full(len(SOLE), 2.0))))
    assert next(readings)[0] == "right"
    stream.close()
    for pair in ends:
        for end in pair:
            os.close(end)
    assert came == {"left": [0.01 * k for k in range(60)], "right": [0.01 * k for k in range(0, 60, 3)]}
    assert stream.faults["stranger"] == 1  # the right foot's board called itself left once


def test_ports_are_named_once_and_all_of_them_open(tmp_path):
    master, slave = os.openpty()
    with pytest.raises(InputError, match="allowed: each of them once"):
        open_live(f"serial:{os.ttyname(slave)},{os.ttyname(slave)}", SOLE)
    with pytest.raises(InputError, match=r"cannot be opened: No such file"):
        open_live(f"serial:{os.ttyname(slave)},{tmp_path / 'none'}", SOLE)
    os.close(master)
    os.close(slave)
