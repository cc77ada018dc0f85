"""Write a bill of materials (CycloneDX 1.5, JSON) of Plantar and all that constraints.txt pins.

python tools/sbom.py FILE
"""

import json
import re
import sys
from pathlib import Path

from licences import declared, licence

ROOT = Path(__file__).resolve().parent.parent


def bill() -> dict[str, object]:
    """The bill: each library with its version, licence and package URL."""
    version = re.search(
        r'VERSION = "([^"]+)"', (ROOT / "plantar" / "common" / "version.py").read_text(encoding="utf-8")
    )
    assert version is not None
    pinned = re.findall(r"^([\w.-]+)==(\S+)$", (ROOT / "constraints.txt").read_text(encoding="utf-8"), re.MULTILINE)
    direct = {name.lower(): extras for name, extras in declared().items()}
    components = [
        {
            "type": "library",
            "bom-ref": f"pkg:pypi/{name.lower()}@{number}",
            "name": name,
            "version": number,
            "purl": f"pkg:pypi/{name.lower()}@{number}",
            "licenses": [{"license": {"name": licence(name)}}],
            "scope": "required" if "" in direct.get(name.lower(), ()) else "optional",
        }
        for name, number in pinned
    ]
    three = {"type": "library", "name": "three", "version": "0.170.0", "purl": "pkg:npm/three@0.170.0"}
    components.append(
        {**three, "bom-ref": three["purl"], "licenses": [{"license": {"name": "MIT"}}], "scope": "required"}
    )
    own = {"type": "library", "name": "plantar", "version": version[1], "licenses": [{"license": {"id": "Apache-2.0"}}]}
    head = {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1}
    return {**head, "metadata": {"component": own}, "components": components}


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(json.dumps(bill(), indent=1) + "\n", encoding="utf-8")
