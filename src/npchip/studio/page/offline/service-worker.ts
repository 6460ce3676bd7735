/**
 * Keeps the page in the browser, so that it opens without a network.
 *
 * The cache holds each file under its address and digest. A new version fetches what has changed
 * only, and works from its own files from the first request on. Tabs that were open before get those
 * of their version as long as they are open: a page never sees half of each.
 */

/** Digests of the site's files by path; the build fills it in. */
declare const FILES: Files;

const worker = self as unknown as ServiceWorkerGlobalScope;
const scope = worker.registration.scope;
/** Several studios of one host have a cache each. */
const cacheName = `npchip studio ${new URL(scope).pathname}`;
const atOnce = 4;

/** Digests of a version's files by path. */
type Files = Record<string, string>;

/** A version before this one: its files, and the tabs and workers that were opened with it. */
interface Former {
  files: Files;
  clients: string[];
}

/** Versions in the cache: the active one, and those before it. */
interface Versions {
  active: Files;
  former: Former[];
}

/** Address under which the cache holds a file. */
const key = (path: string, files: Files = FILES): string => `${new URL(path, scope).href}?${files[path]}`;
/** Address under which the cache holds `Versions`; no file of the site has it. */
const record = `${scope}?versions`;

async function fetched(path: string, cache: RequestCache): Promise<Response> {
  const response = await fetch(new URL(path, scope), { cache });
  if (!response.ok) throw new Error(`${path}: the server answers ${response.status}`);
  return response;
}

async function digest(response: Response): Promise<string> {
  const bytes = await crypto.subtle.digest("SHA-256", await response.arrayBuffer());
  return Array.from(new Uint8Array(bytes), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

/** Put a file of this version into the cache, unless it is there from another one. */
async function keep(cache: Cache, path: string): Promise<void> {
  if (await cache.match(key(path))) return;
  let response = await fetched(path, "no-cache");
  if ((await digest(response.clone())) !== FILES[path]) {
    response = await fetched(path, "reload"); // a proxy may hold an older copy
    if ((await digest(response.clone())) !== FILES[path]) {
      throw new Error(`${path}: the server has another version of it`);
    }
  }
  // A redirected answer, such as of index.html to its folder, may not open a page.
  await cache.put(key(path), response.redirected ? new Response(response.body, response) : response);
}

async function keepAll(): Promise<void> {
  const cache = await caches.open(cacheName);
  const left = Object.keys(FILES);
  const work = async (): Promise<void> => {
    for (let path = left.shift(); path !== undefined; path = left.shift()) await keep(cache, path);
  };
  await Promise.all(Array.from({ length: atOnce }, work));
}

async function versions(): Promise<Versions | null> {
  const found = await (await caches.open(cacheName)).match(record);
  return found ? ((await found.json()) as Versions) : null;
}

/** The versions of tabs that are older than this one; null until they are known. */
let former: Former[] | null = null;
const known = versions().then(
  (found) => (former ??= found?.former ?? []),
  () => (former ??= []), // the browser keeps nothing
);

/** Note which tabs belong to the version before, and drop what no tab needs. */
async function takeOver(): Promise<void> {
  const before = await versions();
  const clients = await worker.clients.matchAll({ includeUncontrolled: true, type: "all" });
  const open = clients.map(({ id }) => id);
  const older = before?.former ?? [];
  const olds = new Set(older.flatMap((each) => each.clients));
  const newest = before ? [{ files: before.active, clients: open.filter((id) => !olds.has(id)) }] : [];
  const left = [...newest, ...older.map(({ files, clients }) => ({ files, clients: clients.filter((id) => open.includes(id)) }))];
  const needed = left.filter((each) => each.clients.length);
  const cache = await caches.open(cacheName);
  await cache.put(record, new Response(JSON.stringify({ active: FILES, former: needed } satisfies Versions)));
  former = needed;
  const kept = [FILES, ...needed.map(({ files }) => files)];
  const own = new Set([record, ...kept.flatMap((files) => Object.keys(files).map((path) => key(path, files)))]);
  for (const request of await cache.keys()) {
    if (!own.has(request.url)) await cache.delete(request);
  }
}

/** The path of an address in the site, of whichever version; undefined if it is outside. */
function pathOf(address: string): string | undefined {
  const bare = address.split(/[?#]/, 1)[0]!;
  if (!bare.startsWith(scope)) return undefined;
  return decodeURIComponent(bare.slice(scope.length)) || "index.html";
}

/** The version of a tab or worker that is older than this one. */
function versionOf(client: string): Former | undefined {
  return former?.find(({ clients }) => clients.includes(client));
}

/** True if a file that this version has not may be one of an older tab's. */
function mayBeOlder(client: string): boolean {
  return client !== "" && (former === null || versionOf(client) !== undefined);
}

/** Answer with the file of the version that the asking tab was opened with. */
async function answer({ request, clientId, resultingClientId }: FetchEvent, path: string): Promise<Response> {
  await known;
  // A request that opens a page anew opens it in this version.
  const older = request.mode === "navigate" ? undefined : versionOf(clientId);
  // A worker that an older tab starts is of its version, too.
  if (older && resultingClientId) older.clients.push(resultingClientId);
  const files = older?.files ?? FILES;
  if (!Object.hasOwn(files, path)) return fetch(request);
  const cache = await caches.open(cacheName);
  return (await cache.match(key(path, files))) ?? fetch(request); // the browser may have cleared it
}

worker.addEventListener("install", (event) => event.waitUntil(keepAll()));
worker.addEventListener("activate", (event) => {
  event.waitUntil(takeOver().then(() => worker.clients.claim()));
});
worker.addEventListener("fetch", (event) => {
  const path = event.request.method === "GET" ? pathOf(event.request.url) : undefined;
  if (path === undefined || !(Object.hasOwn(FILES, path) || mayBeOlder(event.clientId))) return;
  event.respondWith(answer(event, path));
});
worker.addEventListener("message", (event) => {
  if (event.data === "take over") void worker.skipWaiting();
});
