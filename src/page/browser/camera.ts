// The viewer's position: orbit around a pivot, pan, zoom, or walk; by mouse, touch and keyboard.
import { PerspectiveCamera, Vector3 } from "three";
import type { Header, Rgb } from "./container";
import { isShortcut, keysAreFree } from "./ui";

const STEEPEST = (89 * Math.PI) / 180;
const TURN_A_PIXEL = 0.005; // radians
const TURN_A_SECOND = 1.2; // by keys, radians
const WALK_A_SECOND = 0.35; // of the scene's diagonal
const TAP_PIXELS = 6;
const LONG_PRESS_MS = 500;
const MODIFIERS = ["Shift", "Control", "Alt", "AltGraph", "Meta"];

/** Keys that move while they are held, by their places, with the motion in the viewer's own axes. */
const KEYS: Record<string, "left" | "right" | "up" | "down" | "forward" | "back" | "rise" | "sink" |
  "stepLeft" | "stepRight"> = {
  ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down",
  KeyW: "forward", KeyS: "back", KeyA: "stepLeft", KeyD: "stepRight", KeyE: "rise", KeyQ: "sink",
  PageUp: "rise", PageDown: "sink",
};
/** The same by what is written on keys; = is + without Shift on many keyboards. */
const CHARACTERS: typeof KEYS = { "+": "forward", "=": "forward", "-": "back" };

export class CameraControl {
  readonly camera: PerspectiveCamera;
  walking = false;
  private readonly listeners: (() => void)[] = [];
  /** A click or tap at these pixels of the canvas; `second`: with Shift, or held for long. */
  onTap: (x: number, y: number, second: boolean) => void = () => {};
  /** The part of a walker's step that nothing is in the way of. */
  free: (from: Vector3, step: Vector3) => Vector3 = (_, step) => step;

  private readonly up: Vector3;
  private readonly east: Vector3;
  private readonly north: Vector3;
  private readonly eye = new Vector3();
  private yaw = 0;
  private pitch = 0;
  private distance = 1; // from the eye to the pivot
  private readonly keys = new Map<string, (typeof KEYS)[string]>(); // held, by their places
  private readonly pointers = new Map<number, { x: number; y: number }>();
  private travelled = 0;
  private pressed = 0;
  private lastKeyFrame = 0;

  /** `act`: after every motion. */
  listen(act: () => void): void { this.listeners.push(act); }

  constructor(private readonly canvas: HTMLCanvasElement, private readonly header: Header) {
    this.camera = new PerspectiveCamera(header.camera.fov, 1, header.diagonal * 1e-3, header.diagonal * 20);
    this.up = new Vector3(...header.camera.up).normalize();
    const side = Math.abs(this.up.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
    this.north = this.up.clone().cross(side).normalize();
    this.east = this.north.clone().cross(this.up);
    this.listenToDevices();
    this.reset();
  }

  /** Returns to the first view of the page. */
  reset(): void { this.place(this.header.camera.eye, this.header.camera.target); }

  /** Looks from and at these points of the scene. */
  place(eye: Rgb, target: Rgb): void {
    const origin = new Vector3(...this.header.origin);
    this.look(new Vector3(...eye).sub(origin), new Vector3(...target).sub(origin));
  }

  /** The eye and the pivot, as texts of three numbers. */
  words(): { eye: string; target: string } {
    const words = (p: Vector3) => p.toArray().map((x) => Number(x.toPrecision(6))).join(",");
    const eye = this.eye.clone().add(new Vector3(...this.header.origin));
    return { eye: words(eye), target: words(eye.clone().addScaledVector(this.forward(), this.distance)) };
  }

  look(eye: Vector3, target: Vector3): void {
    const direction = target.clone().sub(eye);
    this.distance = Math.max(direction.length(), this.header.diagonal * 1e-3);
    direction.normalize();
    this.eye.copy(eye);
    this.pitch = Math.max(-STEEPEST, Math.min(STEEPEST, Math.asin(direction.dot(this.up))));
    this.yaw = Math.atan2(direction.dot(this.north), direction.dot(this.east));
    this.moved();
  }

  /** Turns around this point from now on; the view stays. It must lie on the line of sight. */
  pivotAt(distance: number): void {
    this.distance = Math.max(distance, this.header.diagonal * 1e-3);
    this.told(); // texts of the camera have the pivot
  }

  /** Turns towards a point and moves to a distance that suits `size`. */
  focus(point: Vector3, size: number): void {
    const direction = this.forward();
    this.look(point.clone().addScaledVector(direction, -Math.max(size, this.header.diagonal * 0.02)), point);
  }

  /** Sets the proportions of the canvas; the camera's field of view stays in the picture. */
  setAspect(aspect: number): void {
    const half = Math.tan((this.header.camera.fov * Math.PI) / 360);
    this.camera.fov = (Math.atan(half / Math.min(1, aspect)) * 360) / Math.PI;
    this.camera.aspect = aspect;
    this.moved();
  }

  /** The camera as text for `radiosity render --camera`. */
  text(): string {
    const { eye, target } = this.words();
    return `eye=${eye};target=${target};up=${this.header.camera.up.join(",")};` +
      `fov=${Number(this.camera.fov.toPrecision(6))}`;
  }

  /** A ray through pixel (x, y) of the canvas. */
  ray(x: number, y: number): { from: Vector3; direction: Vector3 } {
    const { width, height } = this.canvas.getBoundingClientRect();
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const direction = this.forward()
      .addScaledVector(this.right(), half * this.camera.aspect * ((2 * x) / width - 1))
      .addScaledVector(this.right().cross(this.forward()), half * (1 - (2 * y) / height));
    return { from: this.eye.clone(), direction };
  }

  forward(): Vector3 {
    const flat = Math.cos(this.pitch);
    return this.east.clone().multiplyScalar(flat * Math.cos(this.yaw))
      .addScaledVector(this.north, flat * Math.sin(this.yaw))
      .addScaledVector(this.up, Math.sin(this.pitch));
  }

  private right(): Vector3 {
    return this.forward().cross(this.up).normalize();
  }

  private moved(): void {
    this.camera.up.copy(this.up);
    this.camera.position.copy(this.eye);
    this.camera.lookAt(this.eye.clone().add(this.forward()));
    this.camera.updateProjectionMatrix();
    this.told();
  }

  private told(): void {
    for (const act of this.listeners) act();
  }

  /** Orbits around the pivot; walking: turns the head. Radians to the right and up. */
  private turn(right: number, up: number): void {
    const pivot = this.eye.clone().addScaledVector(this.forward(), this.distance);
    this.yaw -= right;
    this.pitch = Math.max(-STEEPEST, Math.min(STEEPEST, this.pitch + up));
    if (!this.walking) this.eye.copy(pivot).addScaledVector(this.forward(), -this.distance);
    this.moved();
  }

  /** Moves eye and pivot by pixels of the picture, so that the pivot follows the pointer. */
  private pan(x: number, y: number): void {
    const height = this.canvas.clientHeight || 1;
    const size = (2 * this.distance * Math.tan((this.camera.fov * Math.PI) / 360)) / height;
    this.shift(this.right().multiplyScalar(-x * size)
      .addScaledVector(this.right().cross(this.forward()), y * size));
  }

  /** Moves eye and pivot; a walker goes through nothing. */
  private shift(step: Vector3): void {
    this.eye.add(this.walking ? this.free(this.eye, step) : step);
    this.moved();
  }

  /** Nearer the pivot by this factor; walking: a step ahead. */
  private zoom(factor: number): void {
    const ahead = this.forward();
    if (this.walking) return this.shift(ahead.multiplyScalar(this.header.diagonal * 0.15 * (1 - factor)));
    const nearer = Math.max(this.distance * factor, this.header.diagonal * 2e-3);
    const step = this.distance - nearer;
    this.distance = nearer;
    this.shift(ahead.multiplyScalar(step));
  }

  private listenToDevices(): void {
    const c = this.canvas;
    c.addEventListener("contextmenu", (event) => event.preventDefault());
    c.addEventListener("wheel", (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
      this.zoom(Math.exp(Math.max(-200, Math.min(200, event.deltaY * lines)) * 0.0015));
    }, { passive: false });
    c.addEventListener("pointerdown", (event) => this.press(event));
    c.addEventListener("pointermove", (event) => this.drag(event));
    c.addEventListener("pointerup", (event) => this.release(event));
    c.addEventListener("pointercancel", (event) => this.pointers.delete(event.pointerId));
    c.addEventListener("blur", () => c.classList.remove("pointed"));
    document.addEventListener("keydown", (event) => this.keyDown(event));
    document.addEventListener("keyup", (event) => this.keys.delete(event.code));
    document.addEventListener("focusin", () => this.keys.clear());
    window.addEventListener("blur", () => this.keys.clear());
  }

  private press(event: PointerEvent): void {
    this.canvas.focus({ preventScroll: true });
    this.canvas.classList.add("pointed");
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.offsetX, y: event.offsetY });
    // A second finger does not count as a tap.
    this.travelled = this.pointers.size > 1 ? Infinity : 0;
    this.pressed = performance.now();
  }

  private drag(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = { x: event.offsetX, y: event.offsetY };
    const dx = now.x - before.x, dy = now.y - before.y;
    this.travelled += Math.hypot(dx, dy);
    if (this.travelled <= TAP_PIXELS) return; // small motions may be trembling
    this.pointers.set(event.pointerId, now);
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    if (other) {
      const apart = (p: { x: number; y: number }) => Math.max(1, Math.hypot(p.x - other.x, p.y - other.y));
      this.zoom(apart(before) / apart(now));
      this.pan(dx / 2, dy / 2);
    } else if (event.buttons > 1 || event.shiftKey) {
      this.pan(dx, dy);
    } else {
      // Orbiting drags the scene, walking turns the head: both follow the pointer.
      const sign = this.walking ? -1 : 1;
      this.turn(sign * dx * TURN_A_PIXEL, -sign * dy * TURN_A_PIXEL);
    }
  }

  private release(event: PointerEvent): void {
    const known = this.pointers.delete(event.pointerId);
    if (!known || this.travelled > TAP_PIXELS || event.button > 0) return;
    const held = performance.now() - this.pressed > LONG_PRESS_MS;
    this.onTap(event.offsetX, event.offsetY, event.shiftKey || held);
  }

  private keyDown(event: KeyboardEvent): void {
    if (!MODIFIERS.includes(event.key)) this.canvas.classList.remove("pointed");
    const motion = CHARACTERS[event.key] ?? KEYS[event.code];
    if (isShortcut(event) || !keysAreFree() || !motion) return;
    event.preventDefault();
    const first = this.keys.size === 0;
    this.keys.set(event.code, motion);
    if (!first) return;
    this.lastKeyFrame = performance.now() - 1000 / 60; // a short press moves too
    this.keyFrame(event.shiftKey);
  }

  private keyFrame(shift: boolean): void {
    if (this.keys.size === 0) return;
    const now = performance.now();
    const seconds = Math.min(0.1, (now - this.lastKeyFrame) / 1000);
    this.lastKeyFrame = now;
    for (const motion of this.keys.values()) this.act(motion, seconds, shift);
    requestAnimationFrame(() => this.keyFrame(shift));
  }

  private act(action: (typeof KEYS)[string], seconds: number, shift: boolean): void {
    const turn = TURN_A_SECOND * seconds;
    const pixels = 400 * seconds;
    const step = this.header.diagonal * WALK_A_SECOND * seconds;
    const slide = (direction: Vector3, length: number) => this.shift(direction.clone().multiplyScalar(length));
    const flat = this.forward().addScaledVector(this.up, -this.forward().dot(this.up)).normalize();
    switch (action) {
      case "left": return shift ? this.pan(pixels, 0) : this.turn(this.walking ? -turn : turn, 0);
      case "right": return shift ? this.pan(-pixels, 0) : this.turn(this.walking ? turn : -turn, 0);
      case "up": return shift ? this.pan(0, pixels) : this.turn(0, this.walking ? turn : -turn);
      case "down": return shift ? this.pan(0, -pixels) : this.turn(0, this.walking ? -turn : turn);
      case "forward": return this.walking ? slide(flat, step) : this.zoom(Math.exp(-1.5 * seconds));
      case "back": return this.walking ? slide(flat, -step) : this.zoom(Math.exp(1.5 * seconds));
      case "stepLeft": return slide(this.right(), -step);
      case "stepRight": return slide(this.right(), step);
      case "rise": return slide(this.up, step);
      case "sink": return slide(this.up, -step);
    }
  }
}
