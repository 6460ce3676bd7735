/** The page of `npchip export`: a program at work, without its source. */

import type { JSX } from "preact";
import { useRef } from "preact/hooks";
import { fitQuestion } from "../control/clips";
import { FRAME_PACES, paceIndex } from "../control/paces";
import { Outputs } from "../results/outputs";
import { Pictures } from "../results/pictures";
import { heard } from "../say";
import { clip, message, pace, program, progress, running, view } from "../store";
import * as play from "./play";

export function Player(): JSX.Element {
  return (
    <>
      <header class="player-head">
        <h1>{play.exported.value?.title ?? document.title}</h1>
        <Controls />
      </header>
      <main class="player-main">
        <section class="player-pictures" aria-label="Pictures">
          <Pictures />
        </section>
        <section class="player-outputs" aria-label="Outputs of each frame">
          <Outputs />
          <Where />
        </section>
      </main>
      <Status />
    </>
  );
}

function Controls(): JSX.Element {
  const busy = running.value || !program.value;
  const ended = view.value?.ended ?? false;
  const exposes = program.value?.exposes ?? false;
  return (
    <div class="player-controls">
      <div role="group" aria-label="Run" class="player-group">
        <button type="button" class="player-primary" disabled={busy} onClick={() => heard(play.run())}>
          Run
        </button>
        <button type="button" disabled={!running.value} onClick={play.pause}>
          Pause
        </button>
        <button type="button" disabled={busy || ended} onClick={() => heard(play.go({ to: "step" }))}>
          Step
        </button>
        <button type="button" disabled={busy} onClick={() => heard(play.go({ to: "step" }, true))}>
          Step back
        </button>
        {exposes && (
          <button type="button" disabled={busy || ended} onClick={() => heard(play.go({ to: "frame" }))}>
            Next frame
          </button>
        )}
        <button type="button" disabled={!program.value} onClick={() => heard(play.reset())}>
          Reset
        </button>
      </div>
      {exposes && <ClipBox />}
      {exposes && play.source.value !== "camera" && <PaceBox />}
    </div>
  );
}

function ClipBox(): JSX.Element {
  const input = useRef<HTMLInputElement>(null);
  const own = play.exported.value?.clip;
  const now = clip.value;
  const shown = play.source.value === "file" && now !== "live" && now?.name;
  const choose = (box: HTMLSelectElement): void => {
    const { value } = box;
    box.value = play.source.value;
    if (value === "open") input.current?.click();
    else if (value === "camera") heard(play.chooseCamera());
    else if (value === "page") heard(play.choosePage());
  };
  return (
    <label>
      <span>Clip</span>
      <select value={play.source.value} onChange={(event) => choose(event.currentTarget)}>
        {!play.source.value && <option value="">none</option>}
        {own && <option value="page">{own.name}</option>}
        {shown && <option value="file">{shown}</option>}
        <option value="open">Open a file …</option>
        <option value="camera">Camera</option>
      </select>
      <input
        ref={input}
        type="file"
        multiple
        hidden
        aria-label="Clip file"
        accept=".npy,image/*,video/*,.pgm,.ppm,.pnm"
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          event.currentTarget.value = "";
          if (files.length) heard(play.chooseFiles(files));
        }}
      />
    </label>
  );
}

function PaceBox(): JSX.Element {
  const now = paceIndex(FRAME_PACES, pace.value);
  return (
    <label>
      <span>Speed</span>
      <select
        value={now}
        onChange={(event) => {
          const chosen = FRAME_PACES[Number(event.currentTarget.value)]?.[1];
          if (chosen) play.setPace(chosen);
        }}
      >
        {FRAME_PACES.map(([name], index) => (
          <option key={name} value={index}>
            {name}
          </option>
        ))}
      </select>
    </label>
  );
}

/** The instruction before which the program stands. */
function Where(): JSX.Element | null {
  const seen = view.value;
  const word = seen && program.value?.words[seen.address];
  if (!seen || !word || running.value) return null;
  const origin = word.origins[0];
  const place = origin ? `${origin.file}, line ${origin.line}` : `address ${seen.address}`;
  return (
    <p class="player-where">
      {seen.ended ? "Ended at" : "Next:"} <code>{word.text}</code> ({place}), instruction{" "}
      {seen.instructions.toLocaleString("en")}, cycle {seen.cycles.toLocaleString("en")}
    </p>
  );
}

function Status(): JSX.Element {
  const { kind, text } = message.value;
  const work = progress.value;
  const share = work?.share ?? null;
  const misfit = fitQuestion.value;
  return (
    <footer class="player-status">
      {misfit && (
        <p role="alert">
          {misfit.text}{" "}
          {misfit.canCrop && (
            <button type="button" onClick={() => heard(play.chooseFiles(misfit.files, "crop"))}>
              Crop
            </button>
          )}{" "}
          <button type="button" onClick={() => heard(play.chooseFiles(misfit.files, "resize"))}>
            Resize
          </button>
        </p>
      )}
      <p role="status" aria-label="Messages" data-kind={kind}>
        {work ? `${work.text}${share === null ? " …" : `: ${Math.round(100 * share)} %`}` : text}
      </p>
      {work?.cancel ? (
        <button type="button" onClick={work.cancel}>
          Cancel
        </button>
      ) : null}
    </footer>
  );
}
