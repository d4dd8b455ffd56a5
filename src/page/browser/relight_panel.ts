// The panel of lamps and materials that the viewer changes, with equivalent options of the command line.
import { chromaOf, hexOf, planckian } from "./colour";
import type { Rgb } from "./container";
import { LUMENS, texturedMaterials, type Textured } from "./light";
import type { Relighting } from "./solver_client";
import { counted, element, make, on, quoted, short } from "./ui";
import type { Viewer } from "./viewer";

const STRONGEST = 4; // times what it was

interface Row {
  key: string; // in links
  name: string;
  note: string;
  get: () => Rgb;
  set: (value: Rgb) => void;
  stored: Rgb;
  limits: Rgb; // largest values of bands
  unit: string;
  photometric?: { unit: string; times: number }; // what that is by luminance, in lumens and the like
  /** The program's option for the present value; null: it has none. */
  option: () => string | null;
}

/** Of lights without a surface. */
const PHOTOMETRIC: Record<string, string> = { "W/sr": "cd", "W/m^2": "lx", "W/m^2/sr": "cd/m²" };

const brightness = ([r, g, b]: Rgb): number => 0.2126 * r + 0.7152 * g + 0.0722 * b;
const largest = (value: Rgb): number => Math.max(...value);
const times = (value: Rgb, factor: number): Rgb => value.map((x) => x * factor) as Rgb;
const same = (a: Rgb, b: Rgb): boolean => a.every((x, k) => x === b[k]);
const limited = (value: Rgb, limits: Rgb): Rgb => value.map((x, k) => Math.min(x, limits[k]!)) as Rgb;
const uniform = (x: number): Rgb => [x, x, x];
/** Numbers with enough digits for the command line to give the same light. */
const digits = (value: Rgb): string => value.map((x) => Number(x.toPrecision(7))).join(",");
/** The same, never rounded up: the program refuses a tint that brings a reflectance above 1. */
const digitsBelow = (value: Rgb): string => value.map((x) => Math.floor(x * 1e6) / 1e6).join(",");

/** What is said of a texture: the largest factor that the program allows. */
function textureNote(factor: Rgb): string {
  const most = 1 / largest(factor);
  return `, textured; at most ${short(most)} times its reflectance`;
}

export class RelightPanel {
  private readonly rows: { row: Row; refresh: () => void }[] = [];
  private readonly textured: Textured[];

  constructor(private readonly viewer: Viewer, private readonly onChange: () => void) {
    this.textured = texturedMaterials(viewer.data);
    const { materials, surfaces, lights } = viewer.data.header;
    const used = materials.map((_, k) => k).filter((k) => surfaces.some((s) => s.material === k));
    const lamps = used.filter((k) => largest(materials[k]!.emission) > 0);
    this.fill("lamps", "Lamps", [...lamps.map((k) => this.lamp(k)), ...lights.map((_, l) => this.light(l))]);
    this.fill("materials", "Reflectances", used.map((k) => this.material(k)));
    on("relight-reset", "click", () => this.reset());
    viewer.onRelit((light) => this.sayRelit(light));
  }

  reset(): void {
    this.viewer.states = this.viewer.storedStates();
    this.viewer.lights = this.viewer.storedLights();
    for (const { refresh } of this.rows) refresh();
    this.onChange();
    this.viewer.toStored();
    element<HTMLButtonElement>("relight-reset").disabled = true;
    element("relight-facts").textContent = "";
  }

  private lamp(k: number): Row {
    const { name, emission } = this.viewer.data.header.materials[k]!;
    const textured = this.textured[k]!.emission;
    const get = () => this.viewer.states[k]!.emission;
    return {
      key: `emission:${name}`, name, note: textured ? ", textured" : "", stored: emission, unit: "W/m²",
      limits: uniform(STRONGEST * largest(emission)),
      photometric: { unit: "lm", times: LUMENS * this.areaOf(k) },
      get,
      set: (value) => { this.viewer.states[k]!.emission = value; },
      option: () => (textured ? null : `--set ${quoted(name)}.emission=${digits(get())}`),
    };
  }

  /** Of a material's patches, both sides, m^2. */
  private areaOf(material: number): number {
    const { area, surface, header } = this.viewer.data;
    return area.reduce((sum, a, i) => (header.surfaces[surface[i]!]!.material === material ? sum + a : sum), 0);
  }

  private light(l: number): Row {
    const { name, kind, single, unit, strength, parameters } = this.viewer.data.header.lights[l]!;
    const get = () => strength.map((x, b) => x * this.viewer.lights[l]![b]!) as Rgb;
    return {
      key: `light:${name}`, name, note: "", stored: strength, limits: uniform(STRONGEST * largest(strength)), unit: unit.replace("^2", "²"),
      ...(PHOTOMETRIC[unit] && { photometric: { unit: PHOTOMETRIC[unit], times: LUMENS } }),
      get,
      set: (value) => {
        this.viewer.lights[l] = value.map((x, b) => (strength[b]! > 0 ? x / strength[b]! : 0)) as Rgb;
      },
      option: () => `${single ? `--${kind} ` : `--light ${kind},`}${digits(get())}${parameters}`,
    };
  }

  private material(k: number): Row {
    const { name, reflectance, factor } = this.viewer.data.header.materials[k]!;
    const textured = this.textured[k]!.reflectance;
    const get = () => this.viewer.states[k]!.reflectance;
    const tint = () => get().map((x, b) => (reflectance[b]! > 0 ? x / reflectance[b]! : 1)) as Rgb;
    const most = (x: number, b: number) => (x > 0 ? x / factor[b]! : 0);
    return {
      key: `reflectance:${name}`, name, note: textured ? textureNote(factor) : "", stored: reflectance, unit: "",
      limits: textured ? (reflectance.map(most) as Rgb) : uniform(1),
      get,
      set: (value) => { this.viewer.states[k]!.reflectance = value; },
      option: () => (textured ? `--set ${quoted(name)}.tint=${digitsBelow(tint())}`
        : `--set ${quoted(name)}.reflectance=${digits(get())}`),
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
    const most = largest(row.limits);
    const slider = make("input", { type: "range", min: "0", max: String(most), step: "any",
      "aria-label": `${row.name}: ${what}` }) as HTMLInputElement;
    const output = make("output");
    const back = make("button", { type: "button", "aria-label": `Reset ${row.name}` }, "Reset") as HTMLButtonElement;
    const lumens = make("span", { class: "note" });
    const kelvin = make("input", { type: "number", min: "1700", max: "10000", step: "100", placeholder: "kelvin",
      "aria-label": `${row.name}: colour temperature in kelvin` }) as HTMLInputElement;
    const say = () => {
      const level = largest(row.get());
      const { photometric } = row;
      lumens.textContent = photometric ? `${short(photometric.times * brightness(row.get()))} ${photometric.unit}` : "";
      output.textContent = `${short(level)}${row.unit ? ` ${row.unit}` : ""}`;
      slider.setAttribute("aria-valuetext", [output.textContent, lumens.textContent].filter(Boolean).join(", "));
      back.disabled = same(row.get(), row.stored);
    };
    const refresh = () => {
      const value = row.get();
      if (largest(value) > 0) chroma = times(value, 1 / largest(value));
      slider.value = String(largest(value));
      colour.value = hexOf(chroma);
      kelvin.value = "";
      say();
    };
    const change = (value: Rgb) => {
      row.set(limited(value, row.limits));
      slider.value = String(largest(row.get()));
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
      slider.value = String(Math.min(most, Math.max(0, Number(slider.value) + (by * most) / 100)));
      slider.dispatchEvent(new Event("input", { bubbles: true }));
    });
    colour.addEventListener("input", () => {
      chroma = chromaOf(colour.value);
      kelvin.value = "";
      change(times(chroma, Number(slider.value)));
    });
    // The colour of a black body, with as many lumens as before.
    kelvin.addEventListener("change", () => {
      if (kelvin.value === "" || !kelvin.reportValidity()) return;
      const before = brightness(row.get());
      chroma = planckian(Number(kelvin.value));
      colour.value = hexOf(chroma);
      change(times(chroma, before / brightness(chroma)));
    });
    back.addEventListener("click", () => {
      row.set([...row.stored]);
      refresh();
      this.changed();
    });
    this.rows.push({ row, refresh });
    refresh();
    const label = make("span", { class: "label" }, row.name, make("span", { class: "note" }, row.note));
    return make("div", { class: "relight", "data-name": row.name, "data-what": what },
      label, colour, back, slider, output, ...(row.photometric ? [lumens, kelvin] : []));
  }

  private changed(): void {
    this.onChange();
    element<HTMLButtonElement>("relight-reset").disabled = this.altered.length === 0;
    element("relight-facts").dataset["state"] = "solving";
    this.viewer.relight();
  }

  private get altered(): Row[] {
    return this.rows.map(({ row }) => row).filter((row) => !same(row.get(), row.stored));
  }

  /** The program's options for what is changed. */
  options(): string[] { return this.altered.map((row) => row.option()).filter((option) => option !== null); }

  /** What is changed and has no option. */
  withoutOption(): string[] { return this.altered.filter((row) => row.option() === null).map((row) => row.name); }

  /** The present values of what is changed, by their keys. */
  state(): Record<string, string> { return Object.fromEntries(this.altered.map((row) => [row.key, digits(row.get())])); }

  /** Sets the values of `state`, and all others to what is stored; takes their keys out of `state`. */
  restore(state: Map<string, string>): void {
    for (const { row, refresh } of this.rows) {
      const value = state.get(row.key)?.split(",").map(Number) as Rgb | undefined;
      const good = value?.length === 3 && value.every((x) => x >= 0 && Number.isFinite(x));
      if (good) state.delete(row.key);
      row.set(good ? limited(value!, row.limits) : [...row.stored]);
      refresh();
    }
    if (this.altered.length > 0) this.changed();
    else this.reset();
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
    facts.textContent = words;
  }
}
