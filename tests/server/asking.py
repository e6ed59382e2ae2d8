"""A server in a thread, what asks it anything at all, and what reads its pages."""

from __future__ import annotations

import http.client
import re
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from html.parser import HTMLParser
from pathlib import Path

from tmpud.server.serving import listen, make_server


@dataclass(frozen=True)
class Answer:
    status: int
    headers: http.client.HTTPMessage
    text: str


@dataclass(frozen=True)
class Served:
    url: str
    port: int
    token: str

    def ask(
        self, path: str, method: str = "GET", headers: Sequence[tuple[str, str]] | None = None, *, bare: bool = False
    ) -> Answer:
        """Ask for a path below the token, or, bare, for just this; by default with the right Host alone."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=300)
        connection.putrequest(method, path if bare else f"/{self.token}/{path}", skip_host=True)
        for name, value in [("Host", f"127.0.0.1:{self.port}")] if headers is None else headers:
            connection.putheader(name, value)
        connection.endheaders()
        answer = connection.getresponse()
        text = answer.read().decode()
        connection.close()
        return Answer(answer.status, answer.headers, text)

    def link(self, name: str) -> str:
        """Return where the list leads for an entry's name."""
        for link, shown in re.findall(r'<a href="([^"]+)"><bdi>([^<]*)</bdi>', self.ask("").text):
            if shown == name:
                return str(link)
        raise LookupError(name)

    def part(self, name: str) -> str:
        return self.ask(f"{self.link(name)}/part").text


@contextmanager
def served(*roots: Path) -> Iterator[Served]:
    with listen(0) as listener:
        server, url = make_server(roots, listener)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        while not server.started:
            time.sleep(0.01)
        _, _, address, token, _ = url.split("/")
        try:
            yield Served(url, int(address.partition(":")[2]), token)
        finally:
            server.should_exit = True
            thread.join()


class Shown(HTMLParser):
    """What a browser would take for elements, and what for text."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.elements: set[str] = set()
        self.attributes: set[str] = set()
        self.text = ""
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.add(tag)
        self.attributes.update(name for name, _ in attrs)

    def handle_data(self, data: str) -> None:
        self.text += data
