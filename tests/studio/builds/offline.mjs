// Runs built service workers against a server and a cache of its own, and prints what they did.

import { readFileSync } from "node:fs";

const [, , first, second] = process.argv;
const scope = "https://host/course/studio/";
const stores = new Map();
let online = true;
/** Tabs that are open, by the id that their requests have. */
let tabs = [];
let asked = [];
/** What the server has: texts by path. `stale` is what a proxy gives until it is told to reload. */
let server = {};
let stale = {};
let redirects = [];

const caches = {
  async open(name) {
    if (!stores.has(name)) stores.set(name, new Map());
    const kept = stores.get(name);
    return {
      match: async (key) => kept.get(key)?.clone(),
      put: async (key, response) => void kept.set(key, response),
      keys: async () => [...kept.keys()].map((url) => ({ url })),
      delete: async ({ url }) => kept.delete(url),
    };
  },
};

async function fetch(address, { cache } = {}) {
  const path = decodeURIComponent(String(address).slice(scope.length));
  asked.push(path);
  if (!online) throw new TypeError("no network");
  const text = cache !== "reload" && path in stale ? stale[path] : server[path];
  const response = new Response(text, { status: text === undefined ? 404 : 200 });
  if (redirects.includes(path)) Object.defineProperty(response, "redirected", { value: true });
  return response;
}

function start(file) {
  const heard = {};
  const self = {
    registration: { scope },
    clients: { claim: async () => undefined, matchAll: async () => tabs.map((id) => ({ id })) },
    skipWaiting: async () => undefined,
    addEventListener: (name, listener) => (heard[name] = listener),
  };
  new Function("self", "caches", "fetch", readFileSync(file, "utf8"))(self, caches, fetch);
  const event = async (name) => {
    let work;
    heard[name]({ waitUntil: (promise) => (work = promise) });
    try {
      await work;
      return "done";
    } catch (fault) {
      await new Promise((done) => setTimeout(done, 50)); // what was fetched beside it arrives
      return fault.message;
    }
  };
  const open = async (url, method = "GET", clientId = "", mode = "no-cors", resultingClientId = "") => {
    let answer;
    heard.fetch({ request: { url, method, mode }, clientId, resultingClientId, respondWith: (promise) => (answer = promise) });
    return answer === undefined ? null : (await answer).text();
  };
  return { event, open };
}

const found = {};
const old = start(first);
server = {
  "index.html": "page 1",
  "studio.js": "script 1",
  "chunks/old.js": "part 1",
  "clips/coin slide.npy": "clip",
};
redirects = ["index.html"];
found.install = await old.event("install");
found.activate = await old.event("activate");
found.fetched = asked.sort();
found.caches = [...stores.keys()];
found.redirected = [...stores.values()].some((kept) => [...kept.values()].some((r) => r.redirected));
online = false;
asked = [];
found.opened = {
  folder: await old.open(scope),
  link: await old.open(`${scope}?from=mail#code=abc`),
  script: await old.open(`${scope}studio.js`),
  spaces: await old.open(`${scope}clips/coin%20slide.npy`),
};
found.left = {
  unknown: await old.open(`${scope}other.js`),
  outside: await old.open("https://host/course/index.html"),
  posted: await old.open(`${scope}studio.js`, "POST"),
};
found.asked = [...asked];

// A new version: its page and script are other ones, its clip is the same.
online = true;
const next = start(second);
server = { ...server, "index.html": "page 2" };
found.mixed = await next.event("install"); // the server has not got the new script yet
asked = [];
server["studio.js"] = "script 2";
stale = { "studio.js": "script 1" };
found.update = await next.event("install");
found.refetched = asked.sort();
found.meanwhile = await old.open(`${scope}studio.js`);
const counts = () => [...stores.values()].map((kept) => [...kept.keys()].filter((url) => !url.endsWith("?versions")).length);
const copy = new Map([...stores].map(([name, kept]) => [name, new Map(kept)]));
await next.event("activate");
found.after = await next.open(`${scope}studio.js`);
found.kept = counts();

// The same again, with a tab that was opened before, and a worker that it starts.
for (const [name, kept] of copy) stores.set(name, kept);
tabs = ["tab"];
await next.event("activate");
const ask = (path, ...more) => next.open(`${scope}${path}`, "GET", ...more);
const again = start(second); // the browser may stop a service worker, and start it anew
found.tab = {
  script: await ask("studio.js", "tab", "no-cors", "worker"),
  worker: await ask("studio.js", "worker"),
  anew: await again.open(`${scope}studio.js`, "GET", "tab"),
  reload: await ask("", "tab", "navigate"),
  part: await ask("chunks/old.js", "tab"),
  other: await ask("studio.js", "other tab"),
  unknown: await ask("chunks/old.js", "other tab"),
  kept: counts(),
};
tabs = ["other tab"];
const third = start(second);
await third.event("activate");
found.tab.left = counts();

console.log(JSON.stringify(found));
