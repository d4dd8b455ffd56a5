// The panel that gives the page away: a link, a picture, the command of the program that draws the same.
import { Fragment } from "./fragment";
import type { RelightPanel } from "./relight_panel";
import { pixelRatio } from "./stage";
import { copy, element, on, quoted, select } from "./ui";
import type { Show, Viewer } from "./viewer";

const POSTER = 2; // times the picture's width and height

/** Of what the program draws of patches. */
const SHOWN: Partial<Record<Show, string>> = {
  "illuminance": "illuminance", "radiosity": "radiosity", "irradiance": "irradiance", "row-sum": "row-sum", "factors": "form-factor:",
  "temperature": "temperature", "net-flux": "net-flux", "heat-irradiance": "heat-irradiance" };

const precise = (x: number): string => String(Number(x.toPrecision(6)));

/** The options of `radiosity render` for the quantity that is shown. */
function lookOptions(viewer: Viewer): string[] {
  const { uniforms, meshes } = viewer;
  const flat = meshes.surfaces === "smooth" ? [] : ["--flat"];
  const shown = viewer.shown();
  const quantity = SHOWN[shown];
  if (quantity) {
    const patch = shown === "factors" ? viewer.picks.first?.patch ?? "" : "";
    const range = `--range ${precise(uniforms.low.value)},${precise(uniforms.high.value)}`;
    return [...flat, `--show ${quantity}${patch}`, range];
  }
  const elements = flat.length > 0 || viewer.showsElements ? flat : ["--elements off"];
  return [...elements, `--exposure ${precise(uniforms.exposure.value)}`];
}

/** What the command does not draw, in words. */
function differences(viewer: Viewer, relight: RelightPanel): string[] {
  const shown = viewer.shown();
  const textured = relight.withoutOption();
  const all: [boolean, string][] = [
    [shown !== "light" && !SHOWN[shown], "this quantity"],
    [shown !== "light" && viewer.uniforms.logarithmic.value, "logarithmic colours"],
    [shown === "light" && select("tone").value !== "linear", "tone mapping"],
    [shown === "light" && viewer.isolines, "isolines (--show illuminance has them)"],
    [viewer.meshes.outlines || viewer.meshes.surfaces === "wireframe", "lines"],
    [viewer.stage.split !== null, "the light before"],
    [viewer.source === "run", "a light on the way to the solution"],
    [viewer.source === "gathered", "gathered light (add --final-gather)"],
    [textured.length > 0, `the changed emission of ${textured.join(", ")}, which is textured`]];
  return all.filter(([is]) => is).map(([, words]) => words);
}

/** The command that draws the picture as it is now. */
function command(viewer: Viewer, relight: RelightPanel): string {
  const { header } = viewer.data;
  const [width, height] = viewer.stage.size();
  return ["radiosity render", header.arguments || "RESULTS.h5", ...relight.options(), ...lookOptions(viewer),
          `--camera '${viewer.control.text()}'`, `--width ${width} --height ${height}`,
          `-o ${quoted(`${header.title}.png`)}`].join(" ");
}

/** Draws the legend as the page has it, in the picture's lower left corner. */
function drawLegend(viewer: Viewer, context: CanvasRenderingContext2D, scale: number): void {
  const [x, y, width] = [14 * scale, context.canvas.height - 84 * scale, 360 * scale];
  const style = getComputedStyle(element("legend"));
  context.fillStyle = style.backgroundColor;
  context.fillRect(x, y, width, 70 * scale);
  context.fillStyle = style.color;
  context.font = `${13 * scale}px system-ui, sans-serif`;
  context.fillText(element("legend-title").textContent ?? "", x + 12 * scale, y + 20 * scale);
  const inner = width - 24 * scale;
  for (let k = 0; k < 256; ++k) {
    context.fillStyle = `rgb(${viewer.colourMap(k / 255).map(Math.round).join(" ")})`;
    context.fillRect(x + 12 * scale + (inner * k) / 256, y + 28 * scale, inner / 256 + 1, 12 * scale);
  }
  context.fillStyle = style.color;
  const ticks = [...element("legend-ticks").children].map((tick) => tick.textContent ?? "");
  const widths = ticks.map((tick) => context.measureText(tick).width);
  const gap = (inner - widths.reduce((sum, each) => sum + each, 0)) / (ticks.length - 1);
  let at = x + 12 * scale;
  ticks.forEach((tick, k) => {
    context.fillText(tick, at, y + 58 * scale);
    at += widths[k]! + gap;
  });
}

/** The picture with its sky and legend; without a sky, nothing is where nothing stands, as in the program's. */
function picture(viewer: Viewer, scale: number): HTMLCanvasElement {
  const drawn = viewer.stage.still(scale);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [drawn.width, drawn.height];
  const context = canvas.getContext("2d")!;
  context.fillStyle = element("stage").style.background || "transparent";
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(drawn, 0, 0);
  if (viewer.shown() !== "light") drawLegend(viewer, context, scale);
  return canvas;
}

function save(viewer: Viewer, scale: number, name: string): void {
  picture(viewer, scale).toBlob((blob) => {
    if (!blob) return;
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  });
}

export function setUpShare(viewer: Viewer, relight: RelightPanel): Fragment {
  const { title } = viewer.data.header;
  const fragment = new Fragment(viewer, relight, (unknown) => {
    element("link-note").hidden = unknown.length === 0;
    element("link-note").textContent = `The link has what this page lacks: ${unknown.join(", ")}.`;
  });
  const say = () => {
    const without = differences(viewer, relight);
    element("command").textContent = command(viewer, relight);
    element("command-note").hidden = without.length === 0;
    element("command-note").textContent = `It draws all but ${without.join("; ")}.`;
  };
  for (const event of ["light", "view", "picks"]) viewer.listen(event, say);
  viewer.control.listen(say);
  on("app", "input", say);
  on("app", "change", say);
  window.addEventListener("resize", say);
  say();
  on("copy-link", "click", () => void copy(fragment.link(), element("copy-link")));
  on("save-picture", "click", () => save(viewer, pixelRatio(), `${title}.png`));
  on("save-poster", "click", () => save(viewer, POSTER * pixelRatio(), `${title}-${POSTER}x.png`));
  element("full-screen").hidden = !document.fullscreenEnabled;
  on("full-screen", "click", () => void element("app").requestFullscreen());
  on("copy-command", "click", () => void copy(element("command").textContent ?? "", element("copy-command")));
  return fragment;
}
