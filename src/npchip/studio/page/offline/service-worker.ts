/**
 * Keeps the page in the browser, so that it opens without a network.
 *
 * The cache holds each file under its address and digest. A new version fetches what has changed
 * only, and works from its own files from the first request on: a page never sees half of each.
 */

/** Digests of the site's files by path; the build fills it in. */
declare const FILES: Record<string, string>;

const worker = self as unknown as ServiceWorkerGlobalScope;
const scope = worker.registration.scope;
/** Several studios of one host have a cache each. */
const cacheName = `npchip studio ${new URL(scope).pathname}`;
const atOnce = 4;

/** Address under which the cache holds a file. */
const key = (path: string): string => `${new URL(path, scope).href}?${FILES[path]}`;

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

/** Drop what belongs to other versions. */
async function clean(): Promise<void> {
  const cache = await caches.open(cacheName);
  const own = new Set(Object.keys(FILES).map(key));
  for (const request of await cache.keys()) {
    if (!own.has(request.url)) await cache.delete(request);
  }
}

/** The file that an address stands for; undefined if it is none of the site's. */
function pathOf(address: string): string | undefined {
  const bare = address.split(/[?#]/, 1)[0]!;
  if (!bare.startsWith(scope)) return undefined;
  const path = decodeURIComponent(bare.slice(scope.length)) || "index.html";
  return Object.hasOwn(FILES, path) ? path : undefined;
}

async function answer(request: Request, path: string): Promise<Response> {
  const cache = await caches.open(cacheName);
  return (await cache.match(key(path))) ?? fetch(request); // the browser may have cleared it
}

worker.addEventListener("install", (event) => event.waitUntil(keepAll()));
worker.addEventListener("activate", (event) => {
  event.waitUntil(clean().then(() => worker.clients.claim()));
});
worker.addEventListener("fetch", (event) => {
  const path = event.request.method === "GET" ? pathOf(event.request.url) : undefined;
  if (path !== undefined) event.respondWith(answer(event.request, path));
});
worker.addEventListener("message", (event) => {
  if (event.data === "take over") void worker.skipWaiting();
});
