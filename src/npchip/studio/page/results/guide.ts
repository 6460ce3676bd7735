/** The place in which a program can read an object: a frame about the middle of the picture. */

import { signal } from "@preact/signals";

/** Rows and columns of the sensor. */
export type Guide = readonly [rows: number, cols: number];

/** The guide of `npchip export --guide`; null without. */
export const guide = signal<Guide | null>(null);
