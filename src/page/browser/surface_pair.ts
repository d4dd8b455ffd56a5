// What two surfaces exchange, in the panel Inspect: form factors both ways, each summed over the matrix' own rows.
import { number, make, select, on, element } from "./ui";
import type { Viewer } from "./viewer";

const BANDS = 3; // of a product with the matrix

/** By node: the area of a surface in it, and what of it `values` of patches weigh. */
function inNodes({ data }: Viewer, surface: number, values: Float32Array | null): Float64Array {
  const sums = new Float64Array(data.nodeArea.length);
  data.surface.forEach((of, patch) => {
    if (of === surface) sums[data.node[patch]!] = sums[data.node[patch]!]! + data.area[patch]! * (values?.[patch] ?? 1);
  });
  return sums;
}

const dot = (a: Float64Array, b: Float64Array): number => a.reduce((sum, x, k) => sum + x * b[k]!, 0);
const total = (a: Float64Array): number => a.reduce((sum, x) => sum + x, 0);

/** Rows of a list: A F both ways, and with heat the net exchange. One product with the matrix. */
async function exchange(viewer: Viewer, one: number, other: number): Promise<[string, number][]> {
  const { data, solver } = viewer;
  const radiosity = data.heat?.radiosity ?? null;
  const mine = inNodes(viewer, one, null), theirs = inNodes(viewer, other, null);
  const sent = [mine, theirs, radiosity ? inNodes(viewer, other, radiosity) : mine];
  const values = new Float32Array(data.nodeArea.length * BANDS);
  sent.forEach((areas, b) => areas.forEach((area, k) => { values[k * BANDS + b] = area / data.nodeArea[k]!; }));
  const product = await solver.product(values);
  const seen = (b: number) => Float64Array.from(mine, (_, k) => product[k * BANDS + b]!);
  const there = dot(mine, seen(1)), back = dot(theirs, seen(0));
  const rows: [string, number][] = [
    ["F there", there / total(mine)], ["F back", back / total(theirs)],
    ["Area of the first, m²", total(mine)], ["Area of the second, m²", total(theirs)],
    ["Reciprocity, difference", there > 0 ? Math.abs(there - back) / there : 0]];
  if (radiosity) rows.push(["Net heat there, W", dot(inNodes(viewer, one, radiosity), seen(1)) - dot(mine, seen(2))]);
  return rows;
}

export function setUpSurfacePair(viewer: Viewer): void {
  const names = ["surface-first", "surface-second"];
  const options = () => viewer.data.header.surfaces.map(({ name }, k) => make("option", { value: String(k) }, name));
  for (const name of names) select(name).append(...options());
  const refresh = async () => {
    const [one, other] = names.map((name) => select(name).value);
    const rows = one && other ? await exchange(viewer, Number(one), Number(other)) : [];
    if (names.some((name, k) => select(name).value !== [one, other][k])) return; // another choice since
    element("surface-pair").replaceChildren(
      ...rows.flatMap(([label, value]) => [make("dt", {}, label), make("dd", {}, number(value))]));
  };
  for (const name of names) on(name, "change", () => void refresh());
}
