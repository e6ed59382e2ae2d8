"""Serves until it is interrupted."""

from __future__ import annotations

import secrets
import socket
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import uvicorn

from tmpud.server.app import make_app

PATIENCE = 1  # [s] for answers that are under way when it is interrupted


def listen(port: int) -> socket.socket:
    """Return a socket on this machine's own address; port 0 is any that is free. OSError where it is taken."""
    listener = socket.socket()
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind(("127.0.0.1", port))
        listener.listen(256)
    except OSError:
        listener.close()
        raise
    return listener


def serve(roots: Sequence[Path], listener: socket.socket, say: Callable[[str], None]) -> None:
    """Say the address and serve what lies below ``roots``."""
    server, url = make_server(roots, listener)
    say(url)
    with suppress(KeyboardInterrupt):
        server.run(sockets=[listener])


def make_server(roots: Sequence[Path], listener: socket.socket) -> tuple[uvicorn.Server, str]:
    """Return a server that has not begun, and its address with a new token."""
    port, token = listener.getsockname()[1], secrets.token_urlsafe(32)
    config = uvicorn.Config(
        make_app(roots, port, token),
        loop="asyncio", http="h11", ws="none", lifespan="off", interface="asgi3", log_config=None, access_log=False,
        proxy_headers=False, server_header=False, timeout_graceful_shutdown=PATIENCE,
    )  # fmt: skip
    return uvicorn.Server(config), f"http://127.0.0.1:{port}/{token}/"
