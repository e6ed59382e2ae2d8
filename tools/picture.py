"""Draw the README's picture and put what the drive prints beside it: a drive in which the first merge is refused.

    python -m tools.picture

Which seed shows that depends on the traffic, so the seeds are tried in their order.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

from tmpud.events import Estimated
from tmpud.roads.towns import PAPER_MISSIONS
from tmpud.runner import Mission, drive

ROOT = Path(__file__).resolve().parents[1]
TOWN, VEHICLES = "millbrook", 200
SEEDS = range(1, 301)
LOW = 0.5  # a merge below this Safe is worth a picture
SHOWN = 11  # lines of the story, before the end
BLOCK = re.compile(r"```text\nmillbrook: .*?```\n", re.DOTALL)


def main() -> None:
    seed = next(seed for seed in SEEDS if _is_refused(seed))
    words = _run(["--seed", str(seed), "--out", str(ROOT / "runs" / "picture")])
    lines = [line for line in words.splitlines() if "next best" not in line]
    end = next(line for line in lines if "SUCCESS" in line)
    readme = ROOT / "README.md"
    block = "\n".join(["```text", *lines[:SHOWN], "   ...", end, "```", ""])
    readme.write_text(BLOCK.sub(lambda _: block, readme.read_text(encoding="utf-8"), count=1), encoding="utf-8")
    shutil.copy(ROOT / "runs" / "picture" / "map.png", ROOT / "docs" / "images" / "demo.png")
    print(words)


def _is_refused(seed: int) -> bool:
    """Whether the first action is an unsafe merge and the drive ends well; libsumo wants a process for each drive."""
    first = subprocess.run(
        [sys.executable, "-m", "tools.picture", str(seed)], check=True, cwd=ROOT, capture_output=True
    )
    if float(first.stdout) >= LOW:
        return False
    summary = json.loads(_run(["--seed", str(seed), "--no-frames", "--json", "--out", str(ROOT / "runs" / "picture")]))
    unsafe = summary["collisions"] + summary["forced_stops"] + summary["violations"]
    return summary["status"] == "SUCCESS" and summary["replans"] == 1 and not unsafe


def _run(arguments: list[str]) -> str:
    paper = PAPER_MISSIONS[TOWN]
    tmpud = str(Path(sys.executable).parent / "tmpud")
    command = [tmpud, "drive", "--from", paper.start, "--to", paper.goal, f"--traffic={VEHICLES}", *arguments]
    return subprocess.run(command, check=True, cwd=ROOT, capture_output=True, text=True).stdout


def _first_safe(seed: int) -> float:
    paper = PAPER_MISSIONS[TOWN]
    mission = Mission(map=TOWN, start=paper.start, goal=paper.goal, traffic=VEHICLES, seed=seed)
    return next(event.safe for event in drive(mission, frames=False) if isinstance(event, Estimated))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        print(_first_safe(int(sys.argv[1])))
    else:
        main()
