// The range of false colours for the values of patches.

/** A missing value, in 32 bits as the others; drawn in grey. */
export const NO_VALUE = Math.fround(-1e30);

/** `rising`: from 0, or below; `fitted`: from the least value; `diverging`: 0 is in the middle. */
export type Scale = "rising" | "fitted" | "logarithmic" | "diverging";

export interface Range {
  low: number;
  high: number;
}

/** The share of values, from the least on, that the automatic range covers: lamps are few and far brighter. */
const COVERED = 0.98;
const DECADES = 1e-4; // of a logarithmic range, at most

/** The values that have a colour, in increasing order; on a logarithmic scale 0 has none. */
function coloured(values: Float32Array, scale: Scale): Float32Array {
  return values.filter((value) => value !== NO_VALUE && (scale !== "logarithmic" || value > 0)).sort();
}

/** The least and the largest of them; both 0 if there is none. */
export function extremes(values: Float32Array, scale: Scale): Range {
  const all = coloured(values, scale);
  return { low: all[0] ?? 0, high: all[all.length - 1] ?? 0 };
}

/** The range ends at the value that `COVERED` of them reach, or at the largest if that is no range. */
export function automaticRange(values: Float32Array, scale: Scale): Range {
  const diverging = scale === "diverging";
  const all = coloured(diverging ? values.map(Math.abs) : values, scale);
  if (all.length === 0) return { low: scale === "logarithmic" ? DECADES : 0, high: 1 };
  const begin = scale === "rising" || diverging ? Math.min(0, all[0]!) : all[0]!;
  const most = all[Math.floor(COVERED * (all.length - 1))]!;
  const high = most > begin ? most : all[all.length - 1]!;
  if (diverging) return { low: -(high || DECADES), high: high || DECADES };
  return { low: scale === "logarithmic" ? Math.max(begin, high * DECADES) : begin, high };
}
