// The panel of heat: what each surface gives off, and its temperature.
import { element, make, short } from "./ui";
import type { Viewer } from "./viewer";

const ROUNDING = 1e-9; // of the largest value: less is rounding, and shown as 0

export function setUpHeat(viewer: Viewer): void {
  const { heat } = viewer.data.header;
  if (!heat) return element("heat-panel").remove();
  element("heat-facts").textContent = heat.message;
  const columns = [
    heat.surfaces.map((surface) => surface.temperature ?? NaN), heat.surfaces.map((surface) => surface.net_flux),
    heat.surfaces.map((surface) => surface.radiated + surface.convected)];
  const cell = (column: number[], row: number) => {
    const value = column[row]!;
    const rounding = Math.abs(value) < ROUNDING * Math.max(...column.map(Math.abs));
    return make("td", {}, make("data", { value: String(value) }, short(rounding ? 0 : value)));
  };
  element("heat-surfaces").replaceChildren(...heat.surfaces.map(({ name }, row) =>
    make("tr", {}, make("th", { scope: "row" }, name), ...columns.map((column) => cell(column, row)))));
}
