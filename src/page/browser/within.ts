// Light within unknowns that patches share, as in the program: irradiance of patches is linear in
// place and normal over their unknown, with slopes fitted to rays by least squares. The page has no
// rays, but sums over those of the program (../../formfactor/rays/seen_patches.h), which serve for
// any light.
import type { Rgb, SeenData } from "./container";
import { BANDS } from "./solver";

/** The number of features of slopes, for any number of axes: it determines the share that noise explains. */
const FEATURES = 6;

export class LightWithin {
  private readonly share: Float32Array; // of an unknown's rays, by item
  private readonly mean: Float32Array; // of axes over them
  private readonly firstAxis: Uint32Array; // K + 1, into scales and slopes
  private readonly firstMean: Uint32Array; // K
  private readonly firstOfPatch: Uint32Array; // N, into the axes of patches
  private readonly area: Float64Array; // K
  private slopes: Float64Array;

  constructor(private readonly seen: SeenData) {
    const { begin, rays, axes, scale, code } = seen;
    const count = axes.length;
    this.share = new Float32Array(seen.item.length);
    this.mean = new Float32Array(code.length);
    this.firstAxis = new Uint32Array(count + 1);
    this.firstMean = new Uint32Array(count);
    let mean = 0;
    for (let k = 0; k < count; ++k) {
      const first = this.firstAxis[k]!, own = axes[k]!;
      this.firstAxis[k + 1] = first + own;
      this.firstMean[k] = mean;
      for (let p = begin[k]!; p < begin[k + 1]!; ++p) {
        this.share[p] = seen.hits[p]! / rays[k]!;
        for (let a = 0; a < own; ++a, ++mean) this.mean[mean] = ((code[mean]! - 32768) / 32767) * scale[first + a]!;
      }
    }
    this.slopes = new Float64Array(this.firstAxis[count]! * BANDS);
    this.firstOfPatch = new Uint32Array(seen.unknown.length);
    this.area = new Float64Array(count);
    let ofPatch = 0;
    seen.unknown.forEach((k, i) => {
      this.firstOfPatch[i] = ofPatch;
      ofPatch += axes[k]!;
      this.area[k] = this.area[k]! + seen.area[i]!;
    });
  }

  /** Finds the slopes in light of this radiosity of patches, N*3, W/m^2; `sky`: its radiance. */
  look(radiosity: Float64Array, sky: Rgb): void {
    const light = new Float64Array(radiosity.length + BANDS);
    light.set(radiosity);
    light.set(sky.map((x) => Math.PI * x), radiosity.length);
    for (let k = 0; k < this.area.length; ++k) if (this.seen.axes[k]! > 0) this.lookFrom(k, light);
  }

  private lookFrom(k: number, light: Float64Array): void {
    const { begin, item, axes, rays } = this.seen;
    const { share, mean, slopes } = this;
    const own = axes[k]!, first = this.firstAxis[k]! * BANDS;
    slopes.fill(0, first, first + own * BANDS);
    const sum = [0, 0, 0], squares = [0, 0, 0];
    for (let p = begin[k]!, m = this.firstMean[k]!; p < begin[k + 1]!; ++p, m += own) {
      for (let b = 0; b < BANDS; ++b) {
        const value = light[item[p]! * BANDS + b]!;
        const found = share[p]! * value;
        sum[b] = sum[b]! + found;
        squares[b] = squares[b]! + found * value;
        for (let a = 0; a < own; ++a) {
          const at = first + a * BANDS + b;
          slopes[at] = slopes[at]! + found * mean[m + a]!;
        }
      }
    }
    for (let b = 0; b < BANDS; ++b) {
      let explained = 0;
      for (let a = 0; a < own; ++a) explained += rays[k]! * slopes[first + a * BANDS + b]! ** 2;
      const all = rays[k]! * (squares[b]! - sum[b]! ** 2);
      const noise = Math.max(0, all - explained) / (rays[k]! - FEATURES - 1);
      // Shrunk by the share that noise explains (positive-part James and Stein 1961).
      const kept = explained > FEATURES * noise ? 1 - (FEATURES * noise) / explained : 0;
      for (let a = 0; a < own; ++a) slopes[first + a * BANDS + b] = slopes[first + a * BANDS + b]! * kept;
    }
  }

  /** Irradiance of patches, N*3, whose unknowns have `irradiance`, K*3; means over unknowns stay what they are. */
  around(irradiance: Float64Array): Float64Array {
    const { unknown, axes, patchAxis } = this.seen;
    const result = this.spread(irradiance);
    for (let i = 0; i < unknown.length; ++i) {
      const k = unknown[i]!;
      for (let a = 0; a < axes[k]!; ++a) {
        const place = patchAxis[this.firstOfPatch[i]! + a]!;
        for (let b = 0; b < BANDS; ++b) {
          const slope = this.slopes[(this.firstAxis[k]! + a) * BANDS + b]!;
          result[i * BANDS + b] = result[i * BANDS + b]! + slope * place;
        }
      }
    }
    for (let at = 0; at < result.length; ++at) result[at] = Math.max(0, result[at]!);
    const means = this.means(result); // raised by what was cut off at 0
    return result.map((h, at) => {
      const from = unknown[Math.floor(at / BANDS)]! * BANDS + (at % BANDS);
      return means[from]! > 0 ? (h * irradiance[from]!) / means[from]! : h;
    });
  }

  /**
   * The irradiance of each unknown from the patches that it sees, minus the irradiance if each of them had the
   * mean radiosity of its unknown, as in the matrix. K*3, W/m^2.
   */
  beyondMeans(radiosity: Float64Array): Float64Array {
    const { begin, item } = this.seen;
    const means = this.spread(this.means(radiosity));
    const beyond = radiosity.map((x, k) => x - means[k]!);
    const result = new Float64Array(this.area.length * BANDS);
    for (let k = 0; k < this.area.length; ++k) {
      for (let p = begin[k]!; p < begin[k + 1]!; ++p) {
        const from = item[p]! * BANDS;
        if (from === beyond.length) continue; // the sky
        for (let b = 0; b < BANDS; ++b) {
          result[k * BANDS + b] = result[k * BANDS + b]! + this.share[p]! * beyond[from + b]!;
        }
      }
    }
    return result;
  }

  /** Gives each patch the value of its unknown. */
  spread(ofUnknowns: Float64Array): Float64Array {
    const { unknown } = this.seen;
    const result = new Float64Array(unknown.length * BANDS);
    for (let i = 0; i < unknown.length; ++i) {
      for (let b = 0; b < BANDS; ++b) result[i * BANDS + b] = ofUnknowns[unknown[i]! * BANDS + b]!;
    }
    return result;
  }

  /** The means by area over unknowns. */
  private means(values: Float64Array): Float64Array {
    const { unknown, area } = this.seen;
    const sums = new Float64Array(this.area.length * BANDS);
    for (let at = 0; at < values.length; ++at) {
      const i = Math.floor(at / BANDS);
      const to = unknown[i]! * BANDS + (at % BANDS);
      sums[to] = sums[to]! + area[i]! * values[at]!;
    }
    return sums.map((sum, at) => {
      const whole = this.area[Math.floor(at / BANDS)]!;
      return whole > 0 ? sum / whole : 0;
    });
  }
}
