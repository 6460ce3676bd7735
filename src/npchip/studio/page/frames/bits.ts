/** Single bits of bytes, from the highest on. */
export class Bits {
  at = 0;

  constructor(private readonly data: Uint8Array) {}

  /** Read a number of bits; zeros behind the end. */
  read(count: number): number {
    let value = 0;
    for (let bit = 0; bit < count; bit++, this.at++) {
      value = value * 2 + (((this.data[this.at >> 3] ?? 0) >> (7 - (this.at & 7))) & 1);
    }
    return value;
  }

  flag(): boolean {
    return this.read(1) === 1;
  }

  write(count: number, value: number): void {
    for (let bit = count - 1; bit >= 0; bit--, this.at++) {
      const mask = 0x80 >> (this.at & 7);
      const byte = this.at >> 3;
      if (byte >= this.data.length) return;
      this.data[byte] = (value >> bit) & 1 ? this.data[byte]! | mask : this.data[byte]! & ~mask;
    }
  }

  /** Read a number in the code of Golomb and Elias, without or with a sign. */
  golomb(signed = false): number {
    let zeros = 0;
    while (zeros < 32 && !this.flag()) zeros++;
    const value = 2 ** zeros - 1 + this.read(zeros);
    return signed ? (value & 1 ? (value + 1) / 2 : -value / 2) : value;
  }
}
