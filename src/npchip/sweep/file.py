"""Sweep files: YAML, checked key by key; messages name file and line."""

from __future__ import annotations

from glob import glob, has_magic
from pathlib import Path

from npchip import bundle
from npchip.base.suggest import shown
from npchip.base.yaml import Located, read_mapping
from npchip.frames.fit import check_fit
from npchip.frames.order import in_order
from npchip.host.scenes.files import read_scene
from npchip.sweep.axes import Value
from npchip.sweep.machines import read_machines
from npchip.sweep.model import Clip, ClipFile, Definition, DrawnClip, Experiment, ProgramFile
from npchip.sweep.section import SweepSection

_KEYS = ("programs", "clips", "machines", "define", "first", "frames", "fit", "experiment")


def read(path: Path) -> Definition:
    """Read a sweep file.

    Raises:
        InputError: NP641 unreadable or no YAML mapping, NP642 unknown key, NP643 a key is
            missing, NP644 a value of the wrong type, NP645 values that cannot be an axis, NP646
            names that cannot be told apart; or the error of a machine or a scene.
    """
    top = SweepSection(read_mapping(path, "NP641"), str(path), "a sweep")
    top.check_keys((), _KEYS)
    define = _define(top)
    common = Definition(
        file=str(path),
        name=path.stem,
        machines=read_machines(top, path.parent),
        define=define,
    )
    if "experiment" in top.data:
        return _experiment(top, common, path.parent)
    top.need("programs")
    for name, found in define.items():
        for value in found:
            if isinstance(value, bool) or not isinstance(value, int):
                message = f"define.{name}: expected whole numbers, found {shown(value)}"
                raise top.section("define").error(message, key=name)
    first = top.get("first", int, what="a number of frames") if "first" in top.data else None
    if first is not None and first < 1:
        raise top.wrong("first", "a number of frames from 1 on", first)
    fit = top.data.get("fit")
    check_fit(fit)
    return Definition(
        **vars(common)
        | {
            "programs": _programs(top, path.parent),
            "clips": _clips(top, path.parent) if "clips" in top.data else (None,),
            "first": first,
            "frames": top.get("frames", bool, default=False),
            "fit": fit,
        }
    )


def _experiment(top: SweepSection, common: Definition, folder: Path) -> Definition:
    for key in ("programs", "clips", "first", "frames", "fit"):
        if key in top.data:
            raise top.error(f"an experiment takes no {key}", code="NP642", key=key)
    text = top.get("experiment", str, what="MODULE:FUNCTION")
    module, _, function = text.partition(":")
    if not function.isidentifier() or not all(map(str.isidentifier, module.split("."))):
        raise top.wrong("experiment", "MODULE:FUNCTION", text)
    machines = common.machines if "machines" in top.data else ()
    found = Experiment(module, function, folder.resolve())
    return Definition(**vars(common) | {"experiment": found, "machines": machines})


def _define(top: SweepSection) -> dict[str, tuple[Value, ...]]:
    if "define" not in top.data:
        return {}
    section = top.section("define", prefix="define.")
    found = {name: section.axis(name) for name in section.data}
    for name, each in found.items():
        for value in each:
            if not isinstance(value, int | float | str):
                raise section.wrong(name, "numbers, or texts for an experiment", value)
    return found


def _programs(top: SweepSection, folder: Path) -> tuple[ProgramFile, ...]:
    given = top.entries("programs", "a list of programs, by name or path")
    paths: list[Path] = []
    for text in given:
        if not isinstance(text, str):
            raise top.wrong("programs", "names or paths of programs", text)
        path = bundle.find("program", text, folder)
        if not path.is_file():
            hint = bundle.hint("program", text)
            raise top.error(f"programs: no such file: {path}", key="programs", hint=hint)
        paths.append(path)
    return tuple(map(ProgramFile, _labels(paths, given), paths))


def _clips(top: SweepSection, folder: Path) -> tuple[Clip, ...]:
    texts: list[tuple[str, Path]] = []
    scenes: list[Clip] = []
    for item in top.entries("clips", "a list of clips: names, paths, patterns or scenes"):
        if isinstance(item, Located):
            scenes += _drawn(SweepSection(item, top.file, "a clip", "clips."), folder)
        elif isinstance(item, str):
            texts += _matching(top, item, folder)
        else:
            raise top.wrong("clips", "names, paths, patterns or scenes", item)
    labels = _labels([path for _, path in texts], [text for text, _ in texts])
    files = [ClipFile(label, path) for label, (_, path) in zip(labels, texts, strict=True)]
    return (*files, *scenes)


def _matching(top: SweepSection, text: str, folder: Path) -> list[tuple[str, Path]]:
    path = bundle.find("clip", text, folder)
    if path.exists():
        return [(text, path)]
    if has_magic(text):
        found = in_order([Path(item) for item in glob(str(folder / text))])  # noqa: PTH207
        clips = [item for item in found if not item.name.endswith(".truth.json")]
        if clips:
            return [(str(item), item) for item in clips]
        raise top.error(f"clips: no file matches {folder / text}", key="clips")
    hint = bundle.hint("clip", text)
    raise top.error(f"clips: no such file or folder: {path}", key="clips", hint=hint)


def _drawn(section: SweepSection, folder: Path) -> list[Clip]:
    section.check_keys(("scene",), ("seeds",))
    text = section.get("scene", str, what="a scene file")
    scene = read_scene(bundle.find("scene", text, folder))
    seeds = section.axis("seeds") if "seeds" in section.data else (scene.seed,)
    label = Path(text).stem
    for seed in seeds:
        if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 1 << 32:
            raise section.wrong("seeds", "whole numbers from 0 to 4294967295", seed)
    return [DrawnClip(label, scene, seed) for seed in seeds]


def _labels(paths: list[Path], given: list[str]) -> list[str]:
    """Return the stems of files, and what was given for those that share one."""
    stems = [path.stem for path in paths]
    return [stem if stems.count(stem) == 1 else str(text) for stem, text in zip(stems, given)]  # noqa: B905
