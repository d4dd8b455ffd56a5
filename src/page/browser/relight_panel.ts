// The panel of lamps and materials that the viewer changes, with an equivalent command line.
import { chromaOf, hexOf } from "./colour";
import type { Rgb } from "./container";
import type { Relighting } from "./solver_client";
import { copy, counted, element, make, on, short } from "./ui";
import type { Viewer } from "./viewer";

const STRONGEST = 4; // times what it was

interface Row {
  name: string;
  get: () => Rgb;
  set: (value: Rgb) => void;
  stored: Rgb;
  most: number; // of the slider: the largest band
  unit: string;
}

const largest = (value: Rgb): number => Math.max(...value);
const times = (value: Rgb, factor: number): Rgb => value.map((x) => x * factor) as Rgb;
const same = (a: Rgb, b: Rgb): boolean => a.every((x, k) => x === b[k]);
/** A number with enough digits for the command line to give the same light. */
const digits = (x: number): string => String(Number(x.toPrecision(7)));

export class RelightPanel {
  private readonly rows: { row: Row; refresh: () => void }[] = [];

  constructor(private readonly viewer: Viewer, private readonly onChange: () => void) {
    const { materials, surfaces, sky } = viewer.data.header;
    const used = materials.map((_, k) => k).filter((k) => surfaces.some((s) => s.material === k));
    const lamps = used.filter((k) => largest(materials[k]!.emission) > 0);
    this.fill("lamps", "Lamps", [...lamps.map((k) => this.lamp(k)), ...(largest(sky) > 0 ? [this.sky()] : [])]);
    this.fill("materials", "Reflectances", used.map((k) => this.material(k)));
    on("relight-reset", "click", () => this.reset());
    on("copy-command", "click", () => void copy(element("command").textContent ?? "", element("copy-command")));
    viewer.onRelit((light) => this.sayRelit(light));
  }

  reset(): void {
    this.viewer.states = this.viewer.storedStates();
    this.viewer.sky = [1, 1, 1];
    for (const { refresh } of this.rows) refresh();
    this.onChange();
    this.viewer.toStored();
    this.sayCommand();
    element("relight-facts").textContent = "";
  }

  private lamp(k: number): Row {
    const { name, emission } = this.viewer.data.header.materials[k]!;
    return {
      name, stored: emission, most: STRONGEST * largest(emission), unit: "W/m²",
      get: () => this.viewer.states[k]!.emission,
      set: (value) => { this.viewer.states[k]!.emission = value; },
    };
  }

  private sky(): Row {
    const stored = this.viewer.data.header.sky;
    return {
      name: "sky", stored, most: STRONGEST * largest(stored), unit: "W/m²/sr",
      get: () => stored.map((x, b) => x * this.viewer.sky[b]!) as Rgb,
      set: (value) => { this.viewer.sky = value.map((x, b) => (stored[b]! > 0 ? x / stored[b]! : 0)) as Rgb; },
    };
  }

  private material(k: number): Row {
    const { name, reflectance } = this.viewer.data.header.materials[k]!;
    return {
      name, stored: reflectance, most: 1, unit: "",
      get: () => this.viewer.states[k]!.reflectance,
      set: (value) => { this.viewer.states[k]!.reflectance = value; },
    };
  }

  private fill(id: string, title: string, rows: Row[]): void {
    if (rows.length > 0) element(id).append(make("h3", {}, title), ...rows.map((row) => this.control(row)));
  }

  private control(row: Row): HTMLElement {
    const what = row.unit ? "strength" : "reflectance";
    // We keep the colour, also when the strength is 0.
    let chroma = largest(row.stored) > 0 ? times(row.stored, 1 / largest(row.stored)) : ([1, 1, 1] as Rgb);
    const colour = make("input", { type: "color", "aria-label": `${row.name}: colour` }) as HTMLInputElement;
    const slider = make("input", { type: "range", min: "0", max: String(row.most), step: "any",
      "aria-label": `${row.name}: ${what}` }) as HTMLInputElement;
    const output = make("output");
    const back = make("button", { type: "button", "aria-label": `Reset ${row.name}` }, "Reset") as HTMLButtonElement;
    const say = () => {
      const level = largest(row.get());
      output.textContent = `${short(level)}${row.unit ? ` ${row.unit}` : ""}`;
      slider.setAttribute("aria-valuetext", output.textContent);
      back.disabled = same(row.get(), row.stored);
    };
    const refresh = () => {
      const value = row.get();
      if (largest(value) > 0) chroma = times(value, 1 / largest(value));
      slider.value = String(largest(value));
      colour.value = hexOf(chroma);
      say();
    };
    const change = (value: Rgb) => {
      row.set(value);
      say();
      this.changed();
    };
    slider.addEventListener("input", () => change(times(chroma, Number(slider.value))));
    // With "step any" the browser's own keys move by too little or too much; we use a hundredth of
    // the range.
    slider.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
      if (!by) return;
      event.preventDefault();
      slider.value = String(Math.min(row.most, Math.max(0, Number(slider.value) + (by * row.most) / 100)));
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    });
    colour.addEventListener("input", () => {
      chroma = chromaOf(colour.value);
      change(times(chroma, Number(slider.value)));
    });
    back.addEventListener("click", () => {
      row.set([...row.stored]);
      refresh();
      this.changed();
    });
    this.rows.push({ row, refresh });
    refresh();
    return make("div", { class: "relight", "data-name": row.name, "data-what": what },
      make("span", { class: "label" }, row.name), colour, back, slider, output);
  }

  private changed(): void {
    this.onChange();
    this.sayCommand();
    element("relight-facts").dataset["state"] = "solving";
    this.viewer.relight();
  }

  /** The options of the program that give this light. */
  private options(): string[] {
    const options: string[] = [];
    for (const { row } of this.rows) {
      const value = row.get();
      if (same(value, row.stored)) continue;
      const numbers = value.map(digits).join(",");
      const name = /^[\w.-]+$/.test(row.name) ? row.name : `'${row.name.replaceAll("'", "'\\''")}'`;
      if (row.unit === "W/m²/sr") options.push(`--sky ${numbers}`);
      else options.push(`--set ${name}.${row.unit ? "emission" : "reflectance"}=${numbers}`);
    }
    return options;
  }

  private sayCommand(): void {
    const options = this.options();
    element("command-row").hidden = options.length === 0;
    element<HTMLButtonElement>("relight-reset").disabled = options.length === 0;
    element("command").textContent = `radiosity solve RESULTS.h5 ${options.join(" ")}`;
  }

  private sayRelit(light: Relighting): void {
    const facts = element("relight-facts");
    const products = light.products === 1 ? "1 product" : `${counted(light.products)} products`;
    const work = `${products} with the matrix in ${Math.ceil(light.milliseconds)} ms`;
    const solved = light.finished && light.converged;
    const words = solved ? `Solved: ${work}; the residual is ${light.residual.toExponential(1)} of the mean irradiance.`
      : light.finished ? `Not converged after ${work}: this room keeps nearly all its light.` : `Solving: ${work}.`;
    facts.dataset["state"] = solved ? "solved" : light.finished ? "failed" : "solving";
    facts.dataset["milliseconds"] = String(light.milliseconds);
    const more = this.viewer.limited > 0
      ? [`${counted(this.viewer.limited)} textured patches are held at a reflectance of 1.`] : [];
    facts.textContent = [words, ...more].join(" ");
  }
}
