// Draws the scene after changes: one picture, or two halves for before and after.
import {
  BufferAttribute, BufferGeometry, Color, FloatType, Points, PointsMaterial, Scene, WebGLRenderer, WebGLRenderTarget,
} from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { CameraControl } from "./camera";
import { drawn, drawsInSoftware } from "./graphics";
import { Pace } from "./pace";
import type { SceneMeshes } from "./scene";
import type { Uniforms } from "./shading";

/** A movement ends after this time without motion; then the picture is drawn at full resolution. */
export const SETTLED_MS = 300;
/** Pixels of the screen a pixel of the page, as far as pictures have them. */
export const pixelRatio = (): number => Math.min(window.devicePixelRatio, 2);
const MARK_PIXELS = 3;
const DOT_PIXELS = 9, DOT_COLOUR = 0xff2d9b;
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
  /** The share of the width that shows the light before; null: all shows the present light. */
  split: number | null = null;
  /** Whether the finer mesh may replace the patches in both halves. */
  elements = true;
  /** Whether the viewer moves. */
  moving = false;

  private readonly renderer: WebGLRenderer | null; // null: the browser has no WebGL 2
  private readonly scene = new Scene();
  private readonly marks: Record<MarkName, Mark>;
  private readonly dot = new Points(new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(3), 3)),
    new PointsMaterial({ color: DOT_COLOUR, size: DOT_PIXELS, sizeAttenuation: false, depthTest: false, toneMapped: false }));
  private readonly pace: Pace | null; // null: a GPU draws
  private pixel: WebGLRenderTarget | null = null; // of valueAt()
  private wanted = false;
  private drawing = false;
  private settling = 0; // a timer

  constructor(readonly canvas: HTMLCanvasElement, private readonly meshes: SceneMeshes,
              private readonly control: CameraControl, private readonly uniforms: Uniforms) {
    const able = document.createElement("canvas").getContext("webgl2") !== null;
    this.renderer = able ? new WebGLRenderer({ canvas, antialias: true, alpha: true }) : null;
    this.renderer?.setClearColor(0x000000, 0);
    if (this.renderer) this.renderer.autoClear = false;
    this.pace = this.renderer && drawsInSoftware(this.gl(this.renderer)) ? new Pace() : null;
    this.scene.add(meshes.group);
    this.dot.visible = false;
    this.dot.renderOrder = 3;
    this.scene.add(this.dot);
    this.marks = { first: new Mark(this.scene), second: new Mark(this.scene) };
    control.listen(() => this.move());
    new ResizeObserver(() => this.resize()).observe(canvas);
    canvas.addEventListener("webglcontextrestored", () => this.draw());
    this.resize();
  }

  mark(name: MarkName, outline: Float32Array | null, colour: string): void {
    this.marks[name].set(outline, new Color(colour));
    this.draw();
  }

  /** Shows a place of the scene, less its origin, by a dot; null: none. */
  point(at: [number, number, number] | null): void {
    this.dot.visible = at !== null;
    if (at) this.dot.position.set(...at);
    this.draw();
  }

  /** Of the picture, in pixels of the screen. */
  size(): [number, number] {
    const ratio = pixelRatio();
    return [Math.floor(this.canvas.clientWidth * ratio), Math.floor(this.canvas.clientHeight * ratio)];
  }

  /** Draws soon: at most once a frame; in software when the last picture is done. */
  draw(): void {
    if (this.wanted) return;
    this.wanted = true;
    if (!this.drawing) requestAnimationFrame(() => void this.drawWanted());
  }

  /** The picture as it is now, without the movement's coarseness; `scale`: pixels a pixel of the page. */
  still(scale: number): HTMLCanvasElement {
    const moving = this.moving;
    this.moving = false;
    this.drawNow(scale);
    const copy = document.createElement("canvas");
    copy.width = this.canvas.width;
    copy.height = this.canvas.height;
    copy.getContext("2d")!.drawImage(this.canvas, 0, 0);
    this.moving = moving;
    this.drawNow();
    return copy;
  }

  /** The value, as for false colour, at a pixel of the page; null: nothing is there. */
  async valueAt(x: number, y: number): Promise<number | null> {
    const { renderer, uniforms, canvas: { clientWidth: width, clientHeight: height } } = this;
    if (!renderer?.extensions.has("EXT_color_buffer_float")) return null;
    const { camera } = this.control;
    this.pixel ??= new WebGLRenderTarget(1, 1, { type: FloatType });
    this.meshes.arrange(this.elements);
    this.meshes.hideLines();
    camera.setViewOffset(width, height, Math.floor(x), Math.floor(y), 1, 1);
    uniforms.measured.value = true;
    uniforms.before.value = this.split !== null && x < this.split * width;
    renderer.setScissorTest(false);
    renderer.setRenderTarget(this.pixel);
    renderer.clear();
    renderer.render(this.meshes.group, camera);
    renderer.setRenderTarget(null);
    uniforms.measured.value = false;
    camera.clearViewOffset();
    const rgba = new Float32Array(4);
    await renderer.readRenderTargetPixelsAsync(this.pixel, 0, 0, 1, 1, rgba);
    return rgba[3] === 1 ? rgba[0]! : null;
  }

  private async drawWanted(): Promise<void> {
    const { renderer, pace, moving } = this;
    this.wanted = false;
    const begin = performance.now();
    this.drawNow();
    if (!renderer || !pace) return;
    this.drawing = true;
    await drawn(this.gl(renderer));
    this.drawing = false;
    if (moving) pace.took(performance.now() - begin);
    if (this.wanted) requestAnimationFrame(() => void this.drawWanted());
  }

  /** Like draw(), for a picture that others will follow. */
  private move(): void {
    this.setMoving(true);
    window.clearTimeout(this.settling);
    this.settling = window.setTimeout(() => this.setMoving(false), SETTLED_MS);
    this.draw();
  }

  private setMoving(moving: boolean): void {
    if (moving === this.moving) return;
    this.moving = moving;
    // Set until the picture has full resolution; tests wait for this.
    if (moving) this.canvas.setAttribute("data-moving", "");
    this.draw();
  }

  private gl(renderer: WebGLRenderer): WebGL2RenderingContext {
    return renderer.getContext() as WebGL2RenderingContext;
  }

  /** False without WebGL 2: then there is no picture. */
  get draws(): boolean { return this.renderer !== null; }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer?.setSize(width, height, false);
    this.control.setAspect(width / height);
    window.clearTimeout(this.settling); // a new shape is not a movement
    this.moving = false;
    this.drawNow(); // a resized canvas is empty until it is drawn
  }

  private drawNow(scale = pixelRatio()): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!this.moving) this.canvas.removeAttribute("data-moving");
    if (!this.renderer) return;
    const ratio = scale * (this.moving ? this.pace?.scale ?? 1 : 1);
    if (ratio !== this.renderer.getPixelRatio()) this.renderer.setPixelRatio(ratio);
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    const left = this.split === null ? 0 : Math.round(width * this.split);
    this.renderer.setScissorTest(true);
    if (left > 0) this.half(this.renderer, 0, left, height, true);
    if (left < width) this.half(this.renderer, left, width - left, height, false);
  }

  private half(renderer: WebGLRenderer, left: number, width: number, height: number, before: boolean): void {
    renderer.setScissor(left, 0, width, height);
    this.uniforms.before.value = before;
    const elements = this.elements && (!this.moving || !this.pace || this.pace.elements);
    this.meshes.arrange(elements);
    renderer.render(this.scene, this.control.camera);
  }
}
