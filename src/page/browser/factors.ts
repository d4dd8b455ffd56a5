// Form factors between nodes: 16-bit codes of one triangle of the matrix -> rows of both.

/** Rows of F, columns increasing: F[i,j] is the fraction of what leaves i that reaches j. */
export interface Factors {
  size: number;
  begin: Uint32Array; // K+1
  column: Uint16Array;
  value: Float32Array;
  diagonal: Float32Array; // K
  area: Float32Array; // K, m^2
}

/** One triangle of F, the diagonal included, as the page stores it. */
export interface StoredFactors {
  area: Float32Array; // K
  begin: Uint32Array; // K+1
  column: Uint32Array; // empty: row i holds every column from i on
  code: Uint16Array; // 0: F is 0; else exp(lowest + step * code)
  lowest: number;
  step: number;
}

const LARGEST_SHORT = 1 << 16; // a page holds at most 8,000 nodes: 16 bits do for columns

/** What each code means. */
export function codeTable(lowest: number, step: number): Float32Array {
  const table = new Float32Array(LARGEST_SHORT);
  for (let code = 1; code < LARGEST_SHORT; ++code) table[code] = Math.exp(lowest + step * code);
  return table;
}

/** The first entry of each row of the whole matrix. */
function beginsOfBoth(stored: StoredFactors): Uint32Array {
  const size = stored.area.length;
  const dense = stored.column.length === 0;
  const begin = new Uint32Array(size + 1);
  for (let i = 0; i < size; ++i) {
    for (let k = stored.begin[i]!; k < stored.begin[i + 1]!; ++k) {
      if (stored.code[k] === 0) continue;
      const j = dense ? i + k - stored.begin[i]! : stored.column[k]!;
      ++begin[i + 1]!;
      if (j !== i) ++begin[j + 1]!;
    }
  }
  for (let i = 0; i < size; ++i) begin[i + 1]! += begin[i]!;
  return begin;
}

const ALIGNED = 16; // bytes: what vectors are loaded from
const aligned = (bytes: number): number => Math.ceil(bytes / ALIGNED) * ALIGNED;

/** Empty rows in one buffer, which `room` allocates. */
function emptyRows(begins: Uint32Array, room: (bytes: number) => ArrayBuffer) {
  const size = begins.length - 1;
  const entries = begins[size]!;
  const columns = aligned(4 * begins.length), values = columns + aligned(2 * entries);
  const buffer = room(values + aligned(4 * entries));
  const begin = new Uint32Array(buffer, 0, begins.length);
  begin.set(begins);
  return { begin, column: new Uint16Array(buffer, columns, entries), value: new Float32Array(buffer, values, entries) };
}

/**
 * Both triangles: F_ji = F_ij A_i / A_j. Rows are filled in order, so that row j has its columns below
 * j, from rows before it, in increasing order before its own. They lie in one buffer, of `room`.
 */
export function expand(
  stored: StoredFactors, room = (bytes: number): ArrayBuffer => new ArrayBuffer(bytes)): Factors {
  const size = stored.area.length;
  if (size > LARGEST_SHORT) throw new Error(`${size} nodes are more than a page holds`);
  const dense = stored.column.length === 0;
  const table = codeTable(stored.lowest, stored.step);
  const { begin, column, value } = emptyRows(beginsOfBoth(stored), room);
  const diagonal = new Float32Array(size);
  const next = begin.slice(0, size);
  for (let i = 0; i < size; ++i) {
    const areaOfRow = stored.area[i]!;
    for (let k = stored.begin[i]!; k < stored.begin[i + 1]!; ++k) {
      const code = stored.code[k]!;
      if (code === 0) continue;
      const j = dense ? i + k - stored.begin[i]! : stored.column[k]!;
      const factor = table[code]!;
      const own = next[i]!++;
      column[own] = j;
      value[own] = factor;
      if (j === i) {
        diagonal[i] = factor;
        continue;
      }
      const other = next[j]!++;
      column[other] = i;
      value[other] = stored.area[j]! > 0 ? (factor * areaOfRow) / stored.area[j]! : 0;
    }
  }
  return { size, begin, column, value, diagonal, area: stored.area };
}

/** Row i with its zeros. */
export function denseRow(factors: Factors, i: number): Float32Array {
  const row = new Float32Array(factors.size);
  for (let k = factors.begin[i]!; k < factors.begin[i + 1]!; ++k) row[factors.column[k]!] = factors.value[k]!;
  return row;
}
