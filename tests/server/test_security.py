"""Who is answered: forged addresses, missing tokens, paths that lead elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from pathlib import Path

import pytest

from tests.experiments.made_results import made_results
from tests.server.asking import Answer, Served, served
from tests.viewer.made_runs import header, recorded

PRIVATE = "not for anybody"
HOSTS = (
    "", "evil.example", "evil.example:{port}", "127.0.0.1", "localhost", "127.0.0.1:80", "localhost:{other}",
    "127.0.0.1:{other}", "127.0.0.1.evil.example:{port}", "127.0.0.1:{port}.evil.example",
    "127.0.0.1:{port}@evil.example",
    "evil@127.0.0.1:{port}", "127.0.0.1:{port}:80", "127.0.0.1:0{port}", "127.0.0.1:{port}/", "127.0.0.1:{port}#",
    "127.0.0.1:{port}?", "127.0.0.1:{port}, evil.example", "evil.example, 127.0.0.1:{port}", "http://127.0.0.1:{port}",
    "[::1]:{port}", "[::ffff:127.0.0.1]:{port}", "0.0.0.0:{port}", "127.1:{port}", "2130706433:{port}",
    "0x7f000001:{port}", "127.0.0.2:{port}", "localhost.:{port}", "xlocalhost:{port}", "*", "null",
)  # fmt: skip
ORIGINS = (
    "", "null", "*", "http://evil.example", "http://evil.example:{port}", "https://127.0.0.1:{port}", "http://127.0.0.1",
    "http://localhost", "http://127.0.0.1:{other}", "http://127.0.0.1:{port}.evil.example", "http://127.0.0.1:{port}/",
    "http://[::1]:{port}", "file://", "127.0.0.1:{port}", "http://127.0.0.1:{port} http://evil.example",
)  # fmt: skip
UPWARDS = (
    "../", "%2e%2e/", "%2e%2e%2f", "..%2f", ".%2e/", "%2E%2E%5C", "..%5c", "%252e%252e%252f", "....//", "..;/",
    "%c0%ae%c0%ae/", "%2e%2e%00/", "./../", "%20../",
)  # fmt: skip
WRONG = (
    "%00", "{link}%00", "{link}/replay%00", "{link}/..", "static/view.css%00", "static/view.css/",
    "static/", "static/%2e", "static//view.css", "static/app.py", "runs", "runs/", "runs/%2e", "runs/run",
    "runs//replay",
    "experiments/run", "{link}/run.jsonl.gz", "{link}/report", "//etc/passwd", "%2fetc%2fpasswd", "runs//etc/passwd",
    "runs/%2fetc%2fpasswd", "runs/file:%2f%2f%2fetc%2fpasswd", "secret.txt", "run/run.jsonl.gz", "{folder}/secret.txt",
    "runs/{folder}/run", "%ff%fe", "runs/%ff",
)  # fmt: skip


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("shown")
    (folder / "secret.txt").write_text(PRIVATE)
    recorded(folder / "below" / "run", [header()])
    made_results(folder / "below" / "sweep")
    return folder / "below"


@pytest.fixture(scope="module")
def server(root: Path) -> Iterator[Served]:
    with served(root) as server:
        yield server


@pytest.fixture(scope="module")
def places(server: Served) -> tuple[str, ...]:
    """Return an address of each kind."""
    run, sweep = server.link("below/run"), server.link("below/sweep")
    trial = server.ask(f"{sweep}/points/0").text.partition("../trials/")[2].partition('"')[0]
    ends = ("", "/part", "/points", "/points/0", f"/trials/{trial}", f"/trials/{trial}/part", f"/trials/{trial}/replay")
    return ("", "list", run, f"{run}/replay", *(sweep + end for end in ends))


def refused(answer: Answer, *statuses: int) -> bool:
    return answer.status in statuses and "below/run" not in answer.text and "millbrook" not in answer.text


def test_its_own_address_is_answered_and_nothing_may_be_kept_or_framed(server: Served) -> None:
    own = (f"127.0.0.1:{server.port}", f"localhost:{server.port}")
    for host in own:
        answer = server.ask("", headers=[("Host", host), ("Origin", f"http://{host}")])
        assert answer.status == 200
        assert "below/run" in answer.text
        assert answer.headers["Cache-Control"] == "no-store"
        assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
        assert "frame-ancestors 'none'" in answer.headers["Content-Security-Policy"]


@pytest.mark.parametrize("host", HOSTS)
def test_a_forged_host_is_refused(server: Served, places: tuple[str, ...], host: str) -> None:
    forged = host.format(port=server.port, other=server.port + 1)
    for place in places:
        assert refused(server.ask(place, headers=[("Host", forged)]), 400, 403)


@pytest.mark.parametrize("origin", ORIGINS)
def test_a_forged_origin_is_refused(server: Served, places: tuple[str, ...], origin: str) -> None:
    forged = origin.format(port=server.port, other=server.port + 1)
    for place in places:
        assert refused(server.ask(place, headers=[("Host", f"127.0.0.1:{server.port}"), ("Origin", forged)]), 403)


def test_no_host_two_hosts_and_a_second_origin_are_refused(server: Served) -> None:
    own = ("Host", f"127.0.0.1:{server.port}")
    origins = [("Origin", f"http://127.0.0.1:{server.port}"), ("Origin", "http://evil.example")]
    assert len(HOSTS) + len(ORIGINS) >= 40
    for headers in ([], [own, own], [own, ("Host", "evil.example")], [own, *origins]):
        assert refused(server.ask("", headers=headers), 400, 403)


def test_without_the_whole_token_nothing_is_shown(server: Served, places: tuple[str, ...]) -> None:
    token = server.token
    wrong = ("", token[:-1], f"{token}x", token.swapcase(), f"%20{token}", f"/{token}", "%00", "%ff", f"?token={token}")
    for start in wrong:
        for path in ("", "/", "/static/view.css", *(f"/{place}" for place in places)):
            assert refused(server.ask(f"/{start}{path}", bare=True), 403), (start, path)


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "PROPFIND"])
def test_nothing_can_be_changed(server: Served, places: tuple[str, ...], method: str) -> None:
    for path in places:
        assert refused(server.ask(path, method), 405)


def test_the_head_of_a_page_can_be_asked_for(server: Served) -> None:
    assert (server.ask("", "HEAD").status, server.ask("", "HEAD").text) == (200, "")


def test_no_path_leads_to_a_file(server: Served, places: tuple[str, ...], root: Path) -> None:
    link = server.link("below/run")
    trial = next(place for place in places if "/trials/" in place)
    assert server.ask(link).status == server.ask("static/view.css").status == 200
    results = (trial.partition("trials/")[0] + "points/", trial.partition("trials/")[0] + "trials/", f"{trial}/")
    starts = ("", "runs/", "experiments/", "static/", f"{link}/", *results)
    targets = ("secret.txt", "etc/passwd")
    paths = [start + up * n + end for start, up, n, end in product(starts, UPWARDS, (1, 2, 9), targets)]
    paths += [path.format(link=link, folder=root.parent) for path in WRONG]
    assert len(set(paths)) >= 300
    for path in paths:
        answer = server.ask(path)
        assert answer.status in (400, 404), path
        assert PRIVATE not in answer.text, path
        assert "root:" not in answer.text, path


def test_a_whole_address_as_path_is_refused(server: Served) -> None:
    for path in (f"http://evil.example/{server.token}/", f"{server.url}", "*", "evil.example:443"):
        assert refused(server.ask(path, bare=True), 400, 403, 404)
