/** One NP enlarged: registers, flags, masks, pixels and memory. */

import type { JSX } from "preact";
import { useState } from "preact/hooks";
import type { Cell, ChipView, Quantity } from "../protocol";
import { chosen, program } from "../store";
import { Eight } from "./Eight";
import { ValueMenu, type Asked } from "./ValueMenu";
import { binary, format, hex, signed } from "./format";
import { namesOf } from "./names";
import { BANK, bankOf, changes, pixelsOf, planeOf } from "./planes";
import { base, calm, geometry, reference } from "./state";
import { useRoving } from "./roving";

/** The chosen NP. */
export function Processor(): JSX.Element {
  const [asked, ask] = useState<Asked | null>(null);
  const { rows, cols } = geometry.value;
  const row = Math.min(chosen.value.row, rows - 1);
  const column = Math.min(chosen.value.column, cols - 1);
  const now = calm.value;
  return (
    <div class="array-processor" data-letters>
      {now?.active.length === rows * cols ? (
        <Parts now={now} row={row} column={column} cols={cols} ask={ask} />
      ) : (
        <p class="array-empty">Run or step a program to see what this NP holds.</p>
      )}
      {asked && <ValueMenu asked={asked} close={() => ask(null)} />}
    </div>
  );
}

interface Place {
  now: ChipView;
  row: number;
  column: number;
  cols: number;
  ask: (asked: Asked) => void;
}

function Parts(place: Place): JSX.Element {
  const { now, row, column, cols, ask } = place;
  const old = reference.value;
  const at = row * cols + column;
  const bytes = program.value?.machine.memory_bytes ?? 256;
  const memory = (index: number): Quantity => one({ kind: "memory", index }, row, column);
  const banks = Array.from({ length: Math.ceil(bytes / BANK) }, (_, bank) => bank * BANK);
  return (
    <>
      <div class="array-heading">
        <h2>
          NP {row}, {column}
        </h2>
        <Flags {...place} />
        <p class="array-hint">Open a value to see who wrote it, or to stop when it changes.</p>
      </div>
      <div class="array-parts">
        <Registers {...place} />
        <Section name="Pixels of the exposed frame">
          {now.exposed ? (
            <Eight
              name="Pixels of the exposed frame"
              values={pixelsOf(now.exposed, row, column, cols)}
              before={old?.exposed ? pixelsOf(old.exposed, row, column, cols) : null}
              base={base.value === "hex" ? "hex" : "decimal"}
              label={(pixel) => `pixel ${Math.floor(pixel / 8)}, ${pixel % 8}`}
              quantity={(pixel) => ({
                kind: "pixel",
                row: row * 8 + Math.floor(pixel / 8),
                column: column * 8 + (pixel % 8),
              })}
              ask={ask}
            />
          ) : (
            <p class="array-empty">No frame has been exposed yet.</p>
          )}
        </Section>
        <Section name="Memory">
          <div class="array-banks">
            {banks.map((first) => (
              <Eight
                key={first}
                name={`Bank ${first}`}
                values={bankOf(now, first, at)}
                before={old?.memory.length === now.memory.length ? bankOf(old, first, at) : null}
                base="hex"
                first={first}
                label={(byte) => `byte ${first + byte}`}
                quantity={(byte) => memory(first + byte)}
                ask={ask}
              />
            ))}
          </div>
        </Section>
      </div>
    </>
  );
}

function Section({ name, children }: { name: string; children: JSX.Element }): JSX.Element {
  return (
    <details class="array-section" open>
      <summary>{name}</summary>
      {children}
    </details>
  );
}

function one(cell: Cell, row: number, column: number): Quantity {
  return { kind: "one", cell, row, column };
}

function Flags({ now, row, column, cols, ask }: Place): JSX.Element {
  const at = row * cols + column;
  const old = reference.value;
  const cells: { cell: Cell; name: string }[] = [
    { cell: { kind: "flag", index: "Z" }, name: "Z" },
    { cell: { kind: "flag", index: "C" }, name: "C" },
    { cell: { kind: "active", index: "" }, name: "active" },
  ];
  return (
    <ul class="array-flags" aria-label="Flags and activity">
      {cells.map(({ cell, name }) => {
        const value = planeOf(now, cell)[at] ?? 0;
        const was = old && planeOf(old, cell)[at];
        const changed = was !== null && was !== undefined && was !== value;
        const text = cell.kind === "active" ? (value ? "yes" : "no") : String(value);
        return (
          <li key={name}>
            <button
              type="button"
              class={`array-flag${changed ? " array-changed" : ""}`}
              aria-haspopup="menu"
              aria-label={`${name}: ${text}${changed ? ", changed" : ""}`}
              onClick={(event) => ask({ value: one(cell, row, column), name, anchor: event.currentTarget })}
            >
              {name} <b>{text}</b>
            </button>
          </li>
        );
      })}
      {now.masks.slice(0, now.depth).map((mask, region) => (
        <li key={region} class="array-mask">
          region {region + 1} <b>{mask[at] ? "on" : "off"}</b>
        </li>
      ))}
    </ul>
  );
}

function Registers({ now, row, column, cols, ask }: Place): JSX.Element {
  const at = row * cols + column;
  const count = now.zero.length;
  const pick = (from: ChipView): Uint8Array =>
    Uint8Array.from({ length: 16 }, (_, number) => from.registers[number * count + at] ?? 0);
  const old = reference.value;
  const values = pick(now);
  const changed = changes(values, old?.zero.length === count ? pick(old) : null);
  const roving = useRoving(16, 1);
  return (
    <table class="array-registers">
      <caption class="array-hidden">
        Registers of NP {row}, {column}
      </caption>
      <thead>
        <tr>
          <th scope="col">register</th>
          <th scope="col">dec</th>
          <th scope="col">signed</th>
          <th scope="col">hex</th>
          <th scope="col">binary</th>
        </tr>
      </thead>
      <tbody ref={roving.ref} onKeyDown={roving.onKeyDown}>
        {Array.from(values, (value, number) => (
          <tr key={number} class={changed[number] ? "array-changed" : ""}>
            <th scope="row">
              <button
                type="button"
                aria-haspopup="menu"
                {...roving.item(number)}
                onClick={(event) =>
                  ask({
                    value: one({ kind: "register", index: number }, row, column),
                    name: [`r${number}`, ...namesOf(program.value, number)].join(" "),
                    anchor: event.currentTarget,
                  })
                }
              >
                r{number} <i>{namesOf(program.value, number).join(" ")}</i>
                {changed[number] && <span class="array-hidden">, changed</span>}
              </button>
            </th>
            <td>{format(value, "decimal")}</td>
            <td>{signed(value)}</td>
            <td>{hex(value)}</td>
            <td>{binary(value)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
