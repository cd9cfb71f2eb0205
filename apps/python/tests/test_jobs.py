"""Progress, cancelling, signals, threads, processes, memory."""

from __future__ import annotations

import concurrent.futures
import hashlib
import multiprocessing
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

import chordal
from conftest import CORPUS


def digest(name: str) -> str:
    return hashlib.sha256(chordal.mesh(CORPUS / name).to_bytes("ply")).hexdigest()


def test_progress_is_told_in_the_calling_thread(bracket: chordal.Model) -> None:
    told: list[tuple[str, float]] = []
    threads = set()

    def progress(phase: str, fraction: float) -> None:
        threads.add(threading.get_ident())
        told.append((phase, fraction))

    bracket.mesh(progress=progress)
    phases = list(dict.fromkeys(phase for phase, _ in told))
    assert phases == ["sewing", "measuring", "meshing", "auditing"]
    meshing = [fraction for phase, fraction in told if phase == "meshing"]
    assert meshing == sorted(meshing) and meshing[0] == 0 and meshing[-1] == 1
    assert threads == {threading.get_ident()}


def test_false_cancels(bracket: chordal.Model) -> None:
    with pytest.raises(chordal.Cancelled) as caught:
        bracket.mesh(progress=lambda phase, fraction: phase != "meshing")
    assert "cancelled" in str(caught.value)
    with pytest.raises(chordal.Cancelled):
        chordal.read(CORPUS / "bracket.step", progress=lambda phase, fraction: False)
    assert bracket.mesh().clean, "later calls are not cancelled"


def test_what_the_callback_raises_arrives(bracket: chordal.Model) -> None:
    def progress(phase: str, fraction: float) -> bool:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        bracket.mesh(progress=progress)


def test_cancelling_takes_less_than_200_milliseconds() -> None:
    model = chordal.read(CORPUS / "blade.step")
    asked: list[float] = []

    def progress(phase: str, fraction: float) -> bool:
        if phase == "meshing":
            asked.append(time.perf_counter())
            return False
        return True

    with pytest.raises(chordal.Cancelled):
        model.mesh("0.00001%", progress=progress)
    assert time.perf_counter() - asked[0] < 0.2


@pytest.mark.skipif(sys.platform == "win32", reason="signals of this kind are those of Unix")
def test_ctrl_c_stops_a_long_mesh() -> None:
    # A shell lets the processes that it starts in the background ignore the signal.
    program = (
        "import chordal, signal, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        f"model = chordal.read({str(CORPUS / 'blade.step')!r})\n"
        "print('ready', flush=True)\n"
        "try:\n"
        "    model.mesh('0.0000001%', face_timeout=0, file_timeout=0, memory=0)\n"
        "except KeyboardInterrupt:\n"
        "    print('stopped', flush=True)\n"
        "    import os; os._exit(7)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    asked = time.perf_counter()
    assert process.stdout.readline() == "stopped\n"
    assert time.perf_counter() - asked < 0.5
    assert process.wait(timeout=20) == 7


def test_other_threads_run_meanwhile() -> None:
    model = chordal.read(CORPUS / "blade.step")
    counted = [0]
    done = threading.Event()

    def count() -> None:
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    model.mesh("0.01%")
    after = counted[0]
    done.set()
    thread.join()
    assert after > before


def test_eight_threads_make_the_same_bytes() -> None:
    names = ["bracket.step", "fillets.step", "mapped_items.step", "gear.step"]
    alone = [digest(name) for name in names]
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        assert list(pool.map(digest, names * 8)) == alone * 8


def test_any_number_of_threads_makes_the_same_bytes(bracket: chordal.Model) -> None:
    assert len({bracket.mesh(threads=threads).to_bytes("ply") for threads in (None, 1, 2, 5)}) == 1


METHODS = [method for method in ("fork", "spawn") if method in multiprocessing.get_all_start_methods()]


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_pools_of_processes(method: str) -> None:
    here = digest("bracket.step")
    with multiprocessing.get_context(method).Pool(2) as pool:
        found = pool.map_async(digest, ["bracket.step"] * 4).get(timeout=120)
    assert found == [here] * 4


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the memory from /proc")
def test_memory_stays_flat_over_a_thousand_meshes() -> None:
    def resident() -> int:
        fields = Path("/proc/self/statm").read_text().split()
        return int(fields[1]) * resource.getpagesize()

    content = (CORPUS / "mapped_items.step").read_bytes()

    def run(times: int) -> None:
        for _ in range(times):
            mesh = chordal.mesh(content, threads=None)
            assert len(mesh.normals) and len(mesh.edges) and mesh.report and mesh.to_bytes("stl")

    run(100)
    before = resident()
    run(1000)
    assert resident() - before < 8_000_000


def test_the_command_line(tmp_path: Path) -> None:
    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "chordal", *arguments]
        return subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)

    shown = run("--version")
    assert shown.returncode == 0 and shown.stdout.split() == ["chordal", chordal.__version__]
    made = run("mesh", str(CORPUS / "bracket.step"), "-o", "out.stl")
    assert made.returncode == 0 and (tmp_path / "out.stl").stat().st_size > 1000, made.stderr
    assert run("mesh", "none.step").returncode == 2
    assert os.listdir(tmp_path) == ["out.stl"]
