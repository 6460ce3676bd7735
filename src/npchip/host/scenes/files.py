"""Scenes from YAML files or options, and as the data of such files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, Field, replace
from pathlib import Path
from typing import Any, Final, TypeVar

from npchip import bundle
from npchip.base.section import Codes, Section
from npchip.base.suggest import shown, suggestion
from npchip.base.yaml import read_mapping
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
        path: the YAML file, or the name of a bundled scene.
        overrides: options for the whole scene that override the file's settings.

    Raises:
        InputError: NP280 unreadable or no YAML mapping, NP281 unknown key, NP282 a key is
            missing, NP283 wrong type, NP284 out of range, NP285 an unknown shape, motion or
            background, NP286 too large, NP287 impossible. Messages name file and line.
    """
    path = bundle.need("scene", path, "NP280")
    scene = Settings(read_mapping(path, "NP280"), str(path), "a scene").scene()
    changes = Settings(overrides or {}, None, "a scene").whole()
    return replace(scene, **changes) if changes else scene


def scene_of_options(item: Mapping[str, Any], whole: Mapping[str, Any]) -> Scene:
    """Make a scene with one object from options; errors as `read_scene`.

    Args:
        item: settings of the object, its shape and its motion.
        whole: settings of the scene.
    """
    return Settings({"objects": [item], **whole}, None, "a scene").scene()


def scene_as_data(scene: Scene) -> dict[str, Any]:
    """Return the content of a scene file that gives an equal scene."""
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


class Settings(Section):
    """Settings of a scene or a part of it, from a file or options; errors as `read_scene`."""

    codes = Codes(unknown="NP281", missing="NP282", type="NP283")

    def scene(self) -> Scene:
        """Read a scene of objects in the frame."""
        self.check_keys((), ("objects", "background", *settings(Scene)))
        self.need("objects")
        items = self.get("objects", list, what="a list of objects")
        objects = tuple(self._object(item) for item in items)
        return self.make(Scene, {"objects": objects, **self.whole()})

    def whole(self, kind: type[Any] = Scene) -> dict[str, Any]:
        """Read the settings of a scene that are given, except its objects."""
        values = self.read(kind)
        if "background" in self.data:
            values["background"] = self.background()
        return values

    def _object(self, data: Any) -> Object:
        if not isinstance(data, Mapping):
            raise self.wrong("objects", "an object with shape and motion", data)
        item = Settings(data, self.file, "it")
        shape = item.choice("shape", SHAPES, None)
        motion = item.choice("motion", MOTIONS, DEFAULT_MOTION)
        item.name = f"a {shape.__name__.lower()} in {motion.__name__.lower()} motion"
        known = [key for kind in (shape, motion, Object) for key in settings(kind)]
        item.check_keys((), ("shape", "motion", *known))
        parts: list[Any] = [item.make(kind, item.read(kind)) for kind in (shape, motion)]
        return item.make(Object, {"shape": parts[0], "motion": parts[1], **item.read(Object)})

    def background(self) -> Background:
        """Read the key `background`: a level or a mapping."""
        data = self.data["background"]
        if not isinstance(data, Mapping):
            return Flat(level=self._checked("background", settings(Flat)["level"]))
        back = Settings(data, self.file, "it")
        kind = back.choice("kind", BACKGROUNDS, None)
        back.name = f"a {kind.__name__.lower()} background"
        back.check_keys((), ("kind", *settings(kind)))
        return back.make(kind, back.read(kind))

    def read(self, kind: type[Any]) -> dict[str, Any]:
        """Read the settings of `kind`, of which those without a default must be there."""
        values = {}
        for key, item in settings(kind).items():
            if key in self.data:
                values[key] = self._checked(key, item)
            elif item.default is item.default_factory is MISSING:
                self.need(key)
        return values

    def _checked(self, key: str, item: Field[Any]) -> Any:
        place = f"{self.file}:{self.line(key)}: " if self.line(key) else ""
        return rule_of(item).check(self.data[key], f"{place}{self.called(key)}")

    def choice(self, key: str, kinds: Mapping[str, type[_T]], default: str | None) -> type[_T]:
        """Return the class of the name in a key."""
        found = self.data.get(key, default) if default else self.need(key)
        if not isinstance(found, str) or found not in kinds:
            message = f"{self.called(key)}: expected {', '.join(kinds)}, found {shown(found)}"
            raise self.error(message, code="NP285", key=key, hint=suggestion(found, kinds))
        return kinds[found]


def values_of(item: Any) -> dict[str, Any]:
    """Return the settings of an object as plain data."""
    return {name: _plain(getattr(item, name)) for name in settings(type(item))}


def background_as_data(back: Background) -> Any:
    """Return the value of the key `background` of a scene file."""
    if isinstance(back, Flat):
        return back.level
    return {"kind": name_of(back, BACKGROUNDS), **values_of(back)}


def name_of(item: Any, kinds: Mapping[str, type[Any]]) -> str:
    """Return the name of an object's class."""
    return next(name for name, kind in kinds.items() if kind is type(item))


def _plain(value: Any) -> Any:
    """Return `value` with its tuples as lists."""
    return [_plain(each) for each in value] if isinstance(value, tuple) else value
