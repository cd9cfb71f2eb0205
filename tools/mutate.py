#!/usr/bin/env python3
"""Runs the program on mutants of small files under limits, and lists panics, timeouts and memory.

usage: mutate.py BINARY FOLDER... [--count N] [--seed N] [--seconds S] [--megabytes M] [--keep FOLDER]

Each mutant is a file of the folders (under --largest bytes) with one to three changes: a number scaled, made negative or
replaced by an extreme one, two references swapped, bytes deleted or doubled. The same seed makes the same mutants. A run
is bad where it ends by a signal, prints a panic or an internal error, or reaches the limit of processor time or memory.
"""

import argparse
import random
import re
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

KINDS = {".step", ".stp", ".igs", ".iges", ".iv", ".wrl", ".x3d", ".x3dv", ".obj", ".json", ".brep", ".3dm"}
NUMBER = re.compile(rb"(?<![\w#.])[-+]?\d+\.\d*(?:[eE][-+]?\d+)?")
REFERENCE = re.compile(rb"#\d+")
EXTREMES = [b"0.", b"-1.", b"1.E10", b"-1.E10", b"1.E-12", b"1.E300", b"2147483648.", b"1.570796251297"]


def changed(text: bytes, rng: random.Random) -> bytes:
    """One change."""
    numbers = list(NUMBER.finditer(text))
    references = list(REFERENCE.finditer(text))
    kind = rng.choice(["scale", "sign", "extreme", "swap", "delete", "double"])
    if kind in ("scale", "sign", "extreme") and numbers:
        found = rng.choice(numbers)
        if kind == "extreme":
            new = rng.choice(EXTREMES)
        else:
            factor = -1.0 if kind == "sign" else 10.0 ** rng.uniform(-8, 8)
            new = repr(float(found.group()) * factor).encode()
        return text[: found.start()] + new + text[found.end():]
    if kind == "swap" and len(references) > 1:
        a, b = sorted(rng.sample(references, 2), key=lambda m: m.start())
        return text[: a.start()] + b.group() + text[a.end(): b.start()] + a.group() + text[b.end():]
    start = rng.randrange(len(text))
    length = rng.choice([1, 4, 64])
    cut = text[start: start + length]
    return text[:start] + (cut + cut if kind == "double" else b"") + text[start + length:]


def run(binary: str, path: Path, output: Path, seconds: int, megabytes: int) -> str:
    """What is wrong with the run; empty for nothing."""
    def limits() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 2))
        resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))

    command = [binary, "mesh", str(path), "-o", str(output), "--jobs", "1"]
    done = subprocess.run(command, capture_output=True, preexec_fn=limits, check=False)
    talk = done.stderr.decode(errors="replace")
    if done.returncode == -24:
        return f"over {seconds} s"
    if "memory allocation" in talk:
        return f"over {megabytes} MB"
    if done.returncode < 0 or done.returncode > 2:
        return f"ended by {done.returncode}"
    if "panicked" in talk or "internal error" in talk:
        return "panic: " + next(line for line in talk.splitlines() if "panicked" in line or "internal error" in line)
    return ""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=int, default=10)
    parser.add_argument("--megabytes", type=int, default=2000)
    parser.add_argument("--largest", type=int, default=100_000)
    parser.add_argument("--keep", type=Path, help="folder for mutants with a bad run")
    args = parser.parse_args()
    files = sorted(
        path
        for folder in args.folders
        for path in folder.rglob("*")
        if path.suffix.lower() in KINDS and 0 < path.stat().st_size <= args.largest
    )
    bad = 0
    with tempfile.TemporaryDirectory() as scratch:
        for number in range(args.count):
            rng = random.Random(args.seed * 1_000_003 + number)
            source = rng.choice(files)
            text = source.read_bytes()
            for _ in range(rng.randint(1, 3)):
                text = changed(text, rng) or text
            path = Path(scratch) / f"mutant_{args.seed}_{number}{source.suffix}"
            path.write_bytes(text)
            fault = run(args.binary, path, Path(scratch) / "out.ply", args.seconds, args.megabytes)
            if fault:
                bad += 1
                print(f"{path.name}\t{source}\t{fault}", flush=True)
                if args.keep:
                    args.keep.mkdir(parents=True, exist_ok=True)
                    (args.keep / path.name).write_bytes(text)
            path.unlink()
    print(f"{bad} of {args.count} bad, {len(files)} files to mutate")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
