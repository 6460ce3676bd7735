"""Rig files: two cameras as YAML."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from npchip import bundle
from npchip.base.section import Codes, Section
from npchip.base.yaml import read_mapping
from npchip.host.vision.fusion.camera import Camera, Rig, calibrate_ratio

_CALIBRATION: Final = ("length", "distance", "pixels")


class _Section(Section):
    """A mapping of a rig file."""

    codes = Codes(unknown="NP501", missing="NP502", type="NP503")


def load_rig(path: Path | str) -> Rig:
    """Read a rig file; its keys are explained in ``docs/fusion.md``.

    Args:
        path: the YAML file, or the name of a bundled rig.

    Returns:
        the cameras.

    Raises:
        InputError: NP500, the file cannot be read or is no YAML mapping; NP501, an unknown key;
            NP502, a missing key or two that exclude each other; NP503, a wrong value; NP504,
            cameras that do not make a rig. Messages name file, line and key.
    """
    file = bundle.need("rig", path, "NP500")
    top = _Section(read_mapping(file, "NP500"), str(file), "a rig")
    top.check_keys(("camera1", "camera2"), ("cell",))
    values: dict[str, Any] = dict(top.data)
    for key in ("camera1", "camera2"):
        values[key] = _camera(top.section(key, prefix=f"{key}."))
    return top.make(Rig, values)


def _camera(camera: _Section) -> Camera:
    camera.check_keys((), ("position", "looks", "ratio", "calibration", "rows", "cols", "turned"))
    data = camera.data
    if ("ratio" in data) == ("calibration" in data):
        both = "both ratio and calibration" if "ratio" in data else "neither ratio nor calibration"
        hint = "give the ratio in pixels, or calibration: {length: m, distance: m, pixels: n}"
        raise camera.error(f"{camera.name} has {both}", code="NP502", hint=hint)
    for key in ("position", "looks"):
        camera.need(key)
    values: dict[str, Any] = {k: v for k, v in data.items() if k != "calibration"}
    for key in ("position", "turned"):
        if isinstance(values.get(key), list):
            values[key] = tuple(values[key])
    if "calibration" in data:
        name = f"{camera.name}.calibration"
        calibration = camera.section("calibration", name, f"{name}.")
        calibration.check_keys(_CALIBRATION)
        values["ratio"] = calibration.make(calibrate_ratio, calibration.data)
    return camera.make(Camera, values)


def rig_as_data(rig: Rig) -> dict[str, Any]:
    """Return the content of a rig file that gives an equal rig."""
    data = asdict(rig)
    for key in ("camera1", "camera2"):
        data[key]["position"] = list(data[key]["position"])
        turned = data[key].pop("turned")
        if any(turned):
            data[key]["turned"] = list(turned)
    return data


def rig_text(rig: Rig) -> str:
    """Return the text of a rig file that gives an equal rig."""
    data = rig_as_data(rig)
    cameras = [f"{key}: {json.dumps(data[key])}" for key in ("camera1", "camera2")]
    return "\n".join([*cameras, f"cell: {rig.cell}", ""])
