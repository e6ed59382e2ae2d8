"""Dijkstra in C++, compiled here and now."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.harness import SkipError
from benchmarks.questions import Graph

SOURCE = Path(__file__).with_name("dijkstra.cpp")
OPTIONS = ("-std=c++17", "-O3", "-march=native", "-shared", "-fPIC")


@cache
def _library() -> Any:
    """Compile and load; raises SkipError where no compiler is there."""
    compiler = os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
    if not compiler:
        raise SkipError("no C++ compiler is there")
    with TemporaryDirectory() as folder:
        library = Path(folder) / "dijkstra.so"
        command = [compiler, *OPTIONS, "-o", str(library), str(SOURCE)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise SkipError(f"{compiler} does not compile it: {done.stderr.splitlines()[-1:]}")
        found = ctypes.CDLL(str(library)).shortest
    found.restype = ctypes.c_int64
    return found


class Compiled:
    """A Router in C++."""

    def __init__(self, graph: Graph) -> None:
        self._library = _library()
        self._nodes = len(graph.index)
        ends = np.array(list(graph.edges), dtype=np.int32)
        self._first = np.searchsorted(ends[:, 0], np.arange(self._nodes + 1)).astype(np.int32)
        self._target = np.ascontiguousarray(ends[:, 1])
        self._weight = np.array(graph.weights, dtype=np.int32)
        self._arrays = [ctypes.c_void_p(array.ctypes.data) for array in (self._first, self._target, self._weight)]

    def weigh(self, edge: int, weight: int) -> None:
        self._weight[edge] = weight

    def shortest(self, start: int, goal: int) -> float:
        return float(self._library(self._nodes, *self._arrays, start, goal))
