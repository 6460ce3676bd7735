"""The debug adapter, ``npchip dap``: `npchip.debugger` behind the Debug Adapter Protocol."""
