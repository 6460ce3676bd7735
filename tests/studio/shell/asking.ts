/** The shell with a compiler and a chip that answer when the test says. */

/** What a part was asked: a method, or an order. */
export interface Asked {
  name: string;
  args: unknown[];
  answer(value: unknown, module?: Uint8Array): void;
}

type Hear = (event: { data: unknown }) => void;
const asked: Asked[] = [];

/** Workers of both kinds: what they are asked waits in a list. */
class Part {
  onmessage: Hear | null = null;
  postMessage(data: { id: number; base?: string; method?: string; args?: string; order?: { to: string } }): void {
    const say = (answer: unknown): void => this.onmessage?.({ data: answer });
    if (data.order) {
      const { to } = data.order;
      asked.push({ name: to, args: [data.order], answer: (value) => say({ of: "answer", id: data.id, value }) });
    } else if (data.method) {
      asked.push({
        name: data.method,
        args: JSON.parse(data.args ?? "[]") as unknown[],
        answer: (value, module) =>
          say({ kind: "answer", id: data.id, text: JSON.stringify({ value }), module: module ?? null }),
      });
    }
  }
  terminate(): void {}
}

Object.assign(globalThis, {
  self: globalThis,
  window: { addEventListener: () => undefined },
  document: { baseURI: "http://page/" },
  location: { hash: "", pathname: "/", search: "" },
  history: { replaceState: () => undefined },
  localStorage: { getItem: () => null, setItem: () => undefined },
  Worker: Part,
  fetch: async () => ({ ok: false }),
});

/** Let all that is under way come to its end. */
export async function settled(): Promise<void> {
  for (let i = 0; i < 20; i++) await new Promise((resolve) => setImmediate(resolve));
}

/** The next thing that a part is asked by this name; all before it is dropped. */
export async function next(name: string): Promise<Asked> {
  for (let i = 0; i < 100; i++) {
    await settled();
    const at = asked.findIndex((each) => each.name === name);
    if (at >= 0) return asked.splice(0, at + 1)[at] as Asked;
  }
  throw new Error(`nobody asks for ${name}`);
}

/** Names of what was asked and not taken. */
export function waiting(): string[] {
  return asked.map(({ name }) => name);
}
