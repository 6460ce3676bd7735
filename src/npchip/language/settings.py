"""``npchip.toml``: what a folder of programs is assembled for.

The nearest one upward of a source counts, and only it. Options of the command line win.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from npchip.base.errors import InputError
from npchip.base.files import read_bytes
from npchip.base.suggest import shown, suggestion
from npchip.isa import Isa, load_isa, read_isa
from npchip.machine import Machine, load_machine

FILE: Final = "npchip.toml"
MAX_BYTES: Final = 1 << 16
_KEYS: Final = ("machine", "isa", "include", "defines")
_CODE: Final = "NP670"


class Settings(NamedTuple):
    """Settings of a project file; the defaults if there is none.

    Attributes:
        file: the project file; None if there is none.
        machine: name or file of the machine; None if the project does not say.
        isa: file of the instruction set; None for the built-in one.
        include: folders besides the source's own from which ``.include`` may take files.
        defines: values for ``.equ`` constants.
    """

    file: Path | None = None
    machine: str | Path | None = None
    isa: Path | None = None
    include: tuple[Path, ...] = ()
    defines: Mapping[str, int] = MappingProxyType({})

    def load_isa(self) -> Isa:
        """Return the instruction set.

        Raises:
            IsaError: its file cannot be used.
        """
        return load_isa() if self.isa is None else read_isa(self.isa)

    def load_machine(self, isa: Isa) -> Machine:
        """Return the machine.

        Raises:
            InputError: its file cannot be used.
        """
        return load_machine(self.machine or "default", isa.timing_classes)


def settings_for(source: Path) -> Settings:
    """Return the settings of the nearest project file upward of a source.

    Raises:
        InputError: NP670, the project file cannot be used.
    """
    file = find(source)
    return Settings() if file is None else read_settings(file)


def find(source: Path) -> Path | None:
    """Return the nearest project file upward of a source or a folder, if there is one."""
    start = source.resolve()
    for folder in (start, *start.parents) if start.is_dir() else start.parents:
        file = folder / FILE
        try:
            if file.is_file():
                return file
        except OSError:  # a folder that may not be looked into
            continue
    return None


def read_settings(file: Path) -> Settings:
    """Return what a project file says; its paths are relative to it.

    Raises:
        InputError: NP670, it cannot be read, or has an unknown key or a wrong value.
    """
    try:
        text = read_bytes(file, MAX_BYTES).decode()
    except OSError as error:
        raise InputError(_CODE, f"cannot read {file}: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise InputError(_CODE, f"{file}: not UTF-8 text at byte {error.start}") from None
    return parse_settings(text, file)


def parse_settings(text: str, file: Path) -> Settings:
    """Return what the text of a project file says; errors as for `read_settings`."""
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise _wrong(file, text, None, f"not TOML: {error}") from None
    for key in data:
        if key not in _KEYS:
            message = f"a project has no {key}: it takes {', '.join(_KEYS)}"
            raise _wrong(file, text, key, message, suggestion(key, _KEYS))
    folder = file.parent
    machine, isa = (_text(data, key, file, text) for key in ("machine", "isa"))
    include = data.get("include", [])
    if not isinstance(include, list) or not all(isinstance(item, str) for item in include):
        message = f"include: expected a list of folders, found {shown(include)}"
        raise _wrong(file, text, "include", message)
    return Settings(
        file,
        folder / machine if machine and machine.endswith((".yaml", ".yml")) else machine,
        isa if isa is None else folder / isa,
        tuple(folder / item for item in include),
        _defines(data.get("defines", {}), file, text),
    )


def _text(data: Mapping[str, Any], key: str, file: Path, text: str) -> str | None:
    value = data.get(key)
    if value is not None and (not isinstance(value, str) or not value):
        raise _wrong(file, text, key, f"{key}: expected a text, found {shown(value)}")
    return value


def _defines(data: Any, file: Path, text: str) -> dict[str, int]:
    if not isinstance(data, dict):
        raise _wrong(file, text, "defines", f"defines: expected a table, found {shown(data)}")
    for name, value in data.items():
        if not isinstance(value, int) or isinstance(value, bool):
            message = f"defines.{name}: expected a whole number, found {shown(value)}"
            raise _wrong(file, text, name, message)
    return data


def _wrong(
    file: Path, text: str, key: str | None, message: str, hint: str | None = None
) -> InputError:
    """Make an error that names the line of a key, by the first line that begins with it."""
    lines = text.splitlines()
    number = next((n for n, line in enumerate(lines, 1) if key and line.strip().startswith(key)), 1)
    return InputError(_CODE, f"{file}:{number}: {message}", hint=hint)
