"""Scenes as text: read strictly from YAML or from options, written as YAML would have them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import MISSING, dataclass, replace
from pathlib import Path
from typing import Any, Final, TypeVar

from npchip.base.errors import InputError
from npchip.base.suggest import near_miss
from npchip.base.yaml import Located, read_mapping
from npchip.host.scenes.backgrounds import BACKGROUNDS, Background, Flat
from npchip.host.scenes.model import Object, Scene
from npchip.host.scenes.motions import MOTIONS
from npchip.host.scenes.rules import rule_of, settings
from npchip.host.scenes.shapes import SHAPES

DEFAULT_MOTION: Final = "linear"

_T = TypeVar("_T")


def read_scene(path: Path, overrides: Mapping[str, Any] | None = None) -> Scene:
    """Read a scene file.

    Args:
        path: the YAML file.
        overrides: options for the whole scene that take the place of the file's settings.

    Raises:
        InputError: NP280 unreadable or no YAML mapping, NP281 unknown key, NP282 a key is
            missing, NP283 wrong type, NP284 out of range, NP285 an unknown shape, motion or
            background, NP286 too large, NP287 impossible. Messages name file and line.
    """
    scene = Reader(str(path)).scene(read_mapping(path, "NP280"))
    changes = Reader(None).whole(overrides or {})
    return replace(scene, **changes) if changes else scene


def scene_of_options(item: Mapping[str, Any], whole: Mapping[str, Any]) -> Scene:
    """Make a scene with one object of what options say; errors as `read_scene`.

    Args:
        item: settings of the object, its shape and its motion.
        whole: settings of the scene.
    """
    return Reader(None).scene({"objects": [item], **whole})


def scene_as_data(scene: Scene) -> dict[str, Any]:
    """Return what a scene file would hold; reading it gives an equal scene."""
    return {
        **values_of(scene),
        "background": background_as_data(scene.background),
        "objects": [
            {
                "shape": name_of(item.shape, SHAPES),
                "motion": name_of(item.motion, MOTIONS),
                **values_of(item),
                **values_of(item.shape),
                **values_of(item.motion),
            }
            for item in scene.objects
        ],
    }


@dataclass(frozen=True)
class Reader:
    """Reads the settings of a file, or of options where `file` is None; errors as `read_scene`."""

    file: str | None

    def scene(self, data: Mapping[str, Any]) -> Scene:
        """Read a scene of objects in the frame."""
        self.check_keys(data, ("objects", "background", *settings(Scene)), "a scene")
        items = self.need(data, "objects", "a scene")
        if not isinstance(items, list):
            raise self.wrong(data, "objects", "a list of objects", items)
        objects = tuple(self._object(item, data) for item in items)
        return self.make(Scene, data, {"objects": objects, **self.whole(data)})

    def whole(self, data: Mapping[str, Any]) -> dict[str, Any]:
        """Settings of a scene other than its objects, as far as they are given."""
        values = self.read(Scene, data, "a scene", partly=True)
        if "background" in data:
            values["background"] = self.background(data)
        return values

    def _object(self, data: Any, parent: Mapping[str, Any]) -> Object:
        if not isinstance(data, Mapping):
            raise self.wrong(parent, "objects", "an object with shape and motion", data)
        shape = self.choice(data, "shape", SHAPES, None)
        motion = self.choice(data, "motion", MOTIONS, DEFAULT_MOTION)
        name = f"a {shape.__name__.lower()} in {motion.__name__.lower()} motion"
        kinds = (shape, motion, Object)
        known = [key for kind in kinds for key in settings(kind)]
        self.check_keys(data, ("shape", "motion", *known), name)
        parts: list[Any] = [
            self.make(kind, data, self.read(kind, data, name)) for kind in (shape, motion)
        ]
        values = self.read(Object, data, name)
        return self.make(Object, data, {"shape": parts[0], "motion": parts[1], **values})

    def background(self, parent: Mapping[str, Any]) -> Background:
        """Read the key `background`: a level or a mapping."""
        data = parent["background"]
        if not isinstance(data, Mapping):
            level = rule_of(settings(Flat)["level"]).check(data, self.place(parent, "background"))
            return Flat(level=level)
        kind = self.choice(data, "kind", BACKGROUNDS, None)
        name = f"a {kind.__name__.lower()} background"
        self.check_keys(data, ("kind", *settings(kind)), name)
        return self.make(kind, data, self.read(kind, data, name))

    def read(
        self, kind: type[Any], data: Mapping[str, Any], name: str, *, partly: bool = False
    ) -> dict[str, Any]:
        """Read and check the settings of `kind`; without `partly` those without default must be."""
        values = {}
        for key, item in settings(kind).items():
            if key in data:
                values[key] = rule_of(item).check(data[key], self.place(data, key))
            elif not partly and item.default is MISSING:
                self.need(data, key, name)
        return values

    def make(self, kind: type[_T], data: Mapping[str, Any], values: Mapping[str, Any]) -> _T:
        """Make an object of checked settings; what is wrong with them together gets a place."""
        try:
            return kind(**values)
        except InputError as error:
            line = f"{self.file}:{data.line}: " if isinstance(data, Located) else ""
            raise InputError(error.code, f"{line}{error.message}", hint=error.hint) from None

    def choice(
        self, data: Mapping[str, Any], key: str, kinds: Mapping[str, type[_T]], default: str | None
    ) -> type[_T]:
        """Read a key that names a class."""
        found = data.get(key, default) if default else self.need(data, key, "it")
        if not isinstance(found, str) or found not in kinds:
            raise InputError(
                "NP285",
                f"{self.place(data, key)}: expected {_listed(kinds)}, found '{str(found)[:60]}'",
                hint=_near(found, kinds),
            )
        return kinds[found]

    def need(self, data: Mapping[str, Any], key: str, name: str) -> Any:
        """Return a key that must be there."""
        if key in data:
            return data[key]
        place = f"{self.file}:{data.line}: " if isinstance(data, Located) else ""
        shown = key if isinstance(data, Located) else f"--{key}"
        raise InputError("NP282", f"{place}{name} needs {shown}")

    def check_keys(self, data: Mapping[str, Any], known: Collection[str], name: str) -> None:
        """Refuse keys other than these."""
        for key in data:
            if key not in known:
                raise InputError(
                    "NP281",
                    f"{self.place(data, key)}: {name} has no {key}: it takes {_listed(known)}",
                    hint=_near(key, known),
                )

    def wrong(self, data: Mapping[str, Any], key: str, expected: str, found: Any) -> InputError:
        """Make the error of a value of the wrong type."""
        kind = "nothing" if found is None else f"a {type(found).__name__}"
        return InputError("NP283", f"{self.place(data, key)}: expected {expected}, found {kind}")

    def place(self, data: Mapping[str, Any], key: str) -> str:
        """Where a key stands, for messages."""
        if isinstance(data, Located):
            return f"{self.file}:{data.lines[key]}: {key}"
        return f"--{key}"


def values_of(item: Any) -> dict[str, Any]:
    """Return the settings of an object as plain data."""
    return {name: _plain(getattr(item, name)) for name in settings(type(item))}


def background_as_data(back: Background) -> Any:
    """Return what the key `background` of a scene file would hold."""
    if isinstance(back, Flat):
        return back.level
    return {"kind": name_of(back, BACKGROUNDS), **values_of(back)}


def name_of(item: Any, kinds: Mapping[str, type[Any]]) -> str:
    """Return the name of an object's class."""
    return next(name for name, kind in kinds.items() if kind is type(item))


def _plain(value: Any) -> Any:
    """Return `value` with lists in the place of tuples."""
    return [_plain(each) for each in value] if isinstance(value, tuple) else value


def _listed(names: Collection[str]) -> str:
    return ", ".join(names)


def _near(name: Any, known: Collection[str]) -> str | None:
    near = near_miss(str(name)[:80], known)
    return f"did you mean '{near}'?" if near else None
