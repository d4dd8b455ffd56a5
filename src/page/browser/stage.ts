// Draws the scene when something changed: one picture, or two halves for before and after.
import { Color, Scene, WebGLRenderer } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { CameraControl } from "./camera";
import type { SceneMeshes } from "./scene";
import type { Uniforms } from "./shading";

const MARK_PIXELS = 3;
const RIM_PIXELS = 6; // behind the mark, so that it shows on any colour

/** The outline of a picked patch. */
class Mark {
  private readonly lines: LineSegments2[];

  constructor(scene: Scene) {
    this.lines = [RIM_PIXELS, MARK_PIXELS].map((linewidth, k) => {
      const material = new LineMaterial({ color: 0x000000, linewidth, toneMapped: false, polygonOffset: true,
                                          polygonOffsetFactor: -4 - 4 * k, polygonOffsetUnits: -4 - 4 * k });
      const lines = new LineSegments2(new LineSegmentsGeometry(), material);
      lines.visible = false;
      lines.renderOrder = 1 + k;
      scene.add(lines);
      return lines;
    });
  }

  set(outline: Float32Array | null, colour: Color): void {
    this.lines.forEach((lines, k) => {
      lines.visible = outline !== null;
      if (!outline) return;
      lines.geometry.dispose();
      lines.geometry = new LineSegmentsGeometry().setPositions(outline);
      lines.material.color = k === 0 ? new Color(0, 0, 0) : colour;
    });
  }
}

export type MarkName = "first" | "second";

export class Stage {
  /** Share of the width that shows the stored light; null: all is as it is now. */
  split: number | null = null;
  /** What the finer mesh may stand for: both halves, or none of them. */
  elements = true;
  /** When a picture was drawn last, as performance.now(). */
  drawnAt = -Infinity;

  private readonly renderer: WebGLRenderer | null; // null: the browser has no WebGL 2
  private readonly scene = new Scene();
  private readonly marks: Record<MarkName, Mark>;
  private wanted = false;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly meshes: SceneMeshes,
              private readonly control: CameraControl, private readonly uniforms: Uniforms) {
    const able = document.createElement("canvas").getContext("webgl2") !== null;
    this.renderer = able ? new WebGLRenderer({ canvas, antialias: true, alpha: true }) : null;
    this.renderer?.setClearColor(0x000000, 0);
    if (this.renderer) this.renderer.autoClear = false;
    this.scene.add(meshes.group);
    this.marks = { first: new Mark(this.scene), second: new Mark(this.scene) };
    control.onMove = () => this.draw();
    new ResizeObserver(() => this.resize()).observe(canvas);
    canvas.addEventListener("webglcontextrestored", () => this.draw());
    this.resize();
  }

  mark(name: MarkName, outline: Float32Array | null, colour: string): void {
    this.marks[name].set(outline, new Color(colour));
    this.draw();
  }

  /** Soon: at most once a frame. */
  draw(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.drawNow();
    });
  }

  /** False: there is no picture, for want of WebGL 2. */
  get draws(): boolean { return this.renderer !== null; }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer?.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer?.setSize(width, height, false);
    this.control.setAspect(width / height);
    this.drawNow(); // a resized canvas is empty until it is drawn
  }

  private drawNow(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!this.renderer) return;
    this.drawnAt = performance.now();
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    const left = this.split === null ? 0 : Math.round(width * this.split);
    this.renderer.setScissorTest(true);
    if (left > 0) this.half(this.renderer, 0, left, height, true);
    if (left < width) this.half(this.renderer, left, width - left, height, false);
  }

  private half(renderer: WebGLRenderer, left: number, width: number, height: number, stored: boolean): void {
    renderer.setScissor(left, 0, width, height);
    this.uniforms.stored.value = stored;
    this.meshes.arrange(this.elements && !this.uniforms.showValue.value);
    renderer.render(this.scene, this.control.camera);
  }
}
