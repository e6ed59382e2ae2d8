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
from tmpud.server.index import KEPT

CLIENTS = 50
DRIVE = (
    sys.executable, "-c", "from tmpud.cli import main; main()", "drive", "--from", "park1e_0", "--to", "high4n",
    "--traffic", "5", "--seed", "3", "--json", "--out",
)  # fmt: skip


def drive(folder: Path) -> bytes:
    subprocess.run([*DRIVE, str(folder)], check=True, capture_output=True)
    return (folder / LOG).read_bytes()


def follow(server: Served, ended: threading.Event, statuses: Counter[int], links: list[str]) -> None:
    """Do what the pages do, but without waiting a second in between; note where the drive was found under way."""
    link = ""
    while not ended.is_set():
        try:
            if not link:
                links.append(link := server.link("live/run"))
            paths = ["", "list", f"{link}/part", f"{link}/replay"]
        except LookupError:
            paths = [""]
        statuses.update(server.ask(path).status for path in paths)
        time.sleep(0.1)


def test_fifty_clients_change_nothing_of_a_drive(tmp_path: Path) -> None:
    alone = drive(tmp_path / "alone" / "run")
    (tmp_path / "live").mkdir()
    ended, statuses, links = threading.Event(), Counter[int](), list[str]()
    with served(tmp_path / "live") as server:
        clients = [threading.Thread(target=follow, args=(server, ended, statuses, links)) for _ in range(CLIENTS)]
        for client in clients:
            client.start()
        followed, under_way = drive(tmp_path / "live" / "run"), len(links)
        ended.set()
        for client in clients:
            client.join()
        time.sleep(KEPT)  # until the list is made anew
        assert "SUCCESS" in server.part("live/run")
    assert followed == alone
    assert under_way > 0
    assert set(statuses) <= {200, 404}  # no replay before the log's first block is written
    assert statuses[200] >= CLIENTS
