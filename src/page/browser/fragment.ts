// The state of the page in the fragment of its address, so that a link shows the same: the camera, what is changed of
// lamps and materials, and the controls that are not as at first.
import type { Rgb } from "./container";
import type { RelightPanel } from "./relight_panel";
import { choose, on, setTo, valueOf } from "./ui";
import type { Viewer } from "./viewer";

/** Ids, in the order in which they are set. */
const CONTROLS = [
  "exposure", "tone", "outlines", "elements", "isolines", "before-after", "split", "paint", "pick-first", "pick-second", "surface-first", "surface-second",
  "show"];
/** Names of radio buttons. */
const CHOICES = ["surfaces", "move"];
const QUIET_MS = 300; // browsers allow so many changes of the address a second

const choices = (name: string) =>
  [...document.querySelectorAll<HTMLInputElement>(`input[name="${name}"]`)].map((radio) => radio.value);
const chosen = (name: string) => document.querySelector<HTMLInputElement>(`input[name="${name}"]:checked`)!.value;

const readable = (text: string) => encodeURIComponent(text).replaceAll("%2C", ",").replaceAll("%3A", ":");
const point = (text: string | undefined): Rgb | null => {
  const numbers = text?.split(",").map(Number) ?? [];
  return numbers.length === 3 && numbers.every(Number.isFinite) ? (numbers as Rgb) : null;
};

export class Fragment {
  private readonly first: Record<string, string>;
  private readonly firstView: string;
  private waiting = 0; // a timer

  /** `onUnknown`: of the parts of a link that this page lacks. */
  constructor(private readonly viewer: Viewer, private readonly relight: RelightPanel,
              private readonly onUnknown: (names: string[]) => void) {
    this.first = this.controls();
    this.firstView = JSON.stringify(viewer.control.words());
    this.restore(location.href);
    for (const event of ["light", "view", "picks"]) viewer.listen(event, () => this.changed());
    viewer.control.listen(() => this.changed());
    on("app", "change", () => this.changed());
    on("app", "input", () => this.changed());
    window.addEventListener("hashchange", () => this.restore(location.href));
  }

  /** The address of the page as it is now. */
  link(): string {
    const { control } = this.viewer;
    const moved = JSON.stringify(control.words()) !== this.firstView;
    const controls = Object.entries(this.controls()).filter(([name, value]) => value !== this.first[name]);
    const all = [...(moved ? Object.entries(control.words()) : []), ...controls, ...Object.entries(this.relight.state())];
    const text = all.map(([name, value]) => `${readable(name)}=${readable(value)}`).join("&");
    return location.href.split("#")[0] + (text ? `#${text}` : "");
  }

  private controls(): Record<string, string> {
    return Object.fromEntries([...CONTROLS.map((id) => [id, valueOf(id)]), ...CHOICES.map((name) => [name, chosen(name)])]);
  }

  private changed(): void {
    window.clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => history.replaceState(null, "", this.link()), QUIET_MS);
  }

  /** Makes the page show what an address says. */
  restore(link: string): void {
    const state = new Map(new URLSearchParams(new URL(link).hash.slice(1)));
    const take = (name: string) => {
      const value = state.get(name);
      state.delete(name);
      return value;
    };
    const eye = point(take("eye")), target = point(take("target"));
    if (eye && target) this.viewer.control.place(eye, target);
    else this.viewer.resetView();
    this.relight.restore(state);
    for (const name of CHOICES) {
      const value = take(name) ?? "";
      choose(name, choices(name).includes(value) ? value : this.first[name]!);
    }
    for (const id of CONTROLS) setTo(id, take(id) ?? this.first[id]!);
    this.onUnknown([...state.keys()]);
  }
}
