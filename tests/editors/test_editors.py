"""Colours against the assembler's own tokens; errors that editors find; completion in bash."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import pytest
from click.shell_completion import ShellComplete
from click.testing import CliRunner
from pygments.lexers import get_lexer_by_name, guess_lexer_for_filename
from pygments.token import Token as AnyToken

from npchip.assembler.diagnostics import Diagnostic, Line
from npchip.assembler.lexer import Kind, tokenize
from npchip.cli.main import COMMANDS, cli
from npchip.editors.pygments import NpchipLexer
from npchip.editors.rules import rules
from npchip.editors.textmate import grammar
from npchip.isa import load_isa
from tests.support.programs import ODD

ROOT = Path(__file__).parents[2]
EXTENSION = ROOT / "docs" / "editors" / "vscode"
GRAMMAR = EXTENSION / "npchip.tmLanguage.json"
SOURCES = sorted((ROOT / "asm").glob("*.s"))


def colours(text: str) -> list[tuple[str, str]]:
    """Pygments' words and kinds without blanks, comments and strings as the assembler has them."""
    return [
        (word, str(kind).removeprefix("Token."))
        for kind, word in NpchipLexer().get_tokens(text)
        if word.strip()
    ]


def scopes(line: str) -> Iterator[tuple[str, str]]:
    """Colour a line as a TextMate editor does: the first match counts, of two the first rule."""
    patterns = json.loads(grammar(load_isa()))["patterns"]
    position = 0
    while True:
        found = [
            (match.start(), number, match)
            for number, rule in enumerate(patterns)
            if (match := re.compile(rule["match"], re.ASCII).search(line, position))
        ]
        if not found:
            return
        _, number, match = min(found, key=lambda item: item[:2])
        yield match[0], patterns[number]["name"]
        position = match.end()


EXPECTED = {
    Kind.NUMBER: {"Literal.Number", "Literal.String.Char"},
    Kind.STRING: {"Literal.String.Double"},
    Kind.SIGN: {"Operator", "Punctuation"},
    Kind.DOTTED: {"Keyword.Declaration", "Name.Label"},
    Kind.NAME: {
        "Keyword",
        "Name",
        "Name.Builtin",
        "Name.Constant",
        "Name.Label",
        "Name.Variable",
    },
}


@pytest.mark.parametrize("text", [*(p.read_text() for p in SOURCES), ODD], ids=lambda t: t[:20])
def test_words_and_kinds_are_those_of_the_assembler(text: str) -> None:
    found = [(word, kind) for word, kind in colours(text) if kind != "Comment.Single"]
    mistakes: list[Diagnostic] = []
    wanted = [
        token
        for number, line in enumerate(text.split("\n"))
        for token in tokenize(Line("t.s", number, line), mistakes.append)
        if token.kind is not Kind.END
    ]
    assert not mistakes
    assert [word for word, _ in found] == [token.text for token in wanted]
    for (word, kind), token in zip(found, wanted, strict=True):
        assert kind in EXPECTED[token.kind], word


@pytest.mark.parametrize("text", [*(p.read_text() for p in SOURCES), ODD], ids=lambda t: t[:20])
def test_the_grammar_sees_what_the_lexer_sees(text: str) -> None:
    found = [item for line in text.split("\n") for item in scopes(line)]
    seen = colours(text)
    assert [word for word, _ in found] == [word for word, _ in seen]
    pairs = {(kind, scope) for (_, kind), (_, scope) in zip(seen, found, strict=True)}
    assert len(pairs) == len({kind for kind, _ in pairs}) == len({scope for _, scope in pairs})


def test_kinds_of_words() -> None:
    kinds = dict(colours(ODD))
    assert kinds["mov"] == kinds["JALL"] == "Keyword"
    assert kinds[".EQU"] == kinds[".macro"] == "Keyword.Declaration"
    assert kinds["start"] == kinds[".local"] == "Name.Label"
    assert kinds["R15"] == "Name.Variable"
    assert kinds["cs"] == "Name.Builtin"
    assert kinds["signal"] == kinds["north"] == kinds["scalar16"] == "Name.Constant"
    assert kinds["SIGNAL"] == kinds["twice"] == "Name"
    assert kinds["; comment ; more"] == "Comment.Single"


def test_every_instruction_and_condition_has_its_colour() -> None:
    isa = load_isa()
    for name in isa.forms:
        assert colours(name) == [(name, "Keyword")]
    for name in isa.condition_names:
        assert colours(name) == [(name, "Name.Builtin")]
    assert len({rule.kind for rule in rules(isa)}) == 13


def test_what_has_no_meaning_is_an_error() -> None:
    assert [kind for _, kind in colours("MOV r0, $5")][-2] == "Error"
    assert AnyToken.Error in dict(NpchipLexer().get_tokens("@"))


def test_pygments_finds_the_lexer() -> None:
    declared = entry_points(group="pygments.lexers", name="npchip")
    if not declared:
        pytest.skip("installed before the lexer was there")
    assert {item.value for item in declared} == {"npchip.editors.pygments:NpchipLexer"}
    assert isinstance(get_lexer_by_name("npchip"), NpchipLexer)
    for path in SOURCES:
        assert isinstance(guess_lexer_for_filename(path.name, path.read_text()), NpchipLexer)
    gas = ".text\n.globl main\nmain:\n\tmovq %rax, %rbx\n\tret\n"
    assert not isinstance(guess_lexer_for_filename("x.s", gas), NpchipLexer)
    assert NpchipLexer.analyse_text(gas) == 0


def test_the_grammar_that_is_checked_in() -> None:
    result = CliRunner().invoke(cli, ["isa", "--textmate"])
    assert result.exit_code == 0
    assert GRAMMAR.read_text(encoding="utf-8") == result.output
    package = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    contributed = package["contributes"]
    named = [*contributed["languages"], *contributed["grammars"]]
    files = [item[key] for item in named for key in ("configuration", "path") if key in item]
    assert len(files) == 2
    for file in files:
        json.loads((EXTENSION / file).read_text(encoding="utf-8"))
    assert contributed["grammars"][0]["scopeName"] == "source.npchip"


# --- errors to jump to --------------------------------------------------------------------------

BROKEN = "loop:   MOV     r0, 64\n        ADDD    r1, #1\n        RET\n"


@pytest.fixture
def broken(tmp_path: Path) -> Path:
    path = tmp_path / "broken.s"
    path.write_text(BROKEN)
    return path


def errors(path: Path) -> str:
    result = CliRunner().invoke(cli, ["asm", str(path)])
    assert result.exit_code == 2
    return result.stderr


def test_vs_code_finds_the_errors(broken: Path) -> None:
    package = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
    (matcher,) = package["contributes"]["problemMatchers"]
    pattern = matcher["pattern"]
    found = [m for line in errors(broken).split("\n") if (m := re.match(pattern["regexp"], line))]
    places = [(m[pattern["file"]], m[pattern["line"]], m[pattern["column"]]) for m in found]
    assert places == [(str(broken), "1", "21"), (str(broken), "2", "9")]
    assert {m[pattern["severity"]] for m in found} == {"error"}
    run_time = re.match(pattern["regexp"], "p.s:9: error: at address 3: no call [NP302]")
    assert run_time
    assert run_time[pattern["line"]] == "9"


@pytest.mark.skipif(shutil.which("vim") is None, reason="no vim here")
def test_vim_finds_the_errors(broken: Path, tmp_path: Path) -> None:
    text = (ROOT / "docs" / "editors.md").read_text(encoding="utf-8")
    form = re.search(r"setlocal errorformat=(.*)", text)
    assert form
    report, listed = tmp_path / "errors", tmp_path / "list"
    report.write_text(errors(broken))
    commands = [
        f"set errorformat={form[1]}",
        f"cgetfile {report}",
        "let found = map(getqflist(), '[v:val.lnum, v:val.col, v:val.type]')",
        f"call writefile([json_encode(found)], '{listed}')",
        "qa!",
    ]
    options = [part for command in commands for part in ("-c", command)]
    subprocess.run(["vim", "-es", "-u", "NONE", "-N", *options], check=False, timeout=30)
    assert json.loads(listed.read_text()) == [[1, 21, "e"], [2, 9, "e"]]


# --- completion ---------------------------------------------------------------------------------


def completions(*words: str) -> list[tuple[str, str]]:
    """(type, value) of what is offered for the last word."""
    *before, incomplete = words
    offered = ShellComplete(cli, {}, "npchip", "_NPCHIP_COMPLETE").get_completions(
        before, incomplete
    )
    return [(item.type, item.value) for item in offered]


def plain(*words: str) -> list[str]:
    found = completions(*words)
    assert {kind for kind, _ in found} <= {"plain"}
    return [value for _, value in found]


def test_commands_and_options_are_completed() -> None:
    assert plain("") == list(COMMANDS)
    assert plain("com") == ["compare", "completion"]
    assert plain("--ver") == ["--version"]
    assert plain("compare", "--ch") == ["--chart"]
    assert plain("run", "x.s", "--define", "HALF", "--mach") == ["--machine"]
    assert plain("scene", "--shape", "d") == ["dot", "disc"]
    assert plain("completion", "") == ["bash", "zsh", "fish"]
    assert plain("nosuch", "--x") == []


def test_machines_and_mnemonics_are_completed() -> None:
    assert plain("run", "--machine", "con") == ["conservative"]
    assert plain("compare", "--machine", "default,con") == ["default,conservative"]
    assert plain("machine", "def") == ["default"]
    assert plain("isa", "ja") == ["JANY", "JALL"]
    assert {*plain("isa", "")} == {*load_isa().forms}


@pytest.mark.parametrize(
    "words",
    [
        ("run", "asm/tra"),
        ("run", "x.s", "--frames", "examples/"),
        ("run", "--machine", "my"),
        ("compare", "a.s", "asm/"),
        ("asm", "asm/"),
        ("disasm", "x"),
        ("scene", "exa"),
        ("scene", "-o", "x"),
    ],
)
def test_files_are_left_to_the_shell(words: tuple[str, ...]) -> None:
    assert [kind for kind, _ in completions(*words)] == ["file"]


def test_completing_a_command_imports_nothing_heavy() -> None:
    code = (
        "import sys; from npchip.cli.main import cli\n"
        "from click.shell_completion import ShellComplete\n"
        "found = ShellComplete(cli, {}, 'npchip', 'X').get_completions([], 'r')\n"
        "assert found[0].value == 'run' and found[0].help\n"
        "print(sorted({'numpy', 'rich', 'yaml', 'PIL'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


@pytest.mark.parametrize(
    ("shell", "sign"), [("bash", "complete -o"), ("zsh", "#compdef npchip"), ("fish", "--command")]
)
def test_scripts_of_the_shells(shell: str, sign: str) -> None:
    result: Any = CliRunner().invoke(cli, ["completion", shell])
    assert result.exit_code == 0
    assert sign in result.output
    assert f"_NPCHIP_COMPLETE={shell}_complete" in result.output


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash here")
def test_bash_itself_completes(tmp_path: Path) -> None:
    command = tmp_path / "npchip"
    command.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m npchip "$@"\n')
    command.chmod(0o755)
    script = (
        f'PATH="{tmp_path}:$PATH"\n'
        "source <(npchip completion bash)\n"
        "COMP_WORDS=(npchip run --machine con); COMP_CWORD=3\n"
        '_npchip_completion npchip; echo "${COMPREPLY[@]}"\n'
    )
    done = subprocess.run(
        ["bash", "--norc", "-c", script], capture_output=True, text=True, check=False, timeout=60
    )
    assert done.stdout == "conservative\n", done.stderr
