"""A drive that is being followed in ``tmpud view``, against the same drive alone.

    python -m benchmarks view --clients 50 --rounds 5

Each round drives one mission twice, in turns first alone and first followed. It is followed by clients that do what
the pages do: they ask for the list each second until the run is in it, open the run's page and its replay, and then
ask each second for what is new. They are threads of this process, so that they cost less than browsers would; the
server is a process of its own. Both drives must write the same log, byte for byte, and every client be answered.
Two tables: the wall clock's time, and the CPU's, which the drive's process alone spent.
"""

from __future__ import annotations

import argparse
import http.client
import os
import re
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urlsplit

from benchmarks.harness import DisagreementError, Result, progress
from tmpud.recording import LOG

FIRST_SEED = 500
ALONE, RUN = "alone", "run"
TMPUD = str(Path(sys.executable).with_name("tmpud"))


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--clients", type=int, default=50)
    parser.add_argument("--rounds", type=int, default=5, help="missions, each with its own seed")
    parser.add_argument("--traffic", type=int, default=200, help="vehicles")
    parser.add_argument("--start", default="park1e_0")
    parser.add_argument("--goal", default="high4n")


def measure(asked: argparse.Namespace) -> list[Result]:
    followed = f"followed by {asked.clients}"
    rows: dict[str, list[tuple[float, float]]] = {ALONE: [], followed: []}
    answers: list[int] = []
    for seed in range(FIRST_SEED, FIRST_SEED + asked.rounds):
        progress(f"mission {seed}, {asked.traffic} vehicles, {asked.clients} clients")
        logs = set()
        for name in (ALONE, followed) if seed % 2 else (followed, ALONE):
            with tempfile.TemporaryDirectory() as folder:
                if name == ALONE:
                    spent, log = _drive(Path(folder), seed, asked)
                else:
                    with _followers(Path(folder), asked.clients) as counted:
                        spent, log = _drive(Path(folder), seed, asked)
                    answers.append(counted.total())
            rows[name].append(spent)
            logs.add(log)
        if len(logs) > 1:
            raise DisagreementError(f"the drive of seed {seed} is another one when it is followed")
    title = f"a drive among {asked.traffic} vehicles"
    clocks = enumerate(("wall clock", "CPU time of the drive's process"))
    return [
        Result(title, ALONE, {n: [r[i] for r in row] for n, row in rows.items()}, clock=c, facts={"answers": answers})
        for i, c in clocks
    ]


def _drive(folder: Path, seed: int, asked: argparse.Namespace) -> tuple[tuple[float, float], bytes]:
    """Return the time by the wall clock and on the CPU [s], and the log."""
    mission = ["--from", asked.start, "--to", asked.goal, "--traffic", str(asked.traffic), "--seed", str(seed)]
    began = time.perf_counter()
    command = [TMPUD, "drive", *mission, "--json", "--out", str(folder / RUN)]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    elapsed = time.perf_counter() - began
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1):  # 1: it did not arrive, which is a drive as well
        raise DisagreementError(f"{' '.join(command)} ended with exit code {process.returncode}")
    return (elapsed, usage.ru_utime + usage.ru_stime), (folder / RUN / LOG).read_bytes()


@contextmanager
def _followers(folder: Path, clients: int) -> Iterator[Counter[int]]:
    """Serve a folder and follow the run in it; yield how often each status was answered."""
    answered: Counter[int] = Counter()
    ended = threading.Event()
    with subprocess.Popen([TMPUD, "view", str(folder)], stdout=subprocess.PIPE, text=True) as server:
        try:
            url = server.stdout.readline().strip() if server.stdout else ""
            threads = [threading.Thread(target=_follow, args=(url, ended, answered)) for _ in range(clients)]
            for thread in threads:
                thread.start()
            yield answered
            ended.set()
            for thread in threads:
                thread.join()
        finally:
            ended.set()
            server.terminate()
    if set(answered) - {200, 204, 404} or answered[200] < clients:  # 404: no replay before there is a header
        raise DisagreementError(f"clients were answered {dict(answered)}")


def _follow(url: str, ended: threading.Event, answered: Counter[int]) -> None:
    link, seen = "", ""
    while not ended.wait(1.0):
        if not link:
            if found := re.search(r'href="(runs/\w+)"', _ask(url, "list", answered)[0]):
                link = found[1]
                _ask(url, link, answered)
                _ask(url, f"{link}/replay", answered)
            continue
        seen = _ask(url, f"{link}/part?seen={seen}", answered)[1] or seen


def _ask(url: str, path: str, answered: Counter[int]) -> tuple[str, str]:
    """Return the text of an answer, and what to name as seen the next time."""
    place = urlsplit(url)
    connection = http.client.HTTPConnection(place.netloc, timeout=600)
    connection.request("GET", place.path + path)
    answer = connection.getresponse()
    text = answer.read().decode()
    connection.close()
    answered[answer.status] += 1
    return text, answer.headers.get("X-Seen", "")
