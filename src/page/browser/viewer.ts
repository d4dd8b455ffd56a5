// The state of the page: the light that is shown, the view, and the picked patches. Panels change
// it and are told of changes; it does not depend on panels.
import { Color, Vector3 } from "three";
import { TriangleTree } from "./bvh";
import { CameraControl } from "./camera";
import { FineLight } from "./fine_light";
import { redBlue, viridis, type ColourMap } from "./colour";
import type { Heat, PageData, Rgb } from "./container";
import { automaticRange, extremes, NO_VALUE, type Range, type Scale } from "./false_colour";
import {
  background, directIrradiance, factorsOf, illuminance, lampIrradiance, luminance, materialsOfNodes, nodeMeans, nodesArePatches, patchIrradiance, radiosityOf,
  withMaterials, type StoredLight,
  type Factors, type MaterialState, type PatchLight,
} from "./light";
import type { Method } from "./methods";
import type { Frame, Materials } from "./protocol";
import { SceneMeshes, type Surfaces } from "./scene";
import { makeUniforms, mapTexture } from "./shading";
import { SolverClient, type Relighting } from "./solver_client";
import { type MarkName, Stage } from "./stage";
import { freeStep } from "./walk";

export type Show = "light" | "illuminance" | "radiosity" | "irradiance" | "row-sum" | "row-error" | "factors" | "difference" |
  "temperature" | "net-flux" | "heat-irradiance";
/** The source of the light that is shown. */
export type Source = "stored" | "relit" | "run" | "gathered";

/** Whose values are interpolated over surfaces, and have isolines. */
const SMOOTH: Show[] = ["light", "illuminance", "radiosity", "irradiance", "difference", "heat-irradiance"];
const MOST_LINES = 10; // in the range of colours
const LOOKS = 9; // rays across the picture and down it

export interface Picked {
  patch: number;
  row: Float32Array | null; // of its node; null: not here yet
}

export class Viewer {
  readonly uniforms = makeUniforms();
  readonly meshes: SceneMeshes;
  readonly control: CameraControl;
  readonly stage: Stage;
  readonly solver = new SolverClient();
  readonly stored: PatchLight;
  agreement = NaN; // of the stored light with the page's own form factors
  light: PatchLight;
  source: Source = "stored";
  show: Show = "light";
  paint = true;
  elements = true;
  isolines = false;
  range: Range | null = null; // null: that of the values
  extremes: Range = { low: 0, high: 0 }; // of the values that have a colour
  lights: Rgb[]; // factors on each light without a surface
  states: MaterialState[];
  readonly picks: Record<MarkName, Picked | null> = { first: null, second: null };

  private readonly maps = { rising: this.uniforms.map.value, diverging: mapTexture(redBlue) };
  private readonly tree: TriangleTree;
  private readonly fine: FineLight;
  private readonly fineStored: Float32Array; // light of element vertices
  private fineIrradiance: Float32Array; // of element vertices, as they are drawn
  private luxOf: Float32Array | null = null; // of what irradiance the meshes have the lux
  private reference: StoredLight | null = null; // where nodes are clusters of patches
  private direct: Float32Array; // N*3, with the present lamps: directIrradiance()
  private lamps: Float32Array; // N*3, likewise: lampIrradiance()
  solved: PatchLight; // by the matrix, for the present materials
  private materials: Materials;
  private runs = 0;
  private readonly listeners: Record<string, (() => void)[]> = {};
  private relitListener: (light: Relighting) => void = () => {};
  private frameListener: (frame: Frame) => void = () => {};

  constructor(readonly data: PageData, canvas: HTMLCanvasElement) {
    this.stored = { emission: data.emission, reflectance: data.reflectance, irradiance: data.irradiance };
    this.light = this.solved = this.stored;
    this.states = this.storedStates();
    this.lights = this.storedLights();
    this.direct = directIrradiance(data, this.factors);
    this.lamps = lampIrradiance(data, this.factors);
    this.materials = materialsOfNodes(data, this.stored, this.direct);
    this.meshes = new SceneMeshes(data, this.uniforms);
    this.fine = new FineLight(data, this.stored);
    this.fineIrradiance = data.elementIrradiance;
    this.fineStored = this.fine.radiosity(this.stored, data.elementIrradiance);
    this.control = new CameraControl(canvas, data.header);
    this.stage = new Stage(canvas, this.meshes, this.control, this.uniforms);
    this.tree = new TriangleTree(data.position, data.patchTriangle);
    this.uniforms.exposure.value = data.header.exposure;
    this.control.free = (from, step) => freeStep(this.tree, data.header.diagonal, from, step);
    this.pivotOnScene();
    this.refreshLight();
  }

  private get factors(): Factors { return factorsOf(this.data, this.states, this.lights); }

  /** Whether form factors are between clusters of patches. */
  get clustered(): boolean { return !nodesArePatches(this.data); }

  /** `event`: "light", "view" (how it is shown), "picks", "rows" (of picks, which come later). */
  listen(event: string, act: () => void): void {
    (this.listeners[event] ??= []).push(act);
  }
  onRelit(act: (light: Relighting) => void): void { this.relitListener = act; }
  onFrame(act: (frame: Frame) => void): void { this.frameListener = act; }

  storedStates(): MaterialState[] {
    return this.data.header.materials.map(({ reflectance, emission }) =>
      ({ reflectance: [...reflectance], emission: [...emission] }));
  }

  storedLights(): Rgb[] { return this.data.header.lights.map(() => [1, 1, 1]); }

  /** The radiance of what is seen where nothing stands. */
  background(): Rgb { return background(this.data.header.lights, this.lights); }

  async start(): Promise<void> {
    const { data } = this;
    const { lowest, step } = data.header.quantisation;
    const loaded = await this.solver.load({
      stored: { area: data.nodeArea, begin: data.factorBegin, column: data.factorColumn,
                code: data.factorCode, lowest, step },
      order: data.order,
      materials: this.materials,
      irradiance: nodeMeans(data, data.irradiance),
      arePatches: !this.clustered,
    });
    this.agreement = loaded.agreement;
    if (loaded.reference) this.reference = this.storedLight(loaded.reference);
    whenIdle(() => {
      this.solver.warm();
      this.fine.prepare();
    });
    this.solver.onRelit = (light) => {
      this.takeSolution(light);
      this.relitListener(light);
    };
    this.solver.onFrame = (frame) => {
      if (frame.run === this.runs) this.frameListener(frame);
    };
  }

  /** Solves again with `states` and `lights`. */
  relight(): void {
    // What lamps give directly is there at once; what is reflected follows.
    const before = this.lamps;
    this.lamps = lampIrradiance(this.data, this.factors);
    const irradiance = this.solved.irradiance.map((h, k) => Math.max(0, h + this.lamps[k]! - before[k]!));
    this.solved = { ...withMaterials(this.data, this.states), irradiance };
    this.setMaterials();
    this.solver.relight(this.materials);
    this.showSolved();
  }

  toStored(): void {
    this.solved = this.stored;
    this.lamps = lampIrradiance(this.data, this.factors);
    this.setMaterials();
    this.showSolved();
  }

  /** Shows the matrix solution; a run that is watched ends. */
  showSolved(): void {
    ++this.runs;
    this.source = this.solved === this.stored ? "stored" : "relit";
    this.light = this.solved;
    this.refreshLight();
  }

  startRun(method: Method): void {
    this.solver.start(++this.runs, method, this.materials);
  }
  stepRun(): void { this.solver.step(this.runs); }

  showFrame(frame: Frame): void {
    this.source = "run";
    this.light = { ...this.solved, irradiance: this.ofPatches(frame.irradiance) };
    this.refreshLight();
  }

  /** Shows irradiance of patches, gathered with the present materials. */
  showGathered(irradiance: Float32Array): void {
    this.source = "gathered";
    this.light = { ...this.solved, irradiance };
    this.refreshLight();
  }

  /** The light that the picture is compared with, side by side. */
  get before(): PatchLight { return this.source === "gathered" ? this.solved : this.stored; }

  /** Resolves when the row of the patch is there. */
  async pick(name: MarkName, patch: number | null): Promise<void> {
    const picked = patch === null ? null : { patch, row: null as Float32Array | null };
    this.picks[name] = picked;
    this.mark(name);
    this.refreshValues();
    this.tell("picks");
    if (!picked) return;
    const [row] = await this.solver.rows([this.data.node[picked.patch]!]);
    picked.row = row!;
    if (this.picks[name] !== picked) return;
    this.refreshValues();
    this.tell("rows");
  }

  /** The patch under a pixel of the canvas, or null. */
  patchAt(x: number, y: number): number | null {
    const { from, direction } = this.control.ray(x, y);
    const hit = this.tree.cast(from.toArray(), direction.toArray());
    return hit ? this.data.trianglePatch[hit.triangle]! : null;
  }

  /** What false colours show at a pixel of the canvas, in the picture's light lux; null: nothing is there. */
  valueAt(x: number, y: number): Promise<number | null> {
    if (this.stage.elements) this.prepareLux();
    return this.stage.valueAt(x, y);
  }

  /** Gives elements their lux, which few looks need. */
  private prepareLux(): void {
    if (this.luxOf === this.fineIrradiance) return;
    this.luxOf = this.fineIrradiance;
    this.meshes.setElementValues(illuminance(this.fineIrradiance), illuminance(this.data.elementIrradiance));
  }

  /** Whether some of the picture shows light, or a false colour: outside a room, or within a table, there is none. */
  seesLight(): boolean {
    const { clientWidth: width, clientHeight: height } = this.stage.canvas;
    const falseColour = this.shown() !== "light";
    const lit = (patch: number | null) => patch !== null &&
      (falseColour || [0, 1, 2].some((b) => this.light.irradiance[patch * 3 + b]! + this.light.emission[patch * 3 + b]! > 0));
    const places = Array.from({ length: LOOKS }, (_, k) => (k + 0.5) / LOOKS);
    return places.some((y) => places.some((x) => lit(this.patchAt(x * width, y * height))));
  }

  focusPick(): void {
    const picked = this.picks.first;
    if (!picked) return;
    const centre = new Vector3(...this.data.centroid.subarray(picked.patch * 3, picked.patch * 3 + 3));
    this.control.focus(centre, 8 * Math.sqrt(this.data.area[picked.patch]!));
  }

  resetView(): void {
    this.control.reset();
    this.pivotOnScene();
  }

  /** The quantity that is shown: a picked patch's form factors replace the light, unless a run is watched. */
  shown(): Show {
    if (this.show === "light" && this.source !== "run" && this.paint && this.picks.first?.row) return "factors";
    return this.show;
  }

  /** Whether the light is drawn finer than patches. */
  get showsElements(): boolean {
    const isSolved = this.source === "stored" || this.source === "relit";
    return this.elements && isSolved && this.meshes.hasElements && this.meshes.surfaces === "smooth";
  }

  setSurfaces(surfaces: Surfaces): void {
    this.meshes.setSurfaces(surfaces);
    this.refreshView();
  }

  /** Sets the colours of lines and marks to those of the page's theme. */
  refreshTheme(): void {
    this.meshes.setLineColour(new Color().setStyle(themed("--wire"), ""));
    this.mark("first");
    this.mark("second");
  }

  refreshView(): void {
    const shown = this.shown();
    const falseColour = shown !== "light";
    this.uniforms.showValue.value = falseColour;
    this.stage.elements = this.showsElements && ["light", "illuminance"].includes(shown);
    if (this.stage.elements && (falseColour || this.isolines)) this.prepareLux();
    const lined = this.isolines && SMOOTH.includes(shown);
    if (falseColour || lined) this.setColours(this.values(shown, this.light));
    const { low, high, lineStep } = this.uniforms;
    lineStep.value = lined ? roundStep((high.value - low.value) / MOST_LINES) : 0;
    this.stage.draw();
    this.tell("view");
  }

  refreshValues(): void {
    const now = this.values(this.shown(), this.light);
    const before = this.values(this.shown(), this.before);
    this.meshes.setValues(now, before, SMOOTH.includes(this.shown()));
    this.refreshView();
  }

  /** One value for each patch. */
  values(show: Show, light: PatchLight): Float32Array {
    const { data } = this;
    const ofNode = (values: Float32Array | null) => Float32Array.from(data.node, (k) =>
      values && values.length > 0 ? values[k]! : NO_VALUE);
    switch (show) {
      case "light":
      case "illuminance": return illuminance(light.irradiance);
      case "radiosity": return luminance(radiosityOf(light));
      case "irradiance": return luminance(light.irradiance);
      case "row-sum": return ofNode(data.rowSum);
      case "row-error": return ofNode(data.rowError);
      case "factors": return ofNode(this.picks.first?.row ?? null);
      case "temperature": return this.ofHeat((heat) => heat.temperature);
      case "net-flux": return this.ofHeat((heat) => heat.netFlux);
      case "heat-irradiance": return this.ofHeat((heat) => heat.irradiance);
      case "difference": {
        const solved = luminance(radiosityOf(this.solved));
        return luminance(radiosityOf(light)).map((value, i) => value - solved[i]!);
      }
    }
  }

  private ofHeat(of: (heat: Heat) => Float32Array): Float32Array {
    return of(this.data.heat!).map((value) => (Number.isNaN(value) ? NO_VALUE : value));
  }

  /** Takes the solution, or the way to it, of the latest change; after a return to stored light it is of no use. */
  private takeSolution({ irradiance }: Relighting): void {
    if (this.solved === this.stored) return;
    const isShown = this.light === this.solved;
    this.solved = { ...this.solved, irradiance: this.ofPatches(irradiance) };
    if (isShown) this.light = this.solved;
    this.refreshLight();
  }

  private setMaterials(): void {
    this.direct = directIrradiance(this.data, this.factors);
    this.materials = materialsOfNodes(this.data, this.solved, this.direct);
  }

  /** `nodes`: of these, with the stored materials, by the page's own solution. */
  private storedLight(nodes: Float32Array): StoredLight {
    const means = nodeMeans(this.data, this.direct);
    return { direct: this.direct, reflected: nodes.map((h, k) => Math.max(0, h - means[k]!)) };
  }

  private ofPatches(nodes: Float32Array): Float32Array {
    return patchIrradiance(this.data, nodes, this.direct, this.reference);
  }

  private refreshLight(): void {
    this.meshes.setLight(radiosityOf(this.light), radiosityOf(this.before));
    if (this.source === "stored") {
      this.fineIrradiance = this.data.elementIrradiance;
      this.meshes.setElementLight(this.fineStored, this.fineStored, this.stored, this.stored);
    }
    if (this.source === "relit") {
      this.fineIrradiance = this.fine.irradiance(this.light, this.factors);
      const radiosity = this.fine.radiosity(this.light, this.fineIrradiance);
      this.meshes.setElementLight(radiosity, this.fineStored, this.light, this.stored);
    }
    this.refreshValues();
    this.tell("light");
  }

  get scale(): Scale {
    if (["difference", "net-flux"].includes(this.shown())) return "diverging";
    if (this.uniforms.logarithmic.value) return "logarithmic";
    return ["row-sum", "temperature"].includes(this.shown()) ? "fitted" : "rising";
  }

  get colourMap(): ColourMap { return this.scale === "diverging" ? redBlue : viridis; }

  private setColours(values: Float32Array): void {
    const { scale, uniforms } = this;
    const { low, high } = this.range ?? automaticRange(values, scale);
    this.extremes = extremes(values, scale);
    uniforms.low.value = low;
    uniforms.high.value = high > low ? high : low + Math.max(Math.abs(low), 1) * 1e-6;
    uniforms.map.value = scale === "diverging" ? this.maps.diverging : this.maps.rising;
  }

  private mark(name: MarkName): void {
    const picked = this.picks[name];
    this.stage.mark(name, picked ? this.meshes.outlineOf(picked.patch) : null, themed(`--mark-${name}`));
  }

  /** Sets the pivot to the surface in the middle of the picture, or else to the scene's middle. */
  private pivotOnScene(): void {
    const { eye, target } = this.data.header.camera;
    const origin = this.data.header.origin;
    const middle = boxMiddle(this.data.position);
    const from = new Vector3(...eye).sub(new Vector3(...origin));
    const along = middle.sub(from).dot(this.control.forward());
    this.control.pivotAt(along > 0 ? along : new Vector3(...target).distanceTo(new Vector3(...eye)));
  }

  private tell(event: string): void {
    for (const act of this.listeners[event] ?? []) act();
  }
}

/** The least of 1, 2, 5, 10, 20... that is no less. */
function roundStep(least: number): number {
  const decade = 10 ** Math.floor(Math.log10(least));
  return decade * [1, 2, 5, 10].find((factor) => factor * decade >= least * (1 - 1e-9))!;
}

function boxMiddle(position: Float32Array): Vector3 {
  const low = new Vector3(Infinity, Infinity, Infinity), high = low.clone().negate(), point = new Vector3();
  for (let k = 0; k < position.length; k += 3) {
    point.fromArray(position, k);
    low.min(point);
    high.max(point);
  }
  return low.add(high).multiplyScalar(0.5);
}

/** Calls `act` when the page is idle. Safari has no idle callbacks. */
function whenIdle(act: () => void): void {
  if ("requestIdleCallback" in window) window.requestIdleCallback(act);
  else setTimeout(act, 500);
}

/** A colour of the page's theme. */
const themed = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
