"""From the firmware to the report as a user goes: compiled, read by `live`, calibrated, walked in, shown, analysed."""

import http.client
import json
import os
import re
import shutil
import subprocess
import sys
import tty
from contextlib import ExitStack, contextmanager
from pathlib import Path
from urllib.parse import urlparse

import numpy as np
import pytest

from plantar import read_layout, write_layout
from plantar.formats import ReadOptions, read_recording
from plantar.shoes.wiring.firmware_files import firmware_sources, header_text
from plantar.shoes.wiring.nets import wiring_of

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")

WEIGHT = 300.0  # N, of hardware_simulated.c
STRIDE = 1.0  # s


def plantar(*arguments: object) -> dict:
    """JSON of a command as a user calls it."""
    command = [sys.executable, "-m", "plantar", *map(str, arguments), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def boards(wired_builds, tmp_path_factory) -> list[Path]:
    """Programs of both feet's boards, with the simulated hardware."""
    build = wired_builds["velostat"]
    made = []
    for shoe in build.shoes:
        folder = tmp_path_factory.mktemp(shoe.side)
        (folder / "sole.h").write_text(header_text(shoe, wiring_of(shoe, build.parameters)))
        for name, source in firmware_sources().items():
            shutil.copy(source, folder / name)
        files = [str(folder / name) for name in ("sole.c", "hardware_simulated.c")]
        subprocess.run(
            ["cc", "-std=c99", "-O2", "-I", str(folder), *files, "-lm", "-o", str(folder / "sole")], check=True
        )
        made.append(folder / "sole")
    return made


@contextmanager
def running(boards: list[Path], motion: str, speed: int):
    """Ports of boards that run some times as fast as by the clock, with noise, drift, lost and wrong bytes."""
    with ExitStack() as stack:
        ports = []
        for board in boards:
            inside, outside = os.openpty()
            for end in (inside, outside):
                tty.setraw(end)
                stack.callback(os.close, end)
            os.set_blocking(inside, False)
            ports.append(os.ttyname(outside))
            settings = {"SOLE_MOTION": motion, "SOLE_SECONDS": "3600", "SOLE_SPEED": str(speed), "SOLE_FAULTS": "2"}
            program = stack.enter_context(subprocess.Popen([board], stdout=inside, env={**os.environ, **settings}))
            stack.callback(program.kill)
        yield "packets:" + ",".join(ports)


def page_of(lines) -> str:
    """Address of the page that a command prints."""
    for line in lines:
        found = re.search(r"page: (http\S+)", line)
        if found:
            return found[1]
    raise AssertionError("no page")


def states_of(url: str, seconds: float) -> list[dict]:
    """What the page's stream sends in some seconds of its soles' clock."""
    where = urlparse(url)
    connection = http.client.HTTPConnection(where.hostname, where.port, timeout=60)
    connection.request("GET", where.path + (f"?{where.query}" if where.query else ""))
    token = json.loads(re.search(r'id="data">(.*?)</script>', connection.getresponse().read().decode())[1])["token"]
    connection.request("GET", f"/stream?token={token}")
    answer = connection.getresponse()
    states = []
    while not states or states[-1]["time"] < states[0]["time"] + seconds:
        line = answer.readline().strip()
        if line.startswith(b"data:"):
            states.append(json.loads(line[5:]))
    connection.close()
    return states


def test_from_firmware_to_calibration_recording_page_and_report(boards, wired_builds, tmp_path):
    layout = write_layout(wired_builds["velostat"].shoes[0].layout, tmp_path / "layout_left.json")
    air = tmp_path / "air.mcap"
    lean = tmp_path / "lean.mcap"
    mine = tmp_path / "mine.json"
    walk = tmp_path / "walk.mcap"
    for path, motion, seconds in ((air, "air", 3.0), (lean, "lean", 40.0)):
        with running(boards, motion, 8) as ports:
            found = plantar("live", ports, "--layout", layout, "--seconds", seconds, "-o", path)
        assert set(found["feet"]) == {"left", "right"}
        assert found["faults"]["garbled"] > 0  # and the recording went on
    fit = plantar("calibrate", layout, "--zero", air, "--motion", lean, "--weight", WEIGHT, "-o", mine)
    for sole in fit["soles"].values():
        # Taxels differ by 15 %, and a body's weight alone does not tell them apart.
        assert 0.1 < sole["gain_error_median"] < 0.25
    assert any("press them one by one" in line for line in fit["unobserved"])
    standing = read_recording(lean, layout=read_layout(mine), options=ReadOptions(unit="raw"))
    total = sum(foot.vertical_force for foot in standing.feet.values())
    assert np.nanmedian(total) == pytest.approx(WEIGHT, rel=0.03)

    with running(boards, "walk", 3) as ports:
        command = [sys.executable, "-m", "plantar", "live", ports, "--counts", "--layout", mine, "--page"]
        more = ["--seconds", "12", "-o", walk, "--json"]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        with subprocess.Popen([*command, *map(str, more)], **pipes) as live:
            states = states_of(page_of(live.stderr), 3.0 * STRIDE)
            _, errors = live.communicate(timeout=300)
    assert live.returncode == 0, errors
    loads = [sole["load"] for state in states for sole in state["soles"].values()]
    assert max(loads) == pytest.approx(WEIGHT, rel=0.15)  # of the foot that carries alone

    report = plantar("analyze", walk, "-o", tmp_path / "out")
    assert report["activity"]["name"] == "walking"
    for foot in report["feet"].values():
        assert foot["measures"]["stride_time_s"]["median"] == pytest.approx(STRIDE, rel=0.02)
        assert foot["measures"]["peak_force_N"]["median"] == pytest.approx(WEIGHT, rel=0.1)
