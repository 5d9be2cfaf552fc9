"""The printer and the material that a document names, loaded once."""

from __future__ import annotations

from dataclasses import dataclass

from gcode.printer import Printer, load_printer
from gcode.used import with_room_for_nozzle
from skinfab.material import Material, load_material
from skinfab.skin import Skin


@dataclass(frozen=True)
class Profiles:
    """What a document is printed with and made of.

    Parameters
    ----------
    printer : Printer
    material : Material
        As its profile has it.
    roomy : Material
        The same with the margin that the printer's nozzle needs beside the mould's wall, where that is more: for placing.
    """

    printer: Printer
    material: Material
    roomy: Material


class ProfileShelf:
    """Profiles by name, read from their files once for as long as the window is open.

    Examples
    --------
    >>> shelf = ProfileShelf()
    >>> shelf.get("ender5plus-vipro", "carbon-grease-ecoflex").material.depth
    2.5
    """

    def __init__(self) -> None:
        self._kept: dict[tuple[str, str], Profiles] = {}

    def of(self, skin: Skin) -> Profiles:
        """Those that a document names."""
        return self.get(skin.printer, skin.material)

    def get(self, printer: str, material: str) -> Profiles:
        """Both, by name or path.

        Raises
        ------
        InputError
            One of them is missing or damaged.
        """
        key = printer, material
        if key not in self._kept:
            head, stuff = load_printer(printer), load_material(material)
            self._kept[key] = Profiles(head, stuff, with_room_for_nozzle(stuff, head)[0])
        return self._kept[key]
