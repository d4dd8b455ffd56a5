// Keys of the whole page. Single characters act only while the picture, or nothing, has the focus, so
// that they do not get in the way of typing.
import type { ConvergePanel } from "./converge_panel";
import type { GatherPanel } from "./gather_panel";
import { clearPicks, pickAt } from "./patch_panel";
import { choose, element, input, isShortcut } from "./ui";
import type { Viewer } from "./viewer";

export function setUpKeys(viewer: Viewer, converge: ConvergePanel, gather: GatherPanel): void {
  const canvas = element<HTMLCanvasElement>("picture");
  const expose = (by: number) => {
    input("exposure").value = String(Number(input("exposure").value) + by);
    input("exposure").dispatchEvent(new Event("input"));
  };
  const actions: Record<string, (event: KeyboardEvent) => void> = {
    "1": () => choose("surfaces", "smooth"),
    "2": () => choose("surfaces", "flat"),
    "3": () => choose("surfaces", "wireframe"),
    "o": () => input("outlines").click(),
    "[": () => expose(-0.25),
    "]": () => expose(0.25),
    "b": () => input("before-after").click(),
    "v": () => choose("move", viewer.control.walking ? "orbit" : "walk"),
    "r": () => viewer.resetView(),
    "f": () => viewer.focusPick(),
    " ": () => converge.toggle(),
    ",": () => converge.step(-1),
    "g": () => gather.toggle(),
    ".": () => converge.step(1),
    "?": () => element<HTMLDialogElement>("help").showModal(),
    "escape": () => clearPicks(viewer),
    "enter": (event) => pickAt(viewer, canvas.clientWidth / 2, canvas.clientHeight / 2, event.shiftKey),
  };
  document.addEventListener("keydown", (event) => {
    const free = document.activeElement === canvas || document.activeElement === document.body;
    if (!free || isShortcut(event)) return;
    const act = actions[event.key.toLowerCase()];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}
