#!/usr/bin/env python3
"""Runs the program on mutants of small files under limits, checks the meshes, and lists what went wrong.

usage: mutate.py BINARY FOLDER... [--count N] [--first N] [--seed N] [--workers N] [--seconds S] [--megabytes M]
                 [--largest BYTES] [--against N] [--keep FOLDER]

Each mutant is a file of the folders (up to --largest bytes) with one to three changes: a number scaled, made
negative or replaced by an extreme one, two references swapped, bytes deleted, doubled or replaced. The same seed
and number make the same mutant. A run is bad where it

- ends by a signal, or with another exit code than 0, 1 or 2;
- prints a panic or an internal error;
- reaches the limit of processor time or memory;
- writes a mesh that `check` cannot read (as with a coordinate that is not finite), that is not closed and
  oriented though the report calls it closed, or that has triangles which the report does not mention;
- writes, in one of --against clean runs, a mesh that `check --against` finds further off than its tolerance.

A bad mutant is shrunk: changes without which the run is as bad are taken back. --keep keeps what remains.
"""

import argparse
import json
import os
import random
import re
import resource
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

KINDS = {".step", ".stp", ".igs", ".iges", ".iv", ".wrl", ".x3d", ".x3dv", ".obj", ".json", ".brep", ".rle", ".3dm"}
NUMBER = re.compile(rb"(?<![\w#.])[-+]?\d+\.\d*(?:[eE][-+]?\d+)?")
REFERENCE = re.compile(rb"#\d+")
EXTREMES = [b"0.", b"-1.", b"1.E10", b"-1.E10", b"1.E-12", b"1.E300", b"2147483648.", b"1.570796251297"]
CHANGES = ["scale", "sign", "extreme", "swap", "delete", "double", "byte"]

# A part of the file, given by its ends, and the bytes in its place.
Edit = tuple[int, int, bytes]


@lru_cache(maxsize=64)
def parts_of(path: Path) -> tuple[bytes, list[tuple[int, int]], list[tuple[int, int]]]:
    """The bytes of a file, and where its numbers and references are."""
    text = path.read_bytes()
    spans = [[match.span() for match in pattern.finditer(text)] for pattern in (NUMBER, REFERENCE)]
    return text, *spans


def change(path: Path, rng: random.Random) -> list[Edit]:
    """One change."""
    text, numbers, references = parts_of(path)
    kind = rng.choice(CHANGES)
    if kind in ("scale", "sign", "extreme") and numbers:
        start, end = rng.choice(numbers)
        if kind == "extreme":
            return [(start, end, rng.choice(EXTREMES))]
        factor = -1.0 if kind == "sign" else 10.0 ** rng.uniform(-8, 8)
        return [(start, end, repr(float(text[start:end]) * factor).encode())]
    if kind == "swap" and len(references) > 1:
        a, b = sorted(rng.sample(references, 2))
        return [(*a, text[slice(*b)]), (*b, text[slice(*a)])]
    start = rng.randrange(len(text))
    end = min(len(text), start + rng.choice([1, 4, 64]))
    if kind == "byte":
        return [(start, start + 1, bytes([rng.randrange(256)]))]
    return [(start, end, text[start:end] * 2 if kind == "double" else b"")]


def mutant(text: bytes, changes: list[list[Edit]]) -> bytes:
    """The file with these changes; of edits that overlap, the first one counts."""
    end_of_last = len(text)
    for start, end, new in sorted((edit for edits in changes for edit in edits), reverse=True):
        if end <= end_of_last:
            text = text[:start] + new + text[end:]
            end_of_last = start
    return text


@dataclass
class Trial:
    """How mutants are run."""

    binary: str
    seconds: int
    megabytes: int

    def limits(self) -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (self.seconds, self.seconds + 2))
        resource.setrlimit(resource.RLIMIT_AS, (self.megabytes << 20, self.megabytes << 20))

    def call(self, *arguments: str) -> subprocess.CompletedProcess:
        return subprocess.run(
            [self.binary, *arguments], capture_output=True, preexec_fn=self.limits, check=False
        )

    def fault(self, path: Path, against: bool) -> str:
        """What is wrong with the run on a mutant; empty for nothing."""
        output = path.with_suffix(".ply")
        report = path.with_suffix(".report")
        arguments = ["mesh", str(path), "-o", str(output), "--jobs", "1", "--report", str(report), "-q"]
        try:
            return fault_of_run(self, self.call(*arguments)) or self.fault_of_mesh(path, output, report, against)
        finally:
            output.unlink(missing_ok=True)
            report.unlink(missing_ok=True)

    def fault_of_mesh(self, path: Path, output: Path, report: Path, against: bool) -> str:
        if not output.exists():
            return "" if not report.exists() else "a report without a mesh"
        claimed = json.loads(report.read_text())
        if claimed["triangles"] == 0:
            return ""
        checked = self.call("check", str(output), "--json")
        fault = fault_of_run(self, checked)
        if fault or checked.returncode == 2:
            return f"check: {fault or checked.stderr.decode(errors='replace').strip()}"
        found = json.loads(checked.stdout)
        if claimed["closedness"] == "closed" and not (found["closed"] and found["oriented"]):
            return "check: called closed and is not"
        for kind in ("degenerate_triangles", "duplicate_triangles"):
            if found[kind] > 0 and claimed["clean"]:
                return f"check: {kind} in a clean mesh"
        if not (against and claimed["clean"]):
            return ""
        # No --tolerance: the exit code is about closedness then, the distances are compared here.
        measured = self.call("check", str(output), "--json", "--against", str(path))
        fault = fault_of_run(self, measured)
        if fault or not measured.stdout:
            return f"check --against: {fault or measured.stderr.decode(errors='replace').strip()}"
        distances = json.loads(measured.stdout)["against"]
        worst = max(distances["mesh_to_model_beyond_gap"], distances["model_to_mesh_beyond_gap"])
        allowed = 1.001 * claimed["options"]["tolerance"] + distances["reference_error"]
        return f"check --against: {worst / claimed['options']['tolerance']:.2f} x the tolerance" if worst > allowed else ""


def fault_of_run(trial: Trial, done: subprocess.CompletedProcess) -> str:
    talk = done.stderr.decode(errors="replace")
    if done.returncode in (-24, -9):
        return f"over {trial.seconds} s"
    if "memory allocation" in talk:
        return f"over {trial.megabytes} MB"
    if "panicked" in talk or "internal error" in talk:
        return "panic: " + next(line for line in talk.splitlines() if "panicked" in line or "internal error" in line)
    if done.returncode not in (0, 1, 2):
        return f"ended by {done.returncode}"
    return ""


def kind_of(fault: str) -> str:
    """A fault without what differs from file to file."""
    return re.sub(r"\d+\.\d+ x|/\S+|#\d+", "_", fault)[:60]


class Campaign:
    def __init__(self, arguments: argparse.Namespace, scratch: Path) -> None:
        self.arguments = arguments
        self.scratch = scratch
        self.trial = Trial(arguments.binary, arguments.seconds, arguments.megabytes)
        self.files = sorted(
            path
            for folder in arguments.folders
            for path in folder.rglob("*")
            if path.suffix.lower() in KINDS and 0 < path.stat().st_size <= arguments.largest
        )

    def run(self, number: int) -> str:
        """The line about one mutant; empty where all is well."""
        rng = random.Random(self.arguments.seed * 1_000_003 + number)
        source = rng.choice(self.files)
        changes = [change(source, rng) for _ in range(rng.randint(1, 3))]
        against = self.arguments.against > 0 and number % self.arguments.against == 0
        fault = self.try_changes(source, number, changes, against)
        if not fault:
            return ""
        for i in reversed(range(len(changes))):
            fewer = changes[:i] + changes[i + 1:]
            if kind_of(self.try_changes(source, number, fewer, against)) == kind_of(fault):
                changes = fewer
        if self.arguments.keep:
            text = parts_of(source)[0]
            self.arguments.keep.mkdir(parents=True, exist_ok=True)
            (self.arguments.keep / f"{number:06}{source.suffix}").write_bytes(mutant(text, changes))
        places = [(edit[0], edit[2].decode(errors="replace")[:40]) for edits in changes for edit in edits]
        return f"{number:06}\t{source}\t{fault}\t{places}"

    def try_changes(self, source: Path, number: int, changes: list[list[Edit]], against: bool) -> str:
        path = self.scratch / f"{number:06}{source.suffix}"
        path.write_bytes(mutant(parts_of(source)[0], changes))
        try:
            return self.trial.fault(path, against)
        finally:
            path.unlink()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=int, default=10)
    parser.add_argument("--megabytes", type=int, default=2000)
    parser.add_argument("--largest", type=int, default=100_000)
    parser.add_argument("--against", type=int, default=10, help="measure one of so many clean meshes; 0 for none")
    parser.add_argument("--keep", type=Path, help="folder for mutants with a bad run")
    arguments = parser.parse_args()
    bad = done = 0
    with tempfile.TemporaryDirectory() as scratch, ThreadPoolExecutor(arguments.workers) as pool:
        campaign = Campaign(arguments, Path(scratch))
        for line in pool.map(campaign.run, range(arguments.first, arguments.first + arguments.count)):
            done += 1
            if line:
                bad += 1
                print(line, flush=True)
            if done % 1000 == 0:
                print(f"# {done} mutants, {bad} bad", flush=True)
    print(f"{bad} of {done} bad, {len(campaign.files)} files to mutate")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
