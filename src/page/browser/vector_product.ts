// F x with the processor's vectors, if the browser has them (WebAssembly with SIMD): product.wat
// runs over rows in its memory. It uses 32 bits: each value is off by a few units of 1e-7, which
// does not matter for relighting; watched runs use the plain sums of solver.ts.
import { expand, type Factors, type StoredFactors } from "./factors";

const BANDS = 3;
const LANES = 4;
const PAGE = 65536; // bytes, of WebAssembly's memory

/** The kernel as a function of addresses; product.wat describes them. */
type Kernel = (rows: number, begin: number, column: number, value: number, x: number, out: number) => void;

export class VectorProduct {
  readonly factors: Factors;
  private readonly x: Float32Array;
  private readonly out: Float32Array;
  private readonly kernel: Kernel;

  /** `program`: product.wat, assembled; WebAssembly.validate() tells whether the browser supports it. */
  constructor(stored: StoredFactors, program: Uint8Array<ArrayBuffer>) {
    const length = stored.area.length * LANES;
    const bytes = length * Float32Array.BYTES_PER_ELEMENT;
    const memory = new WebAssembly.Memory({ initial: 0 });
    this.factors = expand(stored, (needed) => {
      memory.grow(Math.ceil((needed + 2 * bytes) / PAGE));
      return memory.buffer;
    });
    const end = memory.buffer.byteLength;
    this.x = new Float32Array(memory.buffer, end - 2 * bytes, length);
    this.out = new Float32Array(memory.buffer, end - bytes, length);
    const made = new WebAssembly.Instance(new WebAssembly.Module(program), { page: { memory } });
    this.kernel = made.exports["product"] as Kernel;
  }

  /** F x; K * 3 values, as those of x. */
  multiply(x: Float64Array): Float64Array {
    const { size, begin, column, value } = this.factors;
    for (let i = 0; i < size; ++i) {
      for (let b = 0; b < BANDS; ++b) this.x[i * LANES + b] = x[i * BANDS + b]!;
    }
    this.kernel(size, begin.byteOffset, column.byteOffset, value.byteOffset, this.x.byteOffset, this.out.byteOffset);
    const result = new Float64Array(size * BANDS);
    for (let i = 0; i < size; ++i) {
      for (let b = 0; b < BANDS; ++b) result[i * BANDS + b] = this.out[i * LANES + b]!;
    }
    return result;
  }
}
