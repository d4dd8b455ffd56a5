// Plots the residual, on a logarithmic axis, over the work of the solver.

import { short } from "./ui";

const WIDTH = 300, HEIGHT = 150, LEFT = 52, RIGHT = 8, TOP = 8, BOTTOM = 30;
const SVG = "http://www.w3.org/2000/svg";

export interface Point {
  x: number; // rows of the matrix that were multiplied, over their number
  y: number; // residual
}

function shape(tag: string, attributes: Record<string, string | number>, text = ""): SVGElement {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.textContent = text;
  return made;
}

/** `told`: the program's own history, drawn hollow; `now`: the point of `run` that is shown. */
export function drawPlot(into: HTMLElement, run: Point[], told: Point[], now: number, axis: string): void {
  const all = [...run, ...told].filter((p) => p.y > 0);
  const decades = all.map((p) => Math.log10(p.y));
  const high = Math.ceil(Math.max(0, ...decades)), low = Math.min(high - 1, Math.floor(Math.min(-1, ...decades)));
  const most = Math.max(...all.map((p) => p.x)) || 1;
  const x = (v: number) => LEFT + (v / most) * (WIDTH - LEFT - RIGHT);
  const y = (v: number) =>
    TOP + ((high - Math.log10(Math.max(v, 10 ** low))) / (high - low)) * (HEIGHT - TOP - BOTTOM);
  const last = run[run.length - 1];
  const svg = shape("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img",
    "aria-label": `Residual against ${axis}` +
      (last ? `: now ${last.y.toExponential(1)} after ${last.x.toFixed(1)}` : "") });
  const every = Math.ceil((high - low) / 5);
  for (let d = high; d >= low; d -= every) {
    svg.append(shape("line", { class: "grid", x1: LEFT, x2: WIDTH - RIGHT, y1: y(10 ** d), y2: y(10 ** d) }),
      shape("text", { x: LEFT - 5, y: y(10 ** d) + 4, "text-anchor": "end" }, d === 0 ? "1" : `1e${d}`));
  }
  svg.append(shape("text", { x: LEFT, y: HEIGHT - BOTTOM + 14 }, "0"),
    shape("text", { x: WIDTH - RIGHT, y: HEIGHT - BOTTOM + 14, "text-anchor": "end" },
      short(Number(most.toPrecision(2)))),
    shape("text", { x: 10, y: (TOP + HEIGHT - BOTTOM) / 2, "text-anchor": "middle",
                    transform: `rotate(-90 10 ${(TOP + HEIGHT - BOTTOM) / 2})` }, "residual"),
    shape("text", { x: (LEFT + WIDTH) / 2, y: HEIGHT - 4, "text-anchor": "middle" }, axis),
    shape("polyline", { class: "run", points: run.map((p) => `${x(p.x)},${y(p.y)}`).join(" ") }));
  for (const p of told) svg.append(shape("circle", { class: "told", cx: x(p.x), cy: y(p.y), r: 3.5 }));
  const here = run[now];
  if (here) svg.append(shape("circle", { class: "now", cx: x(here.x), cy: y(here.y), r: 5 }));
  into.replaceChildren(svg);
}
