// Shows the solver's iterates from E to the light: played at a speed, stepped, and replayed.
import { FIRST_METHOD, METHODS, wordsOf, type Method } from "./methods";
import { drawPlot, type Point } from "./plot";
import type { Frame } from "./protocol";
import { element, input, on, select, short } from "./ui";
import type { Viewer } from "./viewer";

/** The most frames that are kept for the slider; a longer run stops. */
const MOST_FRAMES = 500;

export class ConvergePanel {
  private frames: Frame[] = [];
  private shown = 0;
  private playing = false;
  private waiting = false; // for a frame of the solver
  private timer = 0;
  private wantsNext = false;

  constructor(private readonly viewer: Viewer) {
    for (const [value, { name, units }] of Object.entries(METHODS)) {
      select("method").add(new Option(`${name} (${units})`, value));
    }
    select("method").value = FIRST_METHOD;
    viewer.onFrame((frame) => this.take(frame));
    on("play", "click", () => this.toggle());
    on("step", "click", () => this.step(1));
    on("restart", "click", () => this.restart());
    on("method", "change", () => this.restart());
    on("speed", "input", () => this.saySpeed());
    on("iteration", "input", () => {
      this.pause();
      this.show(Number(input("iteration").value));
    });
    this.saySpeed();
    this.draw();
  }

  get method(): Method { return select("method").value as Method; }

  /** Forgets the run, since its materials have changed. */
  forget(): void {
    this.pause();
    this.frames = [];
    this.shown = 0;
    this.waiting = this.wantsNext = false;
    this.draw();
  }

  /** The moment that is shown, in words. */
  moment(): string {
    const frame = this.frames[this.shown];
    const { name, unit } = wordsOf(this.method);
    return `${name}, ${unit} ${frame?.index ?? 0}`;
  }

  toggle(): void {
    if (this.playing) return this.pause();
    this.playing = true;
    this.sayPlaying();
    if (this.atEnd()) this.restart(true);
    else this.step(1);
  }

  step(by: number): void {
    if (this.frames.length === 0) return this.restart(this.playing);
    const wanted = this.shown + by;
    if (wanted < 0) return;
    if (wanted < this.frames.length) return this.show(wanted);
    if (this.ended()) return this.pause();
    this.wantsNext = true;
    if (this.waiting) return;
    this.waiting = true;
    this.viewer.stepRun();
  }

  /** Shows an iterate of a method, which runs as far as that. */
  async to(method: Method, index: number): Promise<void> {
    if (this.method !== method || this.frames.length === 0) {
      select("method").value = method;
      this.restart();
    }
    const { frames } = this;
    while (frames.length <= index && !this.ended()) {
      if (!this.waiting) {
        this.waiting = true;
        this.viewer.stepRun();
      }
      await new Promise((resume) => setTimeout(resume, 10));
      if (frames !== this.frames) return; // another run began
    }
    this.wantsNext = false;
    this.show(Math.min(index, frames.length - 1));
  }

  private restart(playing = false): void {
    this.forget();
    this.playing = playing;
    this.sayPlaying();
    this.waiting = this.wantsNext = true;
    this.viewer.startRun(this.method);
  }

  private pause(): void {
    this.playing = false;
    this.wantsNext = false; // a frame that is under way is kept, not shown
    clearTimeout(this.timer);
    this.sayPlaying();
  }

  private ended(): boolean {
    const last = this.frames[this.frames.length - 1];
    if (!last) return false;
    const done = last.residual <= this.viewer.data.header.solver.tolerance;
    return done || last.finished || this.frames.length >= MOST_FRAMES;
  }

  private atEnd(): boolean {
    return this.frames.length > 0 && this.shown === this.frames.length - 1 && this.ended();
  }

  private take(frame: Frame): void {
    this.waiting = false;
    this.frames.push(frame);
    if (this.wantsNext) {
      this.wantsNext = false;
      this.show(this.frames.length - 1);
    }
  }

  private show(index: number): void {
    this.shown = index;
    const frame = this.frames[index];
    if (!frame) return;
    this.viewer.showFrame(frame);
    this.draw();
    if (!this.playing) return;
    clearTimeout(this.timer);
    if (this.atEnd()) return this.pause();
    this.timer = window.setTimeout(() => this.step(1), 1000 / this.perSecond());
  }

  private perSecond(): number {
    return 2 ** Number(input("speed").value);
  }

  private saySpeed(): void {
    const speed = this.perSecond();
    element("speed-text").textContent = `${speed < 10 ? speed.toFixed(1) : Math.round(speed)} a second`;
  }

  private sayPlaying(): void {
    element("play").textContent = this.playing ? "Pause" : "Play";
    element("play").setAttribute("aria-pressed", String(this.playing));
  }

  /** The program's history, if it used this solver and the same materials. */
  private told(): Point[] {
    const { name, history } = this.viewer.data.header.solver;
    const changed = JSON.stringify(this.viewer.states) !== JSON.stringify(this.viewer.storedStates());
    if (name !== this.method || changed || this.frames.length === 0) return [];
    const first = wordsOf(this.method).firstFigure;
    return history.map((y, k) => ({ x: k + first, y }));
  }

  private draw(): void {
    const slider = input("iteration");
    slider.max = String(Math.max(0, this.frames.length - 1));
    slider.value = String(this.shown);
    const frame = this.frames[this.shown];
    const { unit } = wordsOf(this.method);
    element("iteration-text").textContent = frame ? `${unit} ${frame.index}` : "–";
    slider.setAttribute("aria-valuetext",
      frame ? `${unit} ${frame.index}, residual ${frame.residual.toExponential(2)}` : "no run yet");
    const told = this.told();
    element("plot").hidden = !frame;
    if (frame) drawPlot(element("plot"), this.frames.map((f) => ({ x: f.rows, y: f.residual })), told, this.shown,
                        "rows of the matrix used, over their number");
    this.sayFacts(frame, told.length > 0);
  }

  private sayFacts(frame: Frame | undefined, told: boolean): void {
    const facts = element("run-facts");
    facts.dataset["residual"] = frame ? String(frame.residual) : "";
    facts.dataset["change"] = frame ? String(frame.change) : "";
    const within = this.viewer.clustered
      ? " What is reflected to a patch changes as it does for its node." : "";
    if (!frame) {
      facts.textContent = `From B = E on, with the materials as they are now.${within}`;
      return;
    }
    const { residualNote, figures } = wordsOf(this.method);
    const words = [`Residual ${short(frame.residual)}${residualNote}`];
    if (Number.isFinite(frame.change)) words.push(`largest change ${short(frame.change)}`);
    if (told) words.push(`circles: the program's ${figures}`);
    facts.textContent = `${words.join("; ")}.${within}`;
  }
}
