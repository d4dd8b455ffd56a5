// The eyes of gathering, one for each vertex and smooth side, and the conversion of their values to
// those of corners and patches.
import type { PageData } from "./container";
import { shadingValues, type PatchLight } from "./light";

const BANDS = 3;
type Vec = [number, number, number];

const cross = (a: Vec, b: Vec): Vec =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const sub = (a: Vec, b: Vec): Vec => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

export interface EyeMaterials {
  emission: Float32Array; // G*3
  reflectance: Float32Array; // G*3
}

export class Eyes {
  readonly count: number; // G: the first G shading vertices
  private readonly inner = new Map<number, number[]>(); // shading vertex within a patch -> the patch's eyes
  private readonly triangleArea: Float64Array;

  constructor(private readonly data: PageData) {
    this.count = data.eyePosition.length / 3;
    this.triangleArea = Float64Array.from(data.trianglePatch, (_, t) => {
      const corner = (k: number) => this.at(data.position, data.patchTriangle[3 * t + k]!);
      const [a, b, c] = [corner(0), corner(1), corner(2)];
      return 0.5 * Math.hypot(...cross(sub(b, a), sub(c, a)));
    });
    this.findInner();
  }

  position(eye: number): Vec { return this.at(this.data.eyePosition, eye); }
  /** 0 if the eye represents no area and does not look. */
  normal(eye: number): Vec { return this.at(this.data.eyeNormal, eye); }
  axis(eye: number): Vec { return this.at(this.data.eyeAxis, eye); }

  /** Means by area over the patches of each eye. */
  materials(light: PatchLight): EyeMaterials {
    const length = this.count * BANDS;
    const of = (values: Float32Array) => shadingValues(this.data, values, BANDS).slice(0, length);
    return { emission: of(light.emission), reflectance: of(light.reflectance) };
  }

  /** Values at corners of triangles, T*9. */
  corners(values: Float32Array): Float32Array {
    const { triangleCorner } = this.data;
    const result = new Float32Array(triangleCorner.length * BANDS);
    for (let corner = 0; corner < triangleCorner.length; ++corner) {
      const vertex = triangleCorner[corner]!;
      const from = vertex < this.count ? [vertex] : this.inner.get(vertex)!;
      for (let b = 0; b < BANDS; ++b) {
        let sum = 0;
        for (const eye of from) sum += values[eye * BANDS + b]!;
        result[corner * BANDS + b] = from.length > 0 ? sum / from.length : 0;
      }
    }
    return result;
  }

  /** Means by area over patches, N*3, of values that are linear on triangles. */
  patches(values: Float32Array): Float32Array {
    const { trianglePatch, area } = this.data;
    const corners = this.corners(values);
    const sums = new Float64Array(area.length * BANDS), areas = new Float64Array(area.length);
    trianglePatch.forEach((patch, t) => {
      const share = this.triangleArea[t]!;
      areas[patch] = areas[patch]! + share;
      for (let b = 0; b < BANDS; ++b) {
        const mean = (corners[9 * t + b]! + corners[9 * t + 3 + b]! + corners[9 * t + 6 + b]!) / 3;
        sums[patch * BANDS + b] = sums[patch * BANDS + b]! + share * mean;
      }
    });
    return Float32Array.from(sums, (sum, k) => {
      const whole = areas[Math.floor(k / BANDS)]!;
      return whole > 0 ? sum / whole : 0;
    });
  }

  private at(values: Float32Array, k: number): Vec {
    return [values[3 * k]!, values[3 * k + 1]!, values[3 * k + 2]!];
  }

  private findInner(): void {
    const { triangleCorner, trianglePatch } = this.data;
    const eyesOf = new Map<number, Set<number>>();
    for (let pass = 0; pass < 2; ++pass) {
      triangleCorner.forEach((vertex, corner) => {
        const patch = trianglePatch[Math.floor(corner / 3)]!;
        if (pass === 0 && vertex >= this.count) eyesOf.set(patch, new Set());
        if (pass === 1 && vertex < this.count) eyesOf.get(patch)?.add(vertex);
      });
    }
    triangleCorner.forEach((vertex, corner) => {
      if (vertex < this.count) return;
      this.inner.set(vertex, [...eyesOf.get(trianglePatch[Math.floor(corner / 3)]!)!]);
    });
  }
}

/**
 * The area-weighted relative L2 difference of the reflected light, since the lamps' own light is the same by
 * any method.
 */
export function reflectedDifference(data: PageData, irradiance: Float32Array, reference: PatchLight): number {
  let difference = 0, size = 0;
  irradiance.forEach((value, k) => {
    const weight = data.area[Math.floor(k / BANDS)]! * reference.reflectance[k]! ** 2;
    difference += weight * (value - reference.irradiance[k]!) ** 2;
    size += weight * reference.irradiance[k]! ** 2;
  });
  return size > 0 ? Math.sqrt(difference / size) : NaN;
}
