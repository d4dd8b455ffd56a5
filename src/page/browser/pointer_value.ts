// The value at the pointer: lux, or what false colours show there.
import { unitOf } from "./look_panel";
import { element, short } from "./ui";
import type { Viewer } from "./viewer";

const RESTING_MS = 60;

export function setUpPointer(viewer: Viewer): void {
  const { canvas } = viewer.stage;
  const text = element("pointer-value");
  let place: [number, number] | null = null; // in pixels of the picture
  let waiting = 0; // a timer
  const say = async () => {
    if (!place) return;
    const at = place, patch = viewer.patchAt(...at);
    const value = patch === null ? null : await viewer.valueAt(...at);
    if (place !== at) return;
    text.hidden = value === null;
    if (value === null) return;
    const { surface, header } = viewer.data;
    const words = value < -1e29 ? "no value" : `${short(value)} ${unitOf(viewer.shown())}`;
    text.textContent = `${words} · ${header.surfaces[surface[patch!]!]!.name}`;
    text.dataset["value"] = String(value);
  };
  const soon = () => {
    window.clearTimeout(waiting);
    waiting = window.setTimeout(() => void say(), RESTING_MS);
  };
  const point = (event: PointerEvent) => {
    if (event.buttons > 0) return;
    place = [event.offsetX, event.offsetY];
    soon();
  };
  canvas.addEventListener("pointermove", point);
  canvas.addEventListener("pointerup", point); // of a finger, which has no other place
  canvas.addEventListener("pointerleave", (event) => {
    if (event.pointerType !== "mouse") return;
    place = null;
    text.hidden = true;
  });
  for (const event of ["light", "view"]) viewer.listen(event, soon);
  viewer.control.listen(soon);
}
