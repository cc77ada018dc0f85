"""A headless Chromium for tests of pages: opens a page with a probe in it and gives back what the probe found."""

import json
import os
import re
import shutil
import subprocess
import time
from contextlib import suppress
from dataclasses import dataclass
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from queue import Empty, Queue
from threading import Thread
from typing import Any

import pytest

from plantar.common.pages.page import with_policy

AXE = Path(os.environ.get("PLANTAR_AXE") or Path(__file__).parents[3] / ".venv" / "axe" / "axe.min.js")
"""Where axe-core is; `sh tools/fetch-axe .venv/axe` fetches it."""

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")


@dataclass(frozen=True)
class Visit:
    """What a visit to a page gave.

    Attributes:
        found: What the probe gave back.
        console: Errors and warnings on the browser's console.
        seconds: How long the browser ran.
    """

    found: Any
    console: list[str]
    seconds: float


_LOOKS = 5.0  # s between looks into the browser's log


def browser() -> str:
    """The browser's command; the test is skipped, with the reason, where there is none."""
    for name in BROWSERS:
        path = shutil.which(name)
        if path:
            return path
    pytest.skip("no Chromium on this machine: the page is not opened (Debian: apt-get install chromium)")


def axe_script() -> str:
    """axe-core as an element of a page; empty where it is not on this machine."""
    if not AXE.exists():
        return ""
    return "<script>" + AXE.read_text(encoding="utf-8").replace("</script", "<\\/script") + "</script>"


def visit(page, probe, work, *, dark=False, timeout=600.0, width=1000, webgl=False):
    """Open a copy of a page that runs a probe at its end, and take what the probe sends back.

    The page comes from a server on this machine, so that the browser runs in real time and ends when the probe has.
    """
    script = (
        "<script>window.problems = [];"
        "window.addEventListener('error', e => problems.push(String(e.message)));"
        "window.addEventListener('unhandledrejection', e => problems.push(String(e.reason)));</script>"
    )
    end = (
        "<script>(async () => { let found; try { found = await (async () => {"
        + probe
        + "})(); } catch (e) { found = {failed: String(e && e.stack || e)}; }"
        "await fetch('/result', {method: 'POST', body: JSON.stringify({found: found, problems: problems})}); })();"
        "</script>"
    )
    text = page.read_text(encoding="utf-8").replace("<head>", "<head>" + script, 1)
    text = text.replace("</body>", (axe_script() if "axe" in probe else "") + end + "</body>", 1)
    text = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", text, count=1)
    content = with_policy(text).replace("connect-src 'none'", "connect-src 'self'", 1).encode()  # for the answer
    answers: Queue[dict[str, Any]] = Queue()

    class Server(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers["Content-Length"]))
            self.send_response(204)
            self.end_headers()
            answers.put(json.loads(body))

        def log_message(self, format: str, *arguments: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), Server)
    Thread(target=server.serve_forever, daemon=True).start()
    command = [browser(), "--headless=new", "--no-sandbox", "--disable-dev-shm-usage"]
    command += ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"] if webgl else ["--disable-gpu"]
    command += [f"--user-data-dir={work / 'profile'}", "--enable-logging=stderr", f"--window-size={width},1400"]
    command += ["--no-first-run", "--disable-extensions", "--disable-background-networking"]
    command += ["--blink-settings=preferredColorScheme=0"] if dark else []
    log = work / "browser.log"
    command += [f"http://127.0.0.1:{server.server_port}/"]
    begin = time.perf_counter()
    try:
        answer = _answer(command, answers, log, timeout)
    finally:
        server.shutdown()
        server.server_close()
    seconds = time.perf_counter() - begin
    assert not (isinstance(answer["found"], dict) and "failed" in answer["found"]), answer["found"]
    console = re.findall(r":CONSOLE[^\n]*", log.read_text(errors="replace")) + list(answer["problems"])
    return Visit(answer["found"], console, seconds)


def _answer(command: list[str], answers: "Queue[dict[str, Any]]", log: Path, timeout: float) -> dict[str, Any]:
    """What the page sends; a browser whose own processes did not find each other is started once more.

    Beside other work a part of it that waits 15 s for its first message ends, and the rest then waits for ever.
    """
    for attempt in range(2):
        with log.open("wb") as stream:
            process = subprocess.Popen(command, stdout=stream, stderr=stream)
        try:
            for _ in range(int(timeout / _LOOKS)):
                with suppress(Empty):
                    return answers.get(timeout=_LOOKS)
                if not attempt and "with no connection" in log.read_text(errors="replace"):
                    break
        finally:
            process.terminate()
            process.wait(timeout=600)
    pytest.fail(f"the page gave no result in {timeout} s: {log.read_text(errors='replace')[-1500:]}")
