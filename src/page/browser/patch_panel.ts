// The panel of the picked patches and their exchange.
import { radiosityOf } from "./light";
import type { MarkName } from "./stage";
import { element, input, make, number, on, unfold } from "./ui";
import type { Picked, Viewer } from "./viewer";

const NAMES: MarkName[] = ["first", "second"];

function list(rows: [string, Node | string][]): HTMLElement {
  const items = rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]);
  return make("dl", {}, ...items);
}

function bandTable(viewer: Viewer, patch: number): HTMLElement {
  const { light } = viewer;
  const radiosity = radiosityOf(light);
  const rows: [string, string, Float32Array][] = [
    ["emission", "E, W/m²", light.emission], ["reflectance", "ρ", light.reflectance],
    ["irradiance", "H, W/m²", light.irradiance], ["radiosity", "B, W/m²", radiosity]];
  const heads = ["", "red", "green", "blue"].map((text) => make("th", { scope: "col" }, text));
  const body = rows.map(([key, label, values]) => make("tr", { "data-row": key }, make("th", { scope: "row" }, label),
    ...[0, 1, 2].map((band) => make("td", {}, number(values[patch * 3 + band]!)))));
  return make("table", {}, make("thead", {}, make("tr", {}, ...heads)), make("tbody", {}, ...body));
}

function facts(viewer: Viewer, name: MarkName, { patch }: Picked): HTMLElement {
  const { data } = viewer;
  const surface = data.header.surfaces[data.surface[patch]!]!;
  const node = data.node[patch]!;
  const rows: [string, Node | string][] = [
    ["Surface", surface.name],
    ["Material", data.header.materials[surface.material]?.name ?? "none"],
    ["Side", data.side[patch] === 1 ? "back" : "front"],
    ["Area, m²", number(data.area[patch]!)],
    ["Row sum", number(data.rowSum[node]!)],
  ];
  if (data.heat) {
    rows.push(["Temperature, K", number(data.heat.temperature[patch]!)]);
    rows.push(["Net flux of heat, W/m²", number(data.heat.netFlux[patch]!)]);
  }
  if (data.rowError.length > 0) rows.push(["Error figure of the row", number(data.rowError[node]!)]);
  if (viewer.clustered) rows.push(["Node of patches", number(node)]);
  return make("section", { "data-pick": name }, make("h3", { class: name }, `Patch ${patch}`), list(rows),
    bandTable(viewer, patch));
}

/** Of nodes i and j: the heat that i sends to j less what it gets from there. */
function exchanged({ data }: Viewer, i: number, j: number, factorArea: number): [string, Node][] {
  if (!data.heat) return [];
  const { radiosity } = data.heat;
  const mean = (k: number) => data.node.reduce((sum, node, patch) =>
    (node === k ? sum + data.area[patch]! * radiosity[patch]! : sum), 0) / data.nodeArea[k]!;
  return [["Net heat there, W", number(factorArea * (mean(i) - mean(j)))]];
}

function pair(viewer: Viewer): HTMLElement | string {
  const { first, second } = viewer.picks;
  if (!first?.row || !second?.row) return "";
  const { node, nodeArea } = viewer.data;
  const i = node[first.patch]!, j = node[second.patch]!;
  const [one, other] = viewer.clustered ? [`node ${i}`, `node ${j}`] : [first.patch, second.patch];
  const areas: [string, Node][] = viewer.clustered
    ? [[`Area of ${one}, m²`, number(nodeArea[i]!)], [`Area of ${other}, m²`, number(nodeArea[j]!)]] : [];
  const there = first.row[j]!, back = second.row[i]!;
  const power = nodeArea[i]! * there, powerBack = nodeArea[j]! * back;
  const apart = power > 0 ? Math.abs(power - powerBack) / power : 0;
  return make("section", { "data-pick": "pair" }, make("h3", {}, "What they exchange"), list([
    [`F from ${one} to ${other}`, number(there)],
    [`F from ${other} to ${one}`, number(back)],
    ...areas,
    ["A F there, m²", number(power)],
    ["A F back, m²", number(powerBack)],
    ["Reciprocity, difference", number(apart)],
    ...exchanged(viewer, i, j, power),
  ]), make("p", { class: "note" }, (viewer.clustered ? "Form factors are between nodes of patches that are near each other. " : "") +
    "One of each pair is stored; the other follows from A₁F₁₂ = A₂F₂₁."));
}

export function setUpPatch(viewer: Viewer): void {
  const refresh = () => {
    const picked = NAMES.filter((name) => viewer.picks[name]);
    element("pick-facts").replaceChildren(...picked.map((name) => facts(viewer, name, viewer.picks[name]!)));
    element("pick-pair").replaceChildren(pair(viewer));
    element("pick-clear").hidden = picked.length === 0;
  };
  const showPicks = () => {
    for (const name of NAMES) input(`pick-${name}`).value = String(viewer.picks[name]?.patch ?? "");
    refresh();
  };
  viewer.listen("picks", showPicks);
  viewer.listen("light", refresh);
  viewer.listen("rows", refresh); // not the fields, since a number may be being typed
  for (const name of NAMES) {
    const field = input(`pick-${name}`);
    field.max = String(viewer.data.header.patches - 1);
    field.addEventListener("change", () => {
      if (field.reportValidity()) void viewer.pick(name, field.value === "" ? null : Number(field.value));
    });
  }
  on("paint", "change", () => {
    viewer.paint = input("paint").checked;
    viewer.refreshValues();
  });
  on("pick-clear", "click", () => clearPicks(viewer));
}

export function clearPicks(viewer: Viewer): void {
  for (const name of NAMES) void viewer.pick(name, null);
}

/** A click picks while the panel is open. */
export const inspecting = (): boolean => element<HTMLDetailsElement>("patch-panel").open;

/** Picks the patch at a pixel. If there is none it clears that pick, the first one with the second. */
export function pickAt(viewer: Viewer, x: number, y: number, second: boolean): void {
  const name = second ? "second" : "first";
  const patch = viewer.patchAt(x, y);
  unfold("patch-panel");
  if (patch === null && !second) clearPicks(viewer);
  else void viewer.pick(name, patch).then(() => bringIntoSight(name));
}

/** Scrolls the panels to the exchange of two picks, or else to the facts of this one. */
function bringIntoSight(name: MarkName): void {
  const [pair, facts] = ["pair", name].map((of) => document.querySelector(`[data-pick="${of}"]`));
  (pair ?? facts)?.scrollIntoView({ block: "nearest" });
}
