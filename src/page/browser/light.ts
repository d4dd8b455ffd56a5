// Light on patches: computes the light of each patch from the irradiance of unknowns, and its
// emission and reflectance from a viewer's changes of materials.
import type { PageData, Rgb } from "./container";
import type { Materials } from "./protocol";

const BANDS = 3;

/** The properties of a material that a viewer may change, in the units of MaterialInfo. */
export interface MaterialState {
  reflectance: Rgb;
  emission: Rgb;
}

export interface PatchLight {
  emission: Float32Array; // N*3, W/m^2
  reflectance: Float32Array; // N*3
  irradiance: Float32Array; // N*3, W/m^2
}

export function radiosityOf(light: PatchLight): Float32Array {
  return light.emission.map((e, k) => e + light.reflectance[k]! * light.irradiance[k]!);
}

/** Rec. 709. */
export function luminance(values: Float32Array): Float32Array {
  const result = new Float32Array(values.length / BANDS);
  for (let i = 0; i < result.length; ++i) {
    const at = i * BANDS;
    result[i] = 0.2126 * values[at]! + 0.7152 * values[at + 1]! + 0.0722 * values[at + 2]!;
  }
  return result;
}

/** Means by area over the patches of each unknown. */
export function unknownMeans(data: PageData, values: Float32Array): Float32Array {
  const count = data.header.unknowns;
  const sums = new Float64Array(count * BANDS);
  const areas = new Float64Array(count);
  for (let i = 0; i < data.area.length; ++i) {
    const k = data.unknown[i]!;
    areas[k] = areas[k]! + data.area[i]!;
    for (let b = 0; b < BANDS; ++b) {
      sums[k * BANDS + b] = sums[k * BANDS + b]! + data.area[i]! * values[i * BANDS + b]!;
    }
  }
  if (count === data.header.patches) return permuted(data, values); // no rounding, patches of area 0 too
  return Float32Array.from(sums, (sum, k) => {
    const area = areas[Math.floor(k / BANDS)]!;
    return area > 0 ? sum / area : 0;
  });
}

function permuted(data: PageData, values: Float32Array): Float32Array {
  const result = new Float32Array(values.length);
  for (let i = 0; i < data.area.length; ++i) {
    const to = data.unknown[i]! * BANDS;
    for (let b = 0; b < BANDS; ++b) result[to + b] = values[i * BANDS + b]!;
  }
  return result;
}

/**
 * Irradiance of patches from that of unknowns. Where patches share unknowns (`reference` is there: the
 * unknowns' irradiance in the stored light, by the page's own solution) each patch's stored irradiance
 * changes as its unknown's does: an estimate, until light within unknowns is found anew (relight_shared.ts).
 */
export function patchIrradiance(
  data: PageData, unknowns: Float32Array, reference: Float32Array | null): Float32Array {
  const result = new Float32Array(data.area.length * BANDS);
  for (let i = 0; i < data.area.length; ++i) {
    const from = data.unknown[i]! * BANDS;
    for (let b = 0; b < BANDS; ++b) {
      const now = unknowns[from + b]!;
      const then = reference ? reference[from + b]! : 0;
      result[i * BANDS + b] = then > 0 ? (data.irradiance[i * BANDS + b]! * now) / then : now;
    }
  }
  return result;
}

/** A patch's value after its material's changed from `before` to `now`: a texture is multiplied. */
function followed(value: number, before: number, now: number, textured: boolean): number {
  if (now === before) return value;
  if (!textured) return now;
  return before === 0 ? value : (value * now) / before;
}

/** The largest difference of a patch's value from its material's that may be rounding to 32 bits. */
const SAME = 1e-5;

function isPlain(values: Float32Array, at: number, of: Rgb): boolean {
  return of.every((value, b) => Math.abs(values[at + b]! - value) <= SAME * Math.max(1, Math.abs(value)));
}

/** The properties of a material in which its patches differ. */
export interface Textured {
  reflectance: boolean;
  emission: boolean;
}

export function texturedMaterials(data: PageData): Textured[] {
  const { materials, surfaces } = data.header;
  const textured = materials.map(() => ({ reflectance: false, emission: false }));
  for (let i = 0; i < data.area.length; ++i) {
    const m = surfaces[data.surface[i]!]!.material;
    const material = materials[m];
    if (!material?.textured) continue;
    for (const property of ["reflectance", "emission"] as const) {
      textured[m]![property] ||= !isPlain(data[property], i * BANDS, material[property]);
    }
  }
  return textured;
}

/** The emission and reflectance of patches for these materials. */
export function withMaterials(data: PageData, states: MaterialState[]): Omit<PatchLight, "irradiance"> {
  const emission = new Float32Array(data.emission.length);
  const reflectance = new Float32Array(data.reflectance.length);
  const textured = texturedMaterials(data);
  for (let i = 0; i < data.area.length; ++i) {
    const material = data.header.surfaces[data.surface[i]!]!.material;
    const before = data.header.materials[material];
    const now = states[material];
    const at = i * BANDS;
    if (!before || !now) {
      emission.set(data.emission.subarray(at, at + BANDS), at);
      reflectance.set(data.reflectance.subarray(at, at + BANDS), at);
      continue;
    }
    const of = textured[material]!;
    for (let b = 0; b < BANDS; ++b) {
      emission[at + b] = followed(data.emission[at + b]!, before.emission[b]!, now.emission[b]!, of.emission);
      const rho = followed(
        data.reflectance[at + b]!, before.reflectance[b]!, now.reflectance[b]!, of.reflectance);
      reflectance[at + b] = Math.min(1, rho); // 32 bits may round to more
    }
  }
  return { emission, reflectance };
}

/** The radiance of what is seen where nothing stands, with factors on each light. */
export function background(lights: { radiance: Rgb }[], factors: Rgb[]): Rgb {
  return [0, 1, 2].map((b) => lights.reduce((sum, { radiance }, l) => sum + radiance[b]! * factors[l]![b]!, 0)) as Rgb;
}

export function materialsOfUnknowns(data: PageData, light: Omit<PatchLight, "irradiance">, lights: Rgb[]): Materials {
  const { emission, reflectance } = light;
  return {
    emission: unknownMeans(data, emission),
    reflectance: unknownMeans(data, reflectance),
    lights,
    ...(data.seen && { patches: { emission, reflectance } }),
  };
}

/** Values at shading vertices: weighted means of patches. `bands` values a patch. */
export function shadingValues(data: PageData, values: Float32Array, bands: number): Float32Array {
  const count = data.shadingBegin.length - 1;
  const result = new Float32Array(count * bands);
  for (let v = 0; v < count; ++v) {
    for (let k = data.shadingBegin[v]!; k < data.shadingBegin[v + 1]!; ++k) {
      const from = data.shadingPatch[k]! * bands;
      for (let b = 0; b < bands; ++b) {
        result[v * bands + b] = result[v * bands + b]! + data.shadingWeight[k]! * values[from + b]!;
      }
    }
  }
  return result;
}

/** Values at the corners of triangles, T*3*bands: smooth over shading vertices, else a patch's own. */
export function cornerValues(
  data: PageData, values: Float32Array, bands: number, smooth: boolean, out: Float32Array): void {
  const source = smooth ? shadingValues(data, values, bands) : values;
  for (let corner = 0; corner < data.triangleCorner.length; ++corner) {
    const from = (smooth ? data.triangleCorner[corner]! : data.trianglePatch[Math.floor(corner / 3)]!) * bands;
    for (let b = 0; b < bands; ++b) out[corner * bands + b] = source[from + b]!;
  }
}
