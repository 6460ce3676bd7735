import type { JSX } from "preact";
import type { Clip } from "../protocol";
export function SceneEditor(_: { size: { rows: number; cols: number }; onClip: (clip: Clip) => void }): JSX.Element {
  return <p>to come</p>;
}
