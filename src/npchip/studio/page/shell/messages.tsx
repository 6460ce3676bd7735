/** The line at the bottom: what happened last, what takes long, what the camera does. */

import type { JSX } from "preact";
import { newVersion, offlineReady, reload } from "../offline/offline";
import { message, progress } from "../store";
import { cameraRate } from "./camera";
import { cancelReading, leaveCamera } from "./clips";
import { openDialog } from "./dialogs";
import { isGreeted } from "./help";
import { loading } from "./parts";
import { unkept } from "./project";

export function Messages(): JSX.Element {
  const { kind, text } = message.value;
  const work = progress.value ?? loading.value;
  const rate = cameraRate.value;
  return (
    <footer class="shell-messages">
      <p role="status" aria-label="Messages" class={kind === "error" ? "shell-error" : ""}>
        {kind === "error" && text ? <strong>Problem: </strong> : null}
        {text}
      </p>
      {isGreeted.value ? null : (
        <p>
          New here?{" "}
          <button type="button" onClick={() => openDialog("help")}>
            See what to try
          </button>
        </p>
      )}
      {unkept.value ? <p class="shell-error">Not kept: save it as a file</p> : null}
      {offlineReady.value && !work ? <p class="shell-note">Works offline</p> : null}
      {rate ? (
        <p class="shell-rate">
          Camera: {rate.processed.toFixed(0)} of {rate.given.toFixed(0)} frames/s, {Math.round(rate.latency)} ms late{" "}
          <button type="button" onClick={() => void leaveCamera()}>
            Turn off
          </button>
        </p>
      ) : null}
      {newVersion.value ? (
        <p>
          A newer studio is there.{" "}
          <button type="button" onClick={reload}>
            Use it
          </button>
        </p>
      ) : null}
      {work ? (
        <p class="shell-work">
          <label for="work">{work.text}</label>
          <progress id="work" max={1} {...(work.share === null ? {} : { value: work.share })} />
          {cancelReading.value ? (
            <button type="button" onClick={cancelReading.value}>
              Cancel
            </button>
          ) : null}
        </p>
      ) : null}
    </footer>
  );
}
