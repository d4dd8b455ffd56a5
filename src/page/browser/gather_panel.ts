// The panel of gathering: start, pause, forget, and compare each pass with the matrix solution.
import { Gather } from "./gather";
import { drawHemicube } from "./hemicube_picture";
import { reflectedDifference } from "./gather_eyes";
import { counted, element, make, on, select, short } from "./ui";
import type { Viewer } from "./viewer";

export class GatherPanel {
  private gather: Gather | null = null;
  private reflectance: Float32Array | null = null; // of patches, in the light that is gathered
  private running = false;

  /** `onBegin`: the light is about to be the matrix solution, then the gathered one. */
  constructor(private readonly viewer: Viewer, private readonly onBegin: () => void) {
    on("gather-start", "click", () => this.toggle());
    on("gather-reset", "click", () => this.reset());
    on("gather-resolution", "change", () => this.reset());
    viewer.listen("light", () => {
      const relit = viewer.solved.reflectance !== this.reflectance;
      if (this.gather && (viewer.source === "run" || relit)) this.forget();
    });
    if (viewer.data.eyePosition.length === 0) {
      this.refuse("This page was written without eyes; write it again with radiosity view.");
    }
    this.say();
  }

  moment(): string {
    const { pass, eyes } = this.gather?.state ?? { pass: 0, eyes: 0 };
    return eyes > 0 ? `Gathering, pass ${pass + 1}` : `Gathered, pass ${pass}`;
  }

  toggle(): void {
    if (element<HTMLButtonElement>("gather-start").disabled) return;
    if (!this.gather) this.begin();
    if (!this.gather) return;
    this.running = !this.running;
    if (this.running) this.gather.start();
    else this.gather.pause();
    this.say();
  }

  forget(): void {
    this.gather?.close();
    this.gather = null;
    this.running = false;
    element("gather-passes").replaceChildren();
    element("hemicube").hidden = true;
    this.viewer.stage.point(null);
    this.say();
  }

  private reset(): void {
    this.forget();
    if (this.viewer.source === "gathered") this.viewer.showSolved();
  }

  private begin(): void {
    const { viewer } = this;
    this.onBegin();
    if (viewer.light !== viewer.solved) viewer.showSolved(); // we compare with a solution, not an iterate
    try {
      const resolution = Number(select("gather-resolution").value);
      this.gather = new Gather(viewer.data, viewer.solved, viewer.background(), resolution);
    } catch (error) {
      this.refuse((error as Error).message);
      return;
    }
    this.reflectance = viewer.solved.reflectance;
    this.gather.onPass = (irradiance) => this.take(irradiance);
    this.gather.viewerMoves = () => viewer.stage.moving;
    this.gather.onProgress = (irradiance, eye, strip) => this.progress(irradiance, eye, strip);
    this.gather.onFailure = (error) => {
      this.forget();
      element("gather-facts").textContent = error.message;
    };
  }

  /** Shows what has been gathered in this pass, and what the last eye sees. */
  private progress(irradiance: Float32Array, eye: number, strip: Float32Array): void {
    const { viewer } = this;
    viewer.showGathered(irradiance);
    drawHemicube(element<HTMLCanvasElement>("hemicube-picture"), strip, this.gather!.gpu.resolution,
                 viewer.uniforms.exposure.value);
    element("hemicube").hidden = false;
    element("hemicube-text").textContent = `What vertex ${counted(eye)} sees`;
    viewer.stage.point(this.gather!.eyes.position(eye));
    this.say();
  }

  private take(irradiance: Float32Array): void {
    const difference = reflectedDifference(this.viewer.data, irradiance, this.viewer.solved);
    this.viewer.showGathered(irradiance);
    const pass = this.gather!.state.pass;
    const figure = make("data", { value: String(difference) }, `${short(100 * difference)}%`);
    element("gather-passes").prepend(
      make("tr", {}, make("th", { scope: "row" }, `Pass ${pass}`), make("td", {}, figure)));
    this.say();
  }

  private refuse(sentence: string): void {
    element<HTMLButtonElement>("gather-start").disabled = true;
    element("gather-device").textContent = sentence;
  }

  private say(): void {
    element("gather-start").textContent = this.running ? "Pause" : "Start";
    element("gather-start").setAttribute("aria-pressed", String(this.running));
    element<HTMLButtonElement>("gather-reset").disabled = !this.gather;
    element("gather-table").hidden = (this.gather?.state.pass ?? 0) === 0;
    const facts = element("gather-facts");
    facts.dataset["pass"] = String(this.gather?.state.pass ?? 0);
    facts.dataset["weight"] = String(this.gather?.weight ?? NaN);
    if (!this.gather) {
      facts.textContent =
        "Each vertex looks at the scene through a hemicube, drawn by this computer's GPU; no matrix is used.";
      return;
    }
    const { pass, eyes } = this.gather.state;
    facts.textContent = `Pass ${pass + 1}: ${counted(eyes)} of ${counted(this.gather.eyes.count)} eyes.`;
    element("gather-device").textContent = this.gather.gpu.software
      ? "WebGL in software: no GPU draws here, so a pass takes longer." : "";
  }
}
