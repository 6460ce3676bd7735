/** Working without a network, and moving to a new version when the reader wants to. */

import { signal } from "@preact/signals";

/** True once the page opens without a network. */
export const offlineReady = signal(false);
/** True if a newer page is there; `reload` moves to it. */
export const newVersion = signal(false);

let waiting: ServiceWorker | null = null;
/** True once another tab has moved to a newer page. */
let isOld = false;

/**
 * Keep the page in this browser. Call it when the page has loaded what it needs itself: both would
 * share the network. Nothing happens from a file, or where the browser keeps nothing.
 */
export async function keepOffline(): Promise<void> {
  if (!/^https?:$/.test(location.protocol) || !("serviceWorker" in navigator)) return;
  let registration: ServiceWorkerRegistration;
  try {
    const address = new URL("service-worker.js", document.baseURI);
    registration = await navigator.serviceWorker.register(address);
  } catch {
    return; // a private window, or a host without https: the page works, but needs its server
  }
  let isControlled = navigator.serviceWorker.controller !== null;
  navigator.serviceWorker.addEventListener("controllerchange", () => {
    isOld ||= isControlled; // the first one is of this version
    isControlled = true;
    follow(registration);
  });
  const watch = (): void => {
    follow(registration);
    registration.installing?.addEventListener("statechange", () => follow(registration));
  };
  registration.addEventListener("updatefound", watch);
  watch(); // the browser may have found an update before
}

function follow(registration: ServiceWorkerRegistration): void {
  if (registration.active) offlineReady.value = true;
  waiting = registration.waiting;
  // Without an active worker the first one takes over by itself.
  newVersion.value = isOld || (waiting !== null && registration.active !== null);
}

/** Open the newer page; what is not saved should be by then. */
export function reload(): void {
  navigator.serviceWorker.addEventListener("controllerchange", () => location.reload(), {
    once: true,
  });
  if (waiting) waiting.postMessage("take over");
  else location.reload();
}
