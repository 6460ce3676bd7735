/** Sixty-four bytes of an NP as an 8 × 8 picture with numbers. */

import type { JSX } from "preact";
import type { Quantity } from "../protocol";
import type { Asked } from "./ValueMenu";
import { format, greyOf, hex, inkOn, shade, type Base } from "./format";
import { SIDE, changes } from "./planes";
import { useRoving } from "./roving";

interface Props {
  name: string;
  values: Uint8Array;
  before: Uint8Array | null;
  base: Base;
  /** Address of the first byte, if the rows have addresses. */
  first?: number;
  label: (index: number) => string;
  quantity: (index: number) => Quantity;
  ask: (asked: Asked) => void;
}

/** A picture whose values can be opened. */
export function Eight({ name, values, before, base, first, label, quantity, ask }: Props): JSX.Element {
  const changed = changes(values, before);
  const rows = Math.ceil(values.length / SIDE);
  const roving = useRoving(rows, SIDE);
  return (
    <table class="array-eight">
      <caption>{name}</caption>
      <tbody ref={roving.ref} onKeyDown={roving.onKeyDown}>
        {Array.from({ length: rows }, (_, row) => (
          <tr key={row}>
            <th scope="row">{first === undefined ? row : hex(first + row * SIDE)}</th>
            {Array.from(values.subarray(row * SIDE, (row + 1) * SIDE), (value, column) => {
              const index = row * SIDE + column;
              const grey = shade(value, base);
              return (
                <td key={column}>
                  <button
                    type="button"
                    class={changed[index] ? "array-changed" : ""}
                    aria-haspopup="menu"
                    aria-label={`${label(index)}: ${format(value, base)}${changed[index] ? ", changed" : ""}`}
                    style={{ background: greyOf(grey), color: inkOn(grey) }}
                    {...roving.item(index)}
                    onClick={(event) => ask({ value: quantity(index), name: label(index), anchor: event.currentTarget })}
                  >
                    {format(value, base)}
                  </button>
                </td>
              );
            })}
          </tr>
        ))}
      </tbody>
    </table>
  );
}
