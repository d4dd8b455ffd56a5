// Light on patches: computes the light of each patch from the irradiance of nodes, and its emission
// and reflectance from a viewer's changes of materials.
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

/** Rec. 709, times `scale`. */
export function luminance(values: Float32Array, scale = 1): Float32Array {
  const r = 0.2126 * scale, g = 0.7152 * scale, b = 0.0722 * scale;
  const result = new Float32Array(values.length / BANDS);
  for (let i = 0; i < result.length; ++i) {
    const at = i * BANDS;
    result[i] = r * values[at]! + g * values[at + 1]! + b * values[at + 2]!;
  }
  return result;
}

export const LUMENS = 683; // a watt, where luminance is 1

/** Of irradiance, in lux. */
export const illuminance = (irradiance: Float32Array): Float32Array => luminance(irradiance, LUMENS);

/** Whether each patch is a node, so that form factors are between patches. */
export function nodesArePatches(data: PageData): boolean { return data.header.nodes === data.header.patches; }

/** Means by area over the patches of each node. */
export function nodeMeans(data: PageData, values: Float32Array): Float32Array {
  if (nodesArePatches(data)) return values;
  const sums = new Float64Array(data.header.nodes * BANDS);
  for (let i = 0; i < data.area.length; ++i) {
    const to = data.node[i]! * BANDS;
    for (let b = 0; b < BANDS; ++b) sums[to + b] = sums[to + b]! + data.area[i]! * values[i * BANDS + b]!;
  }
  return Float32Array.from(sums, (sum, k) => {
    const area = data.nodeArea[Math.floor(k / BANDS)]!;
    return area > 0 ? sum / area : 0;
  });
}

/** Adds values, times a factor for each band. */
export function addTimes(sum: Float32Array, values: Float32Array, factor: Rgb): void {
  for (let k = 0; k < sum.length; ++k) sum[k] = sum[k]! + factor[k % BANDS]! * values[k]!;
}

/** How many times a lamp's emission is what it was; 1 where it was dark. */
function timesBefore(before: Rgb, now: Rgb): Rgb {
  return now.map((value, b) => (before[b]! > 0 ? value / before[b]! : 1)) as Rgb;
}

/** How many times what it was each material's emission is, and each light. */
export interface Factors {
  materials: Rgb[];
  lights: Rgb[];
}

export function factorsOf(data: PageData, states: MaterialState[], lights: Rgb[]): Factors {
  const { materials } = data.header;
  return { materials: materials.map(({ emission }, m) => timesBefore(emission, states[m]!.emission)), lights };
}

/** The irradiance of patches, N*3, by each lamp whose light is known patch by patch. */
export function lampIrradiance(data: PageData, factors: Factors): Float32Array {
  const sum = new Float32Array(data.area.length * BANDS);
  data.lightIrradiance.forEach((irradiance, l) => addTimes(sum, irradiance, factors.lights[l]!));
  data.emittedIrradiance.forEach((irradiance, m) => {
    if (irradiance) addTimes(sum, irradiance, factors.materials[m]!);
  });
  return sum;
}

/** Of that, what form factors do not give the solver: if these are between patches, lights without a surface alone. */
export function directIrradiance(data: PageData, factors: Factors): Float32Array {
  return lampIrradiance(nodesArePatches(data) ? { ...data, emittedIrradiance: [] } : data, factors);
}

/** Light of which the mean over nodes and the rest, which follows it, are known: as the page has it. */
export interface StoredLight {
  direct: Float32Array; // N*3
  reflected: Float32Array; // K*3: the page's own solution, less nodeMeans(direct)
}

/**
 * Irradiance of patches from that of nodes. Where these are clusters of patches, `direct` is known patch by patch, and
 * what is reflected to a patch changes from the stored light as it does for its node.
 */
export function patchIrradiance(
  data: PageData, nodes: Float32Array, direct: Float32Array, stored: StoredLight | null): Float32Array {
  if (!stored) return nodes;
  const means = nodeMeans(data, direct);
  const result = new Float32Array(data.area.length * BANDS);
  for (let k = 0; k < result.length; ++k) {
    const from = data.node[Math.floor(k / BANDS)]! * BANDS + (k % BANDS);
    const now = nodes[from]!, lit = means[from]!, then = stored.reflected[from]!;
    if (now < lit) {
      result[k] = (direct[k]! * now) / lit; // a run that is watched, before all lamps are there
    } else {
      const before = Math.max(0, data.irradiance[k]! - stored.direct[k]!);
      result[k] = direct[k]! + (then > 0 ? (before * (now - lit)) / then : now - lit);
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

/** What the solver needs: emission that is not in `direct`, which is known patch by patch. */
export function materialsOfNodes(
  data: PageData, light: Omit<PatchLight, "irradiance">, direct: Float32Array): Materials {
  const { surfaces } = data.header;
  const emission = light.emission.slice();
  for (let i = 0; i < data.area.length; ++i) {
    const m = surfaces[data.surface[i]!]!.material;
    if (nodesArePatches(data) || !data.emittedIrradiance[m]) continue;
    for (let b = 0; b < BANDS; ++b) if (data.header.materials[m]!.emission[b]! > 0) emission[i * BANDS + b] = 0;
  }
  return {
    emission: nodeMeans(data, emission),
    reflectance: nodeMeans(data, light.reflectance),
    direct: nodeMeans(data, direct),
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
