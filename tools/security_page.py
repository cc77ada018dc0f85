"""Write SECURITY.md: what is promised of files from outside, made of what `plantar.common.files.gate` declares.

python tools/security_page.py          # writes the page
python tools/security_page.py --check  # exit code 1 where it is another one
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from plantar.common.files.gate import HELPERS, PROMISES, SIZES  # noqa: E402  of this checkout

PAGE = ROOT / "SECURITY.md"
HEAD = """# Security

Plantar reads files of unknown origin: recordings, meshes, models, layouts. A file that makes it run code, write outside
of the output folder, read another file, or take memory or time without bound is a vulnerability; so is a report page
that loads or runs what is not its own.

Please report one privately, by GitHub's "Report a vulnerability" on the repository's Security page, with the file or
the way to make it. You get an answer within a week, and are named in the changelog with the fix if you like.

Fixes go into the latest release; older ones are not maintained.

Made by `python tools/security_page.py` from `plantar/common/files/gate.py`.

## What protects you, and the test that fails without it

| promise | test |
|---|---|
"""


def page() -> str:
    """The page's text."""
    promises = "".join(f"| {promise} | `{test}` |\n" for promise, test in PROMISES.items())
    sizes = "".join(f"| {kind} | {most / 1e6:g} MB |\n" for kind, most in SIZES.items())
    helpers = "".join(
        f"| {h.what} | {h.library} | {h.memory[0] / 1e6:.0f} MB{_more(h.memory[1], 'bytes')} "
        f"| {h.seconds[0]:g} s{_more(1e6 * h.seconds[1], 's a MB')} |\n"
        for h in HELPERS.values()
    )
    return (
        f"{HEAD}{promises}\n## Largest files\n\n| kind | size |\n|---|---|\n{sizes}\n"
        "Recordings and meshes have limits of their own, by their count of values and triangles.\n\n"
        "## Read in a process apart\n\n| file | by | memory | time of the processor |\n|---|---|---|---|\n"
        f"{helpers}"
    )


def _more(each: float, unit: str) -> str:
    return "" if not each else f" and {each:g} {unit}" + (" a byte" if unit == "bytes" else "")


def main() -> None:
    """Write the page, or check it."""
    if sys.argv[1:] == ["--check"]:
        if PAGE.read_text(encoding="utf-8") != page():
            sys.exit("SECURITY.md is not what tools/security_page.py writes: run it")
        return
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
