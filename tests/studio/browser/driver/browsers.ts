/** Start a browser so that it reaches this computer only, and sees a camera that is none. */

import puppeteer, { type Browser } from "puppeteer-core";
import type { Kind, Options } from "./flow";

export interface Setup {
  kind: Kind;
  /** Path of the browser. */
  executable: string;
  /** Where Firefox puts what it downloads; Chromium is told for each context. */
  downloads: string;
  /** A `.mjpeg` or `.y4m` file that Chromium's camera shows again and again. */
  camera: string;
  /** Path of axe, a script for the page. */
  axe: string;
}

/** Start Chromium, or Firefox by WebDriver BiDi, which it speaks without a driver. */
export function launch(setup: Setup, options: Options): Promise<Browser> {
  return setup.kind === "chromium" ? chromium(setup) : firefox(setup, options);
}

function chromium(setup: Setup): Promise<Browser> {
  return puppeteer.launch({
    browser: "chrome",
    executablePath: setup.executable,
    headless: true,
    args: [
      ...(process.getuid?.() === 0 ? ["--no-sandbox"] : []),
      "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
      "--use-fake-device-for-media-stream",
      "--use-fake-ui-for-media-stream",
      `--use-file-for-fake-video-capture=${setup.camera}`,
      "--disable-dev-shm-usage",
    ],
  });
}

function firefox(setup: Setup, options: Options): Promise<Browser> {
  return puppeteer.launch({
    browser: "firefox",
    executablePath: setup.executable,
    headless: true,
    extraPrefsFirefox: {
      // A proxy that answers to nobody; 127.0.0.1 is asked directly.
      "network.proxy.type": 1,
      "network.proxy.http": "127.0.0.1",
      "network.proxy.http_port": 9,
      "network.proxy.ssl": "127.0.0.1",
      "network.proxy.ssl_port": 9,
      "media.navigator.streams.fake": true,
      "media.navigator.permission.disabled": true,
      "browser.download.folderList": 2,
      "browser.download.dir": setup.downloads,
      "browser.download.always_ask_before_handling_new_types": false,
      "browser.download.alwaysOpenPanel": false,
      // What a reader prefers is no part of WebDriver BiDi: 0 is dark, 1 is light.
      "layout.css.prefers-color-scheme.content-override": options.theme === "dark" ? 0 : 1,
      "ui.systemUsesDarkTheme": options.theme === "dark" ? 1 : 0,
      "ui.prefersReducedMotion": options.still ? 1 : 0,
    },
  });
}
