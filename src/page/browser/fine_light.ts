// The light of elements, finer than patches, for a viewer's lamps and materials. What each lamp gives directly is known
// at their vertices, and is multiplied as its slider says. All else there changes as it does for the patches around.
import type { PageData, Rgb } from "./container";
import { addTimes, shadingValues, type Factors, type PatchLight } from "./light";
import { varyingMaterials } from "./textures";

const BANDS = 3;
const WHOLE = 65535; // of a share
/** Of the mean of patches: below it, what is reflected to them tells no ratio, and the difference is added. */
const DARK = 1e-3;

/** Writes the weights of the corners of triangle `t` at a point of its plane; returns the least of them. */
function weigh(data: PageData, t: number, vertex: number, weights: Float64Array): number {
  const { position, patchTriangle, elementPosition } = data;
  const i = patchTriangle[3 * t]! * 3, j = patchTriangle[3 * t + 1]! * 3, k = patchTriangle[3 * t + 2]! * 3;
  let uu = 0, uv = 0, vv = 0, pu = 0, pv = 0;
  for (let axis = 0; axis < 3; ++axis) {
    const origin = position[i + axis]!;
    const u = position[j + axis]! - origin, v = position[k + axis]! - origin;
    const p = elementPosition[3 * vertex + axis]! - origin;
    uu += u * u;
    uv += u * v;
    vv += v * v;
    pu += p * u;
    pv += p * v;
  }
  const area = uu * vv - uv * uv;
  const b = area > 0 ? (vv * pu - uv * pv) / area : 0, c = area > 0 ? (uu * pv - uv * pu) / area : 0;
  weights[0] = 1 - b - c;
  weights[1] = b;
  weights[2] = c;
  return Math.min(1 - b - c, b, c);
}

export class FineLight {
  private readonly corner: Uint32Array; // Q*3: shading vertices, ...
  private readonly weight: Float32Array; // ... and their weights
  private prepared = false; // they are known
  private readonly rest: Float32Array; // Q*3: what is not in shares
  private readonly then: Float32Array; // of shading vertices: likewise, of patches
  private readonly was: Float32Array; // Q*3: that, interpolated
  private readonly gain: Float32Array; // Q*3: `rest` over it; -1 where it is dark
  private readonly little: Rgb;
  private readonly varying: boolean[]; // materials

  constructor(private readonly data: PageData, stored: PatchLight) {
    const { elementIrradiance, elementPatch, elementShare, header } = data;
    this.varying = varyingMaterials(data);
    this.rest = elementIrradiance.slice();
    for (const share of elementShare) {
      for (let k = 0; k < this.rest.length; ++k) {
        this.rest[k] = this.rest[k]! - (elementIrradiance[k]! * share[k]!) / WHOLE;
      }
    }
    const once: Factors = { materials: header.materials.map(() => [1, 1, 1]), lights: header.lights.map(() => [1, 1, 1]) };
    this.then = shadingValues(data, this.others(stored.irradiance, once), BANDS);
    this.little = [0, 1, 2].map((b) => DARK * meanOf(this.then, b)) as Rgb;
    this.corner = new Uint32Array(elementPatch.length * 3);
    this.weight = new Float32Array(elementPatch.length * 3);
    this.was = new Float32Array(this.rest.length);
    this.gain = new Float32Array(this.rest.length);
  }

  /** Does what of() needs once. */
  prepare(): void {
    if (this.prepared) return;
    this.findCorners();
    this.findGains();
    this.prepared = true;
  }

  /** The irradiance of element vertices, Q*3, for a solution of patches and its lamps. */
  irradiance(light: PatchLight, factors: Factors): Float32Array {
    this.prepare();
    const { data, corner, weight, was, gain, rest } = this;
    const now = shadingValues(data, this.others(light.irradiance, factors), BANDS);
    const result = new Float32Array(rest.length);
    for (let v = 0; v < result.length; v += BANDS) {
      const i = corner[v]! * BANDS, j = corner[v + 1]! * BANDS, k = corner[v + 2]! * BANDS;
      const a = weight[v]!, b = weight[v + 1]!, c = weight[v + 2]!;
      for (let band = 0; band < BANDS; ++band) {
        const at = v + band;
        const is = a * now[i + band]! + b * now[j + band]! + c * now[k + band]!;
        const value = gain[at]! >= 0 ? gain[at]! * is : rest[at]! + is - was[at]!;
        result[at] = value > 0 ? value : 0;
      }
    }
    data.header.element_lamps.forEach((lamp, k) => {
      addShares(result, data.elementIrradiance, data.elementShare[k]!, factorOf(lamp, factors));
    });
    return result;
  }

  /** Irradiance of patches less what elements know lamp by lamp. */
  private others(irradiance: Float32Array, factors: Factors): Float32Array {
    const rest = irradiance.slice();
    const { emittedIrradiance, lightIrradiance, header } = this.data;
    for (const lamp of header.element_lamps) {
      const direct = lamp.material === undefined ? lightIrradiance[lamp.light!] : emittedIrradiance[lamp.material];
      if (direct) addTimes(rest, direct, factorOf(lamp, factors).map((x) => -x) as Rgb);
    }
    for (let k = 0; k < rest.length; ++k) if (rest[k]! < 0) rest[k] = 0;
    return rest;
  }

  /**
   * The radiosity of element vertices, Q*3, by their irradiance. Where textures or colours of vertices multiply it, it
   * is irradiance, times what a slider does to the reflectance.
   */
  radiosity(light: PatchLight, irradiance: Float32Array): Float32Array {
    const { elementPatch, surface, header, reflectance } = this.data;
    const varies = header.surfaces.map(({ material }) => this.varying[material]!);
    const values = irradiance.slice();
    for (let v = 0; v < elementPatch.length; ++v) {
      const patch = elementPatch[v]!, isVarying = varies[surface[patch]!]!;
      for (let b = 0; b < BANDS; ++b) {
        const at = v * BANDS + b, of = patch * BANDS + b;
        const now = light.reflectance[of]!, then = reflectance[of]!;
        if (!isVarying) values[at] = light.emission[of]! + now * values[at]!;
        else if (then > 0) values[at] = (values[at]! * now) / then;
      }
    }
    return values;
  }

  private findGains(): void {
    const { corner, weight, then, was, gain, rest } = this;
    for (let at = 0; at < rest.length; ++at) {
      const b = at % BANDS, v = at - b;
      for (let k = v; k < v + 3; ++k) was[at] = was[at]! + weight[k]! * then[corner[k]! * BANDS + b]!;
      gain[at] = was[at]! > this.little[b]! ? rest[at]! / was[at]! : -1;
    }
  }

  /** Finds, for each vertex, the triangle of its patch that it is in. */
  private findCorners(): void {
    const { data } = this;
    const begin = new Uint32Array(data.area.length + 1);
    for (const patch of data.trianglePatch) begin[patch + 1] = begin[patch + 1]! + 1;
    for (let i = 0; i < data.area.length; ++i) begin[i + 1] = begin[i + 1]! + begin[i]!;
    const triangles = new Uint32Array(data.trianglePatch.length);
    const next = begin.slice();
    data.trianglePatch.forEach((patch, t) => { triangles[next[patch]!++] = t; });
    const weights = new Float64Array(3);
    for (let v = 0; v < data.elementPatch.length; ++v) {
      const patch = data.elementPatch[v]!;
      let best = -Infinity, nearest = 0;
      for (let k = begin[patch]!; k < begin[patch + 1]! && best < 0; ++k) {
        const least = weigh(data, triangles[k]!, v, weights);
        if (least > best) [best, nearest] = [least, triangles[k]!];
      }
      weigh(data, nearest, v, weights);
      const inside = weights.map((w) => Math.max(0, w)); // the vertex may be a little outside
      const sum = inside[0]! + inside[1]! + inside[2]!;
      for (let c = 0; c < 3; ++c) {
        this.corner[3 * v + c] = data.triangleCorner[3 * nearest + c]!;
        this.weight[3 * v + c] = inside[c]! / sum;
      }
    }
  }
}

/** Adds a lamp's share of the stored irradiance, times a factor on the lamp. */
function addShares(to: Float32Array, irradiance: Float32Array, share: Uint16Array, [red, green, blue]: Rgb): void {
  const r = red / WHOLE, g = green / WHOLE, b = blue / WHOLE;
  for (let at = 0; at < to.length; at += BANDS) {
    to[at] = to[at]! + r * irradiance[at]! * share[at]!;
    to[at + 1] = to[at + 1]! + g * irradiance[at + 1]! * share[at + 1]!;
    to[at + 2] = to[at + 2]! + b * irradiance[at + 2]! * share[at + 2]!;
  }
}

const factorOf = (lamp: { material?: number; light?: number }, factors: Factors): Rgb =>
  (lamp.material === undefined ? factors.lights[lamp.light!]! : factors.materials[lamp.material]!);

function meanOf(values: Float32Array, band: number): number {
  let sum = 0;
  for (let k = band; k < values.length; k += BANDS) sum += values[k]!;
  return values.length > 0 ? (sum * BANDS) / values.length : 0;
}
