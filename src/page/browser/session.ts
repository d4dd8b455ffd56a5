// The state of the solver worker between messages: the matrix, the last light, and a run that is
// watched. It does not depend on workers, so that tests can call it directly.
import { type Factors, denseRow, expand } from "./factors";
import type { Method } from "./methods";
import type { Frame, Load, Materials, Reply } from "./protocol";
import { type Lit, Relight } from "./relight";
import * as solver from "./solver";
import type { Iterate, System } from "./solver";
import { VectorProduct } from "./vector_product";

/** Relighting is done when the residual is within this share of the mean irradiance. */
export const RELIGHT_TOLERANCE = 5e-5;
/** The most time for the reference light of nodes. */
const REFERENCE_MS = 5000;
/** The approximate limit of warm-up work. */
const WARM_MS = 150;
/** Residuals below this are the rounding of 32-bit form factors. */
const ROUNDING = 1e-7;

interface Run {
  id: number;
  method: Method;
  system: System;
  iterate: Iterate;
  southwell: solver.Southwell | null;
  index: number;
}

export class Session {
  private readonly vectors: VectorProduct | null;
  private readonly factors: Factors;
  private lit: Lit;
  private relighting: Relight | null = null;
  private run: Run | null = null;
  readonly loaded: Reply & { kind: "loaded" };

  /**
   * Where nodes are clusters of patches, the stored light is not the solution of their matrix, so a reference is
   * solved for. `kernel`: of VectorProduct; without it, products are plain sums.
   */
  constructor(private readonly load: Load, kernel: Uint8Array<ArrayBuffer> | null) {
    this.vectors = kernel && WebAssembly.validate(kernel) ? new VectorProduct(load.stored, kernel) : null;
    this.factors = this.vectors?.factors ?? expand(load.stored);
    const stored = Float64Array.from(load.irradiance);
    const system = this.system(load.materials);
    const radiosity = stored.map((h, k) => system.emission[k]! + system.reflectance[k]! * h);
    this.lit = { irradiance: stored, source: solver.source(system) };
    const gathered = this.multiply(radiosity).map((h, k) => h + system.more[k]!);
    this.loaded = {
      kind: "loaded",
      entries: this.factors.value.length,
      agreement: relativeDifference(gathered, stored, this.factors.area),
      reference: load.arePatches ? null : this.referenceLight(),
    };
  }

  rows(nodes: number[]): Float32Array[] {
    return nodes.map((i) => denseRow(this.factors, i));
  }

  /** F x of single values, K * 3. */
  product(x: Float32Array): Float32Array { return Float32Array.from(this.multiply(Float64Array.from(x))); }

  /** Solves for the light of `materials` from the last light for about this time; null: continues. */
  relight(materials: Materials | null, milliseconds: number): Omit<Reply & { kind: "relit" }, "ticket"> {
    const began = performance.now();
    if (materials) this.relighting = this.relightFor(materials);
    const relight = this.relighting!;
    const before = materials ? 0 : relight.products;
    relight.run(RELIGHT_TOLERANCE, () => performance.now() - began > milliseconds);
    if (Number.isFinite(relight.residual)) this.lit = relight.lit();
    return {
      kind: "relit",
      irradiance: Float32Array.from(relight.irradiance()),
      products: relight.products - before,
      residual: relight.residual,
      converged: relight.residual <= RELIGHT_TOLERANCE,
      milliseconds: performance.now() - began,
    };
  }

  /** Relights without keeping the result, since browsers optimise code the more it is used. */
  warm(): void {
    const began = performance.now();
    const { materials } = this.load;
    const relight = this.relightFor({ ...materials, reflectance: materials.reflectance.map((rho) => 0.9 * rho) });
    relight.run(RELIGHT_TOLERANCE, () => performance.now() - began > WARM_MS);
  }

  private relightFor(materials: Materials): Relight {
    return new Relight(this.system(materials), this.lit, (x) => this.multiply(x));
  }

  /** The matrix' own light of nodes, with materials as stored. */
  private referenceLight(): Float32Array {
    const began = performance.now();
    const relight = this.relightFor(this.load.materials);
    relight.run(RELIGHT_TOLERANCE, () => performance.now() - began > REFERENCE_MS);
    this.lit = relight.lit();
    return Float32Array.from(relight.irradiance());
  }

  /** F x. */
  private multiply(x: Float64Array): Float64Array {
    return this.vectors?.multiply(x) ?? solver.product(this.factors, x);
  }

  start(id: number, method: Method, materials: Materials): Frame {
    const system = this.system(materials);
    const southwell = method === "southwell" ? solver.southwellStart(system) : null;
    const iterate = southwell ? southwell.iterate : solver.fromEmission(system);
    this.run = { id, method, system, iterate, southwell, index: 0 };
    return this.frame(this.run, southwell ? null : solver.irradianceOf(system, iterate.radiosity), NaN);
  }

  /** The next frame of the run; null if another was started since. */
  step(id: number): Frame | null {
    const run = this.run;
    if (!run || run.id !== id) return null;
    ++run.index;
    return this.steps[run.method](run);
  }

  private readonly steps: Record<Method, (run: Run) => Frame> = {
    "jacobi": (run) => {
      run.iterate = solver.jacobiSweep(run.system, run.iterate);
      return this.frame(run, solver.irradianceOf(run.system, run.iterate.radiosity), NaN);
    },
    "gauss-seidel": (run) => {
      const scale = solver.scales(solver.source(run.system));
      const change = solver.gaussSeidelSweep(run.system, run.iterate, scale, this.load.order ?? undefined);
      return this.frame(run, solver.irradianceOf(run.system, run.iterate.radiosity), change);
    },
    "southwell": (run) => this.shots(run, run.southwell!),
  };

  /** Makes a tenth as many new shots as there were, at least one, so that the first are shown singly. */
  private shots(run: Run, southwell: solver.Southwell): Frame {
    const before = Math.round(run.iterate.rows * this.factors.size);
    let left = true;
    for (let n = Math.max(1, Math.ceil(before / 10)); n > 0 && left; --n) {
      left = solver.southwellShot(run.system, southwell);
    }
    return this.frame(run, null, NaN, !left);
  }

  /** `gathered`: F B + more of the iterate's B; null: Southwell, which keeps its residual. */
  private frame(run: Run, gathered: Float64Array | null, change: number, exhausted = false): Frame {
    const residual = gathered
      ? solver.residual(run.system, run.iterate.radiosity, gathered)
      : solver.southwellResidual(run.system, run.southwell!);
    return {
      run: run.id,
      index: run.index,
      irradiance: Float32Array.from(run.iterate.irradiance),
      rows: run.iterate.rows,
      residual,
      change,
      finished: exhausted || !(residual > ROUNDING),
    };
  }

  private system(materials: Materials): System {
    const { emission, reflectance, direct } = materials;
    return { factors: this.factors, emission, reflectance, more: direct };
  }
}

/** The relative root mean square difference by area, all bands together. */
function relativeDifference(a: Float64Array, b: Float64Array, area: Float32Array): number {
  let difference = 0, size = 0;
  for (let k = 0; k < a.length; ++k) {
    const weight = area[Math.floor(k / solver.BANDS)]!;
    difference += weight * (a[k]! - b[k]!) ** 2;
    size += weight * b[k]! ** 2;
  }
  return size > 0 ? Math.sqrt(difference / size) : 0;
}
