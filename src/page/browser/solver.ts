// B = E + rho H, H = F B + more, for three bands at once: Jacobi, Gauss-Seidel, Southwell. Pure
// functions of arrays; the worker and the tests call them. Values are K * 3, row-major.
//
// An iterate is stored as its irradiance H; its radiosity is E + rho H. So a patch that reflects
// nothing shows its irradiance, too.
import type { Factors } from "./factors";

export const BANDS = 3;

export interface System {
  factors: Factors;
  emission: Float32Array; // W/m^2
  reflectance: Float32Array;
  more: Float32Array; // irradiance from outside the matrix (a sky), W/m^2
}

/** An iterate. `rows`: rows of the matrix that were multiplied to get there, over K. */
export interface Iterate {
  irradiance: Float64Array;
  radiosity: Float64Array;
  rows: number;
}

/** E + rho * more in each band: B starts from it, and residuals are relative to it. */
export function source(system: System): Float64Array {
  return Float64Array.from(system.emission, (e, k) => e + system.reflectance[k]! * system.more[k]!);
}

/** The largest value of each band; 1 for dark bands, so that it can divide. */
export function scales(values: ArrayLike<number>): Float64Array {
  const most = new Float64Array(BANDS);
  for (let k = 0; k < values.length; ++k) most[k % BANDS] = Math.max(most[k % BANDS]!, values[k]!);
  return most.map((value) => (value > 0 ? value : 1));
}

/** The start: B = E (with the sky's share). */
export function fromEmission(system: System): Iterate {
  return { irradiance: Float64Array.from(system.more), radiosity: source(system), rows: 0 };
}

/** sum_j F_ij B_j of row i, all bands, into `sum`. */
function gatherRow(factors: Factors, radiosity: Float64Array, i: number, sum: Float64Array): void {
  const { begin, column, value } = factors;
  let r = 0, g = 0, b = 0;
  for (let k = begin[i]!, end = begin[i + 1]!; k < end; ++k) {
    const at = column[k]! * BANDS;
    const f = value[k]!;
    r += f * radiosity[at]!;
    g += f * radiosity[at + 1]!;
    b += f * radiosity[at + 2]!;
  }
  sum[0] = r;
  sum[1] = g;
  sum[2] = b;
}

/** F B. */
export function product(factors: Factors, radiosity: Float64Array): Float64Array {
  const result = new Float64Array(factors.size * BANDS);
  const sum = new Float64Array(BANDS);
  for (let i = 0; i < factors.size; ++i) {
    gatherRow(factors, radiosity, i, sum);
    result.set(sum, i * BANDS);
  }
  return result;
}

/** H = F B + more. */
export function irradianceOf(system: System, radiosity: Float64Array): Float64Array {
  const result = product(system.factors, radiosity);
  for (let k = 0; k < result.length; ++k) result[k] = result[k]! + system.more[k]!;
  return result;
}

/** max |E + rho H - B| / max (E + rho more), worst band, with the H of B. */
export function residual(system: System, radiosity: Float64Array, irradiance: Float64Array): number {
  const scale = scales(source(system));
  let worst = 0;
  for (let k = 0; k < radiosity.length; ++k) {
    const left = system.emission[k]! + system.reflectance[k]! * irradiance[k]! - radiosity[k]!;
    worst = Math.max(worst, Math.abs(left) / scale[k % BANDS]!);
  }
  return worst;
}

/**
 * One bounce everywhere (Goral, Torrance, Greenberg & Battaile 1984). `next` is F B + more of this
 * iterate if it is known already, since the residual needs it.
 */
export function jacobiSweep(system: System, iterate: Iterate, next?: Float64Array): Iterate {
  const irradiance = next ?? irradianceOf(system, iterate.radiosity);
  const radiosity = irradiance.map((h, k) => system.emission[k]! + system.reflectance[k]! * h);
  return { irradiance, radiosity, rows: iterate.rows + 1 };
}

/**
 * B_i <- (E_i + rho_i (sum_{j != i} F_ij B_j + more_i)) / (1 - rho_i F_ii), one after another, each
 * with the new values of those before it (Cohen & Greenberg 1985). In place. `order`: the order of
 * rows; `scale`: from scales(). Returns the largest change, relative to `scale`.
 */
export function gaussSeidelSweep(
  system: System, iterate: Iterate, scale: Float64Array, order?: Uint32Array): number {
  const { size, diagonal } = system.factors;
  const { emission, reflectance, more } = system;
  const { irradiance, radiosity } = iterate;
  const over = scale.map((most) => 1 / most);
  const sum = new Float64Array(BANDS);
  let largest = 0;
  for (let row = 0; row < size; ++row) {
    const i = order ? order[row]! : row;
    gatherRow(system.factors, radiosity, i, sum);
    const at = i * BANDS;
    const self = diagonal[i]!;
    for (let band = 0; band < BANDS; ++band) {
      const k = at + band;
      const before = radiosity[k]!;
      const others = sum[band]! - self * before + more[k]!;
      const after = (emission[k]! + reflectance[k]! * others) / (1 - reflectance[k]! * self);
      irradiance[k] = others + self * after;
      radiosity[k] = after;
      const change = Math.abs(after - before) * over[band]!;
      if (change > largest) largest = change;
    }
  }
  iterate.rows += 1;
  return largest;
}

/**
 * Southwell's relaxation, "progressive refinement" (Cohen, Chen, Wallace & Greenberg 1988): the node
 * with the most unsent power sends it, one row of F at a time. `iterate.radiosity` is all light so far,
 * E + rho H; `sent` is the part of it that was sent.
 */
export interface Southwell {
  iterate: Iterate;
  sent: Float64Array;
}

export function southwellStart(system: System): Southwell {
  const iterate = fromEmission(system);
  return { iterate, sent: new Float64Array(iterate.radiosity.length) };
}

function brightestUnsent(system: System, { iterate, sent }: Southwell): number {
  let best = -1, most = 0;
  for (let i = 0; i < system.factors.size; ++i) {
    const at = i * BANDS;
    const unsent = iterate.radiosity[at]! + iterate.radiosity[at + 1]! + iterate.radiosity[at + 2]! -
      sent[at]! - sent[at + 1]! - sent[at + 2]!;
    const power = unsent * system.factors.area[i]!;
    if (power > most) {
      most = power;
      best = i;
    }
  }
  return best;
}

/** Sends once; false if nothing is left to send. */
export function southwellShot(system: System, state: Southwell): boolean {
  const i = brightestUnsent(system, state);
  if (i < 0) return false;
  const { begin, column, value, area } = system.factors;
  const { irradiance, radiosity } = state.iterate;
  for (let band = 0; band < BANDS; ++band) {
    const own = i * BANDS + band;
    const unsent = radiosity[own]! - state.sent[own]!;
    state.sent[own] = radiosity[own]!;
    const power = unsent * area[i]!;
    if (power === 0) continue;
    for (let k = begin[i]!; k < begin[i + 1]!; ++k) {
      const j = column[k]!;
      const at = j * BANDS + band;
      const arriving = (value[k]! * power) / area[j]!; // F_ji = F_ij A_i / A_j
      irradiance[at] = irradiance[at]! + arriving;
      radiosity[at] = radiosity[at]! + system.reflectance[at]! * arriving;
    }
  }
  state.iterate.rows += 1 / system.factors.size;
  return true;
}

/** The residual of the light sent: the largest unsent radiosity. */
export function southwellResidual(system: System, { iterate, sent }: Southwell): number {
  const scale = scales(source(system));
  let worst = 0;
  for (let k = 0; k < sent.length; ++k) {
    worst = Math.max(worst, Math.abs(iterate.radiosity[k]! - sent[k]!) / scale[k % BANDS]!);
  }
  return worst;
}
