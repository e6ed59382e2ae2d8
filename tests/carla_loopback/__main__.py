"""A server that speaks CARLA's wire, for tests: ``python -m tests.carla_loopback TOWN.xodr``. Prints its port."""

from __future__ import annotations

import argparse
import asyncio
import json
from pathlib import Path

from tests.carla_loopback.faults import Faults
from tests.carla_loopback.maps import lights, spawn_points
from tests.carla_loopback.server import Server
from tests.carla_loopback.town import Town


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("xodr", type=Path)
    parser.add_argument("--faults", type=json.loads, default={})
    options = parser.parse_args()
    name, text = options.xodr.stem, options.xodr.read_text(encoding="utf-8")
    town = Town(name, text, spawn_points(name, text), lights(name, text), Faults(**options.faults))
    asyncio.run(Server(town).run())


main()
