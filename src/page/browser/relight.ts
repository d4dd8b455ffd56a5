// Relighting: conjugate gradients (Hestenes & Stiefel 1952) for the irradiance, from the last light on.
//
// H = F (E + rho H) + more, so (I - F rho) H = F E + more. A_i rho_i F_ij rho_j is symmetric in i
// and j (reciprocity), so I - F rho is self-adjoint in <x, y> = sum_i A_i rho_i x_i y_i, and
// positive definite if light dies out, as the method needs. If rho_i = 0, x_i does not affect the
// inner product, but no light is reflected there, and the residual still gives H_i. Bands are
// separate systems that share each pass over the matrix.
import { BANDS, source, type System } from "./solver";

/** The area-weighted mean of each band; 1 for dark bands. */
export function typical(values: ArrayLike<number>, area: Float32Array): Float64Array {
  const sum = new Float64Array(BANDS);
  let total = 0;
  for (let i = 0; i < area.length; ++i) {
    total += area[i]!;
    for (let b = 0; b < BANDS; ++b) sum[b] = sum[b]! + area[i]! * values[i * BANDS + b]!;
  }
  return sum.map((value) => (value > 0 ? value / total : 1));
}

/** An exact or approximate solution: its irradiance and its source(). */
export interface Lit {
  irradiance: Float64Array;
  source: Float64Array;
}

/**
 * A start for `system` from another light: scaled by the ratio of the power of each band now and then. It is
 * exact if only the one lamp changed.
 */
function start(system: System, lit: Lit): Float64Array {
  const now = typical(source(system), system.factors.area);
  const then = typical(lit.source, system.factors.area);
  return lit.irradiance.map((h, k) => (h * now[k % BANDS]!) / then[k % BANDS]!);
}

export class Relight {
  /** The products with the matrix so far. */
  products = 0;
  /** max |E + rho H - B| over the mean irradiance, worst band; infinite if light does not die out. */
  residual = Infinity;

  private readonly weight: Float64Array; // A rho
  private readonly h: Float64Array;
  private readonly left: Float64Array; // F (E + rho h) + more - h
  private readonly direction: Float64Array;
  private size: Float64Array; // <left, left>

  /** `multiply`: F x. */
  constructor(readonly system: System, lit: Lit, private readonly multiply: (x: Float64Array) => Float64Array) {
    const { area } = system.factors;
    this.weight = Float64Array.from(system.reflectance, (rho, k) => rho * area[Math.floor(k / BANDS)]!);
    this.h = start(system, lit);
    const radiosity = this.h.map((h, k) => system.emission[k]! + system.reflectance[k]! * h);
    this.left = multiply(radiosity).map((gathered, k) => gathered + system.more[k]! - this.h[k]!);
    this.direction = this.left.slice();
    this.size = this.inner(this.left, this.left);
    this.products = 1;
    this.measure();
  }

  /** F B + more for the present B; at least 0, since light is not negative. */
  irradiance(): Float64Array { return this.h.map((h, k) => Math.max(0, h + this.left[k]!)); }

  /** A start for other materials. */
  lit(): Lit { return { irradiance: this.irradiance(), source: source(this.system) }; }

  /** Iterates until the residual is within `tolerance`, or until `expired()` is true. */
  run(tolerance: number, expired: () => boolean): void {
    while (this.residual > tolerance && Number.isFinite(this.residual)) {
      this.step();
      if (expired()) return;
    }
  }

  private step(): void {
    const { h, left, direction } = this;
    const image = this.multiply(direction.map((x, k) => this.system.reflectance[k]! * x));
    ++this.products;
    for (let k = 0; k < image.length; ++k) image[k] = direction[k]! - image[k]!; // (I - F rho) direction
    const curvature = this.inner(direction, image);
    if (curvature.some((value, b) => this.size[b]! > 0 && !(value > 0))) {
      this.residual = Infinity;
      return;
    }
    const along = this.size.map((value, b) => (value > 0 ? value / curvature[b]! : 0));
    for (let k = 0; k < h.length; ++k) {
      h[k] = h[k]! + along[k % BANDS]! * direction[k]!;
      left[k] = left[k]! - along[k % BANDS]! * image[k]!;
    }
    const size = this.inner(left, left);
    const keep = size.map((value, b) => (value > 0 ? value / this.size[b]! : 0));
    for (let k = 0; k < h.length; ++k) direction[k] = left[k]! + keep[k % BANDS]! * direction[k]!;
    this.size = size;
    this.measure();
  }

  private measure(): void {
    const mean = typical(this.h, this.system.factors.area);
    this.residual = 0;
    for (let k = 0; k < this.left.length; ++k) {
      const share = (this.system.reflectance[k]! * Math.abs(this.left[k]!)) / mean[k % BANDS]!;
      if (!(share <= this.residual)) this.residual = share;
    }
  }

  private inner(x: Float64Array, y: Float64Array): Float64Array {
    const sum = new Float64Array(BANDS);
    for (let k = 0; k < x.length; ++k) sum[k % BANDS] = sum[k % BANDS]! + this.weight[k]! * x[k]! * y[k]!;
    return sum;
  }
}
