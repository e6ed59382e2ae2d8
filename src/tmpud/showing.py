"""How results show themselves in a notebook.

The classes stand below the drawing and must not know it, so it is looked up by its name when a notebook asks.
"""

from __future__ import annotations

from importlib import import_module

_DRAWING = "tmpud.viewer.notebook"


class ShownAsSvg:
    """A result that is a picture."""

    __slots__ = ()

    def _repr_svg_(self) -> str:
        return str(import_module(_DRAWING).svg(self))


class ShownAsHtml:
    """A result that is a table."""

    __slots__ = ()

    def _repr_html_(self) -> str:
        return str(import_module(_DRAWING).html(self))
