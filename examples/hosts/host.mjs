/**
 * A host of modules that `npchip asm -o PROGRAM.wasm` wrote, for Node: runs one on a clip and prints the result.
 *
 *     node host.mjs PROGRAM.wasm CLIP.npy [--max-cycles N] [--partner PROGRAM.wasm CLIP.npy] [--state]
 *
 * A clip is a NumPy file: uint8 of shape (frames, rows, columns). --max-cycles is the most that a frame may take.
 * --partner runs another program first, whose outputs this program then receives. --state adds the state in which
 * the chip stopped. docs/module.md describes the modules, docs/json.md the JSON.
 */
import { readFileSync } from 'node:fs';

/** An output that its frame's sends do not make; `address` is that of the `OUT`. */
class BrokenRule extends Error {
  constructor(code, { address }) {
    super();
    Object.assign(this, { code, address });
  }
}

/** Read the frames of a clip, each as bytes row by row. */
function readClip(path) {
  const file = readFileSync(path);
  const start = 10 + file.readUInt16LE(8); // behind the header, in version 1 of the format
  const shape = /'\|u1', 'fortran_order': False, 'shape': \((\d+), (\d+), (\d+)\)/.exec(file.latin1Slice(0, start));
  if (!shape) throw new Error(`${path} is not a clip`);
  const size = shape[2] * shape[3];
  return Array.from({ length: shape[1] }, (_, k) => file.subarray(start + k * size, start + (k + 1) * size));
}

/** Compile a module, and read its description. */
function load(binary) {
  const module = new WebAssembly.Module(binary);
  const [description] = WebAssembly.Module.customSections(module, 'npchip');
  return { module, ...JSON.parse(new TextDecoder().decode(description)) };
}

/** Return what a block has in common with the same block of the other form. */
const placeOf = ({ address, stack = [], depth = 0 }) => JSON.stringify([address, stack, depth]);

/** Cut a plane or picture into its rows. */
const rowsOf = (bytes, columns) =>
  Array.from({ length: bytes.length / columns }, (_, r) => [...bytes.subarray(r * columns, (r + 1) * columns)]);

/** Choose the planes or numbers that an output is made of from a frame's sends to its port. */
function partsOf(kind, sends) {
  const exactly = (number, found) => {
    if (found.length && found.length !== number) throw new BrokenRule('NP311', found.at(-1));
    return found;
  };
  if (kind === 'plane') return sends.slice(-1).map((send) => send.bytes);
  if (kind === 'picture') return exactly(64, sends).map((send) => send.bytes);
  let heard = sends.filter(({ active }) => !active || active.includes(255));
  if (kind === 'scalar') heard = heard.slice(-1);
  if (kind === 'scalar16') heard = exactly(2, heard);
  return heard.map((send) => {
    const numbers = send.active ? send.bytes.filter((_, np) => send.active[np]) : send.bytes;
    if (numbers.some((number) => number !== numbers[0])) throw new BrokenRule('NP310', send);
    return numbers[0];
  });
}

/** Make the value of an output of its parts. */
function valueOf(kind, parts, { np_rows: rows, np_cols: cols }) {
  if (!parts?.length) return null;
  if (kind === 'list') return parts;
  if (kind === 'scalar' || kind === 'scalar16') return parts[0] + 256 * (parts[1] ?? 0);
  if (kind === 'plane') return rowsOf(parts[0], cols);
  return Array.from({ length: 8 * rows }, (_, y) => Array.from({ length: 8 * cols }, (_, x) =>
    parts[8 * (y % 8) + (x % 8)][(y >> 3) * cols + (x >> 3)]));
}

/** Run one form of a program: from the beginning, or from the state that was `saved` at a refill. */
function execute(form, clip, limit, partner, saved) {
  const { words, longs, planes, requests, blocks, stride, frames: { first, ring, capacity } } = form;
  const size = form.np_rows * form.np_cols;
  const { memory, run, complete } = new WebAssembly.Instance(form.module, { host: { ask } }).exports;
  const bytes = new Uint8Array(memory.buffer); // for good, as the memory never grows
  const view = new DataView(memory.buffer);
  const word = (name) => view.getUint32(words[name], true);
  const long = (name) => Number(view.getBigUint64(longs[name], true));
  const set = (values) => Object.entries(values).forEach(([name, value]) => (name in words
    ? view.setUint32(words[name], value, true) : view.setBigUint64(longs[name], BigInt(value), true)));
  const clearLog = () => set({ closed: 0, log_end: form.log, data_end: form.data });
  let { frames, next } = saved ?? { frames: [], next: 0 }; // the first of the frames is the setup
  let sent = []; // by the present frame, as far as it was taken from the log
  let broken; // the first rule that a complete frame broke: it ends the run
  const received = {}; // number of bytes by frame and port

  function closeFrame(cycles, instructions, complete) {
    const frame = { cycles, instructions, complete, parts: {} };
    try {
      for (const port of new Set(form.outputs.map((output) => output.port).concat(sent.map((send) => send.port)))) {
        const { kind } = form.outputs.find((output) => output.port === port) ?? { kind: 'plane' };
        frame.parts[port] = partsOf(kind, sent.filter((send) => send.port === port));
      }
    } catch (error) {
      if (!(error instanceof BrokenRule)) throw error;
      if (complete) broken = error;
      Object.assign(frame, { complete: false, parts: {} });
    }
    frames.push(frame);
    sent = [];
  }

  /** Take the complete frames, and what the present one has sent. */
  function takeFrames() {
    let [entry, data, record] = [form.log, form.data, form.records];
    const takeSends = (end) => {
      for (; entry < end; entry += 4) {
        const { port, address, planes: number } = form.sites[view.getUint32(entry, true) >>> 8];
        const found = Array.from({ length: number }, (_, k) => bytes.slice(data + k * stride, data + k * stride + size));
        data += number * stride;
        sent.push({ port, address, bytes: found[0] ?? new Uint8Array(size).fill(bytes[entry]), active: found[1] });
      }
    };
    for (let closed = word('closed'); closed > 0; closed--, record += 24) {
      takeSends(view.getUint32(record + 16, true));
      const [cycles, instructions] = [0, 8].map((offset) => Number(view.getBigUint64(record + offset, true)));
      if (instructions || !frames.length) closeFrame(cycles, instructions, true); // others never were
    }
    takeSends(word('log_end'));
    clearLog();
  }

  function refill(block) {
    takeFrames();
    if (broken || next === clip.length) return 0;
    // The stepping form takes one frame at a time, so that it stops in the state in which a rule was broken.
    const number = Math.min(form.form === 'run' ? capacity : 1, clip.length - next);
    complete(block);
    saved = { state: bytes.slice(0, form.state_end), place: placeOf(blocks[block]), frames: [...frames], next };
    for (let k = 0; k < number; k++) bytes.set(clip[next++], ring + k * form.frames.bytes);
    set({ taken: long('taken') + word('available'), position: 0, available: number });
    return 1;
  }

  function receive(port) {
    const frame = long('taken') + word('position'); // 1 is the first frame, 0 the setup, which receives nothing
    const index = received[[frame, port]] ?? 0;
    const part = frame > 0 ? partner?.frames[frame]?.parts[port]?.[index] : undefined;
    if (part === undefined) return 0;
    received[[frame, port]] = index + 1;
    bytes.set(typeof part === 'number' ? new Uint8Array(size).fill(part) : part, planes.received);
    return 1;
  }

  /** Return whether the frame has broken the limit: at just the limit an `EXPOSE` may come, and nothing else. */
  const isOver = (block) => long('cycles') >= limit + (blocks[block].exposes ? 1 : 0);

  function tick(block) {
    if (isOver(block)) return 1;
    set({ check: long('cycles') + 1 });
    return 0;
  }

  function ask(request, block) {
    if (request === requests.refill) return refill(block);
    if (request === requests.receive) return receive(blocks[block].port);
    return request === requests.tick ? tick(block) : takeFrames();
  }

  if (saved) bytes.set(saved.state);
  clearLog();
  set({ frame: first, check: limit, first_check: limit });
  const last = run(saved ? blocks.findIndex((block) => block.exposes && placeOf(block) === saved.place) : 0);
  takeFrames();
  const stopped = isOver(last);
  if (form.form === 'run' && (stopped || broken)) return { saved }; // too late: only the stepping form stops in time
  complete(last);
  const { address, stack = [], depth = 0, exposes, port, exit } = blocks[last];
  const often = received[[long('taken') + word('position'), port]];
  const unheard = `no partner has sent ${often ? `more than ${often} bytes in this frame` : 'anything'} to port ${port}`;
  const end = stopped ? { status: 'cycle-limit' } : exit ?? (exposes ? { status: 'frames-exhausted' }
    : { status: 'failed', code: 'NP306', message: unheard });
  const halted = end.status === 'halted' ? 1 : 0; // its instruction is not counted yet
  if (end.status !== 'frames-exhausted')
    closeFrame(long('cycles') + (halted && end.cycles), long('instructions') + halted, halted === 1);
  const error = broken ? { code: broken.code, message: null, address: broken.address }
    : { code: end.code, message: `at address ${address}: ${end.message}`, address };
  const planesAt = (start, number, unit = 1) => Array.from({ length: number }, (_, k) =>
    rowsOf(bytes.slice(start + k * stride, start + k * stride + size).map((byte) => byte / unit), form.np_cols));
  const state = () => ({ address: address + halted, stack, depth, registers: planesAt(planes.registers, 16),
    zero: planesAt(planes.zero, 1, 255)[0], carry: planesAt(planes.carry, 1, 255)[0],
    masks: planesAt(planes.masks, depth, 255), memory: planesAt(planes.memory, form.memory_bytes) });
  return { form, status: broken ? 'failed' : end.status, error, frames, state };
}

/** Run a program to its end: in the fast form and, if a frame broke a limit or a rule, again from the last refill. */
function runProgram(limit, program, clipPath, partner) {
  const [form, clip] = [load(readFileSync(program)), readClip(clipPath)];
  const result = execute(form, clip, limit, partner);
  if (result.status) return result;
  const [stepping] = WebAssembly.Module.customSections(form.module, 'npchip.step');
  return execute(load(stepping), clip, limit, partner, result.saved);
}

/** Make the document that docs/json.md describes. JSON leaves out keys that are undefined. */
function documentOf({ form, status, error, frames: [setup, ...frames] }) {
  const sum = (key) => frames.reduce((total, frame) => total + frame[key], setup[key]);
  const isNew = (name) => !form.outputs.some((output) => output.name === name);
  const nameOf = (port) => { let name = `port${port}`; while (!isNew(name)) name += '_'; return name; };
  const outputsOf = (some) => { // of the ports without a name those that were used
    const ports = [...new Set(some.flatMap((frame) => Object.keys(frame.parts)))].map(Number).sort((a, b) => a - b);
    return [...form.outputs, ...ports.filter((port) => !form.outputs.some((output) => output.port === port))
      .map((port) => ({ name: nameOf(port), port, kind: 'plane' }))];
  };
  const entry = ({ cycles, parts, complete }, outputs) => ({ cycles, outputs: Object.fromEntries(outputs.map(
    ({ name, port, kind }) => [name, valueOf(kind, parts[port], form)])), complete: complete ? undefined : false });
  const all = outputsOf(frames);
  return { program: form.program, machine: form.machine, status, error: status === 'failed' ? error : undefined,
    instructions: sum('instructions'), cycles: sum('cycles'), setup: entry(setup, outputsOf([setup])),
    frames: frames.map((frame, index) => ({ index, ...entry(frame, all) })) };
}

const [program, clip, ...args] = process.argv.slice(2);
const option = (name, values) => (args.includes(name) ? args.splice(args.indexOf(name), 1 + values).slice(1) : null);
const limit = Number(option('--max-cycles', 1) ?? 50_000_000);
const other = option('--partner', 2);
const result = runProgram(limit, program, clip, other ? runProgram(limit, ...other) : undefined);
console.log(JSON.stringify({ ...documentOf(result), state: option('--state', 0) ? result.state() : undefined }));
