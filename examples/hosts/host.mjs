/* Run a program that `npchip asm` compiled on a clip, and print the JSON of the run.
 *
 * node host.mjs PROGRAM.wasm CLIP.npy [--max-cycles N] [--partner PROGRAM.wasm CLIP.npy] [--state]
 *
 * --max-cycles stops a frame that takes more (default: 50,000,000). --partner runs another program
 * first; this one then receives what its outputs had in the same frame. --state adds the chip's
 * state at the end. docs/module.md describes the program's file, docs/json.md what is printed. */
import { readFileSync } from 'node:fs';

const list = (length, at) => Array.from({ length }, (_, i) => at(i));
const grid = (rows, cols, at) => list(rows, (r) => list(cols, (c) => at(r, c)));

/** Return a frame's sends as an output: { value, numbers }, or { error } if it is broken. */
function evaluate({ port, kind }, sends, rows, cols) {
  const side = { plane: 1, picture: 8 }[kind]; // of an NP's square of pixels, each a send
  let counted = sends.filter((send) => send.port === port && (side || send.active.length > 0));
  if (kind === 'scalar' || kind === 'plane') counted = counted.slice(-1);
  if (counted.length === 0) return { value: null };
  if (counted.length !== ({ scalar16: 2, picture: 64 }[kind] ?? counted.length))
    return { error: { code: 'NP311', address: counted.at(-1).address } };
  const pixel = (row, col) => counted[row % side * side + col % side]
    .bytes[Math.floor(row / side) * cols + Math.floor(col / side)];
  if (side) return { value: grid(side * rows, side * cols, pixel) };
  const unequal = counted.find(({ active }) => active.some((byte) => byte !== active[0]));
  if (unequal) return { error: { code: 'NP310', address: unequal.address } };
  const numbers = counted.map(({ active }) => active[0]); // what a partner would receive
  return { value: kind === 'list' ? numbers : numbers[0] + 256 * (numbers[1] ?? 0), numbers };
}

/** Run a program to its end. `heard(port, frame)` has the bytes that a partner sent, if any. */
function runProgram(path, clipPath, limit, heard) {
  let about, chip, bytes, view; // of the form of the program that is running
  let sends, taken; // what the present frame sent; how many bytes a frame took from a port
  const frames = []; // the setup, then the frames
  let saved = { bytes: [], block: 0, frames: 0 }; // what to go back to: at first the beginning
  const word = (address) => view.getUint32(address, true);
  const long = (address) => Number(view.getBigUint64(address, true));
  const get = (name) => name in about.words ? word(about.words[name]) : long(about.longs[name]);
  const set = (values) => Object.entries(values).forEach(([name, value]) => name in about.words
    ? view.setUint32(about.words[name], value, true)
    : view.setBigUint64(about.longs[name], BigInt(value), true));
  const plane = (address) => bytes.slice(address, address + about.np_rows * about.np_cols);
  const overLimit = (block) => get('cycles') >= limit + (about.blocks[block].exposes ? 1 : 0);

  function load(module) { // so that it goes on from what was saved
    about = JSON.parse(Buffer.from(WebAssembly.Module.customSections(module, 'npchip')[0]));
    if (about.version !== 1) throw new Error(`${path}: version ${about.version} is not known`);
    chip = new WebAssembly.Instance(module, { host: { ask } }).exports;
    [bytes, view] = [new Uint8Array(chip.memory.buffer), new DataView(chip.memory.buffer)];
    bytes.set(saved.bytes);
    set({ closed: 0, log_end: about.log, data_end: about.data });
    set({ frame: about.frames.first, check: limit, first_check: limit });
    [frames.length, sends, taken] = [saved.frames, [], {}];
  }

  function ask(request, block) {
    const { tick, receive, refill } = about.requests;
    if (request === tick) {
      set({ check: get('cycles') + 1 }); // if it goes on: an EXPOSE may come just at the limit
      return Number(overLimit(block));
    }
    if (request === receive) {
      const key = [about.blocks[block].port, get('taken') + get('position') - 1];
      const byte = heard?.(...key)?.[taken[key] ??= 0];
      if (byte === undefined) return 0;
      taken[key]++;
      bytes.fill(byte, about.planes.received, about.planes.received + about.stride);
      return 1;
    }
    takeFrames(); // for a refill, or because the log is full
    const next = get('taken') + get('available'); // the next frame of the clip
    const { bytes: size, capacity, ring } = about.frames;
    const number = Math.min(capacity, pixels.length / size - next);
    if (request !== refill || number <= 0 || frames.at(-1).error) return 0;
    chip.complete(block); // only then is the state in memory, ready to be saved
    saved = { bytes: bytes.slice(0, about.state_end), block, frames: frames.length };
    bytes.set(pixels.subarray(next * size, (next + number) * size), ring);
    set({ taken: next, position: 0, available: number });
    return 1;
  }

  function takeFrames() {
    let start = about.log - 4 * sends.length; // as if those that were taken before were still there
    for (let at = about.log, data = about.data; at < get('log_end'); at += 4) {
      const { address, port, planes } = about.sites[word(at) >>> 8];
      const sent = planes > 0 ? plane(data) : plane(0).fill(word(at) & 255);
      const isActive = (_, np) => planes < 2 || bytes[data + about.stride + np] > 0;
      sends.push({ address, port, bytes: sent, active: sent.filter(isActive) });
      data += planes * about.stride;
    }
    for (let i = 0, record = about.records; i < get('closed'); i++, record += 24) {
      const end = word(record + 16);
      endFrame(long(record), long(record + 8), true, sends.splice(0, (end - start) / 4));
      start = end;
    }
    set({ closed: 0, log_end: about.log, data_end: about.data });
  }

  function endFrame(cycles, instructions, complete, sent) {
    // A frame that broke a rule is the last. Without instructions there was none, but a setup.
    if (frames.at(-1)?.error || complete && instructions === 0 && frames.length > 0) return;
    const results = outputs
      .filter(({ port, unnamed }) => !unnamed || sent.some((send) => send.port === port))
      .map((output) => ({ ...output, ...evaluate(output, sent, np_rows, np_cols) }));
    const error = results.find((result) => result.error)?.error;
    const values = results.filter(({ unnamed }) => !error || !unnamed)
      .map(({ name, value }) => [name, error ? null : value]);
    frames.push({ cycles, instructions, outputs: Object.fromEntries(values),
      results: error ? [] : results, error: complete && error, complete: complete && !error });
  }

  const module = new WebAssembly.Module(readFileSync(path));
  load(module);
  const { np_rows, np_cols } = about;
  const clip = readFileSync(clipPath);
  const pixels = clip.subarray(10 + clip.readUInt16LE(8)); // what is behind the header
  if (![`, ${8 * np_rows}, ${8 * np_cols})`, "'|u1'"].every((text) => clip.includes(text)))
    throw new Error(`${clipPath} is not uint8 of shape (n, ${8 * np_rows}, ${8 * np_cols})`);
  const isUsed = (key, value) => about.outputs.some((output) => output[key] === value);
  const unnamed = list(16, (port) => ({ port, kind: 'plane', unnamed: true,
    name: isUsed('name', `port${port}`) ? `port${port}_` : `port${port}` }));
  const outputs = about.outputs.concat(unnamed.filter(({ port }) => !isUsed('port', port)));

  let block = chip.run(0);
  if (about.form === 'run' && overLimit(block)) {
    // It may have gone too far. The stepping form stops just before the right instruction.
    const place = ({ address, stack, depth }) => JSON.stringify([address, stack, depth]);
    const start = place(about.blocks[saved.block]);
    load(new WebAssembly.Module(WebAssembly.Module.customSections(module, 'npchip.step')[0]));
    block = chip.run(about.blocks.findIndex((other) => place(other) === start));
  }
  takeFrames();

  const { address, stack = [], depth = 0, exit, port } = about.blocks[block];
  const { status, code, cycles = 0 } = overLimit(block) ? { status: 'cycle-limit' }
    : exit ?? (port === undefined ? { status: 'frames-exhausted' } : { code: 'NP306' });
  const halted = Number(status === 'halted'); // the HALT is executed, so it counts
  if (status !== 'frames-exhausted')
    endFrame(get('cycles') + cycles, get('instructions') + halted, halted > 0, sends);
  // A broken rule ended the run earlier. Only the state is a later one: it would take going back.
  const error = frames.at(-1).error || code && { code, address };
  const [setup, ...rest] = frames;
  for (const { name } of outputs) // a port without a name that one frame sent to is in all of them
    if (rest.some((frame) => name in frame.outputs))
      rest.forEach((frame) => { frame.outputs[name] ??= null; });
  const total = (key) => frames.reduce((sum, frame) => sum + frame[key], 0);
  const entry = ({ cycles, outputs, complete }, index) => // JSON omits what is undefined
    ({ index, cycles, outputs, complete: complete ? undefined : false });
  const document = { program: about.program, machine: about.machine,
    status: error ? 'failed' : status, error, instructions: total('instructions'),
    cycles: total('cycles'), setup: entry(setup), frames: rest.map(entry) };
  const tables = (name, number, largest = 255) => list(number, (i) => {
    const values = plane(about.planes[name] + i * about.stride);
    return grid(np_rows, np_cols, (r, c) => Math.min(values[r * np_cols + c], largest));
  });
  chip.complete(block);
  const state = { address: address + halted, stack, depth, registers: tables('registers', 16),
    zero: tables('zero', 1, 1)[0], carry: tables('carry', 1, 1)[0],
    masks: tables('masks', depth, 1), memory: tables('memory', about.memory_bytes) };
  const sent = (port, frame) => rest[frame]?.results.find((one) => one.port === port)?.numbers;
  return { document, state, sent };
}

const args = process.argv.slice(2);
const option = (name, number) => // its values, which are taken out of the arguments
  args.includes(name) ? args.splice(args.indexOf(name), 1 + number).slice(1) : undefined;
const limit = Number(option('--max-cycles', 1) ?? 50_000_000);
const [partner, showsState] = [option('--partner', 2), option('--state', 0)];
const heard = partner && runProgram(...partner, limit).sent;
const { document, state } = runProgram(...args, limit, heard);
console.log(JSON.stringify(showsState ? { ...document, state } : document));
