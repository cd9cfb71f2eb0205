"""The files of a sweep: from a list of public files, or from a folder."""

from __future__ import annotations

import csv
import hashlib
import subprocess
from dataclasses import dataclass
from pathlib import Path

SUFFIXES = {".step", ".stp", ".p21", ".igs", ".iges", ".stpz"}


@dataclass(frozen=True)
class Entry:
    """`repository` is empty for a file of a folder; `path` is then the path of the file."""

    repository: str
    commit: str
    path: str
    sha256: str
    exporter: str

    @property
    def name(self) -> str:
        return f"{self.repository}/{self.path}" if self.repository else self.path


def listed(path: Path) -> list[Entry]:
    """The lines of a list with the columns repository, commit, path, sha256, exporter."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = csv.DictReader(file, delimiter="\t", quoting=csv.QUOTE_NONE)
        return [Entry(r["repository"], r["commit"], r["path"], r["sha256"], r["exporter"]) for r in rows]


def searched(folder: Path) -> list[Entry]:
    paths = sorted(p for p in folder.rglob("*") if p.suffix.lower() in SUFFIXES and p.is_file())
    return [Entry("", "", str(p), hashlib.sha256(p.read_bytes()).hexdigest(), "") for p in paths]


def materialise(entry: Entry, clones: Path | None, fetch: bool, folder: Path) -> Path:
    """The file on disk, under a name of its sha256. Raises ValueError where it cannot be had."""
    if not entry.repository:
        return Path(entry.path)
    path = folder / (entry.sha256[:16] + Path(entry.path).suffix.lower())
    if not path.exists():
        if clones is None:
            raise ValueError("a list needs --clones")
        content = blob(repository(entry, clones, fetch), entry)
        if hashlib.sha256(content).hexdigest() != entry.sha256:
            raise ValueError("the sha256 differs from the list")
        folder.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return path


def repository(entry: Entry, clones: Path, fetch: bool) -> Path:
    """The git folder of the entry's repository, with its commit."""
    folder = clones / entry.repository.replace("/", "+", 1)
    inside = [p for p in (folder / "repo" / ".git", folder / "repo", folder / ".git", folder) if (p / "HEAD").exists()]
    git_folder = inside[0] if inside else folder
    if git(git_folder, "cat-file", "-e", entry.commit).returncode == 0:
        return git_folder
    if not fetch:
        raise ValueError(f"{folder} lacks the commit {entry.commit}; --fetch fetches it")
    if not inside:
        folder.mkdir(parents=True, exist_ok=True)
        git(folder, "init", "--bare", "--quiet", str(folder))
    address = f"https://github.com/{entry.repository}.git"
    done = git(git_folder, "fetch", "--quiet", "--depth", "1", address, entry.commit)
    if done.returncode != 0:
        raise ValueError(f"git fetch: {done.stderr.decode(errors='replace').strip()}")
    return git_folder


def blob(git_folder: Path, entry: Entry) -> bytes:
    done = git(git_folder, "cat-file", "blob", f"{entry.commit}:{entry.path}")
    if done.returncode != 0:
        raise ValueError(f"no such file in the commit {entry.commit}")
    return done.stdout


def git(git_folder: Path, *arguments: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run(["git", "--git-dir", str(git_folder), *arguments], capture_output=True)
