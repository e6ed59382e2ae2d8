import json
import socket
from collections.abc import Iterator

import pytest
from typer.testing import CliRunner

from tmpud import doctor
from tmpud.cli import app
from tmpud.doctor import Finding, State, examine

OLD, NEW = "0.9.15", "0.9.16"


@pytest.fixture
def port() -> Iterator[int]:
    """Give a port on which somebody listens."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server.getsockname()[1]


def found(**server: str | int) -> dict[str, Finding]:
    return {finding.what: finding for finding in examine("carla", **server)}  # type: ignore[arg-type]


def with_client(monkeypatch: pytest.MonkeyPatch, code: str) -> None:
    monkeypatch.setattr(doctor, "_version", lambda package: NEW if package == "carla" else None)
    monkeypatch.setattr(doctor, "SERVER", code)


def test_where_the_tests_run_a_drive_would_too() -> None:
    findings = {finding.what: finding for finding in examine()}
    assert {name for name, finding in findings.items() if finding.state is State.BAD} == set()
    assert {"Python", "clingo", "SUMO"} <= findings.keys()
    assert "drives" in findings["SUMO"].found


def test_an_empty_sumo_home_is_noted_with_its_remedy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SUMO_HOME", "")
    finding = {finding.what: finding for finding in examine()}["SUMO_HOME"]
    assert (finding.state, finding.remedy) == (State.NOTE, "unset SUMO_HOME")


def test_a_sumo_that_dies_is_told_with_its_last_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "SUMO", "import os; os.abort()")
    finding = {finding.what: finding for finding in examine()}["SUMO"]
    assert (finding.state, finding.found.rpartition(": ")[2]) == (State.BAD, "ended with -6")


def test_what_hangs_is_given_up() -> None:
    assert doctor._tried("while True: pass", patience=0.5) == (False, "no answer within 0.5 s")


def test_without_carlas_client_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "_version", lambda _: None)
    finding = found()["CARLA's client"]
    assert (finding.state, finding.remedy) == (State.BAD, "pip install 'tmpud[carla]'")
    assert "CARLA's server" not in found()


def test_a_port_at_which_nobody_listens_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with_client(monkeypatch, "print('never asked')")
    with socket.create_server(("127.0.0.1", 0)) as server:
        closed = server.getsockname()[1]
    finding = found(port=closed)["CARLA's server"]
    assert finding.state is State.BAD
    assert f"127.0.0.1:{closed}" in finding.found


@pytest.mark.parametrize(
    ("code", "state", "said"),
    [
        (f"print('{NEW}')", State.OK, NEW),
        (f"print('{OLD}')", State.BAD, f"{OLD}, the client is {NEW}"),
        ("raise RuntimeError('time-out of 2000ms')", State.BAD, "time-out of 2000ms"),
    ],
)
def test_a_server_is_asked_its_version(
    monkeypatch: pytest.MonkeyPatch, port: int, code: str, state: State, said: str
) -> None:
    with_client(monkeypatch, code)
    finding = found(port=port)["CARLA's server"]
    assert finding.state is state
    assert finding.found.endswith(said)
    assert bool(finding.remedy) == (state is State.BAD)


def test_the_command_prints_json_alone_and_fails_where_something_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "_version", lambda _: None)
    result = CliRunner().invoke(app, ["doctor", "--sim", "carla", "--json"])
    assert result.exit_code == 3
    assert {"what": "SUMO", "state": "bad", "found": "libsumo is not installed", "remedy": "pip install libsumo"} in (
        json.loads(result.stdout)
    )
