/** The line at the bottom: what happened last, what takes long, what the camera does. */

import { useEffect, useState } from "preact/hooks";
import type { JSX } from "preact";
import { cameraRate } from "../control/camera";
import { newVersion, offlineReady, reload } from "../offline/offline";
import { heard } from "../say";
import { message, progress } from "../store";
import { leaveCamera } from "./clips";
import { openDialog } from "./dialogs";
import { isGreeted } from "./help";
import { loading } from "./parts";
import { unkept } from "./project";
import { problem, putAway } from "../say";

/** Milliseconds after which work is shown. */
const LONG = 1000;

export function Messages(): JSX.Element {
  const { kind, text } = message.value;
  const work = progress.value ?? loading.value;
  const cancel = progress.value?.cancel;
  const rate = cameraRate.value;
  return (
    <footer class="shell-messages">
      {/* On the left it stays where it is, whatever else comes and goes. */}
      {problem.value ? (
        <button type="button" aria-label="Dismiss the problem" onClick={putAway}>
          Dismiss
        </button>
      ) : null}
      {/* Not read as a whole: a problem that is still there would be told again with every text. */}
      <div role="status" aria-label="Messages" aria-atomic="false">
        {problem.value ? (
          <p role="alert" class="shell-error">
            <strong>Problem: </strong>
            {problem.value}
          </p>
        ) : null}
        {kind === "info" && text ? <p>{text}</p> : null}
      </div>
      <Heard text={work?.text ?? ""} />
      {isGreeted.value ? null : (
        <p>
          New here?{" "}
          <button type="button" onClick={() => openDialog("help")}>
            See what to try
          </button>
        </p>
      )}
      {unkept.value ? <p class="shell-error">Not saved in this browser: save it as a file</p> : null}
      {offlineReady.value && !work ? <p class="shell-note">Works offline</p> : null}
      {rate ? (
        <p class="shell-rate">
          Camera: {rate.processed.toFixed(0)} of {rate.given.toFixed(0)} frames/s, {Math.round(rate.latency)} ms delay{" "}
          <button type="button" onClick={() => heard(leaveCamera())}>
            Turn off
          </button>
        </p>
      ) : null}
      {newVersion.value ? (
        <p>
          A new version of the studio is ready.{" "}
          <button type="button" onClick={reload}>
            Reload
          </button>
        </p>
      ) : null}
      {work ? (
        <p class="shell-work">
          <label for="work">{work.text}</label>
          <progress id="work" max={1} {...(work.share === null ? {} : { value: work.share })} />
          {cancel ? (
            <button type="button" onClick={cancel}>
              Cancel
            </button>
          ) : null}
        </p>
      ) : null}
    </footer>
  );
}

/** Tells those who hear the page of work that takes long; short work would only interrupt. */
function Heard({ text }: { text: string }): JSX.Element {
  const [told, setTold] = useState("");
  useEffect(() => {
    setTold("");
    const timer = setTimeout(setTold, LONG, text);
    return () => clearTimeout(timer);
  }, [text]);
  return (
    <span role="status" class="shell-hidden">
      {told}
    </span>
  );
}
