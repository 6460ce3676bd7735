"""Rig files: two cameras as YAML."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from npchip.base.errors import InputError
from npchip.base.suggest import near_miss
from npchip.base.yaml import Located, read_mapping
from npchip.host.vision.fusion.camera import Camera, Rig, calibrate_ratio

_RIG_KEYS: Final = ("camera1", "camera2", "cell")
_CAMERA_KEYS: Final = ("position", "looks", "ratio", "calibration", "rows", "cols")
_CALIBRATION_KEYS: Final = ("length", "distance", "pixels")


def load_rig(path: Path | str) -> Rig:
    """Read a rig file; its keys are explained in ``docs/fusion.md``.

    Args:
        path: the YAML file.

    Returns:
        the cameras.

    Raises:
        InputError: NP500, the file cannot be read or is no YAML mapping; NP501, an unknown key;
            NP502, a missing key or both of two that exclude each other; NP503, a value; NP504,
            cameras that do not make a rig. Messages name file, line and key.
    """
    name = str(path)
    data = read_mapping(Path(path), "NP500")
    _check_keys(name, data, _RIG_KEYS, "a rig")
    cameras = [_camera(name, data, key) for key in ("camera1", "camera2")]
    more = {"cell": data["cell"]} if "cell" in data else {}
    try:
        return Rig(camera1=cameras[0], camera2=cameras[1], **more)
    except InputError as error:
        line = data.lines["cell"] if error.message.startswith("cell") and more else data.line
        raise InputError(error.code, f"{name}:{line}: {error.message}", hint=error.hint) from None


def _camera(name: str, parent: Located, key: str) -> Camera:
    data = _mapping(name, parent, key, "a rig")
    _check_keys(name, data, _CAMERA_KEYS, key)
    if ("ratio" in data) == ("calibration" in data):
        both = "both ratio and calibration" if "ratio" in data else "neither ratio nor calibration"
        raise InputError(
            "NP502",
            f"{name}:{data.line}: {key} has {both}",
            hint="give the ratio in pixels, or calibration: {length: m, distance: m, pixels: n}",
        )
    for needed in ("position", "looks"):
        if needed not in data:
            raise InputError("NP502", f"{name}:{data.line}: {key} needs {needed}")
    values: dict[str, Any] = {k: v for k, v in data.items() if k != "calibration"}
    if isinstance(values["position"], list):
        values["position"] = tuple(values["position"])
    if "calibration" in data:
        values["ratio"] = _calibrated(name, data, key)
    try:
        return Camera(**values)
    except InputError as error:
        field = error.message.split(":", maxsplit=1)[0]
        line = data.lines.get(field, data.line)
        raise InputError(
            error.code, f"{name}:{line}: {key}.{error.message}", hint=error.hint
        ) from None


def _calibrated(name: str, parent: Located, key: str) -> float:
    data = _mapping(name, parent, "calibration", key)
    where = f"{key}.calibration"
    _check_keys(name, data, _CALIBRATION_KEYS, where)
    for needed in _CALIBRATION_KEYS:
        if needed not in data:
            raise InputError("NP502", f"{name}:{data.line}: {where} needs {needed}")
    try:
        return calibrate_ratio(**data)
    except InputError as error:
        field = error.message.split(":", maxsplit=1)[0]
        line = data.lines.get(field, data.line)
        raise InputError(error.code, f"{name}:{line}: {where}.{error.message}") from None


def _mapping(name: str, parent: Located, key: str, owner: str) -> Located:
    if key not in parent:
        raise InputError("NP502", f"{name}:{parent.line}: {owner} needs {key}")
    data = parent[key]
    if not isinstance(data, Located):
        raise InputError(
            "NP503",
            f"{name}:{parent.lines[key]}: {key}: expected a mapping (key: value),"
            f" found {str(data)[:60]}",
        )
    return data


def _check_keys(name: str, data: Located, known: tuple[str, ...], owner: str) -> None:
    for key in data:
        if key not in known:
            near = near_miss(key[:80], known)
            raise InputError(
                "NP501",
                f"{name}:{data.lines[key]}: {owner} has no {key}: it takes {', '.join(known)}",
                hint=f"did you mean '{near}'?" if near else None,
            )


def rig_as_data(rig: Rig) -> dict[str, Any]:
    """Return what a rig file would hold; reading it gives an equal rig."""
    cameras = {
        key: {
            "position": list(camera.position),
            "looks": camera.looks,
            "ratio": camera.ratio,
            "rows": camera.rows,
            "cols": camera.cols,
        }
        for key, camera in (("camera1", rig.camera1), ("camera2", rig.camera2))
    }
    return {**cameras, "cell": rig.cell}
