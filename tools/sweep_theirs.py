"""The exact properties of a file by OpenCASCADE, kept by the file's sha256."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from pathlib import Path

SERVER = [sys.executable, str(Path(__file__).parent / "sweep_occ.py"), "--serve"]
# Every thread has a server of its own.
_local = threading.local()


def run_theirs(model: Path, sha256: str, limit: float, folder: Path) -> dict:
    """What `sweep_occ.py` found: see there. `ended`: "" or how it ended before everything was known."""
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / f"{sha256[:16]}.json"
    if kept.exists():
        return json.loads(kept.read_text(encoding="utf-8"))
    lines = folder / f"{sha256[:16]}.lines"
    found: dict = {"ended": request({"path": str(model), "out": str(lines), "limit": limit})}
    for line in lines.read_text(encoding="utf-8", errors="replace").splitlines():
        if line.startswith("{"):
            found |= json.loads(line)
    kept.write_text(json.dumps(found) + "\n", encoding="utf-8")
    lines.unlink()
    return found


def request(what: dict) -> str:
    server = getattr(_local, "server", None)
    if server is None or server.poll() is not None:
        server = _local.server = subprocess.Popen(SERVER, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    server.stdin.write(json.dumps(what) + "\n")
    server.stdin.flush()
    return json.loads(server.stdout.readline())["ended"]
