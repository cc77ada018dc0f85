"""Firmware compiled and run on this machine with a simulated sole, through a pseudo-terminal, to the listener."""

import os
import shutil
import subprocess
import threading
import tty
from pathlib import Path

import numpy as np
import pytest

from plantar.live import Fault, open_live
from plantar.live.packets import packets_of
from plantar.live.record import record
from plantar.recordings.recording import read_mcap
from plantar.shoes.wiring.firmware_files import firmware_sources, header_text
from plantar.shoes.wiring.nets import wiring_of

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")

NEWTON = 0.05 * 8192  # counts: 0.05 mS of a simulated taxel over the 1 mS of the resistor


def compiled(shoe, parameters, folder: Path) -> Path:
    """Program of a shoe's firmware with the simulated board, all warnings being errors."""
    for name, source in firmware_sources().items():
        shutil.copy(source, folder / name)
    (folder / "sole.h").write_text(header_text(shoe, wiring_of(shoe, parameters)))
    program = folder / "sole"
    flags = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-I", str(folder)]
    files = [str(folder / name) for name in ("sole.c", "hardware_simulated.c")]
    subprocess.run(["cc", *flags, *files, "-lm", "-o", str(program)], check=True)
    return program


def readings(program: Path, shoe, **settings: str):
    """Readings that a program sends, and faults among them."""
    done = subprocess.run([program], env={**os.environ, **settings}, capture_output=True, check=True, timeout=60)
    arrivals = list(packets_of([done.stdout], {shoe.side: shoe.layout}))
    faults = [a for a in arrivals if isinstance(a, Fault)]
    return [a[1] for a in arrivals if not isinstance(a, Fault)], faults


@pytest.mark.parametrize("cell", ["velostat", "fsr_402_short", "fx29_25"])
def test_a_pressed_taxel_is_read_by_its_force_and_no_other(cell, wired_builds, tmp_path):
    build = wired_builds[cell]
    shoe = build.shoes[0]
    program = compiled(shoe, build.parameters, tmp_path)
    pressed = len(shoe.layout) // 2
    found, faults = readings(program, shoe, SOLE_SECONDS="0.8", SOLE_PRESSED=str(pressed))
    assert faults == []
    rise = found[-1].force - found[0].force
    wanted = 15.0 * 2**15 / 694.0 if cell == "fx29_25" else 15.0 * NEWTON
    assert rise[pressed] == pytest.approx(wanted, rel=0.02)
    others = np.delete(rise, pressed)
    assert np.abs(others).max() < 0.01 * wanted  # no ghost


def test_the_load_and_its_center_are_those_of_the_simulated_step(wired_builds, tmp_path):
    build = wired_builds["velostat"]
    shoe = build.shoes[0]
    program = compiled(shoe, build.parameters, tmp_path)
    found, _ = readings(program, shoe, SOLE_SECONDS="1.1")
    force = np.array([reading.force for reading in found])
    force = force - force.min(axis=0)
    total = force.sum(axis=1) / NEWTON
    stance = total > 100.0
    assert np.median(total[stance]) == pytest.approx(300.0, rel=0.03)  # with every ghost of the sheet in the circuit
    x = (force @ shoe.layout.positions[:, 0])[stance] / force.sum(axis=1)[stance]
    assert np.ptp(x) > 0.5 * np.ptp(shoe.layout.positions[:, 0])


def test_through_a_terminal_to_a_recording_whatever_is_lost_or_wrong(wired_builds, tmp_path):
    build = wired_builds["velostat"]
    shoe = build.shoes[0]
    program = compiled(shoe, build.parameters, tmp_path)
    board, port = os.openpty()
    tty.setraw(port)
    tty.setraw(board)
    stream = open_live(f"packets:{os.ttyname(port)}", shoe.layout)
    env = {**os.environ, "SOLE_SECONDS": "2.0", "SOLE_FAULTS": "2"}
    with subprocess.Popen([program], stdout=board, env=env) as running:
        threading.Thread(target=running.wait).start()
        found = record(stream, tmp_path / "run.mcap", 1.5)
    stream.close()
    os.close(board)
    os.close(port)
    assert found["feet"]["left"]["frames"] > 20
    assert found["faults"].get("dropped", 0) + found["faults"]["garbled"] > 0
    recording = read_mcap(tmp_path / "run.mcap")
    assert recording is not None


def test_it_names_the_pressed_taxel(wired_builds, tmp_path):
    build = wired_builds["fsr_402_short"]
    shoe = build.shoes[0]
    program = compiled(shoe, build.parameters, tmp_path)
    board, port = os.openpty()
    tty.setraw(port)
    tty.setraw(board)
    taxel = 3
    os.write(board, b"n")
    env = {**os.environ, "SOLE_SECONDS": "1.0", "SOLE_PRESSED": str(taxel), "SOLE_DEVICE": os.ttyname(port)}
    subprocess.run([program], env=env, check=True, timeout=60)
    text = os.read(board, 1 << 16).decode("latin-1")
    os.close(board)
    os.close(port)
    assert f"T{shoe.layout.ids[taxel]} " in text
    assert text.count("T") == 1  # no other one
