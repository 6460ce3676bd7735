/**
 * The colours that a VP9 stream declares, made known.
 *
 * Firefox hands out decoded pictures as colours only. Their luma comes back if it is known by which
 * matrix they were made, but where a stream declares none, browsers choose. So the declaration,
 * three plain bits of each key frame, is set to ITU-R 601. The luma itself is stored and stays.
 */

const [KEY_MARK, SRGB, BT601] = [2, 7, 1];
const SYNC = 0x498342;

/** Declare ITU-R 601 in a packet, if it is one that declares a matrix. */
export function declareMatrix(packet: Uint8Array): void {
  const bits = new Bits(packet);
  if (bits.read(2) !== KEY_MARK) return;
  const profile = bits.read(1) | (bits.read(1) << 1);
  if (profile === 3) bits.read(1);
  if (bits.read(1)) return; // shows a picture that was decoded before
  if (bits.read(1)) return; // no key frame
  bits.read(2);
  if (bits.read(24) !== SYNC) return;
  if (profile >= 2) bits.read(1); // depth
  if (bits.read(3) === SRGB) return;
  bits.at -= 3;
  bits.write(3, BT601);
}

/** Bits of bytes, from the highest on. */
class Bits {
  at = 0;

  constructor(private readonly data: Uint8Array) {}

  read(count: number): number {
    let value = 0;
    for (let bit = 0; bit < count; bit++, this.at++) {
      value = (value << 1) | (((this.data[this.at >> 3] ?? 0) >> (7 - (this.at & 7))) & 1);
    }
    return value;
  }

  write(count: number, value: number): void {
    for (let bit = count - 1; bit >= 0; bit--, this.at++) {
      const mask = 0x80 >> (this.at & 7);
      const byte = this.at >> 3;
      if (byte >= this.data.length) return;
      this.data[byte] = (value >> bit) & 1 ? this.data[byte]! | mask : this.data[byte]! & ~mask;
    }
  }
}
