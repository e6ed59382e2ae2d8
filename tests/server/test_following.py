"""A drive that fifty clients follow is the same drive."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

from tests.server.asking import Served, served
from tmpud.recording import LOG

CLIENTS = 50
DRIVE = (
    sys.executable, "-c", "from tmpud.cli import main; main()", "drive", "--from", "park1e_0", "--to", "park2e_1",
    "--traffic", "5", "--seed", "3", "--json", "--out",
)  # fmt: skip


def drive(folder: Path) -> bytes:
    subprocess.run([*DRIVE, str(folder)], check=True, capture_output=True)
    return (folder / LOG).read_bytes()


def follow(server: Served, ended: threading.Event, statuses: Counter[int]) -> None:
    """Do what the pages do, but without waiting a second in between."""
    link = ""
    while not ended.is_set():
        try:
            link = link or server.link("live/run")
            paths = ["", "list", f"{link}/part", f"{link}/replay"]
        except LookupError:
            paths = [""]
        statuses.update(server.ask(path).status for path in paths)
        time.sleep(0.1)


def test_fifty_clients_change_nothing_of_a_drive(tmp_path: Path) -> None:
    alone = drive(tmp_path / "alone" / "run")
    (tmp_path / "live").mkdir()
    ended, statuses = threading.Event(), Counter[int]()
    with served(tmp_path / "live") as server:
        clients = [threading.Thread(target=follow, args=(server, ended, statuses)) for _ in range(CLIENTS)]
        for client in clients:
            client.start()
        followed = drive(tmp_path / "live" / "run")
        ended.set()
        for client in clients:
            client.join()
        assert "SUCCESS" in server.part("live/run")
    assert followed == alone
    assert set(statuses) <= {200, 404}  # no replay before the log's first block is written
    assert statuses[200] >= CLIENTS
