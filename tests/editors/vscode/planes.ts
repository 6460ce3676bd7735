/** The extension takes pictures of banks apart as the studio puts them together. */

import assert from "node:assert/strict";
import { planesOf } from "../../../docs/editors/vscode/src/chip";
import { bankPicture } from "../../../src/npchip/studio/page/array/planes";

for (const [rows, cols] of [[8, 10], [3, 5], [1, 1]] as const) {
  const count = rows * cols;
  const memory = Uint8Array.from({ length: 128 * count }, (_, at) => (at * 167 + (at >> 8)) % 251);
  for (const first of [0, 64]) {
    const data = bankPicture(memory, first, rows, cols);
    const planes = planesOf({ rows: rows * 8, cols: cols * 8, data });
    assert.deepEqual(planes, memory.slice(first * count, (first + 64) * count));
  }
}
