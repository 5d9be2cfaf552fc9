"""What every tool is: a name in the tool bar, and what it makes of clicks, drags and the pointer's way."""

from __future__ import annotations

from typing import TypeAlias

from gui.view2d.hit import Hit2D
from gui.view3d.hit import Hit

#: A place on the object, clicked in either view: both know face, barycentric, point, vertex, edge and target.
AnyHit: TypeAlias = Hit | Hit2D


class Tool:
    """Does nothing; tools override what they need.

    Attributes
    ----------
    id, label, key, tip : str
        For the tool bar and the keys; `tip` is shown while the tool is in hand.
    """

    id = ""
    label = ""
    key = ""
    tip = ""

    @property
    def begun(self) -> bool:
        """Whether something was begun that further clicks would go on with."""
        return False

    def click(self, hit: AnyHit, *, shift: bool) -> None:
        """The object was clicked."""

    def drag(self, hit: AnyHit) -> bool:
        """The pointer is dragged over the object; True takes the drag from the view."""
        return False

    def release(self) -> None:
        """The drag has ended."""

    def point(self, hit: AnyHit | None) -> None:
        """The pointer is over the object, or has left it."""

    def stop(self) -> None:
        """Escape, Enter, or another tool: what was begun and not done is dropped."""
