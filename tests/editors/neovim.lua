-- What a reader of Neovim asks, written as JSON to the file that REPORT names.

local report = {}
local window, buffer = vim.api.nvim_get_current_win(), vim.api.nvim_get_current_buf()

local function until_(what, condition)
  if not vim.wait(30000, condition, 20) then
    error("waited in vain until " .. what)
  end
end

local function at(line, column)
  vim.api.nvim_win_set_cursor(window, { line, column })
end

local function ask(method, more)
  local parameters = vim.tbl_extend("force", vim.lsp.util.make_position_params(), more or {})
  local answers = assert(vim.lsp.buf_request_sync(buffer, method, parameters, 30000))
  for _, answer in pairs(answers) do
    assert(not answer.err, vim.inspect(answer.err))
    return answer.result
  end
end

local function main()
  until_("there is a mistake", function()
    return #vim.diagnostic.get(buffer) == 1
  end)
  local mistake = vim.diagnostic.get(buffer)[1]
  report.mistake = { mistake.lnum, mistake.col, mistake.message, mistake.source }

  at(4, 8)
  report.hover = ask("textDocument/hover").contents.value
  at(5, 8)
  vim.lsp.buf.definition()
  until_("the macro is shown", function()
    return vim.api.nvim_buf_get_name(0):match("add%.s$")
  end)
  report.definition = vim.api.nvim_win_get_cursor(window)
  vim.api.nvim_win_set_buf(window, buffer)

  at(4, 16)
  report.references = #ask("textDocument/references", { context = { includeDeclaration = true } })
  vim.lsp.buf.rename("total")
  until_("the name is new", function()
    return vim.api.nvim_buf_get_lines(buffer, 2, 3, true)[1]:match("total")
  end)

  at(6, 8)
  local range = { start = { line = 5, character = 8 }, ["end"] = { line = 5, character = 12 } }
  local actions = ask("textDocument/codeAction", { range = range, context = { diagnostics = {} } })
  report.action = actions[1].title
  vim.lsp.util.apply_workspace_edit(actions[1].edit, "utf-16")
  until_("there is no mistake", function()
    return #vim.diagnostic.get(buffer) == 0
  end)

  vim.api.nvim_buf_set_lines(buffer, 6, 7, true, { "  JMP start" })
  vim.lsp.buf.formatting_sync(nil, 30000)
  report.text = vim.api.nvim_buf_get_lines(buffer, 0, -1, true)
  at(7, 16)
  report.completion = vim.tbl_map(function(item)
    return item.label
  end, vim.tbl_islist(ask("textDocument/completion")) and ask("textDocument/completion")
    or ask("textDocument/completion").items)
end

local ok, fault = xpcall(main, debug.traceback)
report.fault = not ok and fault or nil
vim.fn.writefile({ vim.fn.json_encode(report) }, vim.env.REPORT)
vim.cmd("qall!")
