// Gathering, pass after pass: every eye looks at the scene in its present light; then B = E + rho
// H. Pass k adds the k-th bounce.
import type { PageData, Rgb } from "./container";
import { Batch } from "./gather_batch";
import { Eyes, type EyeMaterials } from "./gather_eyes";
import { GatherGpu } from "./gather_gpu";
import type { PatchLight } from "./light";

const BANDS = 3;
const BATCH_MS = 16; // of a frame of 33 ms; the picture and the panels need the rest
// In software a frame of the page costs as much as ten eyes. So it is only drawn if something
// changes, and then waits for a batch.
const SOFTWARE_BATCH_MS = 60;
const PROGRESS_MS = 200, SOFTWARE_PROGRESS_MS = 800; // between pictures of what has been gathered so far

export interface GatherState {
  pass: number; // passes that are complete
  eyes: number; // that have looked in the present pass
}

export class Gather {
  readonly eyes: Eyes;
  readonly gpu: GatherGpu;
  state: GatherState = { pass: 0, eyes: 0 };
  weight = NaN; // the sum of all weights at an eye, farthest from 1
  /** `irradiance` of patches, N*3, after each pass. */
  onPass: (irradiance: Float32Array) => void = () => {};
  /** The same with what eyes of this pass have seen so far, and the last of them: its hemicube, GatherGpu.strip(). */
  onProgress: (irradiance: Float32Array, eye: number, strip: Float32Array) => void = () => {};
  onFailure: (error: Error) => void = () => {};
  /** In software, gathering waits while the viewer moves. */
  viewerMoves: () => boolean = () => false;

  private readonly materials: EyeMaterials;
  private readonly sky: Rgb;
  private readonly batch: Batch;
  private told = 0; // time of the last progress
  private running = false;
  private working = false;
  private closed = false;

  /** Throws an Error with one sentence if the browser cannot gather. */
  constructor(data: PageData, light: PatchLight, sky: Rgb, resolution: number) {
    this.eyes = new Eyes(data);
    this.gpu = new GatherGpu(data, this.eyes, resolution);
    this.batch = new Batch(this.gpu.software ? SOFTWARE_BATCH_MS : BATCH_MS, this.gpu.capacity);
    this.materials = this.eyes.materials(light);
    this.sky = sky;
    this.gpu.setLight(this.eyes.corners(this.materials.emission));
  }

  start(): void {
    this.running = true;
    if (!this.working) void this.work();
  }
  pause(): void { this.running = false; }
  close(): void {
    this.pause();
    this.closed = true;
    this.gpu.dispose();
  }

  private async work(): Promise<void> {
    this.working = true;
    try {
      while (this.running) {
        await this.turn();
        if (this.running) await this.someEyes();
      }
    } catch (error) {
      if (!this.closed) this.onFailure(error as Error);
    }
    this.working = false;
  }

  /** Waits for the next batch, in step with frames: there are none while the page is hidden. */
  private async turn(): Promise<void> {
    if (!this.gpu.software) return void (await new Promise(requestAnimationFrame));
    do await new Promise((resume) => setTimeout(resume, 1));
    while (this.running && (document.hidden || this.viewerMoves()));
  }

  /** Lets as many eyes look as a batch has time for. */
  private async someEyes(): Promise<void> {
    const begin = performance.now();
    const looks = this.gpu.look(this.state.eyes, this.batch.size, this.sky);
    await this.gpu.done();
    this.batch.took(looks, performance.now() - begin);
    this.state.eyes += looks;
    const ended = this.state.eyes === this.eyes.count;
    const due = performance.now() - this.told > (this.gpu.software ? SOFTWARE_PROGRESS_MS : PROGRESS_MS);
    if (due && !ended) await this.tell(looks);
    if (ended) await this.endPass();
  }

  /** Tells what has been gathered; `looks`: of the last batch. */
  private async tell(looks: number): Promise<void> {
    const first = this.state.eyes - looks;
    let k = looks - 1;
    while (k > 0 && !this.looks(first + k)) --k;
    const strip = await this.gpu.strip(k);
    const irradiance = this.irradiance(await this.gpu.read());
    if (this.closed) return;
    this.onProgress(this.eyes.patches(irradiance), first + k, strip);
    this.told = performance.now();
  }

  private looks(eye: number): boolean { return Math.hypot(...this.eyes.normal(eye)) > 0; }

  /** Of eyes, G*3. */
  private irradiance(received: Float32Array): Float32Array {
    const irradiance = new Float32Array(this.eyes.count * BANDS);
    for (let eye = 0; eye < this.eyes.count; ++eye) {
      if (this.looks(eye)) irradiance.set(received.subarray(4 * eye, 4 * eye + BANDS), eye * BANDS);
    }
    return irradiance;
  }

  private async endPass(): Promise<void> {
    const received = await this.gpu.read();
    if (this.closed) return;
    const irradiance = this.irradiance(received);
    this.weight = 1;
    for (let eye = 0; eye < this.eyes.count; ++eye) {
      const weight = received[4 * eye + 3]!;
      if (this.looks(eye) && Math.abs(weight - 1) > Math.abs(this.weight - 1)) this.weight = weight;
    }
    const { emission, reflectance } = this.materials;
    this.gpu.setLight(this.eyes.corners(emission.map((e, k) => e + reflectance[k]! * irradiance[k]!)));
    this.state = { pass: this.state.pass + 1, eyes: 0 };
    this.onPass(this.eyes.patches(irradiance));
  }
}
