"""Draw the README's picture and animation, and put what the demo prints beside them.

python -m tools.picture
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FILM = ("--from", "70", "--to", "86")  # around the second change of plan
SHOWN = 11  # lines of the story, before the end
BLOCK = re.compile(r"```text\nmillbrook: .*?```\n", re.DOTALL)


def main() -> None:
    """Run the demo once; rewrite picture, animation and excerpt."""
    folder, images = ROOT / "runs" / "demo", ROOT / "docs" / "images"
    tmpud = str(Path(sys.executable).parent / "tmpud")
    command = [tmpud, "demo", "--out", str(folder)]
    words = subprocess.run(command, check=True, cwd=ROOT, capture_output=True, text=True).stdout
    lines = [line for line in words.splitlines() if "next best" not in line]
    end = next(line for line in lines if "SUCCESS" in line)
    readme = ROOT / "README.md"
    block = "\n".join(["```text", *lines[:SHOWN], "   ...", end, "```", ""])
    readme.write_text(BLOCK.sub(lambda _: block, readme.read_text(encoding="utf-8"), count=1), encoding="utf-8")
    shutil.copy(folder / "map.png", images / "demo.png")
    subprocess.run([tmpud, "replay", str(folder), "--gif", str(images / "demo.gif"), *FILM], check=True, cwd=ROOT)
    print(words)


if __name__ == "__main__":
    main()
