"""Load of `plantar live`: two soles of 42 taxels at 500 Hz by UDP, with every fault that a line can have, and the page.

    python benchmarks/live_load.py SECONDS [--page] [--rate 500]

Prints what was sent, what the recording holds, the listener's share of a core, its memory's slope, and of the page,
open in Chromium, the times from a packet's arrival to the end of its picture's drawing. Faults are drawn by the commit.
"""

import argparse
import json
import math
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
from resumable import commit

from plantar.formats import read_recording

ROOT = Path(__file__).resolve().parent.parent
LAYOUT = ROOT / "plantar" / "robots" / "h1" / "layout_left.json"
SIDES = ("left", "right")
STEP = 0.6  # s of a stance
FAULTS = 0.01  # of packets that are wrong, or come with one that is
KINDS = ("garbled", "blank", "repeated", "cut", "foreign", "infinite", "missing", "gap", "long")


def lines_of_stance(taxels: int, rate: float) -> list[str]:
    """Forces of one stride, as text."""
    count = round(2.0 * STEP * rate)
    shape = np.maximum(0.0, np.sin(2.0 * math.pi * np.arange(count) / count))
    share = np.random.default_rng(0).uniform(0.5, 1.5, taxels)
    return [",".join(f"{force:.2f}" for force in 15.0 * level * share) for level in shape]


def send(port: int, seconds: float, rate: float, taxels: int) -> tuple[Counter[str], Counter[str]]:
    """Send both soles in real time; returns readings sent by side, and faults by kind."""
    drawn = random.Random(commit())
    device = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    device.connect(("127.0.0.1", port))
    forces = lines_of_stance(taxels, rate)
    sent: Counter[str] = Counter()
    faults: Counter[str] = Counter()
    begin = time.monotonic()
    for k in range(round(seconds * rate)):
        wait = begin + k / rate - time.monotonic()
        if wait > 0.0:
            time.sleep(wait)
        for side in SIDES:
            line = f"{side},{k / rate:.6f},{forces[(k + len(forces) // 2 * (side == 'right')) % len(forces)]}\n"
            if drawn.random() < FAULTS:
                kind = drawn.choice(KINDS)
                faults[kind] += 1
                wrong = {
                    "garbled": drawn.randbytes(drawn.randrange(1, 400)),
                    "blank": b"\n",
                    "repeated": line.encode(),
                    "cut": line[: drawn.randrange(6, len(line) // 2)].encode(),
                    "foreign": b"middle," + line.encode(),
                    "infinite": re.sub(r",[^,]+\n", ",1e308\n", line).encode(),
                    "long": line.encode().rstrip() + b",1" * 20_000,
                    "missing": re.sub(r",[^,]+\n", ",\n", line).encode(),
                }.get(kind, b"")
                if kind == "gap":
                    continue
                if kind in ("infinite", "missing"):  # a reading of which one force is unknown
                    device.send(wrong)
                    sent[side] += 1
                    continue
                if wrong:
                    device.send(wrong)
            device.send(line.encode())
            sent[side] += 1
    device.close()
    return sent, faults


class Browser:
    """A page in headless Chromium, asked through pipes."""

    def __init__(self, url: str, folder: Path) -> None:
        name = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))))
        inside, self._out = os.pipe()
        self._in, outside = os.pipe()

        def pipes() -> None:  # Chromium reads 3 and writes 4
            high = [os.dup2(end, 100 + i) for i, end in enumerate((inside, outside))]
            os.dup2(high[0], 3)
            os.dup2(high[1], 4)

        command = [name, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]
        command += ["--no-first-run", "--disable-extensions", "--disable-background-networking"]
        command += ["--remote-debugging-pipe", f"--user-data-dir={folder}", "--window-size=1280,800", url]
        self._process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, close_fds=False, preexec_fn=pipes
        )
        os.close(inside)
        os.close(outside)
        self._rest = b""
        self._number = 0
        self._session = ""
        while not self._session:
            for target in self._call("Target.getTargets")["targetInfos"]:
                if target["type"] == "page" and target["url"].startswith(url):
                    asked = {"targetId": target["targetId"], "flatten": True}
                    self._session = self._call("Target.attachToTarget", asked)["sessionId"]
            time.sleep(0.2)
        while self.evaluate("document.readyState") != "complete":
            time.sleep(0.2)

    def evaluate(self, text: str) -> Any:
        found = self._call("Runtime.evaluate", {"expression": text, "returnByValue": True})
        return found["result"].get("value")

    def close(self) -> None:
        self._process.terminate()
        self._process.wait()

    def _call(self, method: str, parameters: dict[str, Any] | None = None) -> Any:
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method, "params": parameters or {}}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            while b"\0" not in self._rest:
                self._rest += os.read(self._in, 1 << 16)
            one, _, self._rest = self._rest.partition(b"\0")
            answer = json.loads(one)
            if answer.get("id") == self._number:
                return answer["result"]


def used(process: int) -> tuple[float, float]:
    """Processor time in s, by the scheduler's clock, and memory in MB of a process."""
    place = Path(f"/proc/{process}")
    spent = sum(int(thread.read_text().split()[0]) for thread in place.glob("task/*/schedstat"))
    return 1e-9 * spent, int((place / "statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def interruptible() -> None:
    """Let Ctrl-C end what is started here, also where a shell started this in the background."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def main() -> None:
    asked = argparse.ArgumentParser(description="Load of plantar live.")
    asked.add_argument("seconds", type=float)
    asked.add_argument("--page", action="store_true")
    asked.add_argument("--rate", type=float, default=500.0)
    options = asked.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measure(options, Path(folder))


def measure(options: Any, folder: Path) -> None:
    """Run listener, sender and browser, and print what was measured."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    recording = folder / "live.mcap"
    command = [sys.executable, "-m", "plantar", "live", f"udp:{port}", "--layout", str(LAYOUT), "--json"]
    command += ["-o", str(recording), "--seconds", str(options.seconds + 3600.0), *(["--page"] if options.page else [])]
    errors = folder / "errors.txt"
    with errors.open("w") as stream:
        live = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=stream, text=True, preexec_fn=interruptible)
    while not Path(f"/proc/{live.pid}/net/udp").read_text(encoding="utf-8").count(f":{port:04X} "):
        time.sleep(0.1)
    browser = None
    if options.page:
        while not (url := re.search(r"page: (http\S+)", errors.read_text())):
            time.sleep(0.1)
        browser = Browser(url[1], folder / "profile")
    taxels = len(json.loads(LAYOUT.read_text(encoding="utf-8"))["taxels"])
    sender = os.fork()
    if sender == 0:
        sent, faults = send(port, options.seconds, options.rate, taxels)
        (folder / "sent.json").write_text(json.dumps([sent, faults]))
        os._exit(0)
    rows = []
    latencies: list[float] = []
    begin = time.monotonic()
    while os.waitpid(sender, os.WNOHANG) == (0, 0):
        rows.append((time.monotonic() - begin, *used(live.pid)))
        if browser is not None:
            latencies += [ms for ms in browser.evaluate("latencies.splice(0)") or [] if ms < 1e9]  # 0 before a reading
        time.sleep(min(5.0, options.seconds / 10.0))
    rows.append((time.monotonic() - begin, *used(live.pid)))
    if browser is not None:
        browser.close()
    time.sleep(1.0)
    (row,) = re.findall(rf":{port:04X} .*", Path("/proc/net/udp").read_text(encoding="utf-8"))
    live.send_signal(signal.SIGINT)
    summary = json.loads(live.communicate()[0])
    sent, faults = json.loads((folder / "sent.json").read_text())
    held = read_recording(recording)
    print(f"sent {sent}, faults {faults}; {row.split()[-1]} packets that the system had no room for")
    print(f"received { ({side: one['frames'] for side, one in summary['feet'].items()}) }, counted {summary['faults']}")
    print(f"recorded { ({side: int((~np.isnan(foot.force)).any(axis=1).sum()) for side, foot in held.feet.items()}) }")
    at, spent, memory = np.array(rows).T
    late = at > 0.2 * at[-1]
    slope = np.polyfit(at[late], memory[late], 1)[0] * 600.0
    share = 100.0 * np.ptp(spent[late]) / np.ptp(at[late])
    print(f"{share:.1f} % of a core; {memory[-1]:.0f} MB, {slope:+.2f} MB in ten minutes")
    if latencies:
        found = np.percentile(latencies, (50, 95, 99, 100)).round(1).tolist()
        print(f"packet to picture, {len(latencies)} pictures: median, 95, 99 %, most: {found} ms")


if __name__ == "__main__":
    main()
