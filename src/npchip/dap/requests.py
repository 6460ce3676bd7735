"""The table of requests, and what the adapter says that it can do."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from npchip.dap import breakpoints, evaluate, memory, pictures, program, stack, stops, variables
from npchip.dap.arguments import Arguments
from npchip.dap.session import Session

Answer = Callable[[Session, Arguments], dict[str, Any]]

SETTING: Final[dict[str, Answer]] = {
    "setBreakpoints": breakpoints.set_lines,
    "setFunctionBreakpoints": breakpoints.set_functions,
    "setInstructionBreakpoints": breakpoints.set_instructions,
    "setDataBreakpoints": breakpoints.set_data,
}
"""Requests that change where the program stops; they interrupt a movement for a moment."""


def choose(session: Session, arguments: Arguments) -> dict[str, Any]:
    """Choose the NP that scopes show.

    Raises:
        InputError: NP351, NP358, there is no such NP.
    """
    session.choose(arguments.number("row"), arguments.number("column"))
    return {"row": session.chosen[0], "column": session.chosen[1]}


def exception(session: Session, _arguments: Arguments) -> dict[str, Any]:
    """Say more of the exception at which the program stands."""
    stop = session.debugger.stop
    return {"exceptionId": stop.reason, "description": stop.message, "breakMode": "always"}


READING: Final[dict[str, Answer]] = {
    "breakpointLocations": breakpoints.locations,
    "loadedSources": stack.sources,
    "source": stack.text,
    "npchip/program": program.program,
}
"""Requests that need the program alone; they are answered even while it moves."""

STILL: Final[dict[str, Answer]] = {
    "stackTrace": stack.stack_trace,
    "disassemble": stack.disassemble,
    "scopes": variables.scopes,
    "variables": variables.variables,
    "setVariable": variables.set_variable,
    "evaluate": evaluate.evaluate,
    "setExpression": evaluate.set_expression,
    "completions": evaluate.completions,
    "dataBreakpointInfo": breakpoints.data_info,
    "exceptionInfo": exception,
    "readMemory": memory.read,
    "writeMemory": memory.write,
    "npchip/picture": pictures.picture,
    "npchip/choose": choose,
}
"""Requests that need a program that stands still."""

CAPABILITIES: Final[dict[str, Any]] = {
    "supportsConfigurationDoneRequest": True,
    "supportsFunctionBreakpoints": True,
    "supportsConditionalBreakpoints": True,
    "supportsHitConditionalBreakpoints": True,
    "supportsLogPoints": True,
    "supportsDataBreakpoints": True,
    "supportsInstructionBreakpoints": True,
    "supportsBreakpointLocationsRequest": True,
    "supportsStepBack": True,
    "supportsSteppingGranularity": True,
    "supportsSetVariable": True,
    "supportsSetExpression": True,
    "supportsEvaluateForHovers": True,
    "supportsClipboardContext": True,
    "supportsCompletionsRequest": True,
    "completionTriggerCharacters": ["."],
    "supportsLoadedSourcesRequest": True,
    "supportsDelayedStackTraceLoading": True,
    "supportsDisassembleRequest": True,
    "supportsReadMemoryRequest": True,
    "supportsWriteMemoryRequest": True,
    "supportsValueFormattingOptions": True,
    "supportsExceptionInfoRequest": True,
    "exceptionBreakpointFilters": [
        {"filter": name, "label": label, "description": description, "default": True}
        for name, (label, description) in stops.FILTERS.items()
    ],
}
