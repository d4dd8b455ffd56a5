// Keys of the whole page, but for those of the camera.
import type { ConvergePanel } from "./converge_panel";
import type { GatherPanel } from "./gather_panel";
import { clearPicks, pickAt } from "./patch_panel";
import type { Tour } from "./tour";
import { choose, element, input, isShortcut, keysAreFree, unfold } from "./ui";
import type { Viewer } from "./viewer";

export function setUpKeys(viewer: Viewer, converge: ConvergePanel, gather: GatherPanel, tour: Tour): void {
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
    "t": () => tour.toggle(),
    "i": () => element<HTMLDetailsElement>("patch-panel").toggleAttribute("open"),
    " ": () => {
      unfold("converge-panel");
      converge.toggle();
    },
    ",": () => converge.step(-1),
    ".": () => converge.step(1),
    "g": () => {
      unfold("gather-panel");
      gather.toggle();
    },
    "?": () => element<HTMLDialogElement>("help").showModal(),
    "escape": () => clearPicks(viewer),
    "enter": (event) => pickAt(viewer, canvas.clientWidth / 2, canvas.clientHeight / 2, event.shiftKey),
  };
  document.addEventListener("keydown", (event) => {
    if (!keysAreFree() || isShortcut(event)) return;
    const act = actions[event.key.toLowerCase()];
    if (!act) return;
    event.preventDefault();
    act(event);
  });
}
