"""The command: it says one address, answers there, and ends when it is asked to."""

from __future__ import annotations

import signal
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import chain
from pathlib import Path

from tests.viewer.made_runs import events, frame, header, recorded

COMMAND = (sys.executable, "-c", "from tmpud.cli import main; main()", "view")


@contextmanager
def viewing(folder: Path, *words: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Yield the running command and the address that it says."""
    pipe = subprocess.PIPE
    with subprocess.Popen([*COMMAND, *words], cwd=folder, stdout=pipe, stderr=pipe, text=True) as process:
        assert process.stdout is not None
        try:
            yield process, process.stdout.readline().strip()
        finally:
            process.kill()


def read(url: str) -> str:
    with urllib.request.urlopen(url, timeout=60) as page:  # noqa: S310 - the address that was said
        return str(page.read().decode())


def test_it_says_one_address_shows_runs_and_results_and_ends_on_ctrl_c(tmp_path: Path) -> None:
    recorded(tmp_path / "runs" / "one", [header()])
    recorded(tmp_path / "elsewhere" / "two", [header()])
    with viewing(tmp_path) as (process, url):
        page = read(url)
        assert "runs/one" in page
        assert "two" not in page
        with socket.create_connection(("127.0.0.1", int(url.split(":")[2].partition("/")[0]))):  # is kept open
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=30)
        assert (process.returncode, out, err) == (0, "", "")


def test_ctrl_c_ends_a_replay_that_is_being_made(tmp_path: Path) -> None:
    recorded(tmp_path / "one", chain(events(), (frame(number) for number in range(40, 20_000))))  # takes long to show
    with viewing(tmp_path, "one") as (process, url):
        host, _, rest = url.removeprefix("http://").partition("/")
        link = read(url).partition('<a href="')[2].partition('"')[0]
        with socket.create_connection(("127.0.0.1", int(host.partition(":")[2]))) as asking:
            asking.sendall(f"GET /{rest}{link}/replay HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
            read(url)  # what came later was answered, so the other is under way
            process.send_signal(signal.SIGINT)
            _, err = process.communicate(timeout=30)
        assert process.returncode == 0
        assert "Traceback" not in err


def test_a_port_that_is_taken_and_a_folder_that_is_not_there_are_one_line(tmp_path: Path) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        taken = str(other.getsockname()[1])
        for words, said in ((("--port", taken), taken), (("nowhere",), "nowhere"), (("--port", "70000"), "70000")):
            done = subprocess.run([*COMMAND, *words], cwd=tmp_path, capture_output=True, text=True, check=False)
            assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
            assert said in done.stderr
