// Drive the compiler's client with a worker of the test's own.
// node client.mjs CLIENT: the address of the bundled client; prints what came out, as JSON.

const { createCompiler } = await import(process.argv[2]);

globalThis.document = { baseURI: "http://page.example/studio/" };
const workers = [];
class FakeWorker {
  heard = [];
  ended = false;
  constructor() {
    workers.push(this);
  }
  postMessage(message) {
    this.heard.push(message);
  }
  terminate() {
    this.ended = true;
  }
  say(message) {
    this.onmessage({ data: message });
  }
  answer(id, answer, module = null) {
    this.say({ kind: "answer", id, text: JSON.stringify(answer), module });
  }
}

const loading = [];
const found = { loading };
const compiler = createCompiler(
  () => new FakeWorker(),
  (item) => loading.push(item),
);
const said = (promise) => promise.catch((error) => `error: ${error.message}`);

const [first] = workers;
first.say({ kind: "loading", loading: { text: "Loading", share: 0.5 } });
const request = {
  project: { main: "a.s", files: { "a.s": "HALT" } },
  machine: { name: "default" },
  defines: {},
  memory: [{ address: 3, planes: 1, data: new Uint8Array([7, 8]) }],
  module: true,
};
const answers = [compiler.compile(request), compiler.condition("x"), compiler.tests(request)].map(said);
first.say({ kind: "ready" });
// In another order than they were asked.
first.answer(1, { error: "no label 'x'" });
const memory = [{ address: 3, planes: 1, data: btoa("\x01\xff") }];
first.answer(2, { value: { runs: [{ name: "r", memory }], diagnostics: [] } });
first.answer(0, { value: { program: null, module: null } }, new Uint8Array([1, 2, 3]));
const [compiled, condition, tests] = await Promise.all(answers);
found.heard = first.heard.map((message) => ({ ...message, blobs: message.blobs?.map((blob) => [...blob]) }));
found.compiled = { ...compiled, module: [...compiled.module] };
found.condition = condition;
found.memory = tests.runs.map((run) => run.memory.map((part) => [part.address, ...part.data]));

const whole = compiler.whole({ ...request, module: "run" });
first.answer(3, { value: null }, new Uint8Array([4, 5]));
found.whole = [...(await whole)];

const stopped = said(compiler.language());
compiler.terminate();
found.stopped = [await stopped, first.ended];
first.answer(4, { value: "late" }); // nobody waits for it any more

const again = said(compiler.language());
workers[1].answer(workers[1].heard[1].id, { value: "new" });
found.again = [await again, workers.length];

const failed = [compiler.language(), compiler.bounds()].map(said);
workers[1].say({ kind: "failed", message: "Out of memory" });
found.failed = await Promise.all(failed);
const broken = said(compiler.language());
workers[2].onerror({ message: "404" });
found.broken = await broken;

const once = createCompiler(new FakeWorker(), () => undefined);
once.terminate();
found.once = await said(once.language());
console.log(JSON.stringify(found));
