"""Open every page of the built site in Chromium, and show what a reader could not read or what would leave the machine.

    make docs && python tools/check_site.py            (options: FOLDER, --only REGEX, --axe FILE)

Each page is opened light and dark, at the width of a desk and of a telephone. Findings, one a line: of axe-core where
`sh tools/fetch-axe .venv/axe` fetched it, requests to other servers, errors of scripts, links to what is not there, and
text that makes the page wider than the window. Exit code 1 where there is one, 2 without Chromium or site. Pages
without findings are noted next to the site (FOLDER.checked.json), and opened again when they or what they share change.
"""

import argparse
import hashlib
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from itertools import chain
from pathlib import Path
from queue import Empty, Queue
from threading import Thread

ROOT = Path(__file__).resolve().parent.parent
WIDTHS = (1280, 390)
PAGE_TIMEOUT = 300.0
"""Longest time in s between the results of two pages."""

HARNESS = """<!doctype html><title>check</title><iframe id=page height=900></iframe><script>
const PAGES = %s, WIDTHS = %s, AXE = %s;
const frame = document.getElementById('page');
const answer = (of, found) => fetch('/__result', {method: 'POST', body: JSON.stringify({of, found})});
async function look(page) {
  const found = [], view = frame.contentWindow, seen = frame.contentDocument;
  if (AXE) {
    const script = seen.createElement('script');
    const ready = new Promise(done => { script.onload = done; });
    script.src = '/__axe.js';
    seen.head.append(script);
    await ready;
    const options = {resultTypes: ['violations'], selectors: false, preload: false, iframes: false};
    const result = await view.axe.run(seen, options);
    for (const rule of result.violations)
      for (const node of rule.nodes.slice(0, 3)) found.push(`axe ${rule.id}: ${node.html.slice(0, 160)}`);
  }
  for (const asked of view.performance.getEntriesByType('resource'))
    if (!asked.name.startsWith(location.origin) && !/^(data|blob):/.test(asked.name)) found.push('asks ' + asked.name);
  const wide = seen.scrollingElement.scrollWidth - view.innerWidth;
  if (wide > 0) found.push(`${wide} px wider than the window`);
  for (const image of seen.images) if (image.complete && !image.naturalWidth) found.push('no picture ' + image.src);
  return found;
}
(async () => {
  for (const width of WIDTHS) for (const page of PAGES) {
    const errors = [];
    frame.width = width;
    await new Promise(done => { frame.onload = done; frame.src = page; });
    frame.contentWindow.addEventListener('error', e => errors.push('error ' + e.message));
    await new Promise(done => setTimeout(done, 150));
    let found;
    try { found = await look(page); } catch (e) { found = ['failed ' + e]; }
    await answer(`${page} at ${width} px`, found.concat(errors));
  }
  await answer('', []);
})();
</script>"""


class Site(SimpleHTTPRequestHandler):
    """Serves the site, axe-core and the page that opens all others; takes their results."""

    def __init__(self, *arguments: object, harness: str, axe: Path, answers: Queue[dict[str, object]], **more: object):
        self.harness, self.axe, self.answers = harness, axe, answers
        super().__init__(*arguments, **more)  # type: ignore[arg-type]

    def do_GET(self) -> None:
        if self.path == "/__check":
            self.reply(self.harness.encode(), "text/html; charset=utf-8")
        elif self.path == "/__axe.js":
            self.reply(self.axe.read_bytes(), "text/javascript")
        else:
            super().do_GET()

    def do_POST(self) -> None:
        self.answers.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
        self.send_response(204)
        self.end_headers()

    def reply(self, content: bytes, kind: str) -> None:
        """Send a page that is not of the site."""
        self.send_response(200)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *arguments: object) -> None:
        pass


def pages_of(site: Path, only: str) -> list[str]:
    """Addresses of the pages that match an expression."""
    pages = ("/" + p.relative_to(site).as_posix().removesuffix("index.html") for p in sorted(site.rglob("*.html")))
    return [page for page in pages if re.search(only, page)]


def findings(site: Path, pages: list[str], axe: Path, browser: str, *, dark: bool) -> Iterator[str]:
    """What is found on pages of a folder, a finding a line, as it comes."""
    harness = HARNESS % (json.dumps(pages), json.dumps(WIDTHS), json.dumps(axe.exists()))
    answers: Queue[dict[str, object]] = Queue()
    handler = partial(Site, directory=str(site), harness=harness, axe=axe, answers=answers)
    server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
    Thread(target=server.serve_forever, daemon=True).start()
    with tempfile.TemporaryDirectory() as profile:
        command = [browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]
        command += [f"--user-data-dir={profile}", "--window-size=1400,1000", "--no-first-run", "--disable-extensions"]
        command += ["--disable-background-networking", "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1"]
        command += ["--blink-settings=preferredColorScheme=0"] if dark else []
        process = subprocess.Popen(
            [*command, f"http://127.0.0.1:{server.server_port}/__check"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            while (answer := answers.get(timeout=PAGE_TIMEOUT))["of"]:
                print(f"\r{answer['of']}\033[K", end="", file=sys.stderr, flush=True)
                findings = list(dict.fromkeys(answer["found"]))  # type: ignore[call-overload]
                yield from (f"{answer['of']}, {'dark' if dark else 'light'}: {what}" for what in findings)
        except Empty:
            yield f"no page was answered within {PAGE_TIMEOUT:g} s"
        finally:
            process.terminate()
            process.wait(timeout=20)
            server.shutdown()


def broken_links(site: Path) -> Iterator[str]:
    """Links inside of the site that lead to no page, or to no place on it."""
    texts = {page.resolve(): page.read_text(encoding="utf-8") for page in site.rglob("*.html")}
    places = {page: set(re.findall(r'\bid="([^"]+)"', text)) for page, text in texts.items()}
    for page, text in texts.items():
        for link in dict.fromkeys(re.findall(r'<a\b[^>]*?\bhref="([^"]+)"', text)):
            path, _, place = link.partition("#")
            if re.match(r"[a-z]+:", link) or not path or page.name == "404.html":
                continue
            target = (page.parent / path).resolve()
            target = target / "index.html" if target.is_dir() else target
            if not target.exists() or (place and target in places and place not in places[target]):
                yield f"/{page.relative_to(site.resolve())}: leads to {link}, which is not there"


def prints_of(site: Path, pages: list[str], axe: Path) -> dict[str, str]:
    """A fingerprint of each page: its text with what is behind all of them, styles, scripts and this check."""
    shared = sorted(p for p in site.rglob("*") if p.suffix in (".css", ".js"))
    common = hashlib.sha256(b"".join(p.read_bytes() for p in (*shared, Path(__file__), axe) if p.exists()))
    prints = {}
    for page in pages:
        whole = common.copy()
        whole.update((site / page.lstrip("/") / "index.html" if page.endswith("/") else site / page[1:]).read_bytes())
        prints[page] = whole.hexdigest()
    return prints


def main() -> int:
    """Check a site; the exit code."""
    asked = argparse.ArgumentParser(description="Open every page of the built site in Chromium.")
    asked.add_argument("site", nargs="?", type=Path, default=ROOT / "out" / "site")
    asked.add_argument("--only", default="", metavar="REGEX", help="only pages whose address matches")
    asked.add_argument("--axe", type=Path, default=ROOT / ".venv" / "axe" / "axe.min.js")
    options = asked.parse_args()
    names = ("chromium", "chromium-browser", "google-chrome", "chrome")
    browser = next((path for path in map(shutil.which, names) if path), None)
    if browser is None or not (options.site / "index.html").exists():
        print(f"no Chromium, or no site in {options.site}: make docs builds it", file=sys.stderr)
        return 2
    if not options.axe.exists():
        print("axe-core is not here: sh tools/fetch-axe .venv/axe", file=sys.stderr)
    pages = pages_of(options.site, options.only)
    prints = prints_of(options.site, pages, options.axe)
    notes = options.site.with_name(f"{options.site.name}.checked.json")
    clean = json.loads(notes.read_text()) if notes.exists() else {}
    left = [page for page in pages if clean.get(page) != prints[page]]
    seen = (findings(options.site, left, options.axe, browser, dark=dark) for dark in (False, True) if left)
    found = []
    for finding in chain(broken_links(options.site), *seen):
        print(f"\r\033[K{finding}", flush=True)
        found.append(finding)
    if not any(finding.startswith("no page") for finding in found):
        faulty = {finding.partition(" at ")[0] for finding in found}
        notes.write_text(json.dumps(clean | {page: prints[page] for page in left if page not in faulty}))
    print(f"\r\033[K{len(found) or 'nothing'} found on {len(pages)} pages, {len(left)} of them opened")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
