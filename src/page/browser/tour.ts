// The tour: seven steps from patches to the error of the light, on the page's own scene. When it ends, the page is as
// it was.
import type { Rgb } from "./container";
import type { ConvergePanel } from "./converge_panel";
import type { Fragment } from "./fragment";
import { TOUR, type TourText } from "./tour_text";
import { choose, counted, element, on, setTo } from "./ui";
import type { Viewer } from "./viewer";

type Step = keyof typeof TOUR;
const STEPS = Object.keys(TOUR) as Step[];
const OFF_PATCH = 1e-3; // of the scene's diagonal: where an eye on a patch is

const VISITED = "radiosity-visited";
const SEES_MUCH = 0.8; // of what the one sees that sees most

/** Of the patches that a grid over the picture meets, from the middle on, the first that sees much of the scene. */
function patchInView(viewer: Viewer): number {
  const { clientWidth: width, clientHeight: height } = viewer.stage.canvas;
  const { rowSum, node } = viewer.data;
  const places = [0.5, 0.4, 0.6, 0.3, 0.7];
  const found = places.flatMap((y) => places.map((x) => viewer.patchAt(x * width, y * height)));
  const patches = found.filter((patch) => patch !== null);
  const seen = (patch: number) => Math.min(1, rowSum[node[patch]!]!);
  const most = Math.max(...patches.map(seen));
  return patches.find((patch) => seen(patch) >= SEES_MUCH * most) ?? 0;
}

/** Whether no page of this program was opened here before; false where a browser keeps no notes for pages of files. */
function isFirstVisit(): boolean {
  try {
    if (localStorage.getItem(VISITED)) return false;
    localStorage.setItem(VISITED, "1");
    return true;
  } catch {
    return false;
  }
}

export class Tour {
  private at: number | null = null; // the step; null: closed
  private before = ""; // the address of the page as it was
  private patch = 0;

  constructor(private readonly viewer: Viewer, private readonly converge: ConvergePanel,
              private readonly fragment: Fragment) {
    on("open-tour", "click", () => this.toggle());
    on("tour-offer-yes", "click", () => this.toggle());
    on("tour-offer-no", "click", () => this.endOffer());
    on("tour-close", "click", () => this.close());
    on("tour-back", "click", () => this.show(this.at! - 1));
    on("tour-next", "click", () => (this.at === STEPS.length - 1 ? this.close() : this.show(this.at! + 1)));
  }

  /** Offers the tour on the first visit, unless the address asks for something. */
  offer(): void {
    if (location.hash.length <= 1 && isFirstVisit()) element("tour-offer").hidden = false;
  }

  private endOffer(): void { element("tour-offer").hidden = true; }

  toggle(): void {
    this.endOffer();
    if (this.at !== null) return this.close();
    this.before = this.fragment.link();
    this.viewer.resetView();
    this.patch = patchInView(this.viewer);
    this.show(0);
    element("tour-next").focus();
  }

  private close(): void {
    this.at = null;
    element("tour").hidden = true;
    this.fragment.restore(this.before);
    element("picture").focus({ preventScroll: true });
  }

  private show(at: number): void {
    this.at = at;
    const step = STEPS[at]!;
    const { title, text, equation }: TourText = TOUR[step];
    element("tour").hidden = false;
    element("tour").dataset["step"] = step;
    element("tour-title").textContent = `${at + 1}. ${title}`;
    element("tour-text").textContent = text.replace("{patches}", counted(this.viewer.data.header.patches));
    element("tour-equation").textContent = equation;
    element<HTMLButtonElement>("tour-back").disabled = at === 0;
    element("tour-next").textContent = at === STEPS.length - 1 ? "End" : "Next";
    void this.arrange(step);
  }

  /** Makes the page show what the step is about. */
  private async arrange(step: Step): Promise<void> {
    const { viewer } = this;
    const row = step === "factor" || step === "hemicube";
    choose("surfaces", step === "patch" ? "flat" : "smooth");
    setTo("outlines", step === "patch" ? "1" : "0");
    setTo("paint", row ? "1" : "0");
    setTo("before-after", "0");
    setTo("show", row ? "factors" : step === "error" ? "difference" : "light");
    void viewer.pick("second", null);
    void viewer.pick("first", row || step === "patch" ? this.patch : null);
    if (step === "hemicube") this.standOnPatch();
    else viewer.resetView();
    const bounces = { first: 1, more: 3, error: 3 }[step as string];
    if (bounces === undefined) {
      this.converge.forget();
      viewer.showSolved();
    } else {
      await this.converge.to("jacobi", bounces);
    }
  }

  /** Looks from the patch along its normal. */
  private standOnPatch(): void {
    const { centroid, normal, header } = this.viewer.data;
    const place = (along: number) => [0, 1, 2].map((axis) => centroid[3 * this.patch + axis]! +
      header.origin[axis]! + along * normal[3 * this.patch + axis]!) as Rgb;
    this.viewer.control.place(place(OFF_PATCH * header.diagonal), place(0.1 * header.diagonal));
  }
}
