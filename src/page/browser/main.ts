// Starts the page: unpacks and checks its data, draws, and gives the solver its matrix.
import { readContainer, type PageData } from "./container";
import { ConvergePanel } from "./converge_panel";
import { fail, isCutShort } from "./failure";
import { GatherPanel } from "./gather_panel";
import { setUpHeat } from "./heat_panel";
import { setUpKeys } from "./keys";
import { unpack } from "./load";
import { setUpLook } from "./look_panel";
import { inspecting, pickAt, setUpPatch } from "./patch_panel";
import { setUpPointer } from "./pointer_value";
import { RelightPanel } from "./relight_panel";
import { setUpShare } from "./share_panel";
import { SETTLED_MS } from "./stage";
import { setUpSurfacePair } from "./surface_pair";
import { Tour } from "./tour";
import { copy, counted, element, make, on, onChoice, short } from "./ui";
import { Viewer } from "./viewer";

/** The names of the program's methods in a sentence. */
const METHODS: Record<string, string> = { rays: "ray-traced" };
const NARROW = "(max-width: 760px)";

/** Updates the loading bar: the share of the work, and the present step. */
async function loading(share: number, text: string): Promise<void> {
  element<HTMLProgressElement>("loading-bar").value = share;
  element("loading-text").textContent = text;
  await new Promise((resume) => setTimeout(resume)); // lets it be drawn
}

async function readPage(): Promise<PageData> {
  const script = document.getElementById("radiosity-data");
  if (!script?.textContent) throw new Error("This page holds no scene: write one with radiosity view");
  const buffer = await unpack(script.textContent, (share) => void loading(0.5 * share, "Unpacking…"));
  script.remove(); // frees megabytes of text
  return readContainer(buffer);
}

const percent = (x: number): string => `${short(100 * x)}%`;

function sayAbout(viewer: Viewer): void {
  const { header } = viewer.data;
  const { quantisation: q, solver } = header;
  const rows: [string, string][] = [
    ["Written by", header.program],
    ["Patches", counted(header.patches)],
    ["Form factors between", viewer.clustered ? `${counted(header.nodes)} nodes of patches` : "patches"],
    ["Form factors by", header.method + (header.tolerance === null ? "" : `, tolerance ${short(header.tolerance)}`)],
    ["Scene", header.closed ? "closed" : "open"],
    ["Solved by", `${solver.name}, ${solver.iterations} iterations`],
    ["Residual", short(solver.residual)],
    ["16-bit form factors: error of each, at most", percent(q.largest_relative_error)],
    ["…of a row, at most", short(q.largest_row_error)],
  ];
  const texels = (header.textures ?? []).reduce((sum, { width, height }) => sum + width * height, 0);
  if (texels > 0) rows.push(["Textures", `${header.textures!.length}, ${counted(texels)} texels`]);
  if (!viewer.clustered) rows.push(["Stored light against these form factors", percent(viewer.agreement)]);
  element("about").replaceChildren(...rows.flatMap(([name, value]) => [make("dt", {}, name), make("dd", {}, value)]));
  if (viewer.clustered) {
    element("about").after(make("p", { class: "note" },
      "Form factors are summed over nodes of patches that are near each other and face alike. Direct light is known " +
      "patch by patch; what is reflected to a patch changes as it does for its node."));
  }
}

function sayTitle({ header }: PageData): void {
  document.title = `${header.title} – radiosity`;
  element("title").textContent = header.title;
  element("loading-title").textContent = header.title;
  element("subtitle").textContent = `${counted(header.patches)} patches, ` +
    (header.nodes === header.patches ? "" : `${counted(header.nodes)} nodes, `) +
    `${METHODS[header.method] ?? header.method} form factors`;
}

function setUpCamera(viewer: Viewer): void {
  const say = () => { element("camera-text").textContent = viewer.control.text(); };
  let settling = 0;
  viewer.control.listen(() => {
    say();
    window.clearTimeout(settling);
    settling = window.setTimeout(() => { element("lost").hidden = viewer.seesLight(); }, SETTLED_MS);
  });
  say();
  on("lost", "click", () => viewer.resetView());
  onChoice("move", (value) => { viewer.control.walking = value === "walk"; });
  on("reset-view", "click", () => viewer.resetView());
  on("copy-camera", "click", () => void copy(viewer.control.text(), element("copy-camera")));
}

function setUpPanels(viewer: Viewer): void {
  setUpLook(viewer);
  setUpPatch(viewer);
  setUpSurfacePair(viewer);
  setUpPointer(viewer);
  setUpHeat(viewer);
  const converge = new ConvergePanel(viewer);
  const relight = new RelightPanel(viewer, () => converge.forget());
  setUpCamera(viewer);
  const gather = new GatherPanel(viewer, () => converge.forget());
  viewer.control.onTap = (x, y, second) => { if (inspecting()) pickAt(viewer, x, y, second); };
  on("open-help", "click", () => element<HTMLDialogElement>("help").showModal());
  on("to-stored", "click", () => {
    gather.forget();
    converge.forget();
    relight.reset();
  });
  viewer.listen("light", () => {
    const words = { stored: "Light as stored", relit: "Relit", run: converge.moment(), gathered: gather.moment() };
    element("source").textContent = words[viewer.source];
    element("to-stored").hidden = viewer.source === "stored";
  });
  if (window.matchMedia(NARROW).matches) {
    for (const panel of document.querySelectorAll("details")) panel.open = false;
  }
  const fragment = setUpShare(viewer, relight); // after all others, since it restores what an address says
  const tour = new Tour(viewer, converge, fragment);
  setUpKeys(viewer, converge, gather, tour);
  tour.offer();
}

async function begin(): Promise<void> {
  const data = await readPage();
  sayTitle(data);
  await loading(0.6, "Setting up the picture…");
  element("app").hidden = false; // the canvas needs its size
  const viewer = new Viewer(data, element<HTMLCanvasElement>("picture"));
  element("no-picture").hidden = viewer.stage.draws;
  viewer.solver.onFailure = (message) => fail(`The solver stopped: ${message}`);
  await loading(0.8, "Decoding form factors…");
  await viewer.start();
  setUpPanels(viewer);
  sayAbout(viewer);
  viewer.refreshTheme();
  for (const query of ["(prefers-color-scheme: dark)", "(prefers-contrast: more)"]) {
    window.matchMedia(query).addEventListener("change", () => viewer.refreshTheme());
  }
  element("loading").hidden = true;
  document.documentElement.dataset["ready"] = String(Math.round(performance.now())); // ms, tests wait for it
}

document.addEventListener("DOMContentLoaded", () => {
  if (!isCutShort()) begin().catch((error: unknown) => fail(error instanceof Error ? error.message : String(error)));
});
