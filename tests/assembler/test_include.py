"""``.include``: which files may be read, and what is said of those that may not."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from npchip.assembler import AssemblyError, assemble, assemble_text

HALF = ".macro half a\nSHR a, #1\n.endm\n"


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def code(path: Path, *folders: Path) -> str:
    with pytest.raises(AssemblyError) as caught:
        assemble(path, include_paths=folders)
    return caught.value.diagnostics[0].code


def test_relative_to_the_including_file(tmp_path: Path) -> None:
    write(tmp_path / "lib" / "deep" / "half.s", HALF)
    write(tmp_path / "lib" / "all.s", '.include "deep/half.s"\n.equ LIMIT, 7\n')
    main = write(tmp_path / "main.s", '.include "lib/all.s"\nhalf r1\nMOV r0, #LIMIT\nHALT\n')
    program = assemble(main)
    assert program.words == assemble_text("SHR r1, #1\nMOV r0, #7\nHALT").words
    assert program.source[0].file == str(tmp_path / "lib" / "deep" / "half.s")
    assert program.source[0].written_at.file == str(main)


def test_code_of_an_included_file_is_written_there(tmp_path: Path) -> None:
    write(tmp_path / "tail.s", "half: SHR r0, #1\nRET\n")
    main = write(tmp_path / "main.s", 'CALL half\nHALT\n.include "tail.s"\n')
    program = assemble(main)
    assert program.source[2].written_at is program.source[2]
    assert (program.source[2].file, program.source[2].line) == (str(tmp_path / "tail.s"), 1)
    assert program.labels == {"half": 2}


def test_local_labels_do_not_cross_files(tmp_path: Path) -> None:
    write(tmp_path / "inner.s", ".x: NOP\nJMP .x\n")
    main = write(tmp_path / "main.s", 'a: .x: NOP\n.include "inner.s"\nJMP .x\n')
    assert [word & 0x1FF for word in assemble(main).words] == [0x1A, 0x1A, 1, 0]


def test_a_file_may_come_twice_and_guard_itself(tmp_path: Path) -> None:
    write(tmp_path / "one.s", "ADD r0, #1\n")
    write(tmp_path / "guarded.s", ".ifndef GUARD\n.equ GUARD, 1\nSUB r0, #1\n.endif\n")
    text = '.include "one.s"\n.include "guarded.s"\n' * 2 + "HALT\n"
    assert len(assemble(write(tmp_path / "main.s", text)).words) == 4


def test_only_what_a_condition_takes_is_read(tmp_path: Path) -> None:
    main = write(tmp_path / "main.s", '.if 0\n.include "missing.s"\n.endif\nHALT\n')
    assert len(assemble(main).words) == 1


def test_outside_the_tree(tmp_path: Path) -> None:
    outside = write(tmp_path / "lib" / "half.s", HALF)
    for name in ("../lib/half.s", str(outside), "../none.s", "../../../../etc/passwd"):
        main = write(tmp_path / "main" / "main.s", f'.include "{name}"\nhalf r0\nHALT\n')
        assert code(main) == "NP028"
    main = write(tmp_path / "main" / "main.s", '.include "half.s"\nhalf r0\nHALT\n')
    assert code(main) == "NP027"
    assert len(assemble(main, include_paths=[tmp_path / "lib"]).words) == 2
    main = write(tmp_path / "main" / "main.s", '.include "../lib/half.s"\nhalf r0\nHALT\n')
    assert len(assemble(main, include_paths=[tmp_path / "lib"]).words) == 2


def test_the_including_file_comes_before_the_include_paths(tmp_path: Path) -> None:
    for folder, count in (("own", 1), ("first", 2), ("second", 3)):
        write(tmp_path / folder / "x.s", "NOP\n" * count)
    main = write(tmp_path / "own" / "main.s", '.include "x.s"\nHALT\n')
    folders = [tmp_path / "first", tmp_path / "second"]
    assert len(assemble(main, include_paths=folders).words) == 2
    (tmp_path / "own" / "x.s").unlink()
    assert len(assemble(main, include_paths=folders).words) == 3


def test_a_library_may_include_its_neighbours(tmp_path: Path) -> None:
    write(tmp_path / "lib" / "all.s", '.include "half.s"\n')
    write(tmp_path / "lib" / "half.s", HALF)
    main = write(tmp_path / "main" / "main.s", '.include "all.s"\nhalf r0\nHALT\n')
    assert len(assemble(main, include_paths=[tmp_path / "lib"]).words) == 2


def test_symbolic_links_do_not_lead_out(tmp_path: Path) -> None:
    write(tmp_path / "secret" / "half.s", HALF)
    folder = tmp_path / "main"
    main = write(folder / "main.s", '.include "half.s"\nhalf r0\nHALT\n')
    try:
        (folder / "half.s").symlink_to(tmp_path / "secret" / "half.s")
    except OSError:
        pytest.skip("no symbolic links here")
    assert code(main) == "NP028"
    (folder / "half.s").unlink()
    (folder / "lib").symlink_to(tmp_path / "secret")
    main.write_text('.include "lib/half.s"\nhalf r0\nHALT\n')
    assert code(main) == "NP028"
    (folder / "loop.s").symlink_to(folder / "loop.s")
    main.write_text('.include "loop.s"\nHALT\n')
    assert code(main) == "NP027"


def test_a_main_file_behind_a_link_has_the_tree_of_the_file(tmp_path: Path) -> None:
    write(tmp_path / "real" / "half.s", HALF)
    main = write(tmp_path / "real" / "main.s", '.include "half.s"\nhalf r0\nHALT\n')
    link = tmp_path / "link.s"
    try:
        link.symlink_to(main)
    except OSError:
        pytest.skip("no symbolic links here")
    assert len(assemble(link).words) == 2


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes here")
def test_what_is_no_file(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for name in ("pipe", ".", "main.s/x", "x" * 5000):
        main = write(tmp_path / "main.s", f'.include "{name}"\nHALT\n')
        assert code(main) == "NP027"


def test_cycles(tmp_path: Path) -> None:
    write(tmp_path / "b.s", '.include "a.s"\n')
    assert code(write(tmp_path / "a.s", '.include "b.s"\nHALT\n')) == "NP029"
    (tmp_path / "c").mkdir()
    assert code(write(tmp_path / "d.s", 'NOP\n.include "c/../d.s"\n')) == "NP029"


def test_depth(tmp_path: Path) -> None:
    for index in range(100):
        write(tmp_path / f"f{index}.s", f'NOP\n.include "f{index + 1}.s"\n')
    write(tmp_path / "f100.s", "HALT\n")
    assert code(tmp_path / "f0.s") == "NP014"
    assert len(assemble(tmp_path / "f60.s").words) == 41


def test_total_size(tmp_path: Path) -> None:
    for index in range(3):
        write(tmp_path / f"f{index}.s", "; filler\n" * 12_000)
    text = "".join(f'.include "f{index}.s"\n' for index in range(3)) + "HALT\n"
    assert code(write(tmp_path / "main.s", text)) == "NP027"


def test_a_text_has_no_folder(tmp_path: Path) -> None:
    write(tmp_path / "half.s", HALF)
    text = '.include "half.s"\nhalf r0\nHALT\n'
    with pytest.raises(AssemblyError) as caught:
        assemble_text(text, str(tmp_path / "main.s"))
    assert caught.value.diagnostics[0].code == "NP027"
    assert len(assemble_text(text, include_paths=[tmp_path]).words) == 2


def test_a_mistake_in_an_included_file_names_both(tmp_path: Path) -> None:
    write(tmp_path / "lib.s", "NOP\nMOV r0, 5\n")
    main = write(tmp_path / "main.s", 'NOP\n.include "lib.s"\nHALT\n')
    with pytest.raises(AssemblyError) as caught:
        assemble(main)
    (only,) = caught.value.diagnostics
    assert only.span.line.file == str(tmp_path / "lib.s")
    assert [note.span.line.number for note in only.notes if note.span] == [2]
