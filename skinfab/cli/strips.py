"""`skinfab strips`: print calibration strips, and fit the ink from what was measured on them."""

from __future__ import annotations

import argparse
import json
import tempfile
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from skinfab.cli import steps

if TYPE_CHECKING:
    from skinfab.strip_fit import StripFit

#: Below this the strips' means do not lie where the model has them.
MISFIT_P = 0.01


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command and its options."""
    p = subparsers.add_parser(
        "strips",
        help="calibration strips for the ink: print them, then fit what was measured",
        description="Without --fit: a plate of strips of three lengths, made like any skin (G-code, mould, recipe, report), and strips.csv "
        "to write the measured resistances into. With --fit: the cross-section that conducts, the contacts and the scatter, with "
        "standard errors, into a material profile for --material.",
    )
    p.add_argument("-o", "--output", metavar="DIR|MATERIAL.toml", type=Path, required=True, help="folder, or with --fit the new profile")
    p.add_argument(
        "--fit",
        metavar="FILE.csv",
        type=Path,
        help="measured strips: a table with the columns length_mm and r_kohm, kilo-ohm; comma or semicolon between them",
    )
    p.add_argument("--copies", metavar="N", type=int, help="strips of each length, 2 to 8 (default 4)")
    p.add_argument("--material", type=steps.profile, metavar="NAME|FILE.toml", help="material profile to begin from")
    p.add_argument("--printer", type=steps.profile, metavar="NAME|FILE", help="printer profile")
    p.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    p.set_defaults(run=run, wrong_usage=p.error)


def run(args: argparse.Namespace) -> int:
    """Make the plate, or fit."""
    if args.fit is None:
        return _make(args)
    if args.copies is not None or args.printer is not None:
        args.wrong_usage("--copies and --printer are for printing strips, not for --fit")
    if args.output.suffix.lower() != ".toml":
        args.wrong_usage(f"with --fit, -o names the new profile: {str(args.output)!r} does not end in .toml")
    return _fit(args)


def _make(args: argparse.Namespace) -> int:
    from skinfab.cli.main import build_parser
    from skinfab.document import save_skin
    from skinfab.strip_plate import strip_skin, write_strip_table

    used = steps.profiles(args.printer, args.material)
    copies = 4 if args.copies is None else args.copies
    skin = strip_skin(used.material, copies=copies, material_name=used.material_name, printer_name=used.printer_name)
    with tempfile.TemporaryDirectory() as folder:
        document = Path(folder) / "strips.skin"
        save_skin(skin, document)
        words = ["make", str(document), "-o", str(args.output), *(["--json"] if args.json else [])]
        made = build_parser(words).parse_args(words)
        status = int(made.run(made))
    table = args.output / "strips.csv"
    if table.exists():
        steps.say([f"{table} is there already and was left as it is"])
    else:
        write_strip_table(skin, table)
    if not args.json:
        print(f"measure each strip from pad to pad, write kohm into {table}, then: skinfab strips --fit {table} -o MATERIAL.toml")
    return status


def _fit(args: argparse.Namespace) -> int:
    from skinfab.files import atomic_write
    from skinfab.material import DEFAULT_MATERIAL, load_material, material_toml
    from skinfab.strip_fit import fit_strips, fitted_material, require_plausible
    from skinfab.strip_table import read_strips

    material, strips = load_material(args.material or DEFAULT_MATERIAL), read_strips(args.fit)
    fit = fit_strips(strips, resistivity_ohm_cm=material.ink.resistivity_ohm_cm)
    require_plausible(fit, material.ink)
    notes = _notes(fit)
    atomic_write(args.output, material_toml(fitted_material(material, fit), comments=[f"Fitted from {args.fit.name}.", *notes]))
    warnings = [f"{args.fit}: no resistance on {', '.join(strips.unmeasured)}; left out"] if strips.unmeasured else []
    if fit.outlier is not None:
        warnings.append(f"{fit.outlier}: measure it again, and leave its r_kohm empty if it is broken or bridged")
    if fit.misfit_p < MISFIT_P:
        warnings.append(f"the lengths' means do not lie on one line (p = {fit.misfit_p:.2g}): look for broken or bridged strips first")
    steps.say(warnings, kind="warning")
    if args.json:
        print(json.dumps({"material": str(args.output), "fit": asdict(fit), "warnings": warnings}))
        return 0
    print("\n".join(notes))
    print(f"{args.output}: use it with --material {args.output}")
    return 0


def _notes(fit: StripFit) -> list[str]:
    return [
        f"{fit.n} strips of {fit.lengths} lengths",
        f"effective_area_mm2: {fit.effective_area_mm2}",
        f"contact_resistance_kohm: {fit.contact_resistance_kohm}",
        f"log_sigma: {fit.log_sigma}",
    ]
