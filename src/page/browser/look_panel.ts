// The panel of the view: exposure, tone mapping, surfaces, false colour with its legend, before and
// after.
import { toSrgb } from "./colour";
import { toneIndex, type Tone } from "./shading";
import type { Surfaces } from "./scene";
import { element, input, make, on, onChoice, select, short } from "./ui";
import type { Show, Viewer } from "./viewer";

const TITLES: Record<Show, string> = {
  "light": "Light",
  "illuminance": "Illuminance, lx",
  "radiosity": "Radiosity B (luminance), W/m²",
  "irradiance": "Irradiance H (luminance), W/m²",
  "row-sum": "Row sum of form factors",
  "row-error": "Error figure of the row",
  "factors": "Form factor from the picked patch",
  "temperature": "Temperature, K",
  "net-flux": "Net flux of heat that is given off, W/m²",
  "heat-irradiance": "Irradiance of heat, W/m²",
  "difference": "B less the matrix solution's (luminance), W/m²",
};
/** The unit of what is shown; light is measured in lux. */
export const unitOf = (shown: Show): string => (shown === "light" ? "lx" : TITLES[shown].split(", ")[1] ?? "");

const EXPOSURE_STOPS = 8;

/** The reason why no form factors can be painted; null: they can. */
function whyNoFactors(viewer: Viewer): string | null {
  const { first } = viewer.picks;
  if (!first) return "pick a patch";
  return first.row?.every((value) => value === 0) ? "all are 0" : null;
}

function showLegend(viewer: Viewer): void {
  const shown = viewer.shown();
  element("legend").hidden = shown === "light";
  element("range-rows").hidden = shown === "light";
  if (shown === "light") return;
  const low = viewer.uniforms.low.value, high = viewer.uniforms.high.value;
  const logarithmic = viewer.uniforms.logarithmic.value;
  const why = shown === "factors" ? whyNoFactors(viewer) : null;
  element("legend-title").textContent = TITLES[shown] + (why ? `: ${why}` : logarithmic ? " (grey: 0)" : "");
  element("legend-bar").hidden = element("legend-ticks").hidden = why !== null;
  const stops = Array.from({ length: 17 }, (_, k) => `rgb(${viewer.colourMap(k / 16).map(Math.round).join(" ")})`);
  element("legend-bar").style.background = `linear-gradient(to right, ${stops.join(",")})`;
  element("legend-bar").setAttribute("aria-label", `Colours from ${short(low)} to ${short(high)}`);
  const at = (t: number) => (logarithmic ? low * (high / low) ** t : low + t * (high - low));
  const { extremes } = viewer;
  const signs = [extremes.low < low ? "≤ " : "", "", "", "", extremes.high > high ? "≥ " : ""];
  element("legend-ticks").replaceChildren(...signs.map((sign, k) => make("span", {}, sign + short(at(k / 4)))));
  if (!viewer.range) {
    input("range-low").value = short(low);
    input("range-high").value = short(high);
  }
}

/** Of the sky's brightness: it is shown a little darker, so that a surface as bright as it, or white, stands out. */
const SKY_SHARE = 0.88;

/** Shows the sky behind the scene. */
function showSky(viewer: Viewer): void {
  const sky = viewer.background().map((x) => x * 2 ** viewer.uniforms.exposure.value);
  if (!viewer.data.header.lights.some(({ radiance }) => Math.max(...radiance) > 0)) return;
  const bytes = sky.map((x) => Math.round(255 * SKY_SHARE * toSrgb(Math.min(1, Math.max(0, x)))));
  element("stage").style.background = `rgb(${bytes.join(" ")})`;
}

function setUpExposure(viewer: Viewer): void {
  const slider = input("exposure");
  const middle = viewer.data.header.exposure;
  slider.min = String(middle - EXPOSURE_STOPS);
  slider.max = String(middle + EXPOSURE_STOPS);
  slider.value = String(middle);
  const say = () => { element("exposure-text").textContent = `${Number(slider.value).toFixed(2)} EV`; };
  on("exposure", "input", () => {
    viewer.uniforms.exposure.value = Number(slider.value);
    say();
    viewer.refreshView();
  });
  say();
}

function setUpRange(viewer: Viewer): void {
  const given = () => {
    const high = Number(input("range-high").value);
    const low = viewer.scale === "diverging" ? -high : Number(input("range-low").value);
    const positive = !viewer.uniforms.logarithmic.value || low > 0;
    const wrong = !(high > low) || !positive;
    input("range-high").setCustomValidity(wrong ? "The range must rise, above 0 on a logarithmic scale" : "");
    if (wrong) return void input("range-high").reportValidity();
    if (viewer.scale === "diverging") input("range-low").value = String(low);
    viewer.range = { low, high };
    viewer.refreshView();
  };
  on("range-low", "change", given);
  on("range-high", "change", given);
  on("range-auto", "click", () => {
    viewer.range = null;
    viewer.refreshView();
  });
  on("logarithmic", "change", () => {
    viewer.uniforms.logarithmic.value = input("logarithmic").checked;
    viewer.range = null;
    viewer.refreshView();
  });
}

function setUpSplit(viewer: Viewer): void {
  const apply = () => {
    const share = Number(input("split").value) / 100;
    const wanted = input("before-after").checked;
    viewer.stage.split = wanted ? share : null;
    element("split-frame").hidden = !wanted;
    element("split-line").style.left = `${100 * share}%`;
    viewer.stage.draw();
  };
  on("before-after", "change", apply);
  on("split", "input", apply);
  viewer.listen("light", () => {
    const gathered = viewer.source === "gathered";
    element("split-before").textContent = gathered ? "Matrix solution" : "Stored";
    element("split-now").textContent = gathered ? "Gathered" : "Now";
  });
}

/** Chooses the scale: logarithmic at first for form factors, which span decades, linear for others. */
function scaleFor(viewer: Viewer, shown: Show): void {
  const logarithmic = shown === "factors";
  viewer.uniforms.logarithmic.value = logarithmic;
  input("logarithmic").checked = logarithmic;
  element("logarithmic-row").hidden = viewer.scale === "diverging";
  input("range-low").disabled = viewer.scale === "diverging"; // it is the other end's opposite
  viewer.range = null;
}

export function setUpLook(viewer: Viewer): void {
  setUpExposure(viewer);
  setUpRange(viewer);
  setUpSplit(viewer);
  let last: Show = "light";
  viewer.listen("view", () => {
    const shown = viewer.shown();
    if (shown !== last) {
      last = shown;
      scaleFor(viewer, shown);
      return viewer.refreshView();
    }
    showLegend(viewer);
    const step = viewer.uniforms.lineStep.value;
    element("isolines-step").textContent = step > 0 ? `, every ${short(step)} ${unitOf(shown)}` : "";
    showSky(viewer);
  });
  on("show", "change", () => {
    viewer.show = select("show").value as Show;
    viewer.refreshValues();
  });
  on("tone", "change", () => {
    viewer.uniforms.tone.value = toneIndex(select("tone").value as Tone);
    viewer.refreshView();
  });
  onChoice("surfaces", (value) => viewer.setSurfaces(value as Surfaces));
  on("outlines", "change", () => {
    viewer.meshes.outlines = input("outlines").checked;
    viewer.refreshView();
  });
  on("isolines", "change", () => {
    viewer.isolines = input("isolines").checked;
    viewer.refreshView();
  });
  element("elements-row").hidden = !viewer.meshes.hasElements;
  on("elements", "change", () => {
    viewer.elements = input("elements").checked;
    viewer.refreshView();
  });
  if (viewer.data.heat) {
    select("show").value = viewer.show = "temperature";
    viewer.refreshValues();
  } else {
    for (const value of ["temperature", "net-flux", "heat-irradiance"]) {
      select("show").querySelector(`[value="${value}"]`)?.remove();
    }
  }
  if (viewer.data.rowError.length === 0) select("show").querySelector('[value="row-error"]')?.remove();
}
