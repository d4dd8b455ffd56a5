// The messages between the page and its solver worker. Values of nodes: K * 3, row-major.
import type { StoredFactors } from "./factors";
import type { Method } from "./methods";

/** The materials of nodes, with the viewer's changes. */
export interface Materials {
  emission: Float32Array; // W/m^2
  reflectance: Float32Array;
  direct: Float32Array; // irradiance from outside the form factors, W/m^2
}

/** The data that the worker gets once. */
export interface Load {
  stored: StoredFactors;
  order: Uint32Array | null; // of Gauss-Seidel's sweeps over nodes; null: as numbered
  materials: Materials;
  irradiance: Float32Array; // as stored
  arePatches: boolean; // else clusters of patches
}

export type Request =
  | ({ kind: "load" } & Load)
  | { kind: "rows"; ticket: number; nodes: number[] }
  | { kind: "product"; ticket: number; values: Float32Array } // F x
  | { kind: "warm" }
  | { kind: "relight"; ticket: number; materials: Materials | null; milliseconds: number } // null: go on
  | { kind: "start"; run: number; method: Method; materials: Materials }
  | { kind: "step"; run: number };

/** A moment of a run: iterate `rows` of the matrix (over K) from the start. */
export interface Frame {
  run: number;
  index: number; // 0: B = E
  irradiance: Float32Array;
  rows: number;
  residual: number; // true residual over the brightest source; Southwell: of the light sent
  change: number; // Gauss-Seidel: the largest of the sweep, over the brightest source; else NaN
  finished: boolean; // no work is left, or the precision is exhausted
}

export type Reply =
  | { kind: "loaded"; entries: number; agreement: number; reference: Float32Array | null }
  | { kind: "rows"; ticket: number; rows: Float32Array[] }
  | { kind: "product"; ticket: number; values: Float32Array }
  | { kind: "relit"; ticket: number; irradiance: Float32Array; products: number; residual: number;
      converged: boolean; milliseconds: number }
  | ({ kind: "frame" } & Frame)
  | { kind: "failed"; message: string };
