// node run.mjs FOLDER RADIOSITY: the tests of the page's browser half. FOLDER: everything is written there; packages
// are fetched once. RADIOSITY: the program. CHROMIUM (environment): the browser, else the first that is found.
import { execFileSync, spawnSync } from "node:child_process";
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const root = resolve(here, "../../..");
const [folder, program] = process.argv.slice(2).map((path) => resolve(path));
if (!program) {
  console.error("usage: node run.mjs FOLDER RADIOSITY");
  process.exit(2);
}
/** Parts of the page that node runs by themselves. */
const modules = [
  ...["factors", "solver", "relight", "vector_product", "session"],
  ...["container", "light", "load", "bvh", "gather_weights", "gather_eyes", "gather_chunks", "gather_batch", "pace"],
  ...["colour", "false_colour", "hemicube_picture"],
];
const sources = join(folder, "source");
const tests = join(folder, "tests");
const pages = join(folder, "pages");

function run(command, args, options = {}) {
  return execFileSync(command, args, {
    encoding: "utf8",
    stdio: ["ignore", "pipe", "inherit"],
    maxBuffer: 1 << 28,
    ...options,
  });
}

/** A copy of `from` with its packages. */
function install(from, to) {
  mkdirSync(to, { recursive: true });
  const lock = readFileSync(join(from, "package-lock.json"), "utf8");
  const stamp = join(to, "installed-lock.json");
  cpSync(from, to, { recursive: true });
  if (existsSync(stamp) && readFileSync(stamp, "utf8") === lock) return;
  run("npm", ["ci", "--no-audit", "--no-fund", "--loglevel=error"], { cwd: to });
  writeFileSync(stamp, lock);
}

/** The page of a scene: data of the program under test, in the template of these sources. */
function makePage(template, name, scene, options, looks = [], stage = "solve") {
  const results = join(pages, `${name}.h5`),
    made = join(pages, `${name}.made.html`);
  run(program, [stage, resolve(root, "data", scene), "-o", results, "--quiet", ...options]);
  run(program, ["view", results, "-o", made, "--quiet", ...looks]);
  const data = readFileSync(made, "utf8").match(/<script id="radiosity-data"[^]*?<\/script>/)[0];
  writeFileSync(
    join(pages, `${name}.html`),
    template.replace("<!--radiosity-data-->", () => data),
  );
}

install(join(root, "src/page/browser"), sources);
install(here, tests);
mkdirSync(pages, { recursive: true });
run("npx", ["tsc", "--noEmit"], { cwd: sources, stdio: "inherit" });
run("node", ["build.mjs", join(folder, "template.html")], { cwd: sources });
run(
  "npx",
  [
    "esbuild",
    ...modules.map((name) => `${name}.ts`),
    "--bundle",
    "--format=esm",
    "--out-extension:.js=.mjs",
    `--outdir=${join(folder, "modules")}`,
    "--log-level=warning",
  ],
  { cwd: sources },
);
const { assembled } = await import(join(sources, "assemble.mjs"));
writeFileSync(join(folder, "modules/product.wasm"), await assembled(join(sources, "product.wat")));
const template = readFileSync(join(folder, "template.html"), "utf8");
makePage(template, "cornell", "cornell-box.obj", []);
makePage(template, "small", "cornell-box.obj", ["--patches", "400", "--solver", "jacobi"]);
makePage(template, "sweeps", "cornell-box.obj", ["--patches", "400", "--solver", "gauss-seidel"]);
makePage(template, "nodes", "furnished-room.obj", ["--method", "cut"], ["--elements", "off"]);
makePage(template, "textured", join(here, "textured.obj"), ["--patches", "150", "--sky", "0.5,0.6,0.8"]);
const oven = ["--patches", "200", "--thermal", join(root, "data/oven.csv"), "-o", join(pages, "heat.csv")];
makePage(template, "heat", "cornell-box-closed.obj", oven, ["--elements", "off"], "heat");
writeFileSync(join(pages, "empty.html"), template);

const files = readdirSync(tests)
  .filter((name) => name.endsWith(".test.mjs"))
  .map((name) => join(tests, name));
const done = spawnSync("node", ["--test", ...files], {
  stdio: "inherit",
  env: { ...process.env, PAGE_FOLDER: folder, RADIOSITY: program, PAGE_ROOT: root },
});
process.exit(done.status ?? 1);
